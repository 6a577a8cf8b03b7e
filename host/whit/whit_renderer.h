/* Part of whit.h: pictures and rays, on a device or by its twin. */
#ifndef WHIT_RENDERER_H
#define WHIT_RENDERER_H

#include "whit_shader.h"
#include "whit_types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Rendering ---- */

/* Which of two nodes that a ray meets is visited first. Never changes a picture. */
typedef enum whit_traversal {
    WHIT_TRAVERSAL_DISTANCE = 0, /* the one entered earlier */
    WHIT_TRAVERSAL_SIGN,  /* by the ray's sign on the axis where their centres are farthest apart */
    WHIT_TRAVERSAL_BASIC, /* as they come */
} whit_traversal;

/* What decides whether a ray meets a triangle, and which one first: see docs/numerics.md. */
typedef enum whit_numerics {
    WHIT_NUMERICS_WATERTIGHT = 0, /* no cracks; the same hit whatever the tree */
    WHIT_NUMERICS_FAST,  /* Moeller and Trumbore 1997, slabs of Williams et al. 2005: rays leak
                            between triangles; hits may depend on the tree */
    WHIT_NUMERICS_EXACT, /* as exact arithmetic says for the given floats, t rounded to nearest */
} whit_numerics;

/* Whether surfaces between a point and a light keep the light from that point. */
typedef enum whit_shadows {
    WHIT_SHADOWS_TINTED = 0, /* glass and blended surfaces let light through */
    WHIT_SHADOWS_OPAQUE,     /* they cast full shadows too */
    WHIT_SHADOWS_NONE,       /* light reaches everything */
} whit_shadows;

/* Which samples of the sequence each pixel gets. */
typedef enum whit_sampling_kind {
    WHIT_SAMPLING_FIXED = 0, /* `count` from `first` on */
    WHIT_SAMPLING_ADAPTIVE,  /* 4; where a pixel differs from a neighbour by more than `contrast`
                                16, and then 64 */
} whit_sampling_kind;
typedef struct whit_sampling {
    whit_sampling_kind kind;
    uint32_t count;  /* FIXED: up to WHIT_SAMPLES_MAX; powers of 4 are spread evenly; 0: 1 */
    uint32_t first;  /* FIXED: a multiple of `count`; ids are of sample 0 alone */
    double contrast; /* ADAPTIVE: above 0, up to 1 */
} whit_sampling;

/* What textures show of a pixel that covers many of their texels. */
typedef enum whit_minification {
    WHIT_MINIFICATION_MIPMAP = 0, /* the mean of about as many, from smaller levels */
    WHIT_MINIFICATION_NONE,       /* the texels where its samples are */
} whit_minification;

/* How kernels read trees. */
typedef enum whit_load_path {
    WHIT_LOAD_AUTO = 0, /* by the device */
    WHIT_LOAD_STORAGE,  /* storage buffers */
    WHIT_LOAD_TEXEL,    /* texel buffers */
} whit_load_path;

/* A picture in the making: every `spacing`-th pixel of its rows and columns, beginning near the
   middle of the first square of so many. */
typedef struct whit_step {
    uint32_t spacing;       /* 8, 4 or 2 */
    uint32_t width, height; /* the picture's by `spacing`, rounded up */
    const float *rgba; /* linear, row by row from above; while whit_renderer_params.step runs */
} whit_step;

/* Begin with whit_renderer_defaults(): a zeroed one asks for no bounces and traces every ray. */
typedef struct whit_renderer_params {
    uint32_t width, height; /* pixels; 0: 640 x 480 */
    /* The rows of the picture that are drawn, and that its images have: `row_count` of them from
       `first_row` on; 0: all. They begin at a multiple of 8, and end at another one or at the
       picture's last row. The picture has a fixed number of samples, and its costs are not
       counted. */
    uint32_t first_row, row_count;
    whit_camera camera; /* its name is borrowed by renderers */
    double time_s;      /* of the animation */
    whit_sampling sampling;
    uint32_t depth; /* most bounces; 0: what the camera ray sees, with its shadows */
    double bailout; /* rays that can add less than this to a pixel are not traced, nor shadow rays
                       that can add at most 2^-14 of this, times what their light sends; 0: all are
                       */
    whit_shadows shadows;
    uint32_t light_samples; /* of an area light: 1, 4, 16 or 64; 0: 16 */
    bool schlick;           /* Schlick's approximation in place of exact Fresnel */
    whit_minification minification;
    /* The same bits on every device: nothing is left to the driver (docs/numerics.md).
       WHIT_ERROR_DEVICE where a device keeps no denormals, WHIT_ERROR_INPUT for a shader that calls
       what has no portable form. */
    bool portable;
    double exposure_ev;   /* what is displayed (.png, FLIP, bytes) is times 2^this */
    bool soft_highlights; /* and runs softly towards 1 from 0.6 on, in place of a cut at 1 */
    /* Kernels have what the scene calls for. With all_effects they have everything, which changes
       no picture; without effects_removed it does. Bits 1 << the index of whit_effect_name. */
    bool all_effects;
    uint64_t effects_added, effects_removed;
    /* Draw with the general kernel, which is compiled first when no cache has it, while a thread
       compiles that of the scene; the pictures are the same. Errors of that thread are logged from
       it. */
    bool compile_async;
    /* The renderer is for many pictures: kernels that take longer to make are right where they draw
       faster. */
    bool many_pictures;
    /* Textures, normals and others that no function of `shader` reads are compiled all the same:
       the renderer can take versions of it that read them (whit_renderer_takes_shader). */
    bool keep_unread;
    /* If nothing but post() of `shader` and what it has beside the colour have changed since the
       renderer's last picture (no other kernel, slider or parameter), and neither
       traces, the colours are not drawn once more: post() is given those of the last picture, and
       for values beside the colour camera rays alone are traced. The picture is the same;
       whit_stats are those of the last one. */
    bool reuse_rays;
    /* With `step`, and a shade() of `shader`: kernels that are sooner made are right where they
       draw slower, as of a picture that is given up after its first step. The picture is the
       same. */
    bool few_pixels;
    uint32_t tile_size; /* pixels on a side, 16..1024; 0: by measured time */
    const volatile bool *cancel;
    /* Called from the rendering thread with the share done, 0..1; may be NULL. */
    void (*progress)(void *user, double done);
    void *progress_user;
    /* With `step` a picture of at least 16 x 16 pixels and a fixed number of samples, which fits
       one buffer of the device and whose costs are not counted, is drawn in steps: first every
       `step_spacing`-th pixel of rows and columns, then what half of that asks for, and so on. Each
       pixel is drawn once, and the picture is the same. It is called from the rendering thread with
       progress_user after each step but the last. */
    uint32_t step_spacing; /* 2, 4 or 8; 0: at once */
    uint32_t step_aov;     /* 1 + the index of the aov of `shader` that steps show; 0: colours */
    void (*step)(void *user, const whit_step *step);
    double time_limit_s; /* from whit_renderer_create on; 0: none */
    whit_load_path load_path;
    whit_traversal traversal;
    whit_numerics numerics;
    /* How the kernels work; pictures are the same. `segments` of lists: 1 or 2; 0: as the device
       likes. */
    whit_packets packets;
    whit_classes classes;
    uint32_t segments;
    bool count; /* count what traversals cost: for whit_stats.costs and whit_renderer_cost_image */
    /* Functions in the place of whit's own, borrowed as long as the renderer lives; NULL: none. Its
       kernels are made before the first picture, whatever compile_async says. */
    const whit_shader *shader;
    const char *sliders; /* "NAME=VALUE,NAME=VALUE": values of its sliders; read during the call;
                            NULL or "": as the file has them */
    bool skip_sliders;   /* what the shader has no slider or use for is left out, not refused */
    uint32_t trace_rays; /* most rays that whit_trace will be given, so that buffers need not be
                            larger; 0: any number */
} whit_renderer_params;

/* 640 x 480, one sample, 16 of an area light, depth 8, bailout WHIT_BAILOUT_DEFAULT, the rest zero.
   It is what a call takes whose params are NULL. */
whit_renderer_params whit_renderer_defaults(void);

/* `device` may be NULL: then only whit_trace on the CPU works. WHIT_ERROR_USAGE for params out of
   range, a camera that there is none of, or a scene whose pictures were dropped; WHIT_ERROR_INPUT
   for a scene that has no finite pose at that time; WHIT_ERROR_STATUS for a camera in too many
   media; WHIT_ERROR_DEVICE, also where a kernel cannot be made. */
WHIT_CHECK whit_result whit_renderer_create(whit_device *device, whit_accel *accel,
                                            const whit_renderer_params *params,
                                            whit_renderer **out);
void whit_renderer_destroy(whit_renderer *renderer);

/* Renders the whole picture. WHIT_ERROR_STATUS when a kernel reported that it must not be trusted
   (logged in words); WHIT_ERROR_USAGE without a device; WHIT_ERROR_DEVICE, WHIT_ERROR_TIME_LIMIT,
   WHIT_ERROR_CANCELLED. May be called again: the same bytes. */
WHIT_CHECK whit_result whit_renderer_render(whit_renderer *renderer);

/* Draws `count` small pictures together: of each of `cameras`, in the renderer's size, the picture
   that a renderer with that camera draws, byte for byte. whit_renderer_image then gives them one
   below the other, as an image of `count` times the height, until whit_renderer_render draws a
   picture of one camera again, or a view is set or a pixel probed. They share tiles and dispatches,
   so that thousands of 64 x 64 take about the time of one picture of as many pixels
   (whit_renderer_params.many_pictures makes the kernels for that; docs/batch.md); memory is that of
   all of them, some 40 bytes a pixel. `cameras` are read during the call. WHIT_ERROR_USAGE, logged
   with the number of the view, for no or too many cameras and for one that a renderer refuses; and
   for params with a shader, adaptive samples, counts or some of the rows. Others as of
   whit_renderer_render. */
WHIT_CHECK whit_result whit_renderer_render_views(whit_renderer *renderer,
                                                  const whit_camera *cameras, uint32_t count);

/* Goes to another time of the animation: moves instances, lights and camera, keeps mesh trees and
   pipelines. The picture is that of a renderer made at that time, byte for byte. WHIT_ERROR_USAGE
   for a time that is not finite, WHIT_ERROR_INPUT for one without a finite pose;
   WHIT_ERROR_DEVICE. */
WHIT_CHECK whit_result whit_renderer_set_time(whit_renderer *renderer, double time_s);

/* Another picture of the same scene with the same kernel: takes over width, height, camera, time_s,
   sampling, light_samples, bailout, depth, exposure_ev, soft_highlights and sliders, and nothing
   else. Its camera is borrowed until the next call. The picture is that of a renderer made with
   these, byte for byte. After an error there is nothing to render before a call that succeeds:
   WHIT_ERROR_USAGE and others as of whit_renderer_create. */
WHIT_CHECK whit_result whit_renderer_set_view(whit_renderer *renderer,
                                              const whit_renderer_params *params);

/* Whether `shader` is another version of the renderer's own: a file with the same functions,
   which ask for the same of lights and shadows. */
bool whit_renderer_takes_shader(const whit_renderer *renderer, const whit_shader *shader);
/* The same with another version of the renderer's shader, params->shader, whose kernels alone are
   made anew; the one before may go afterwards. The rest of `params` as of whit_renderer_set_view.
   WHIT_ERROR_USAGE, logged, for a shader that is no other version. */
WHIT_CHECK whit_result whit_renderer_set_shader(whit_renderer *renderer,
                                                const whit_renderer_params *params);

/* Effects by index, in the order of whit_scene_get_effect; NULL past the last. */
const char *whit_effect_name(uint32_t index);
/* Whether whit_renderer_params.effects_added and effects_removed may have it: what geometry or
   camera decide cannot be switched; a lens can be left out. */
bool whit_effect_can_add(uint32_t index);
bool whit_effect_can_remove(uint32_t index);
/* Whether the kernel of a renderer has an effect in it. */
bool whit_renderer_compiles(const whit_renderer *renderer, uint32_t effect);

typedef enum whit_aov {
    WHIT_AOV_COLOR = 0, /* 4 floats: linear RGB, alpha 1 */
    WHIT_AOV_IDS,       /* 2 uint32: instance, primitive of the pixel's first sample */
    WHIT_AOV_CUTS,      /* 2 floats: weights of rays that were not traced, for params.depth and for
                           params.bailout: sums of largest channels, means over samples */
    WHIT_AOV_DISTANCES, /* 1 float, after whit_renderer_render_views: from where the camera ray of
                           the pixel's first sample starts to what it meets, world units; infinity:
                           nothing. The t of whit_trace, but that cut-outs are looked through,
                           and that at WHIT_NUMERICS_EXACT it is not rounded from the exact one */
    WHIT_AOV_SHADER = 64, /* and up: whit_shader_info.aovs by index; 4 floats, means over samples of
                             what the function gives for what the camera meets, 0 for nothing */
} whit_aov;
/* WHIT_ERROR_USAGE where nothing was rendered, for functions that the shader has not, for cuts of
   a picture of adaptive samples, and for distances of one that is no views; WHIT_ERROR_DEVICE. */
WHIT_CHECK whit_result whit_renderer_image(whit_renderer *renderer, whit_aov aov, whit_image **out);
/* From here on an image of colours is displayed as a picture with these params is, which those of
   renderers and references are from the beginning. */
void whit_image_display_as(whit_image *image, const whit_renderer_params *params);

typedef enum whit_ray_kind {
    WHIT_RAY_PRIMARY = 0,
    WHIT_RAY_SHADOW,
    WHIT_RAY_REFLECTED,
    WHIT_RAY_REFRACTED,
    WHIT_RAY_KINDS,
} whit_ray_kind;

/* What traversals cost; see struct gpu_cost in shaders/abi/bvh.h. Sums, but for stack and depth,
   which are the largest. */
typedef struct whit_cost {
    uint64_t rays;
    uint64_t inner_nodes; /* inner nodes opened: box tests are twice that */
    uint64_t leaves, instances, triangles;
    uint32_t stack, depth;
    /* A record is a ray of a batch, or a sample of a pixel that has rays of the kind. */
    uint64_t records;
    uint64_t stack_sum, depth_sum; /* over records: means are these over `records` */
    uint32_t max_inner_nodes, max_leaves, max_instances, max_triangles; /* in one record */
} whit_cost;

typedef enum whit_view {
    WHIT_VIEW_DEPTH = 0, /* deepest level of the trees that was looked at */
    WHIT_VIEW_VISITS,    /* nodes opened: inner nodes, leaves, instances */
    WHIT_VIEW_BOXES,     /* box tests */
    WHIT_VIEW_TRIS,      /* triangle tests */
    WHIT_VIEW_STACK,     /* most refs on the node stack */
} whit_view;
/* One number a pixel, as floats of one channel: what the rays of `kind` of its first sample cost
   (WHIT_RAY_KINDS: of all kinds). WHIT_ERROR_USAGE without params.count, or where nothing was
   rendered. */
WHIT_CHECK whit_result whit_renderer_cost_image(whit_renderer *renderer, whit_view view,
                                                whit_ray_kind kind, whit_image **out);

/* What a stage of the kernels took. Time stamps are around the work of one tile in eight: `ms` is
   that of all `rays`, by what one took there. */
typedef struct whit_stage {
    char name[24];
    uint64_t rays; /* hits where they are shaded, sums where they are added up */
    double ms;     /* < 0: not measured */
} whit_stage;
#define WHIT_STAGES 14

/* How many of the hits that a shading kernel worked on, in those tiles, wear one material. This is
   the material's share of the kernel's time, not its price: a hit of one material may take longer
   than a hit of another. */
typedef struct whit_share {
    uint32_t stage;    /* of whit_stats.stages */
    uint32_t material; /* of the scene */
    double share;      /* 0..1 */
} whit_share;
#define WHIT_SHARES 24

/* Pixels are counted by their samples: 1, up to 4, up to 16, ... up to WHIT_SAMPLES_MAX. */
enum { WHIT_SAMPLE_LEVELS = 7 };

typedef struct whit_stats {
    double upload_ms, compile_ms, render_ms, render_device_ms; /* device: < 0 when not measured */
    uint64_t rays_primary, rays_shadow, rays_reflected, rays_refracted;
    uint64_t rays_by_functions; /* that functions of params.shader traced, of all kinds */
    double mrays_per_s;         /* all rays over render_ms */
    uint64_t device_bytes;
    /* Rays that were not traced, and the largest sum of their weights in one pixel: depth, for
       params.depth; bailout, for params.bailout. */
    uint64_t rays_cut_depth, rays_cut_bailout;
    double weight_cut_depth, weight_cut_bailout;
    /* No pixel channel is off by more than this for rays and shadow rays that bailout leaves out; <
       0: not known. */
    double bailout_bound;
    uint64_t pixels_by_samples[WHIT_SAMPLE_LEVELS];
    uint32_t kernel_instructions; /* SPIR-V, of its functions; see whit_renderer_get_kernel */
    uint32_t kernels_beside; /* of these kernels, translated to machine code by a second device */
    bool general;            /* drawn by the general kernel: see params.compile_async */
    uint32_t dispatches, tiles, tile_size;
    uint32_t deferred;        /* exact numerics: steps of pixels' rays that took more than floats */
    whit_load_path load_path; /* the one taken: not WHIT_LOAD_AUTO */
    bool packets;             /* camera rays walked together */
    whit_cost costs[WHIT_RAY_KINDS]; /* with params.count */
    whit_stage stages[WHIT_STAGES];  /* those that had rays; the others have none */
    whit_share shares[WHIT_SHARES];  /* largest first; the rest is left out */
    uint32_t share_count;
} whit_stats;

/* All rays of a picture. */
static inline uint64_t whit_stats_rays(const whit_stats *stats)
{
    return stats->rays_primary + stats->rays_shadow + stats->rays_reflected +
           stats->rays_refracted + stats->rays_by_functions;
}
void whit_renderer_get_stats(const whit_renderer *renderer, whit_stats *stats);
/* Adds what one more picture took to what others took: sums, of weights and bounds the largest; of
   tiles and memory those of the last. Shares of materials, upload and compilation stay as they
   are. */
void whit_stats_add(const whit_stats *from, whit_stats *to);

/* ---- Rays ---- */

/* Directions need not be unit; t counts in their lengths. Hits with t_min <= t <= t_max. */
typedef struct whit_ray {
    float origin[3], t_min, dir[3], t_max;
} whit_ray;
/* `u`, `v` weigh the second and third vertex; ng is (v1 - v0) x (v2 - v0) in world space, as long
   as it comes. Of a sphere u and v are its normal in object space on the unit square (octahedral,
   +y in the middle), and ng is that normal by the inverse transpose. */
typedef struct whit_hit {
    float t; /* infinity: miss */
    float u, v;
    uint32_t primitive, instance; /* WHIT_NONE: miss */
    float ng[3];
} whit_hit;

typedef enum whit_trace_on {
    WHIT_TRACE_DEVICE = 0,
    WHIT_TRACE_CPU_FLOAT, /* the twin: the same bits */
    WHIT_TRACE_CPU_BRUTE, /* the twin without trees */
} whit_trace_on;

/* `cost`: what all rays together cost, or NULL (on the device it needs params.count).
   Closest hit, or with `any` any hit (then only `primitive` != WHIT_NONE means something). Rays
   that are not finite miss. Cut-outs count as solid. WHIT_ERROR_STATUS where the hits are not to be
   trusted, WHIT_ERROR_USAGE for what the renderer was not made for, WHIT_ERROR_CANCELLED;
   WHIT_ERROR_DEVICE on the device. */
WHIT_CHECK whit_result whit_trace(whit_renderer *renderer, whit_trace_on on, const whit_ray *rays,
                                  uint64_t count, bool any, whit_hit *hits, whit_cost *cost);
/* Device time of the traversals of the last whit_trace on the device, without transfers; < 0: not
   measured. */
double whit_trace_device_ms(const whit_renderer *renderer);

#ifdef __cplusplus
}
#endif

#endif
