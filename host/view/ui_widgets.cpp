// The C interface to Dear ImGui: items of panels, and lines over the picture.
#include "view/ui_inside.hpp"

#include <cstdarg>
#include <cstdio>

#include <imgui.h>

// Most bytes of a text, which may contain names of files, materials and cameras.
enum { SHOWN_BYTES = 4096 };

static const char *shown(const char *text)
{
    static char out[SHOWN_BYTES];
    return whit_text_show(text, out, sizeof out);
}

static const char *shown_format(const char *format, va_list args)
{
    static char text[SHOWN_BYTES];
    std::vsnprintf(text, sizeof text, format, args);
    return shown(text);
}

static void put_text(ImU32 color, const char *text)
{
    ImGui::PushStyleColor(ImGuiCol_Text, color);
    ImGui::TextUnformatted(text);
    ImGui::PopStyleColor();
}

extern "C" {

void ui_text(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    put_text(UI_COLOR_TEXT, shown_format(format, args));
    va_end(args);
}

void ui_paragraph(const char *text)
{
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextUnformatted(shown(text));
    ImGui::PopTextWrapPos();
}

void ui_text_dim(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    put_text(UI_COLOR_DIM, shown_format(format, args));
    va_end(args);
}

void ui_text_color(uint32_t color, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    put_text(color, shown_format(format, args));
    va_end(args);
}

void ui_text_beside(uint32_t color, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    const char *text = shown_format(format, args);
    va_end(args);
    float end = ImGui::GetItemRectMax().x - ImGui::GetWindowPos().x +
                ImGui::GetStyle().ItemSpacing.x + ImGui::CalcTextSize(text).x;
    if (end <= panel_width() - ImGui::GetStyle().WindowPadding.x)
        ImGui::SameLine();
    put_text(color, text);
}

void ui_cell(uint32_t color, const char *text)
{
    ImGui::TableNextColumn();
    ImGui::PushTextWrapPos(0.0f); // wraps at the cell's right side
    put_text(color, shown(text));
    ImGui::PopTextWrapPos();
}

void ui_separator(void)
{
    ImGui::Separator();
}
void ui_same_line(float x)
{
    ImGui::SameLine(x * ImGui::GetFontSize() * 0.54f);
}
static bool noted(bool done, const char *label)
{
    note_item(label);
    return done;
}

bool ui_button(const char *label)
{
    return noted(ImGui::Button(label), label);
}
bool ui_selectable(const char *label, bool selected)
{
    return noted(ImGui::Selectable(label, selected), label);
}
bool ui_fold(const char *label, bool open)
{
    ImGui::SetNextItemOpen(open, ImGuiCond_Once);
    return noted(ImGui::CollapsingHeader(label), label);
}
bool ui_checkbox(const char *label, bool *value)
{
    return noted(ImGui::Checkbox(label, value), label);
}

static float field_width()
{
    return 9.0f * ImGui::GetFontSize();
}

bool ui_choice(const char *label, const char *preview, const char *const *names, int count,
               int *value)
{
    ImGui::SetNextItemWidth(field_width());
    bool open = ImGui::BeginCombo(label, shown(preview)), chosen = false;
    note_item(label);
    if (open && note_menu())
        ImGui::CloseCurrentPopup();
    for (int i = 0; open && i < count; ++i) {
        ImGui::PushID(i); // two files may have the same name
        if (ui_selectable(shown(names[i]), i == *value)) {
            *value = i;
            chosen = true;
        }
        ImGui::PopID();
    }
    if (open)
        ImGui::EndCombo();
    return chosen;
}

bool ui_slider(const char *label, double *value, double lo, double hi, bool logarithmic)
{
    ImGui::SetNextItemWidth(field_width());
    bool moved =
        ImGui::SliderScalar(label, ImGuiDataType_Double, value, &lo, &hi, "%.4g",
                            logarithmic ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None);
    return noted(moved, label);
}

bool ui_color(const char *label, float rgb[3])
{
    return noted(ImGui::ColorEdit3(label, rgb, ImGuiColorEditFlags_DisplayHex), label);
}

bool ui_slider_count(const char *label, uint32_t *value, uint32_t lo, uint32_t hi)
{
    ImGui::SetNextItemWidth(field_width());
    return noted(ImGui::SliderScalar(label, ImGuiDataType_U32, value, &lo, &hi), label);
}

void ui_ramp(const uint32_t *colors, int count, const char *const *labels, int label_count)
{
    float em = ImGui::GetFontSize(), width = 20.0f * em, height = 0.8f * em;
    ImVec2 at = ImGui::GetCursorScreenPos();
    ImDrawList *list = ImGui::GetWindowDrawList();
    for (int i = 0; i < count; ++i)
        list->AddRectFilled(ImVec2(at.x + width * (float)i / (float)count, at.y),
                            ImVec2(at.x + width * (float)(i + 1) / (float)count, at.y + height),
                            colors[i]);
    float last = width - ImGui::CalcTextSize(labels[label_count - 1]).x - 0.5f * em, end = 0.0f;
    for (int i = 0; i < label_count; ++i) {
        float part = (float)i / (float)(label_count - 1);
        float wide = ImGui::CalcTextSize(labels[i]).x, x = at.x + part * width;
        list->AddLine(ImVec2(x, at.y + height), ImVec2(x, at.y + height + 0.25f * em), 0xFFE0E0E0u,
                      line_scale);
        float left = part * (width - wide);
        if (i > 0 && i < label_count - 1 && (left < end || left + wide > last))
            continue; // no room for the label
        list->AddText(ImVec2(at.x + left, at.y + height + 0.25f * em), 0xFFE0E0E0u, labels[i]);
        end = left + wide + 0.5f * em;
    }
    ImGui::Dummy(ImVec2(width, height + 1.25f * em));
}

void ui_progress(float part, const char *text)
{
    ImGui::ProgressBar(part < 0.0f ? 0.0f : part, ImVec2(18.0f * ImGui::GetFontSize(), 0.0f),
                       shown(text));
}

bool ui_table_begin(const char *id, int columns)
{
    return ImGui::BeginTable(id, columns,
                             ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerV |
                                 ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_NoHostExtendX);
}

static float character_width()
{
    return ImGui::CalcTextSize("0").x;
}

static int characters_in(float width, int columns)
{
    float room = width - (float)columns * (2.0f * ImGui::GetStyle().CellPadding.x + 1.0f);
    return (int)(room / character_width());
}

int ui_characters(int columns)
{
    const ImGuiStyle &style = ImGui::GetStyle();
    return characters_in(panel_width() - 2.0f * style.WindowPadding.x - style.ScrollbarSize,
                         columns);
}

int ui_characters_here(int columns)
{
    return characters_in(ImGui::GetContentRegionAvail().x, columns);
}

void ui_table_columns(const char *const *heads, const int *characters, int count)
{
    for (int i = 0; i < count; ++i) {
        bool fixed = !heads || characters[i] > 0;
        ImGui::TableSetupColumn(heads ? heads[i] : "",
                                fixed ? ImGuiTableColumnFlags_WidthFixed
                                      : ImGuiTableColumnFlags_None,
                                fixed ? (float)characters[i] * character_width() + 1.0f : 0.0f);
    }
    if (heads)
        ImGui::TableHeadersRow();
}

void ui_table_next(void)
{
    ImGui::TableNextColumn();
}
void ui_table_end(void)
{
    ImGui::EndTable();
}

void ui_line(float x0, float y0, float x1, float y1, uint32_t color, float width)
{
    ImGui::GetBackgroundDrawList()->AddLine(ImVec2(x0, y0), ImVec2(x1, y1), color,
                                            width * line_scale);
}

void ui_rectangle(float x0, float y0, float x1, float y1, uint32_t color)
{
    ImGui::GetBackgroundDrawList()->AddRect(ImVec2(x0, y0), ImVec2(x1, y1), color);
}

void ui_text_size(const char *text, float *width, float *height)
{
    ImVec2 size = ImGui::CalcTextSize(shown(text));
    *width = size.x;
    *height = size.y;
}

} // extern "C"
