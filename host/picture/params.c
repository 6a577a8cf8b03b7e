#include "picture/params.h"

#include <math.h>

#include "abi/bvh.h"
#include "abi/spec.h"

_Static_assert((uint32_t)WHIT_NUMERICS_WATERTIGHT == NUMERICS_WATERTIGHT &&
                   (uint32_t)WHIT_NUMERICS_FAST == NUMERICS_FAST &&
                   (uint32_t)WHIT_NUMERICS_EXACT == NUMERICS_EXACT &&
                   (uint32_t)WHIT_TRAVERSAL_DISTANCE == ORDER_DISTANCE &&
                   (uint32_t)WHIT_TRAVERSAL_SIGN == ORDER_SIGN &&
                   (uint32_t)WHIT_TRAVERSAL_BASIC == ORDER_BASIC,
               "kernels take these as they are");

enum { DEPTH_LARGEST = 255 }; /* bounces of a ray have 8 bits */
enum { LIGHT_SAMPLES_MAX = 64 };

static bool is_power_of_4(uint32_t n)
{
    return (n & (n - 1)) == 0 && (n & 0x55555555u) != 0;
}

/* Checks enumerations, which in C may have any value. */
static whit_result check_values(const whit_log *log, const whit_renderer_params *params)
{
    const struct {
        const char *name;
        uint32_t value, last;
    } all[] = {{"traversal", params->traversal, WHIT_TRAVERSAL_BASIC},
               {"numerics", params->numerics, WHIT_NUMERICS_EXACT},
               {"shadows", params->shadows, WHIT_SHADOWS_NONE},
               {"minification", params->minification, WHIT_MINIFICATION_NONE},
               {"load_path", params->load_path, WHIT_LOAD_TEXEL},
               {"packets", params->packets, WHIT_PACKETS_OFF},
               {"classes", params->classes, WHIT_CLASSES_MANY},
               {"sampling.kind", params->sampling.kind, WHIT_SAMPLING_ADAPTIVE}};
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i)
        if (all[i].value > all[i].last)
            return log_usage(log, "%s %d: the enumeration has 0 to %u", all[i].name,
                             (int)all[i].value, all[i].last);
    return WHIT_OK;
}

uint32_t params_rows(const whit_renderer_params *params)
{
    return params->row_count ? params->row_count : params->height;
}

/* Checks the rows, which consist of whole blocks of 8 x 8 pixels. */
static whit_result check_rows(const whit_log *log, const whit_renderer_params *params)
{
    uint32_t first = params->first_row, count = params->row_count;
    bool inside = first < params->height && count <= params->height - first;
    bool whole_blocks = first % 8 == 0 && (count % 8 == 0 || first + count == params->height);
    if (!inside || !whole_blocks || (first && !count))
        return log_usage(
            log, "%u rows from %u on of %u: must begin and end at multiples of 8 or the last",
            count, first, params->height);
    if (count && params->sampling.kind == WHIT_SAMPLING_ADAPTIVE)
        return log_usage(log,
                         "adaptive samples of some rows: only whole pictures tell who differs");
    if (count && params->count)
        return log_usage(log, "what rays cost is counted of whole pictures");
    return WHIT_OK;
}

whit_result params_check(const whit_log *log, whit_renderer_params *params)
{
    if (params->width == 0 && params->height == 0) {
        params->width = 640;
        params->height = 480;
    }
    bool adaptive = params->sampling.kind == WHIT_SAMPLING_ADAPTIVE;
    if (params->sampling.count == 0)
        params->sampling.count = adaptive ? SAMPLING_ADAPTIVE_FIRST : 1;
    if (params->sampling.count_max == 0)
        params->sampling.count_max = SAMPLING_ADAPTIVE_MAX;
    if (params->width == 0 || params->height == 0 || params->width > 65535 ||
        params->height > 65535)
        return log_usage(log, "size %ux%u: both sides must be 1..65535", params->width,
                         params->height);
    if (!isfinite(params->time_s) || !(params->bailout >= 0.0) || !isfinite(params->bailout))
        return log_usage(
            log, "a time of %g s and a bail-out of %g: must be finite, and the latter not below 0",
            params->time_s, params->bailout);
    if (!isfinite(params->exposure_ev) || !(params->time_limit_s >= 0.0))
        return log_usage(log,
                         "an exposure of %g and a time limit of %g s: the former must be finite, "
                         "the latter not below 0",
                         params->exposure_ev, params->time_limit_s);
    whit_result result = check_values(log, params);
    if (result != WHIT_OK)
        return result;
    uint32_t n = params->sampling.count, first = params->sampling.first;
    if (n > WHIT_SAMPLES_MAX)
        return log_usage(log, "%u samples a pixel: must be 1..%d", n, WHIT_SAMPLES_MAX);
    if (first % n != 0 || first > WHIT_SAMPLES_MAX - n)
        return log_usage(log, "samples of a pixel from %u on: must be a multiple of %u below %d",
                         first, n, WHIT_SAMPLES_MAX);
    n = params->light_samples;
    if (n != 0 && (!is_power_of_4(n) || n > LIGHT_SAMPLES_MAX))
        return log_usage(log, "%u samples of an area light: must be 1, 4, 16 or 64", n);
    if (params->node_bytes && params->node_bytes != 16 && params->node_bytes != 32)
        return log_usage(log, "nodes of %u bytes: must be 16 or 32", params->node_bytes);
    if (params->segments > 2)
        return log_usage(log, "%u segments of lists: must be 1 or 2", params->segments);
    if (params->tile_size && (params->tile_size < TILE_MIN || params->tile_size > TILE_MAX))
        return log_usage(log, "tile size %u: must be %d..%d", params->tile_size, TILE_MIN,
                         TILE_MAX);
    if (adaptive &&
        (!is_power_of_4(params->sampling.count) || !is_power_of_4(params->sampling.count_max) ||
         params->sampling.count >= params->sampling.count_max ||
         params->sampling.count_max > SAMPLING_ADAPTIVE_MAX))
        return log_usage(log, "adaptive samples from %u to %u: must be powers of 4 from 1 up to %d",
                         params->sampling.count, params->sampling.count_max, SAMPLING_ADAPTIVE_MAX);
    if (adaptive && !(params->sampling.contrast > 0.0 && params->sampling.contrast <= 1.0))
        return log_usage(log, "adaptive contrast %g: must be above 0, up to 1",
                         params->sampling.contrast);
    if (adaptive && params->sampling.first)
        return log_usage(log, "adaptive samples begin with the first one");
    if (adaptive && params->count)
        return log_usage(log, "what rays cost is not counted with adaptive samples");
    n = params->step_spacing;
    if (n != 0 && n != 2 && n != 4 && n != 8)
        return log_usage(log, "steps of every %u-th pixel: must be 2, 4 or 8", n);
    if (params->depth > DEPTH_LARGEST)
        return log_usage(log, "depth %u: must be 0..%d", params->depth, DEPTH_LARGEST);
    return check_rows(log, params);
}
