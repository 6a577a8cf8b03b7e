/* A picture in steps, each of which shows all of it: every eighth pixel of rows and columns, every
   fourth, every second, all. A step draws what those before it have not. */
#include <stdlib.h>

#include "base/array.h"
#include "render/renderer.h"

enum { SIDE_MIN = 16 };

/* The first pixel of a step is near the middle of its square, and of every step after it. */
static uint32_t first_pixel(uint32_t spacing)
{
    return spacing == 8 ? 5 : spacing > 1;
}

static struct lattice make_lattice(const whit_renderer_params *params, uint32_t spacing, uint32_t x,
                                   uint32_t y)
{
    return (struct lattice){
        .spacing = spacing,
        .x = x,
        .y = y,
        .width = (params->width - x + spacing - 1) / spacing,
        .height = (params->height - y + spacing - 1) / spacing,
    };
}

struct lattice lattice_whole(const whit_renderer_params *params)
{
    return make_lattice(params, 1, 0, 0);
}

uint32_t lattice_word(const struct lattice *lattice)
{
    uint32_t shift = 0;
    while (lattice->spacing >> (shift + 1))
        ++shift;
    return shift | lattice->x << LATTICE_X_SHIFT | lattice->y << LATTICE_Y_SHIFT;
}

bool steps_are_wanted(const struct renderer *renderer)
{
    const whit_renderer_params *params = &renderer->params;
    return params->step && params->step_spacing && params->width >= SIDE_MIN &&
           params->height >= SIDE_MIN && !params->count && readback_is_late(renderer);
}

/* A column or row of squares that ends outside of the picture shows what is left of or above it. */
static uint32_t pixel_of(uint32_t at, uint32_t spacing, uint32_t end)
{
    uint32_t first = first_pixel(spacing), pixel = at * spacing + first;
    return pixel < end ? pixel : pixel - spacing;
}

static whit_result read_step(const struct renderer *renderer, const whit_step *step, float *row,
                             float *rgba)
{
    const whit_renderer_params *params = &renderer->params;
    uint64_t row_bytes = (uint64_t)params->width * 4 * sizeof *row;
    whit_result result = WHIT_OK;
    for (uint32_t y = 0; result == WHIT_OK && y < step->height; ++y) {
        uint64_t at = pixel_of(y, step->spacing, params->height);
        result = buffer_read(renderer->picture.buffers.pixels, at * row_bytes, row, row_bytes);
        for (uint32_t x = 0; x < step->width; ++x, rgba += 4) {
            const float *pixel = &row[4 * (size_t)pixel_of(x, step->spacing, params->width)];
            for (int i = 0; i < 4; ++i)
                rgba[i] = pixel[i];
        }
    }
    return result;
}

static whit_result give_step(const struct renderer *renderer, uint32_t spacing)
{
    const whit_renderer_params *params = &renderer->params;
    whit_step step = {
        .spacing = spacing,
        .width = (params->width + spacing - 1) / spacing,
        .height = (params->height + spacing - 1) / spacing,
    };
    float *rgba = array_alloc((size_t)step.width * step.height, 4 * sizeof *rgba);
    float *row = array_alloc(params->width, 4 * sizeof *row);
    whit_result result =
        rgba && row ? read_step(renderer, &step, row, rgba) : render_no_memory(renderer, "a step");
    step.rgba = rgba;
    if (result == WHIT_OK)
        params->step(params->progress_user, &step);
    free(rgba);
    free(row);
    return result;
}

static whit_result draw_lattice(struct renderer *renderer, struct progress *progress,
                                uint32_t spacing, uint32_t x, uint32_t y)
{
    const whit_renderer_params *params = &renderer->params;
    progress->lattice = make_lattice(params, spacing, x, y);
    progress->share = (double)progress->lattice.width * progress->lattice.height /
                      ((double)params->width * params->height);
    return render_pass(renderer, params->sampling.count, progress);
}

/* Every pixel of a step of half the spacing is one of four of this spacing, of which one is
   drawn. */
static whit_result draw_between(struct renderer *renderer, struct progress *progress,
                                uint32_t spacing)
{
    uint32_t half = spacing / 2, first = first_pixel(half), drawn = first_pixel(spacing);
    whit_result result = WHIT_OK;
    for (uint32_t i = 0; result == WHIT_OK && i < 4; ++i) {
        uint32_t x = first + half * (i & 1), y = first + half * (i >> 1);
        if (x != drawn || y != drawn)
            result = draw_lattice(renderer, progress, spacing, x, y);
    }
    return result;
}

whit_result steps_render(struct renderer *renderer, struct progress *progress)
{
    uint32_t spacing = renderer->params.step_spacing, first = first_pixel(spacing);
    whit_result result = draw_lattice(renderer, progress, spacing, first, first);
    for (; result == WHIT_OK && spacing > 1; spacing /= 2) {
        result = give_step(renderer, spacing);
        if (result == WHIT_OK)
            result = draw_between(renderer, progress, spacing);
    }
    return result;
}
