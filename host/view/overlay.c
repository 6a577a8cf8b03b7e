#include <string.h>

#include "view/overlay.h"
#include "view/view_private.h"

/* The colour-blind can tell blue and orange apart. */
static const uint32_t COLOR_INNER = 0xB0FFC060u, COLOR_LEAF = 0xD020A0FFu;

bool overlay_is_possible(const struct view *view)
{
    whit_camera_info info = {0};
    if (!view->camera_known)
        return false;
    if (view->file_camera >= 0 && view->scene)
        whit_scene_get_camera(view->scene->scene, (uint32_t)view->file_camera, &info);
    return view->file_camera < 0 || info.kind == WHIT_CAMERA_PERSPECTIVE;
}

void overlay_line(const struct view *view, const double a[3], const double b[3], uint32_t color,
                  float width)
{
    const whit_renderer_params *p = &view->settings.picture;
    double line[4];
    if (camera_project(&view->camera, a, b, p->width, p->height, line))
        ui_line((float)line[0], (float)line[1], (float)line[2], (float)line[3], color, width);
}

static void draw_box(const struct view *view, const whit_box *box)
{
    for (uint32_t i = 0; i < 8; ++i) {
        for (uint32_t k = 0; k < 3; ++k) {
            double a[3], b[3];
            uint32_t j = i | 1u << k;
            if (j == i)
                continue;
            for (int c = 0; c < 3; ++c) {
                a[c] = (double)box->corners[i][c];
                b[c] = (double)box->corners[j][c];
            }
            overlay_line(view, a, b, box->leaf ? COLOR_LEAF : COLOR_INNER, 1.0f);
        }
    }
}

void overlay_boxes(const struct view *view)
{
    const struct engine_frame *frame = &view->frame;
    uint64_t count = frame->boxes_total < ENGINE_BOXES_MAX ? frame->boxes_total : ENGINE_BOXES_MAX;
    if (!overlay_is_possible(view))
        return;
    for (uint64_t i = 0; frame->boxes && i < count; ++i)
        draw_box(view, &frame->boxes[i]);
}
