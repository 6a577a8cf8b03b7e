/* The parameters of a picture, with or without a device. */
#ifndef PICTURE_PARAMS_H
#define PICTURE_PARAMS_H

#include <stdbool.h>
#include <stdint.h>

#include "base/log.h"

enum render_classes { RENDER_CLASSES_AUTO, RENDER_CLASSES_ONE, RENDER_CLASSES_MANY };
enum render_packets { RENDER_PACKETS_AUTO, RENDER_PACKETS_ON, RENDER_PACKETS_OFF };
enum render_load_path { RENDER_LOAD_AUTO, RENDER_LOAD_STORAGE, RENDER_LOAD_TEXEL };

struct render_params {
    uint32_t width, height; /* 0: 640 x 480 */
    const char *camera;     /* name, index, or ten numbers; NULL: the first */
    double time_s;
    uint32_t samples;      /* a power of 4 up to WHIT_SAMPLES_MAX; 0: 1 */
    uint32_t first_sample; /* a multiple of `samples`; ids are of sample 0 alone */
    uint32_t depth;        /* most bounces */
    double bailout; /* rays that can add less to a pixel are not traced; 0: 1/1024, < 0: none */
    bool no_shadows;
    double adaptive;        /* contrast from which a pixel gets 16, then 64 samples; 0: off */
    uint32_t light_samples; /* of an area light: 1, 4, 16 or 64; 0: 16 */
    bool schlick, opaque_shadows;
    bool all_effects; /* compile everything */
    /* Bits 1 << SCENE_EFFECT_*: compiled though not called for; left out though called for. */
    uint64_t effects_added, effects_removed;
    bool compile_async, many_pictures;
    uint32_t tile_size; /* 16..512; 0: by measured time */
    const volatile bool *cancel;
    void (*progress)(void *user, double done);
    void *progress_user;
    double time_limit_s; /* counted from renderer_create on */
    enum render_load_path load_path;
    uint32_t order;              /* ORDER_* */
    uint32_t numerics;           /* NUMERICS_* */
    enum render_packets packets; /* see whit_packets */
    enum render_classes classes; /* see whit_classes */
    uint32_t segments;           /* of lists, 1 or 2; 0: as the device likes */
    bool count;                  /* count what traversals cost */
    /* Most rays that renderer_trace will be given, so that buffers need not be larger; 0: any. */
    uint32_t trace_rays;
};

enum { TILE_MIN = 16, TILE_MAX = 512 }; /* sides of tiles, pixels */

/* Fills in defaults. WHIT_ERROR_USAGE, logged, for what is out of range. */
WHIT_CHECK whit_result params_check(const struct log *log, struct render_params *params);

#endif
