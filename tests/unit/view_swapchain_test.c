/* The pictures of a window, unscaled and stretched, windows that change, and every checked Vulkan
   call, made to fail in turn. */
#include "device/swapchain.h"
#include "device_fixture.h"
#include "unit.h"
#include "view/ui.h"
#include "view/window.h"

enum { WIDTH = 64, HEIGHT = 48, OUT_OF_DATE = -1000001004, SUBOPTIMAL = 1000001003 };

/* The objects of a viewer's window, with which each operation is done once. */
struct shop {
    struct window *window;
    struct device *device;
    struct swapchain *swapchain;
    struct ui *ui;
    struct messages messages;
};

/* Opens the ui with a font of this system; the package fonts-dejavu-core is required. */
static whit_result open_ui(struct shop *shop)
{
    own_memory uint8_t *font = NULL;
    size_t font_bytes;
    assert_true(font_load(&font, &font_bytes));
    return ui_create(shop->swapchain, 1.0f, font, font_bytes, &shop->ui);
}

static whit_result shop_open(struct shop *shop, bool validation)
{
    whit_log log = messages_log(&shop->messages);
    const struct window_params window = {.title = "test", .width = WIDTH, .height = HEIGHT};
    const struct swapchain_params chain = {.vsync = true};
    shop->device = NULL;
    shop->swapchain = NULL;
    shop->ui = NULL;
    whit_result result = window_create(&log, &window, &shop->window);
    if (result != WHIT_OK)
        return result;
    const whit_device_params device = {.validation = validation};
    result = device_create(&log, &device, window_surface(shop->window), &shop->device);
    if (result == WHIT_OK)
        result = swapchain_create(shop->device, &chain, &shop->swapchain);
    if (result == WHIT_OK)
        result = swapchain_resize(shop->swapchain, WIDTH, HEIGHT);
    return result == WHIT_OK ? open_ui(shop) : result;
}

static void shop_close(struct shop *shop)
{
    ui_destroy(shop->ui);
    swapchain_destroy(shop->swapchain);
    device_destroy(shop->device);
    window_destroy(shop->window);
    if (shop->messages.validation > 0)
        print_message("%s", shop->messages.text);
    assert_int_equal(shop->messages.validation, 0);
}

/* Sets a picture in which the colour of each pixel tells its place. */
static whit_result set_picture(struct shop *shop)
{
    uint8_t rgba[WIDTH * HEIGHT * 4];
    for (int i = 0; i < WIDTH * HEIGHT; ++i) {
        rgba[4 * i] = (uint8_t)(i % WIDTH * 3);
        rgba[4 * i + 1] = (uint8_t)(i / WIDTH * 5);
        rgba[4 * i + 2] = (uint8_t)(i * 7);
        rgba[4 * i + 3] = 255;
    }
    return swapchain_set_picture(shop->swapchain, rgba, WIDTH, HEIGHT);
}

static whit_result show_text(struct shop *shop, bool *shown)
{
    assert_true(ui_begin(shop->ui, WIDTH, HEIGHT, 0.01, false));
    ui_rectangle(1, 1, 9, 9, 0xFFFFFFFFu);
    if (ui_panel_begin("text", 0, 0, UI_PANEL_STAYS))
        ui_text("text");
    ui_panel_end();
    ui_end(shop->ui);
    return swapchain_show(shop->swapchain, ui_draw, shop->ui, false, shown);
}

/* Shows the window without an overlay, and reads its pixels. */
static whit_result read_window(struct shop *shop, uint8_t rgba[WIDTH * HEIGHT * 4])
{
    bool shown = false;
    whit_result result = swapchain_show(shop->swapchain, NULL, NULL, true, &shown);
    if (result == WHIT_OK)
        result = swapchain_read(shop->swapchain, rgba, WIDTH * HEIGHT * 4);
    if (result == WHIT_OK)
        assert_true(shown);
    return result;
}

/* Without a picture the window has one dark colour. */
static whit_result check_dark(struct shop *shop)
{
    uint8_t rgba[WIDTH * HEIGHT * 4];
    whit_result result = read_window(shop, rgba);
    for (size_t i = 0; i < sizeof rgba && result == WHIT_OK; ++i) {
        if (i % 4 < 3)
            assert_in_range(rgba[i], 10, 30);
        assert_int_equal(rgba[i], rgba[i % 4]);
    }
    return result;
}

static whit_result check_picture(struct shop *shop)
{
    uint8_t rgba[WIDTH * HEIGHT * 4];
    whit_result result = read_window(shop, rgba);
    if (result != WHIT_OK)
        return result;
    for (int i = 0; i < WIDTH * HEIGHT; ++i) {
        assert_int_equal(rgba[4 * i], (uint8_t)(i % WIDTH * 3));
        assert_int_equal(rgba[4 * i + 1], (uint8_t)(i / WIDTH * 5));
        assert_int_equal(rgba[4 * i + 2], (uint8_t)(i * 7));
    }
    return WHIT_OK;
}

/* A picture of two columns, dark and bright, is stretched over the window: each colour fills a
   quarter at its side, and between them pixels become brighter step by step. */
static whit_result check_stretched(struct shop *shop)
{
    const uint8_t columns[] = {0, 0, 0, 255, 200, 150, 250, 255};
    uint8_t rgba[WIDTH * HEIGHT * 4];
    whit_result result = swapchain_set_picture(shop->swapchain, columns, 2, 1);
    if (result == WHIT_OK)
        result = read_window(shop, rgba);
    if (result != WHIT_OK)
        return result;
    for (int x = 0; x < WIDTH; ++x) {
        const uint8_t *pixel = rgba + 4 * (WIDTH * (HEIGHT / 2) + x);
        double part = (2.0 * x + 1.0) / WIDTH - 0.5;
        part = part < 0.0 ? 0.0 : part > 1.0 ? 1.0 : part;
        for (int i = 0; i < 3; ++i)
            assert_in_range(pixel[i] + 2, columns[4 + i] * part, columns[4 + i] * part + 4.0);
    }
    return WHIT_OK;
}

static whit_result shop_work(struct shop *shop)
{
    bool shown = false;
    struct swapchain_info info;
    whit_result result = show_text(shop, &shown); /* before there is a picture */
    if (result == WHIT_OK)
        result = set_picture(shop);
    if (result == WHIT_OK)
        result = show_text(shop, &shown);
    if (result == WHIT_OK)
        result = check_picture(shop);
    if (result == WHIT_OK)
        result = swapchain_resize(shop->swapchain, 0, 0); /* minimised */
    if (result == WHIT_OK)
        result = show_text(shop, &shown);
    if (result != WHIT_OK)
        return result;
    assert_false(shown);
    result = swapchain_resize(shop->swapchain, WIDTH, HEIGHT);
    swapchain_get_info(shop->swapchain, &info);
    if (result != WHIT_OK)
        return result;
    assert_int_equal(info.width, WIDTH);
    result = check_dark(shop);
    if (result == WHIT_OK)
        result = set_picture(shop);
    if (result == WHIT_OK)
        result = check_picture(shop);
    return result == WHIT_OK ? check_stretched(shop) : result;
}

static whit_result shop_run(struct shop *shop, bool validation)
{
    whit_result result = shop_open(shop, validation);
    if (result == WHIT_OK)
        result = shop_work(shop);
    return result;
}

TEST(pictures_come_whole)
{
    struct shop shop;
    struct swapchain_info info;
    assert_int_equal(shop_run(&shop, true), WHIT_OK);
    swapchain_get_info(shop.swapchain, &info);
    assert_int_equal(info.recreated, 2);
    assert_true(info.image_count >= 2);
    shop_close(&shop);
    assert_int_equal(shop.messages.lines, 0);
}

static unsigned number_of(const char *variable, unsigned otherwise)
{
    const char *text = getenv(variable);
    return text && text[0] ? (unsigned)strtoul(text, NULL, 10) : otherwise;
}

/* Makes every `step`-th Vulkan call fail. WHIT_TEST_OFFSET says from which call on, and with
   WHIT_TEST_EVERY=1 all of them fail. A few fail under the validation layers, which are slow, but
   see objects that are left behind. */
static void fail_each_call(bool validation, unsigned step)
{
    whit_result result = WHIT_ERROR_FAILED;
    step = number_of("WHIT_TEST_EVERY", step);
    unsigned call = 1 + number_of("WHIT_TEST_OFFSET", 0) % step, runs = 0;
    for (; result != WHIT_OK && call < 400; call += step, ++runs) {
        struct shop shop;
        char fault[32];
        snprintf(fault, sizeof fault, "*:%u", call);
        setenv("WHIT_FAULT", fault, 1);
        result = shop_run(&shop, validation);
        if (result != WHIT_OK) {
            assert_true(result == WHIT_ERROR_MEMORY || result == WHIT_ERROR_DEVICE);
            if (shop.messages.errors - shop.messages.validation != 1)
                print_message("call %u: %s", call, shop.messages.text);
            assert_int_equal(shop.messages.errors - shop.messages.validation, 1);
        }
        shop_close(&shop);
    }
    unsetenv("WHIT_FAULT");
    assert_int_equal(result, WHIT_OK);
    print_message("%u of some %u checked calls failed%s\n", runs - 1, call - step,
                  validation ? ", validated" : "");
    assert_true(call > 60); /* that it failed all along */
}

TEST(each_call_may_fail)
{
    fail_each_call(false, 3);
}

TEST(nothing_is_left_behind)
{
    fail_each_call(true, 8);
}

/* When `call` says that the window has changed, the swapchain reports that it is stale, and shows
   nothing more until it gets its new size. */
static void change_at(const char *call, int result, bool shown_then)
{
    struct shop shop;
    struct swapchain_info info;
    char fault[64];
    bool shown = false;
    snprintf(fault, sizeof fault, "%s:2:%d", call, result);
    setenv("WHIT_FAULT", fault, 1);
    assert_int_equal(shop_open(&shop, true), WHIT_OK);
    assert_int_equal(set_picture(&shop), WHIT_OK);
    assert_int_equal(show_text(&shop, &shown), WHIT_OK);
    assert_true(shown);
    assert_int_equal(show_text(&shop, &shown), WHIT_OK);
    assert_int_equal(shown, shown_then);
    swapchain_get_info(shop.swapchain, &info);
    assert_true(info.stale);
    assert_int_equal(show_text(&shop, &shown), WHIT_OK); /* not before its new size */
    assert_false(shown);
    assert_int_equal(swapchain_resize(shop.swapchain, WIDTH, HEIGHT), WHIT_OK);
    swapchain_get_info(shop.swapchain, &info);
    assert_false(info.stale);
    assert_int_equal(check_dark(&shop), WHIT_OK);
    assert_int_equal(set_picture(&shop), WHIT_OK);
    assert_int_equal(check_picture(&shop), WHIT_OK);
    unsetenv("WHIT_FAULT");
    assert_int_equal(shop.messages.lines, 0);
    shop_close(&shop);
}

TEST(windows_that_change)
{
    change_at("vkAcquireNextImageKHR", OUT_OF_DATE, false);
    change_at("vkAcquireNextImageKHR", SUBOPTIMAL, true);
    change_at("vkQueuePresentKHR", OUT_OF_DATE, false);
    change_at("vkQueuePresentKHR", SUBOPTIMAL, true);
}

TEST(a_lost_device_is_said_once)
{
    static const char *const calls[] = {"vkQueueSubmit:2", "vkWaitForFences:2",
                                        "vkQueuePresentKHR:1:-4", "vkAcquireNextImageKHR:1:-4"};
    for (size_t i = 0; i < sizeof calls / sizeof *calls; ++i) {
        struct shop shop;
        bool shown = false;
        setenv("WHIT_FAULT", calls[i], 1);
        assert_int_equal(shop_run(&shop, true), WHIT_ERROR_DEVICE);
        assert_int_equal(shop.messages.errors, 1);
        assert_non_null(strstr(shop.messages.text, "VK_ERROR_DEVICE_LOST"));
        assert_int_equal(show_text(&shop, &shown), WHIT_ERROR_DEVICE);
        assert_false(shown);
        assert_int_equal(swapchain_resize(shop.swapchain, 8, 8), WHIT_ERROR_DEVICE);
        assert_int_equal(shop.messages.lines, 1);
        unsetenv("WHIT_FAULT");
        shop_close(&shop);
    }
}

TEST(no_surface)
{
    struct shop shop;
    setenv("WHIT_FAULT", "vkCreateSurface:1", 1);
    assert_int_equal(shop_open(&shop, true), WHIT_ERROR_MEMORY);
    unsetenv("WHIT_FAULT");
    assert_non_null(strstr(shop.messages.text, "the window's surface"));
    assert_int_equal(shop.messages.lines, 1);
    shop_close(&shop);
}
