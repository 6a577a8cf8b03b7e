#include "view/palette.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "view/ui.h"

whit_result palette_cut(const whit_image *image, uint32_t left, uint32_t top, uint32_t width,
                        uint32_t height, uint8_t *rgba)
{
    whit_image_info info;
    whit_image_get_info(image, &info);
    uint8_t *all = malloc((size_t)info.width * info.height * 4);
    if (!all)
        return WHIT_ERROR_MEMORY;
    whit_image_display_bytes(image, all);
    for (uint32_t y = 0; y < height; ++y)
        memcpy(rgba + (size_t)y * width * 4, all + ((size_t)(top + y) * info.width + left) * 4,
               (size_t)width * 4);
    free(all);
    return WHIT_OK;
}

/* The heat map has its legend below, and may be wider on both sides. */
whit_result palette_heat(const whit_image *values, double scale, uint8_t *rgba)
{
    const whit_heat_params params = {.scale = scale};
    whit_image_info own, whole;
    whit_image *heat = NULL;
    whit_result result = whit_image_heat(values, &params, &heat);
    if (result != WHIT_OK)
        return result;
    whit_image_get_info(values, &own);
    whit_image_get_info(heat, &whole);
    result = palette_cut(heat, (whole.width - own.width) / 2, 0, own.width, own.height, rgba);
    whit_image_destroy(heat);
    return result;
}

whit_result palette_init(struct palette *palette)
{
    float ramp[PALETTE_COLORS];
    whit_image *values = NULL;
    for (int i = 0; i < PALETTE_COLORS; ++i)
        ramp[i] = (float)i / (PALETTE_COLORS - 1);
    palette->colors[PALETTE_COLORS] = 0xFFFF00FFu;
    whit_result result = whit_image_create(PALETTE_COLORS, 1, 1, ramp, &values);
    if (result == WHIT_OK)
        result = palette_heat(values, 1.0, (uint8_t *)palette->colors);
    whit_image_destroy(values);
    return result;
}

void palette_paint(const struct palette *palette, const float *values, uint64_t count, double scale,
                   uint32_t *rgba)
{
    const float to_index = (float)((PALETTE_COLORS - 1) / scale);
    for (uint64_t i = 0; i < count; ++i) {
        float at = values[i] * to_index;
        uint32_t index = at < PALETTE_COLORS - 1 ? (uint32_t)(at + 0.5f) : PALETTE_COLORS - 1;
        rgba[i] = palette->colors[isnan(at) ? PALETTE_COLORS : index];
    }
}

void palette_legend(const struct palette *palette, const char *id, const char *title, double scale)
{
    enum { TICKS = 5 };
    char numbers[TICKS][24];
    const char *labels[TICKS];
    for (int i = 0; i < TICKS; ++i) {
        snprintf(numbers[i], sizeof numbers[i], "%.4g%s", scale * i / (TICKS - 1),
                 i == TICKS - 1 ? "+" : "");
        labels[i] = numbers[i];
    }
    if (ui_panel_begin(id, 1.0f, 1.0f, UI_PANEL_PLAIN)) {
        ui_text("%s", title);
        ui_ramp(palette->colors, PALETTE_COLORS, labels, TICKS);
    }
    ui_panel_end();
}
