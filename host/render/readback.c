/* Pictures from the device to the host. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "device/buffer.h"
#include "picture/grid.h"
#include "render/adaptive_samples.h"
#include "render/hooks.h"
#include "render/pixels.h"
#include "render/readback.h"
#include "render/renderer.h"
#include "render/views.h"

bool readback_is_late(const struct renderer *renderer)
{
    return renderer->picture.buffers.band_rows >= views_rows(renderer) &&
           renderer->params.sampling.kind == WHIT_SAMPLING_FIXED;
}

enum { READ_SLICE = 4096 }; /* pixels that are read back at once */

/* The place on the device of one plane of a band. */
struct plane {
    struct buffer *buffer; /* NULL: without secondary rays nothing is cut, so weights are zeros */
    uint32_t channels;
    uint64_t before; /* pixels in the buffer before those of the band */
};

static struct plane plane_of(const struct renderer *renderer, enum plane_name name)
{
    const struct pixel_buffers *p = &renderer->picture.buffers;
    const struct plane planes[] = {
        [PLANE_COLOR] = {p->pixels, 4, 0},
        [PLANE_IDS] = {p->ids, 2, 0},
        [PLANE_CUTS] = {p->queues.cut_sums, 2, 0},
        [PLANE_DISTANCES] = {p->distances, 1, 0},
        [PLANE_AOVS] = {p->aovs, 4 * hooks_aov_count(&renderer->picture), p->chunk_slots},
    };
    return planes[name];
}

void readback_drop_images(struct renderer *renderer)
{
    for (int i = 0; i < PLANES; ++i)
        image_finish(&renderer->planes[i]);
}

whit_result readback_make_images(struct renderer *renderer)
{
    uint32_t aovs = hooks_aov_count(&renderer->picture);
    bool data = pixels_have_data(&renderer->picture);
    const bool kept[] = {
        [PLANE_COLOR] = true,
        [PLANE_IDS] = data,
        [PLANE_CUTS] = data && renderer->params.sampling.kind == WHIT_SAMPLING_FIXED,
        [PLANE_DISTANCES] = renderer->views.count > 0,
        [PLANE_AOVS] = aovs > 0,
    };
    whit_result result = WHIT_OK;
    for (int i = 0; result == WHIT_OK && i < PLANES; ++i) {
        uint32_t columns = i == PLANE_AOVS ? aovs : 1;
        if (kept[i])
            result = image_init_logged(&renderer->log, &renderer->planes[i],
                                       renderer->params.width * columns, views_rows(renderer),
                                       plane_of(renderer, (enum plane_name)i).channels / columns,
                                       i == PLANE_IDS);
    }
    return result;
}

static uint32_t *words_of(const struct image *image)
{
    return image->words ? image->words : (uint32_t *)image->pixels;
}

/* Reads `count` pixels of the band, from its pixel `at` on. */
static whit_result read_plane(const struct renderer *renderer, enum plane_name name, size_t at,
                              size_t count, void *values)
{
    const struct plane plane = plane_of(renderer, name);
    uint64_t pixel_bytes = plane.channels * sizeof(uint32_t);
    return plane.buffer ? buffer_read(plane.buffer, (plane.before + at) * pixel_bytes, values,
                                      count * pixel_bytes)
                        : WHIT_OK;
}

/* Copies a plane of the pixels that the pass drew, among `count` pixels of the band, into the
   picture from pixel `first` on. */
static whit_result read_listed(struct renderer *renderer, const struct progress *progress,
                               enum plane_name name, size_t first, size_t count)
{
    float *kept = renderer->planes[name].pixels;
    size_t each = plane_of(renderer, name).channels;
    whit_result result = WHIT_OK;
    float *pixels = kept ? array_alloc(READ_SLICE, each * sizeof *pixels) : NULL;
    if (!pixels)
        return kept ? render_no_memory(renderer, "pixels") : WHIT_OK;
    for (size_t at = 0; result == WHIT_OK && at < count; at += READ_SLICE) {
        size_t n = count - at < READ_SLICE ? count - at : READ_SLICE;
        result = read_plane(renderer, name, at, n, pixels);
        for (size_t i = 0; result == WHIT_OK && i < n; ++i) {
            if (adaptive_draws(progress, first + at + i))
                memcpy(&kept[(first + at + i) * each], &pixels[i * each], each * sizeof *pixels);
        }
    }
    free(pixels);
    return result;
}

whit_result readback_non_finite(const struct target *target, uint32_t *x, uint32_t *y,
                                uint32_t *count)
{
    struct renderer *renderer = target->renderer;
    const struct pixel_buffers *p = &target->buffers;
    float pixels[READ_SLICE][4];
    uint64_t held = (uint64_t)renderer->params.width * p->band_rows;
    uint32_t stride = views_stride(renderer), end = views_rows(renderer);
    end += renderer->views.count ? 0 : renderer->params.first_row;
    *x = *y = *count = 0;
    for (uint64_t at = 0; at < held; at += READ_SLICE) {
        uint64_t n = held - at < READ_SLICE ? held - at : READ_SLICE;
        whit_result result =
            buffer_read(p->pixels, at * sizeof *pixels, pixels, n * sizeof *pixels);
        if (result != WHIT_OK)
            return result;
        for (uint64_t i = 0; i < n; ++i) {
            uint32_t row = (uint32_t)((at + i) / renderer->params.width) + p->band_y;
            bool below = row >= end || row % stride >= renderer->params.height;
            if (below ||
                (isfinite(pixels[i][0]) && isfinite(pixels[i][1]) && isfinite(pixels[i][2])))
                continue;
            if ((*count)++ == 0) {
                *x = (uint32_t)((at + i) % renderer->params.width);
                *y = row;
            }
        }
    }
    return WHIT_OK;
}

whit_result readback_band(struct renderer *renderer, const struct progress *progress,
                          uint32_t band_y, uint32_t rows)
{
    size_t first = (size_t)renderer->params.width * (band_y - renderer->params.first_row);
    size_t count = (size_t)renderer->params.width * rows;
    whit_result result = WHIT_OK;
    if (progress->listed) {
        result = read_listed(renderer, progress, PLANE_COLOR, first, count);
        return result == WHIT_OK ? read_listed(renderer, progress, PLANE_AOVS, first, count)
                                 : result;
    }
    for (int i = 0; result == WHIT_OK && i < PLANES && !readback_is_late(renderer); ++i) {
        enum plane_name name = (enum plane_name)i;
        uint32_t *kept = words_of(&renderer->planes[i]);
        if (kept)
            result = read_plane(renderer, name, 0, count,
                                kept + first * plane_of(renderer, name).channels);
    }
    return result;
}

static whit_result begin_read(const struct renderer *renderer, uint32_t channels, bool integers,
                              struct image *out)
{
    if (!renderer->rendered)
        return log_usage(&renderer->log, RENDER_NO_PICTURE);
    return image_init_logged(&renderer->log, out, renderer->params.width, views_rows(renderer),
                             channels, integers);
}

/* Removes the rows of padding between views. */
static void close_gaps(const struct renderer *renderer, struct image *image)
{
    size_t words = (size_t)image->width * image->channels, height = renderer->params.height;
    size_t stride = views_stride(renderer);
    uint32_t *all = words_of(image);
    for (size_t i = 1; height != stride && i < renderer->views.count; ++i)
        memmove(all + words * height * i, all + words * stride * i, words * height * sizeof *all);
    image->height = views_image_rows(renderer);
}

static whit_result read_whole(struct renderer *renderer, enum plane_name name, struct image *out)
{
    uint32_t channels = plane_of(renderer, name).channels;
    whit_result result = begin_read(renderer, channels, name == PLANE_IDS, out);
    if (result != WHIT_OK)
        return result;
    size_t count = (size_t)out->width * out->height;
    if (readback_is_late(renderer))
        result = read_plane(renderer, name, 0, count, words_of(out));
    else
        memcpy(words_of(out), words_of(&renderer->planes[name]),
               count * channels * sizeof(uint32_t));
    close_gaps(renderer, out);
    return result;
}

whit_result renderer_read_color(struct renderer *renderer, struct image *out)
{
    return read_whole(renderer, PLANE_COLOR, out);
}

whit_result renderer_borrow_color(struct renderer *renderer, struct image *out)
{
    const struct pixel_buffers *p = &renderer->picture.buffers;
    float *pixels = readback_is_late(renderer) ? buffer_contents(p->pixels)
                                               : renderer->planes[PLANE_COLOR].pixels;
    if (!renderer->rendered || !pixels || renderer->views.count)
        return renderer_read_color(renderer, out);
    *out = (struct image){.width = renderer->params.width,
                          .height = views_rows(renderer),
                          .channels = 4,
                          .pixels = pixels,
                          .borrowed = true};
    return WHIT_OK;
}

whit_result renderer_read_distances(struct renderer *renderer, struct image *out)
{
    if (!renderer->views.count)
        return log_usage(&renderer->log, "distances are kept of views that are drawn together");
    return read_whole(renderer, PLANE_DISTANCES, out);
}

/* As read_whole, for what renderers with params.color_only do not keep. */
static whit_result read_data(struct renderer *renderer, enum plane_name name, struct image *out)
{
    if (!pixels_have_data(&renderer->picture))
        return log_usage(&renderer->log, "the renderer keeps colours alone (color_only)");
    return read_whole(renderer, name, out);
}

whit_result readback_check_first(const struct renderer *renderer, const char *what)
{
    if (!renderer->params.sampling.first)
        return WHIT_OK;
    return log_usage(&renderer->log,
                     "%s are those of the first sample, which samples from %u on do not have", what,
                     renderer->params.sampling.first);
}

whit_result renderer_read_ids(struct renderer *renderer, struct image *out)
{
    whit_result result = readback_check_first(renderer, "hit identities");
    return result == WHIT_OK ? read_data(renderer, PLANE_IDS, out) : result;
}

/* Copies aov `index` out of a row that has all of them. */
static void pick_aov(const float *row, uint32_t all, uint32_t index, uint32_t width, float *to)
{
    for (uint32_t x = 0; x < width; ++x)
        memcpy(&to[4 * (size_t)x], &row[4 * ((size_t)x * all + index)], 4 * sizeof *to);
}

whit_result readback_aov_row(const struct renderer *renderer, uint32_t index, uint32_t y,
                             float *row, float *to)
{
    uint32_t all = hooks_aov_count(&renderer->picture), width = renderer->params.width;
    whit_result result = read_plane(renderer, PLANE_AOVS, (size_t)width * y, width, row);
    if (result == WHIT_OK)
        pick_aov(row, all, index, width, to);
    return result;
}

whit_result renderer_read_aov(struct renderer *renderer, uint32_t index, struct image *out)
{
    uint32_t all = hooks_aov_count(&renderer->picture), width = renderer->params.width;
    if (index >= all)
        return log_usage(&renderer->log,
                         "the shader has %u functions beside the colour, no number %u", all, index);
    whit_result result = begin_read(renderer, 4, false, out);
    bool late = readback_is_late(renderer);
    float *row = result == WHIT_OK && late ? malloc((size_t)width * all * 4 * sizeof *row) : NULL;
    if (result == WHIT_OK && late && !row)
        result = render_no_memory(renderer, "values of functions");
    for (uint32_t y = 0; result == WHIT_OK && y < out->height; ++y) {
        size_t at = (size_t)width * y;
        if (late)
            result = readback_aov_row(renderer, index, y, row, &out->pixels[4 * at]);
        else
            pick_aov(&renderer->planes[PLANE_AOVS].pixels[4 * at * all], all, index, width,
                     &out->pixels[4 * at]);
    }
    free(row);
    if (result != WHIT_OK)
        image_finish(out);
    return result;
}

whit_result renderer_read_cuts(struct renderer *renderer, struct image *out)
{
    if (renderer->params.sampling.kind == WHIT_SAMPLING_ADAPTIVE)
        return log_usage(&renderer->log,
                         "weights that were cut are not kept with adaptive samples");
    return read_data(renderer, PLANE_CUTS, out);
}

whit_result renderer_camera_rays(const struct renderer *renderer, uint32_t max,
                                 struct gpu_ray **rays, uint64_t *count)
{
    const whit_renderer_params *params = &renderer->params;
    uint32_t width = params->width, height = params->height;
    for (uint32_t by = 2; (uint64_t)width * height > max && width * height > 1; ++by) {
        width = (params->width + by - 1) / by;
        height = (params->height + by - 1) / by;
    }
    *count = (uint64_t)width * height;
    *rays = malloc((size_t)*count * sizeof **rays);
    if (!*rays)
        return render_no_memory(renderer, "camera rays");
    whit_result result =
        camera_all_rays(&renderer->log, &renderer->pose, &params->camera, width, height, *rays);
    if (result != WHIT_OK) {
        free(*rays);
        *rays = NULL;
    }
    return result;
}

whit_result renderer_grid_rays(const struct renderer *renderer, struct gpu_ray **rays,
                               float **cover, uint64_t *count)
{
    *cover = NULL;
    whit_result result = renderer_camera_rays(renderer, UINT32_MAX, rays, count);
    if (result != WHIT_OK)
        return result;
    *cover = malloc((size_t)*count * sizeof **cover);
    if (*cover) {
        grid_cover(&renderer->pose, renderer->params.width, renderer->params.height, *rays, *cover);
        return WHIT_OK;
    }
    free(*rays);
    *rays = NULL;
    return render_no_memory(renderer, "a grid");
}
