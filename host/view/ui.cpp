// The C interface to Dear ImGui 1.86 and its Vulkan backend: memory, start and end, layout of
// panels. ui_widgets.cpp and ui_plots.cpp are the rest of the viewer's C++.
#include "view/ui_inside.hpp"

#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>

extern "C" {
#include "device/layers.h"
#include "device/swapchain.h"
#include "view/events.h"
}

struct ui {
    struct swapchain *swapchain;
    VkDescriptorPool descriptors;
    VkDevice device;
    float scale;
    bool backend, pressed[3], down[3];
    whit_result result; // of drawing: the first error
    int vertices;       // most vertices that there is memory for
    uint32_t images;    // see give_back
};

float line_scale = 1.0f;

// ---- Memory ----

// Dear ImGui does not check allocations. If memory runs out, a block that was set aside is freed,
// which suffices to the end of the frame; the next frame begins only if the block can be allocated
// again.
enum { SET_ASIDE_BYTES = 8 << 20 };
static void *aside;

static bool set_aside()
{
    if (!aside)
        aside = std::malloc(SET_ASIDE_BYTES);
    return aside != nullptr;
}

// Header of each block, in a list of all: so blocks that the backend leaves after a failure are
// freed too.
struct alignas(16) link {
    link *before, *after;
};
static link blocks = {&blocks, &blocks};

static void *take(size_t bytes, void *)
{
    link *block = static_cast<link *>(std::malloc(sizeof *block + bytes));
    if (!block) {
        std::free(aside);
        aside = nullptr;
        block = static_cast<link *>(std::malloc(sizeof *block + bytes));
    }
    if (!block) {
        std::fputs("whit: error: out of memory for the figures of the window\n", stderr);
        std::_Exit(2);
    }
    *block = link{&blocks, blocks.after};
    blocks.after->before = block;
    blocks.after = block;
    return block + 1;
}

static void give(void *memory, void *)
{
    if (!memory)
        return;
    link *block = static_cast<link *>(memory) - 1;
    block->before->after = block->after;
    block->after->before = block->before;
    std::free(block);
}

// ---- Failures of the backend ----

enum { IMAGES_MIN = 2 }; // the backend requires as many

// The backend goes on after a failed call, and uses what that did not create: an exception stops
// it.
struct failed_call {
    VkResult result;
};

static void check_call(VkResult result)
{
    if (result < 0)
        throw failed_call{result};
}

static whit_result say_failure(const struct ui *ui, const failed_call &failure)
{
    return swapchain_failed(ui->swapchain, failure.result, "the window's figures");
}

// ---- Where panels are ----

enum { PANELS_MAX = 24, ITEMS_MAX = 128, AGAIN_MAX = 8 };

struct panel {
    char title[32];
    ImVec2 size, at; // in the last frame that it was in
    ImVec2 content;  // what it had then; its size follows that in the next frame
    int frame;       // number of that frame
    bool cut;        // part of it is beyond its right side
    bool holds;      // it takes the mouse
};

// All panels. Those that were ended in this frame are obstacles for later ones.
static struct {
    panel panels[PANELS_MAX];
    int count, frame, current;
    int obstacles[PANELS_MAX], obstacle_count;
    panel kept_free; // area that later panels avoid; without a size: none
    bool changed, wraps;
    bool grows;                 // the current panel takes its size from its content
    bool crowded;               // an opened panel covers another for want of room
    bool releases;              // a button was pressed in this frame, and is released in the next
    bool has_menu, closes_menu; // a list of choices is open; it is to be closed
    bool had_menu;              // has_menu of the frame before
    int again;
} layout;

static struct {
    char label[48];
    ImVec2 middle;
} items[ITEMS_MAX];
static uint32_t item_count;

static int find_panel(const char *title)
{
    int oldest = 0;
    for (int i = 0; i < layout.count; ++i) {
        if (std::strncmp(layout.panels[i].title, title, sizeof layout.panels[i].title - 1) == 0)
            return i;
        if (layout.panels[i].frame < layout.panels[oldest].frame)
            oldest = i;
    }
    int at = layout.count < PANELS_MAX ? layout.count++ : oldest;
    layout.panels[at] = panel();
    std::snprintf(layout.panels[at].title, sizeof layout.panels[at].title, "%s", title);
    return at;
}

static float gap()
{
    return 6.0f * line_scale;
}

static const panel *obstacle_of(const ImVec2 &at, const ImVec2 &size)
{
    for (int i = layout.kept_free.size.x > 0.0f ? -1 : 0; i < layout.obstacle_count; ++i) {
        const panel &p = i < 0 ? layout.kept_free : layout.panels[layout.obstacles[i]];
        if (at.x < p.at.x + p.size.x + gap() && p.at.x < at.x + size.x + gap() &&
            at.y < p.at.y + p.size.y + gap() && p.at.y < at.y + size.y + gap())
            return &p;
    }
    return nullptr;
}

static float inside()
{
    return 10.0f * line_scale;
}

float panel_width()
{
    return ImGui::GetIO().DisplaySize.x - 2.0f * inside();
}

// Position of panels for which there is no room.
static const ImVec2 NOWHERE(-1e5f, -1e5f);

// Moves a panel from its corner away from the window's edge, until it covers no earlier one.
static ImVec2 free_place(ImVec2 at, const ImVec2 &size, float y, const ImVec2 &otherwise)
{
    float height = ImGui::GetIO().DisplaySize.y;
    for (int turn = 0; turn < PANELS_MAX && y != 0.5f; ++turn) {
        const panel *other = obstacle_of(at, size);
        if (!other)
            break;
        at.y = y < 0.5f ? other->at.y + other->size.y + gap() : other->at.y - gap() - size.y;
    }
    bool outside = at.y < 0.0f || at.y + size.y > height;
    return outside ? otherwise : at; // no room: the window is small
}

// The least height of a panel that scrolls.
static float lowest()
{
    return 70.0f * line_scale;
}

// The height available at `at` for a panel of this width: down to the next panel below or to the
// window's end, but never less than a minimum.
static float room_below(const ImVec2 &at, float width)
{
    float end = ImGui::GetIO().DisplaySize.y - gap();
    for (int i = 0; i < layout.obstacle_count; ++i) {
        const panel &p = layout.panels[layout.obstacles[i]];
        bool beside = at.x >= p.at.x + p.size.x + gap() || p.at.x >= at.x + width + gap();
        if (!beside && p.at.y >= at.y && p.at.y - gap() < end)
            end = p.at.y - gap();
    }
    return end - at.y > lowest() ? end - at.y : lowest();
}

static void note_panel(int index, bool holds, const ImVec2 &content)
{
    panel &p = layout.panels[index];
    ImVec2 size = ImGui::GetWindowSize(), at = ImGui::GetWindowPos();
    bool same = p.size.x == size.x && p.size.y == size.y && p.at.x == at.x && p.at.y == at.y &&
                p.content.x == content.x && p.content.y == content.y;
    layout.changed |= !same || p.frame != layout.frame - 1;
    p.content = content;
    p.size = size;
    p.at = at;
    p.cut = ImGui::GetScrollMaxX() > 0.0f;
    p.holds = holds;
    p.frame = layout.frame;
    if (layout.obstacle_count < PANELS_MAX && at.x > NOWHERE.x)
        layout.obstacles[layout.obstacle_count++] = index;
}

bool note_menu()
{
    layout.has_menu = !layout.closes_menu;
    layout.changed |= !layout.had_menu; // the list finds its size in this frame
    return layout.closes_menu;
}

void note_place(const char *label, float x, float y)
{
    if (item_count == ITEMS_MAX)
        return;
    const char *end = std::strstr(label, "##");
    int length = end ? (int)(end - label) : (int)std::strlen(label);
    std::snprintf(items[item_count].label, sizeof items[item_count].label, "%.*s", length, label);
    items[item_count++].middle = ImVec2(x, y);
}

void note_item(const char *label)
{
    ImVec2 lo = ImGui::GetItemRectMin(), hi = ImGui::GetItemRectMax();
    note_place(label, 0.5f * (lo.x + hi.x), 0.5f * (lo.y + hi.y));
}

static void make_fonts(void *user, void *commands)
{
    struct ui *ui = static_cast<struct ui *>(user);
    try {
        LAYERS_BESIDE(ImGui_ImplVulkan_CreateFontsTexture(static_cast<VkCommandBuffer>(commands)));
    } catch (const failed_call &failure) {
        ui->result = say_failure(ui, failure);
    }
}

// Dear ImGui's own font has 13 pixels and needs no file.
static void set_font(float scale, const uint8_t *data, size_t size_bytes)
{
    ImFontConfig font;
    font.SizePixels = 13.0f * scale;
    if (data) {
        font.FontDataOwnedByAtlas = false;
        ImGui::GetIO().Fonts->AddFontFromMemoryTTF(const_cast<uint8_t *>(data), (int)size_bytes,
                                                   (float)(int)(12.5f * scale + 0.5f), &font);
    } else {
        ImGui::GetIO().Fonts->AddFontDefault(&font);
    }
}

static void set_style(float scale)
{
    ImGui::StyleColorsDark();
    ImGuiStyle &style = ImGui::GetStyle();
    style.WindowRounding = 4.0f;
    style.FrameRounding = 3.0f;
    style.Colors[ImGuiCol_WindowBg] = ImVec4(0.06f, 0.07f, 0.09f, 0.86f);
    style.Colors[ImGuiCol_PopupBg] = ImVec4(0.06f, 0.07f, 0.09f, 1.0f);
    style.Colors[ImGuiCol_PlotHistogram] = ImVec4(0.16f, 0.42f, 0.62f, 1.0f); /* below white text */
    style.ScaleAllSizes(scale);
}

static void set_keys()
{
    int *keys = ImGui::GetIO().KeyMap;
    keys[ImGuiKey_Tab] = KEY_TAB;
    keys[ImGuiKey_LeftArrow] = KEY_LEFT;
    keys[ImGuiKey_RightArrow] = KEY_RIGHT;
    keys[ImGuiKey_UpArrow] = KEY_UP;
    keys[ImGuiKey_DownArrow] = KEY_DOWN;
    keys[ImGuiKey_Home] = KEY_HOME;
    keys[ImGuiKey_End] = KEY_END;
    keys[ImGuiKey_Delete] = KEY_DELETE;
    keys[ImGuiKey_Backspace] = KEY_BACKSPACE;
    keys[ImGuiKey_Enter] = KEY_ENTER;
    keys[ImGuiKey_Escape] = KEY_ESCAPE;
}

static void start_backend(struct ui *ui)
{
    struct swapchain_handles handles;
    swapchain_get_handles(ui->swapchain, &handles);
    ui->device = static_cast<VkDevice>(handles.device);
    VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 8};
    VkDescriptorPoolCreateInfo pool = {};
    pool.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    pool.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
    pool.maxSets = 8;
    pool.poolSizeCount = 1;
    pool.pPoolSizes = &size;
    check_call(LAYERS_BESIDE(vkCreateDescriptorPool(ui->device, &pool, nullptr, &ui->descriptors)));
    ImGui_ImplVulkan_InitInfo info = {};
    info.Instance = static_cast<VkInstance>(handles.instance);
    info.PhysicalDevice = static_cast<VkPhysicalDevice>(handles.physical);
    info.Device = ui->device;
    info.QueueFamily = handles.queue_family;
    info.Queue = static_cast<VkQueue>(handles.queue);
    info.PipelineCache = (VkPipelineCache)handles.pipeline_cache;
    info.DescriptorPool = ui->descriptors;
    info.MinImageCount = ui->images = IMAGES_MIN;
    info.ImageCount = handles.image_count;
    info.CheckVkResultFn = check_call;
    ui->backend = true; // also after an error: the backend knows what it has created
    LAYERS_BESIDE(ImGui_ImplVulkan_Init(&info, (VkRenderPass)handles.render_pass));
}

static whit_result start(struct ui *ui)
{
    try {
        start_backend(ui);
    } catch (const failed_call &failure) {
        return say_failure(ui, failure);
    }
    whit_result result = swapchain_submit(ui->swapchain, make_fonts, ui);
    if (result == WHIT_OK)
        result = ui->result;
    if (result == WHIT_OK)
        LAYERS_BESIDE(ImGui_ImplVulkan_DestroyFontUploadObjects());
    return result;
}

template <typename T> static void shrink(ImVector<T> &list)
{
    ImVector<T> copy;
    if (!list.empty()) // an empty list would be copied from a null pointer
        copy = list;   // the copy has the capacity that it needs
    list.swap(copy);
}

// Frees memory after frames with thousands of boxes, as lists and buffers of Dear ImGui only grow.
// Its backend drops its buffers when MinImageCount changes, which it uses for nothing else.
static bool give_back(struct ui *ui)
{
    enum { VERTICES_KEPT = 1 << 15 };
    int count = ImGui::GetDrawData()->TotalVtxCount;
    ui->vertices = count > ui->vertices ? count : ui->vertices;
    if (ui->vertices <= VERTICES_KEPT || count > ui->vertices / 4)
        return false;
    ui->vertices = count;
    ui->images = ui->images == IMAGES_MIN ? IMAGES_MIN + 1 : IMAGES_MIN;
    shrink(ImGui::GetBackgroundDrawList()->VtxBuffer);
    shrink(ImGui::GetBackgroundDrawList()->IdxBuffer);
    try {
        LAYERS_BESIDE(ImGui_ImplVulkan_SetMinImageCount(ui->images));
    } catch (const failed_call &failure) {
        ui->result = say_failure(ui, failure);
    }
    return true;
}

extern "C" {

whit_result ui_create(struct swapchain *swapchain, float scale, const uint8_t *font,
                      size_t font_bytes, struct ui **out)
{
    *out = nullptr;
    struct ui *ui = set_aside() ? new (std::nothrow) struct ui() : nullptr;
    if (!ui) {
        std::free(aside);
        aside = nullptr;
        return swapchain_failed(swapchain, VK_ERROR_OUT_OF_HOST_MEMORY, "the window's figures");
    }
    ImGui::SetAllocatorFunctions(take, give);
    ui->swapchain = swapchain;
    ui->scale = scale > 0.0f ? scale : 1.0f;
    line_scale = ui->scale;
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    ImGui::GetIO().BackendPlatformName = "whit";
    set_style(ui->scale);
    set_font(ui->scale, font, font_bytes);
    set_keys();
    whit_result result = start(ui);
    if (result != WHIT_OK) {
        ui->result = WHIT_OK;
        ui_destroy(ui);
        return result;
    }
    *out = ui;
    return WHIT_OK;
}

void ui_destroy(struct ui *ui)
{
    if (!ui)
        return;
    if (ui->device)
        (void)LAYERS_BESIDE(
            vkDeviceWaitIdle(ui->device)); // a lost device has nothing left to wait for
    // After an error in a frame the backend may have handles of destroyed objects: it is left as it
    // is.
    if (ui->backend && ui->result == WHIT_OK)
        LAYERS_BESIDE(ImGui_ImplVulkan_Shutdown());
    if (ui->device)
        LAYERS_BESIDE(vkDestroyDescriptorPool(ui->device, ui->descriptors, nullptr));
    ImGui::DestroyContext();
    while (blocks.after != &blocks)
        give(blocks.after + 1, nullptr);
    std::free(aside);
    aside = nullptr;
    delete ui;
}

void ui_mouse(struct ui *, float x, float y)
{
    ImGui::GetIO().MousePos = ImVec2(x, y);
}

// A press and its release between two frames also count as a click.
void ui_button_event(struct ui *ui, int button, bool down)
{
    ui->down[button] = down;
    ui->pressed[button] |= down;
}

void ui_wheel(struct ui *, float x, float y)
{
    ImGui::GetIO().MouseWheelH += x;
    ImGui::GetIO().MouseWheel += y;
}

void ui_key_event(struct ui *, int key, bool down)
{
    static_assert(KEY_ALT < IM_ARRAYSIZE(ImGuiIO::KeysDown), "it is the last key");
    ImGui::GetIO().KeysDown[key] = down;
}

void ui_character(struct ui *, uint32_t code_point)
{
    ImGui::GetIO().AddInputCharacter(code_point);
}

// Dear ImGui knows what the mouse was over when the last frame began; the mouse may have moved
// since.
bool ui_has_mouse(const struct ui *)
{
    ImVec2 mouse = ImGui::GetIO().MousePos;
    bool drags = ImGui::IsAnyItemActive() && ImGui::IsAnyMouseDown();
    bool over = drags || layout.has_menu || ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup);
    for (int i = 0; i < layout.obstacle_count; ++i) {
        const panel &p = layout.panels[layout.obstacles[i]];
        over |= p.holds && mouse.x >= p.at.x && mouse.y >= p.at.y && mouse.x < p.at.x + p.size.x &&
                mouse.y < p.at.y + p.size.y;
    }
    return over;
}

bool ui_close_menus(struct ui *)
{
    bool had = layout.has_menu;
    layout.closes_menu = had;
    return had;
}

bool ui_has_keys(const struct ui *)
{
    return ImGui::GetIO().WantTextInput;
}

bool ui_begin(struct ui *ui, uint32_t width, uint32_t height, double seconds, bool settles)
{
    if (!set_aside())
        return false;
    ImGuiIO &io = ImGui::GetIO();
    io.DisplaySize = ImVec2((float)width, (float)height);
    io.DeltaTime = seconds > 1e-4 ? (float)seconds : 1e-4f;
    layout.changed = layout.crowded = layout.releases = false;
    for (int i = 0; i < 3; ++i) {
        io.MouseDown[i] = ui->pressed[i] || ui->down[i];
        layout.releases |= io.MouseDown[i] != ui->down[i];
        ui->pressed[i] = false;
    }
    layout.again = settles ? layout.again : 0;
    ++layout.frame;
    layout.obstacle_count = 0;
    layout.kept_free.size = ImVec2(0.0f, 0.0f);
    layout.had_menu = layout.has_menu;
    layout.has_menu = false;
    item_count = 0;
    ImGui_ImplVulkan_NewFrame();
    ImGui::NewFrame();
    return true;
}

bool ui_end(struct ui *ui)
{
    layout.closes_menu = false;
    layout.again = layout.changed ? layout.again + 1 : 0;
    ImGui::Render();
    return give_back(ui);
}

// At most AGAIN_MAX times in a row, since numbers may change their width in every frame; but the
// release of a button always needs another frame.
bool ui_wants_again(const struct ui *)
{
    return layout.releases || (layout.again > 0 && layout.again < AGAIN_MAX);
}

bool ui_is_crowded(const struct ui *)
{
    return layout.crowded;
}

float ui_panel_height(const char *title)
{
    float height = layout.panels[find_panel(title)].content.y;
    return height > 0.0f ? height + 2.0f * ImGui::GetStyle().WindowPadding.y : 0.0f;
}

void ui_forget_panel(const char *title)
{
    layout.panels[find_panel(title)].content = ImVec2(0.0f, 0.0f);
}

float ui_scale(const struct ui *ui)
{
    return ui->scale;
}

bool ui_item(uint32_t index, const char **label, float *x, float *y)
{
    if (index >= item_count)
        return false;
    *label = items[index].label;
    *x = items[index].middle.x;
    *y = items[index].middle.y;
    return true;
}

void ui_draw(void *user, void *commands)
{
    struct ui *ui = static_cast<struct ui *>(user);
    try {
        LAYERS_BESIDE(ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(),
                                                      static_cast<VkCommandBuffer>(commands)));
    } catch (const failed_call &failure) {
        ui->result = say_failure(ui, failure);
    }
}

whit_result ui_result(const struct ui *ui)
{
    return ui->result;
}

// The corner of the window for a panel of this size.
static ImVec2 anchor_of(const ImVec2 &size, float x, float y)
{
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    return ImVec2(inside() + x * (window.x - 2.0f * inside() - size.x),
                  inside() + y * (window.y - 2.0f * inside() - size.y));
}

// Places a panel beside earlier ones; a plain one is moved to the other end of the window, or to
// NOWHERE, if there is no room.
static void place_beside(const ImVec2 &size, float x, float y, enum ui_panel kind)
{
    const ImVec2 anchor = anchor_of(size, x, y);
    bool stays = (kind & (UI_PANEL_HOLD | UI_PANEL_STAYS)) != 0;
    float height = kind & UI_PANEL_HOLD && size.y > lowest() ? lowest() : size.y;
    ImVec2 at = free_place(anchor, ImVec2(size.x, height), y, stays ? anchor : NOWHERE);
    if (at.x == NOWHERE.x)
        at = free_place(anchor_of(size, x, 1.0f - y), size, 1.0f - y, NOWHERE);
    layout.crowded |= (kind & UI_PANEL_HOLD) && obstacle_of(at, ImVec2(size.x, height));
    height = kind & UI_PANEL_HOLD ? room_below(at, size.x) : 1e6f;
    ImGui::SetNextWindowPos(at);
    ImGui::SetNextWindowSizeConstraints(ImVec2(0.0f, 0.0f), ImVec2(panel_width(), height));
}

bool ui_panel_begin(const char *title, float x, float y, enum ui_panel kind)
{
    int flags = ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings |
                ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav |
                ImGuiWindowFlags_NoMove;
    flags |= kind & UI_PANEL_HOLD
                 ? ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_HorizontalScrollbar
                 : ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs;
    layout.current = find_panel(title);
    place_beside(layout.panels[layout.current].size, x, y, kind);
    layout.wraps = !(kind & UI_PANEL_HOLD);
    bool open = ImGui::Begin(title, nullptr, flags);
    if (layout.wraps)
        ImGui::PushTextWrapPos(panel_width() - ImGui::GetStyle().WindowPadding.x);
    layout.grows = true;
    ImGui::BeginGroup(); // its size is that of the content
    return open;
}

bool ui_window_begin(const char *title, float x, float y, float width, float height, bool moves,
                     bool *open)
{
    int flags = ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                ImGuiWindowFlags_HorizontalScrollbar;
    layout.current = find_panel(title);
    layout.wraps = layout.grows = false;
    const ImGuiCond when = moves ? ImGuiCond_Always : ImGuiCond_Appearing;
    ImGui::SetNextWindowPos(anchor_of(ImVec2(0.0f, 0.0f), x, y), when, ImVec2(x, y));
    ImVec2 window = ImGui::GetIO().DisplaySize;
    float w = width * line_scale, h = height * line_scale, high = window.y - 2.0f * inside();
    ImGui::SetNextWindowSize(ImVec2(w < panel_width() ? w : panel_width(), h < high ? h : high),
                             when);
    ImGui::SetNextWindowContentSize(ImVec2(
        w - 2.0f * ImGui::GetStyle().WindowPadding.x - ImGui::GetStyle().ScrollbarSize, 0.0f));
    return ImGui::Begin(title, open, flags);
}

void ui_keep_free(float x, float y, float radius)
{
    layout.kept_free.at = ImVec2(x - radius, y - radius);
    layout.kept_free.size = ImVec2(2.0f * radius, 2.0f * radius);
}

void ui_panel_end(void)
{
    bool holds = !layout.wraps; // it takes the mouse
    if (layout.wraps)
        ImGui::PopTextWrapPos();
    layout.wraps = false;
    ImVec2 content(0.0f, 0.0f);
    if (layout.grows) {
        ImGui::EndGroup();
        content = ImGui::GetItemRectSize();
    }
    note_panel(layout.current, holds, content);
    ImGui::End();
}

bool ui_panel(uint32_t index, const char **title, float rectangle[4], bool *cut)
{
    if (index >= (uint32_t)layout.obstacle_count)
        return false;
    const panel &p = layout.panels[layout.obstacles[index]];
    const float sides[4] = {p.at.x, p.at.y, p.at.x + p.size.x, p.at.y + p.size.y};
    *title = p.title;
    *cut = p.cut;
    std::memcpy(rectangle, sides, sizeof sides);
    return true;
}

} // extern "C"
