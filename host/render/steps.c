/* A picture in steps, each of which shows the whole picture: every eighth pixel of rows and
   columns, every fourth, every second, all. A step draws the pixels that the steps before it have
   not. */
#include <stdlib.h>

#include "base/array.h"
#include "device/buffer.h"
#include "render/hooks.h"
#include "render/readback.h"
#include "render/renderer.h"
#include "render/steps.h"
#include "render/tiles.h"
#include "render/views.h"

enum { SIDE_MIN = 16 };

/* Offset of a step's pixels in their squares of `spacing` x `spacing`. It is near the middle, and
   such that all later steps have these pixels too. */
static uint32_t first_pixel(uint32_t spacing)
{
    return spacing == 8 ? 5 : spacing > 1;
}

static struct lattice make_lattice(const whit_renderer_params *params, uint32_t x, uint32_t y,
                                   uint32_t spacing_x, uint32_t spacing_y)
{
    return (struct lattice){
        .x = x,
        .y = y,
        .spacing_x = spacing_x,
        .spacing_y = spacing_y,
        .width = (params->width - x + spacing_x - 1) / spacing_x,
        .height = (params->height - y + spacing_y - 1) / spacing_y,
    };
}

struct lattice lattice_whole(const struct renderer *renderer)
{
    struct lattice lattice = make_lattice(&renderer->params, 0, 0, 1, 1);
    lattice.height = renderer->params.first_row + views_rows(renderer);
    return lattice;
}

static uint32_t log2_of(uint32_t spacing)
{
    return spacing == 8 ? 3 : spacing / 2;
}

uint32_t lattice_word(const struct lattice *lattice)
{
    return log2_of(lattice->spacing_x) | log2_of(lattice->spacing_y) << LATTICE_ROWS_SHIFT |
           lattice->x << LATTICE_X_SHIFT | lattice->y << LATTICE_Y_SHIFT;
}

bool steps_are_wanted(const struct renderer *renderer)
{
    const whit_renderer_params *params = &renderer->params;
    return params->step && params->step_spacing && !params->row_count && !renderer->views.count &&
           params->width >= SIDE_MIN && params->height >= SIDE_MIN && !params->count &&
           readback_is_late(renderer);
}

/* The row or column of the picture that square `at` of a step shows: its own pixel, or the one of
   the square before if its own is outside of the picture. */
static uint32_t pixel_of(uint32_t at, uint32_t spacing, uint32_t end)
{
    uint32_t first = first_pixel(spacing), pixel = at * spacing + first;
    return pixel < end ? pixel : pixel - spacing;
}

/* Reads row `y` of the image that steps show: an aov or the colours. `all`: room for all aovs of a
   row. */
static whit_result read_row(const struct renderer *renderer, uint32_t y, float *all, float *row)
{
    const whit_renderer_params *params = &renderer->params;
    uint64_t row_bytes = (uint64_t)params->width * 4 * sizeof *row;
    uint32_t aov = params->step_aov;
    if (aov)
        return readback_aov_row(renderer, aov - 1, y, all, row);
    return buffer_read(renderer->picture.buffers.pixels, y * row_bytes, row, row_bytes);
}

static whit_result read_step(const struct renderer *renderer, const whit_step *step, float *all,
                             float *row, float *rgba)
{
    const whit_renderer_params *params = &renderer->params;
    whit_result result = WHIT_OK;
    for (uint32_t y = 0; result == WHIT_OK && y < step->height; ++y) {
        result = read_row(renderer, pixel_of(y, step->spacing, params->height), all, row);
        for (uint32_t x = 0; x < step->width; ++x, rgba += 4) {
            const float *pixel = &row[4 * (size_t)pixel_of(x, step->spacing, params->width)];
            for (int i = 0; i < 4; ++i)
                rgba[i] = pixel[i];
        }
    }
    return result;
}

whit_result steps_give(const struct renderer *renderer, uint32_t spacing)
{
    const whit_renderer_params *params = &renderer->params;
    whit_step step = {
        .spacing = spacing,
        .width = (params->width + spacing - 1) / spacing,
        .height = (params->height + spacing - 1) / spacing,
    };
    float *rgba = array_alloc((size_t)step.width * step.height, 4 * sizeof *rgba);
    float *row = array_alloc(params->width, 4 * sizeof *row);
    size_t aovs = hooks_aov_count(&renderer->picture);
    float *all = array_alloc(params->width, (aovs ? aovs : 1) * 4 * sizeof *all);
    whit_result result = rgba && row && all ? read_step(renderer, &step, all, row, rgba)
                                            : render_no_memory(renderer, "a step");
    step.rgba = rgba;
    if (result == WHIT_OK)
        params->step(params->progress_user, &step);
    free(rgba);
    free(row);
    free(all);
    return result;
}

static whit_result draw_lattice(struct renderer *renderer, struct progress *progress,
                                const struct lattice *lattice)
{
    const whit_renderer_params *params = &renderer->params;
    progress->lattice = *lattice;
    progress->share =
        (double)lattice->width * lattice->height / ((double)params->width * params->height);
    return render_pass(renderer, params->sampling.count, progress);
}

/* Draws the step of half the spacing, which has twice as many rows. New rows are drawn whole, since
   packets of rays gain by pixels side by side; in the other rows every second pixel is new. */
static whit_result draw_between(struct renderer *renderer, struct progress *progress,
                                uint32_t spacing)
{
    const whit_renderer_params *params = &renderer->params;
    uint32_t half = spacing / 2, first = first_pixel(half), drawn = first_pixel(spacing);
    uint32_t other = first + (drawn == first ? half : 0);
    const struct lattice rows = make_lattice(params, first, other, half, spacing);
    const struct lattice rest = make_lattice(params, other, drawn, spacing, spacing);
    whit_result result = draw_lattice(renderer, progress, &rows);
    return result == WHIT_OK ? draw_lattice(renderer, progress, &rest) : result;
}

whit_result steps_render(struct renderer *renderer, struct progress *progress)
{
    uint32_t spacing = renderer->params.step_spacing, first = first_pixel(spacing);
    const struct lattice begin = make_lattice(&renderer->params, first, first, spacing, spacing);
    whit_result result = draw_lattice(renderer, progress, &begin);
    for (; result == WHIT_OK && spacing > 1; spacing /= 2) {
        result = steps_give(renderer, spacing);
        if (result == WHIT_OK)
            result = draw_between(renderer, progress, spacing);
    }
    return result;
}
