// The C interface to Dear ImGui: plots and small pictures in panels.
#include "view/ui_inside.hpp"

#include <cstdio>
#include <cstring>
#include <math.h>

#include <imgui.h>

static const ImU32 COLOR_BOX = 0xFF808080u, COLOR_GRID = 0xFF404040u, COLOR_TEXT = 0xFFE0E0E0u;

namespace
{

struct box {
    ImVec2 lo, hi;
};

// A plot while it is drawn.
struct drawing {
    const ui_plot *plot;
    box inner;
    ImVector<box> taken; // rectangles of names and named points
};

} // namespace

static ImVec2 place_of(const drawing &drawing, float x, float y)
{
    const box &b = drawing.inner;
    return ImVec2(b.lo.x + x * (b.hi.x - b.lo.x), b.hi.y - y * (b.hi.y - b.lo.y));
}

static bool is_free(const drawing &drawing, const box &b)
{
    if (b.lo.x < drawing.inner.lo.x || b.lo.y < drawing.inner.lo.y || b.hi.x > drawing.inner.hi.x ||
        b.hi.y > drawing.inner.hi.y)
        return false;
    for (const box &other : drawing.taken)
        if (b.lo.x < other.hi.x && other.lo.x < b.hi.x && b.lo.y < other.hi.y &&
            other.lo.y < b.hi.y)
            return false;
    return true;
}

// Draws a name right of its point, else left of it, moved up or down if another name is there.
static void draw_name(drawing &drawing, const ui_point &point)
{
    enum { STEPS = 12 };
    ImVec2 at = place_of(drawing, point.x, point.y), size = ImGui::CalcTextSize(point.name);
    float gap = (point.radius + 3.0f) * line_scale;
    box name = {};
    bool found = false;
    for (int i = 0; i < 2 * STEPS && !found; ++i) {
        int up = (i / 2 + 1) / 2 * (i / 2 % 2 ? -1 : 1);
        name.lo.x = i % 2 ? at.x - gap - size.x : at.x + gap;
        name.lo.y = at.y + 0.5f * (float)up * size.y - 0.5f * size.y;
        name.hi = ImVec2(name.lo.x + size.x, name.lo.y + size.y);
        found = is_free(drawing, name);
    }
    if (!found)
        return; // the text under the mouse has the name too
    note_place(point.name, at.x, at.y);
    drawing.taken.push_back(name);
    ImGui::GetWindowDrawList()->AddText(name.lo, COLOR_TEXT, point.name);
}

static void draw_ticks(const drawing &drawing)
{
    ImDrawList *list = ImGui::GetWindowDrawList();
    const box &b = drawing.inner;
    for (uint32_t axis = 0; axis < 2; ++axis) {
        for (uint32_t i = 0; i < drawing.plot->tick_count[axis]; ++i) {
            const ui_tick &tick = drawing.plot->ticks[axis][i];
            ImVec2 at = place_of(drawing, tick.at, tick.at), size = ImGui::CalcTextSize(tick.label);
            list->AddLine(axis ? ImVec2(b.lo.x, at.y) : ImVec2(at.x, b.lo.y),
                          axis ? ImVec2(b.hi.x, at.y) : ImVec2(at.x, b.hi.y), COLOR_GRID,
                          line_scale);
            list->AddText(axis ? ImVec2(b.lo.x - size.x - 0.4f * size.y, at.y - 0.5f * size.y)
                               : ImVec2(at.x - 0.5f * size.x, b.hi.y + 0.15f * size.y),
                          COLOR_TEXT, tick.label);
        }
    }
}

static void draw_points(drawing &drawing)
{
    ImDrawList *list = ImGui::GetWindowDrawList();
    const ui_point *before = nullptr;
    for (uint32_t i = 0; i < drawing.plot->count; ++i) {
        const ui_point &point = drawing.plot->points[i];
        ImVec2 at = place_of(drawing, point.x, point.y);
        if (point.joined && before)
            list->AddLine(place_of(drawing, before->x, before->y), at, drawing.plot->line_color,
                          1.5f * line_scale);
        before = point.joined ? &point : before;
        float r = point.radius * line_scale;
        list->AddCircleFilled(at, r, point.color);
        if (point.name)
            drawing.taken.push_back({ImVec2(at.x - r, at.y - r), ImVec2(at.x + r, at.y + r)});
    }
    for (uint32_t i = 0; i < drawing.plot->count; ++i)
        if (drawing.plot->points[i].name)
            draw_name(drawing, drawing.plot->points[i]);
}

// Shows the text of the point that is nearest to the mouse.
static void draw_about(const drawing &drawing)
{
    ImVec2 mouse = ImGui::GetIO().MousePos;
    float nearest = 8.0f * line_scale;
    const char *about = nullptr;
    for (uint32_t i = 0; i < drawing.plot->count; ++i) {
        const ui_point &point = drawing.plot->points[i];
        ImVec2 at = place_of(drawing, point.x, point.y);
        float away = hypotf(at.x - mouse.x, at.y - mouse.y);
        if (away < nearest && point.about) {
            nearest = away;
            about = point.about;
        }
    }
    if (about)
        ImGui::SetTooltip("%s", about);
}

extern "C" {

float ui_log_place(double value, double low, double high)
{
    return low == high ? 0.5f : (float)(log(value / low) / log(high / low));
}

void ui_plot_points(const struct ui_plot *plot)
{
    float em = ImGui::GetFontSize(), left = 0.0f;
    for (uint32_t i = 0; i < plot->tick_count[1]; ++i)
        left = fmaxf(left, ImGui::CalcTextSize(plot->ticks[1][i].label).x + 0.4f * em);
    ImVec2 at = ImGui::GetCursorScreenPos();
    drawing drawing = {plot,
                       {ImVec2(at.x + left, at.y),
                        ImVec2(at.x + left + plot->width * em, at.y + plot->height * em)},
                       {}};
    const box &b = drawing.inner;
    ImGui::GetWindowDrawList()->AddRect(b.lo, b.hi, COLOR_BOX, 0.0f, 0, line_scale);
    draw_ticks(drawing);
    draw_points(drawing);
    ImGui::Dummy(ImVec2(b.hi.x - at.x, (plot->height + (plot->tick_count[0] ? 1.5f : 0.25f)) * em));
    if (ImGui::IsItemHovered())
        draw_about(drawing);
}

// Draws equal pixels of a row as one rectangle: pictures in panels are small, with few colours.
static void draw_pixels(const uint32_t *rgba, uint32_t width, uint32_t height, float side)
{
    ImDrawList *list = ImGui::GetWindowDrawList();
    ImVec2 at = ImGui::GetCursorScreenPos();
    for (uint32_t y = 0; y < height; ++y) {
        const uint32_t *row = rgba + (size_t)y * width;
        for (uint32_t x = 0, end; x < width; x = end) {
            for (end = x + 1; end < width && row[end] == row[x];)
                ++end;
            list->AddRectFilled(ImVec2(at.x + (float)x * side, at.y + (float)y * side),
                                ImVec2(at.x + (float)end * side, at.y + (float)(y + 1) * side),
                                row[x]);
        }
    }
}

void ui_picture(const uint32_t *rgba, uint32_t width, uint32_t height, const char *const *lines,
                uint32_t line_count)
{
    float wide = ImGui::GetContentRegionAvail().x, side = wide / (float)width;
    char label[128] = "";
    draw_pixels(rgba, width, height, side);
    ImGui::Dummy(ImVec2(wide, (float)height * side));
    for (uint32_t i = 0; i < line_count; ++i) {
        size_t used = std::strlen(label);
        std::snprintf(label + used, sizeof label - used, "%s%s", i ? ", " : "", lines[i]);
    }
    note_item(label);
    for (uint32_t i = 0; i < line_count; ++i)
        ui_paragraph(lines[i]);
}

} // extern "C"
