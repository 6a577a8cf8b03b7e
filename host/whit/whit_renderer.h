/* Part of whit.h: pictures and rays, on a device or by its twin. */
#ifndef WHIT_RENDERER_H
#define WHIT_RENDERER_H

#include "whit_shader.h"
#include "whit_types.h"

WHIT_C_BEGIN

/* ---- Rendering ---- */

/* The order in which a ray visits two sibling nodes that it meets. It does not change the
   picture. */
typedef enum whit_traversal {
    WHIT_TRAVERSAL_DISTANCE = 0, /* the one entered earlier */
    WHIT_TRAVERSAL_SIGN,  /* by the sign of the ray's direction on the axis where their centres are
                             farthest apart */
    WHIT_TRAVERSAL_BASIC, /* in the order in which they are stored */
} whit_traversal;

/* The arithmetic that decides whether a ray meets a triangle, and which one first: see
   docs/numerics.md. */
typedef enum whit_numerics {
    WHIT_NUMERICS_WATERTIGHT = 0, /* no cracks; the same hit whatever the tree */
    WHIT_NUMERICS_FAST,  /* Moeller and Trumbore 1997, slabs of Williams et al. 2005: rays leak
                            between triangles; hits may depend on the tree */
    WHIT_NUMERICS_EXACT, /* the hit of exact arithmetic on the given floats, with t rounded to
                            nearest */
} whit_numerics;

/* The shadows that surfaces between a point and a light cast on that point. */
typedef enum whit_shadows {
    WHIT_SHADOWS_TINTED = 0, /* glass and blended surfaces let light through */
    WHIT_SHADOWS_OPAQUE,     /* they cast full shadows too */
    WHIT_SHADOWS_NONE,       /* light reaches everything */
} whit_shadows;

/* The samples of the sequence that each pixel gets. */
typedef enum whit_sampling_kind {
    WHIT_SAMPLING_FIXED = 0, /* `count` samples from `first` on */
    WHIT_SAMPLING_ADAPTIVE,  /* `count` samples; where a pixel then differs from a neighbour by more
                                than `contrast` 4 times as many, and so on up to `count_max` */
} whit_sampling_kind;
typedef struct whit_sampling {
    whit_sampling_kind kind;
    uint32_t count;     /* FIXED: up to WHIT_SAMPLES_MAX; powers of 4 are the most evenly spread; 0:
                           1. ADAPTIVE: 1, 4 or 16; 0: 4 */
    uint32_t first;     /* FIXED: a multiple of `count`; hit identities exist for sample 0 only.
                           ADAPTIVE: 0 */
    uint32_t count_max; /* ADAPTIVE: 4, 16 or 64, above `count`; 0: 64 */
    double contrast;    /* ADAPTIVE: above 0, up to 1, of what is displayed, linear */
} whit_sampling;

/* The sampling of textures for a pixel that covers many texels. */
typedef enum whit_minification {
    WHIT_MINIFICATION_MIPMAP = 0, /* the mean of about as many texels, from smaller levels */
    WHIT_MINIFICATION_NONE,       /* only the texels at its samples */
} whit_minification;

/* The kind of buffer through which kernels read trees. */
typedef enum whit_load_path {
    WHIT_LOAD_AUTO = 0, /* by the device */
    WHIT_LOAD_STORAGE,  /* storage buffers */
    WHIT_LOAD_TEXEL,    /* texel buffers */
} whit_load_path;

/* A coarse version of a picture that is being drawn: every `spacing`-th pixel of its rows and
   columns. The first one lies near the middle of the first square of `spacing` x `spacing`
   pixels. */
typedef struct whit_step {
    uint32_t spacing;       /* 8, 4 or 2 */
    uint32_t width, height; /* the picture's size divided by `spacing`, rounded up */
    const float *rgba; /* linear RGBA, top row first; valid while whit_renderer_params.step runs */
} whit_step;

/* Start from whit_renderer_defaults(): a zeroed struct asks for no bounces and a bail-out of 0. */
typedef struct whit_renderer_params {
    uint32_t width, height; /* pixels, 1..65535; both 0: 640 x 480 */
    /* Draws only some rows of the picture, and its images have only these: `row_count` rows from
       `first_row` on; 0: all. They begin at a multiple of 8, and end at a multiple of 8 or at the
       picture's last row. This needs a fixed number of samples, and `count` false. */
    uint32_t first_row, row_count;
    whit_camera camera; /* its name is borrowed by renderers */
    double time_s;      /* of the animation */
    whit_sampling sampling;
    uint32_t depth; /* most bounces, 0..255; 0: only camera rays and their shadow rays */
    double bailout; /* rays that can add less than this to a pixel are not traced, nor are shadow
                       rays that can add at most this * 2^-14 of the light that their light sends;
                       0: all rays are traced */
    whit_shadows shadows;
    uint32_t light_samples; /* of an area light: 1, 4, 16 or 64; 0: 16 */
    bool schlick;           /* Schlick's approximation in place of exact Fresnel */
    whit_minification minification;
    /* Pictures have the same bits on every device, as no arithmetic is left to the driver
       (docs/numerics.md). WHIT_ERROR_DEVICE where a device flushes denormals to 0, WHIT_ERROR_INPUT
       for a shader that calls what has no portable form. */
    bool portable;
    double exposure_ev;   /* displayed colours (.png, FLIP, bytes) are multiplied by 2^this */
    bool soft_highlights; /* displayed colours above 0.6 approach 1 smoothly, in place of a cut at
                             1 */
    /* Kernels contain the effects that the scene needs. all_effects compiles every effect, which
       does not change the picture; effects_removed leaves effects out, which may change it. Bits
       are 1 << the index of whit_effect_name. */
    bool all_effects;
    uint64_t effects_added, effects_removed;
    /* Draws with the general kernel (compiled first where no cache has it) while a thread compiles
       the scene's own kernels; the pictures are the same. That thread logs its own errors. */
    bool compile_async;
    /* The renderer will draw many pictures: it uses kernels that draw faster even where they take
       longer to make. */
    bool many_pictures;
    /* Compiles textures, normals and other effects even where no function of `shader` reads them,
       so that the renderer can take later versions of the shader that do
       (whit_renderer_takes_shader). */
    bool keep_unread;
    /* If only post() and aovs of `shader` have changed since the renderer's last picture (no other
       kernel, slider or parameter), and they trace no rays, colours are not drawn again: post()
       gets the colours of the last picture, and aovs only need camera rays. The picture is the
       same; whit_stats are those of the last picture. */
    bool reuse_rays;
    /* With `step` and a shade() of `shader`: uses kernels that are made sooner even where they draw
       slower, for pictures that are often abandoned after their first step. The picture is the
       same. */
    bool few_pixels;
    /* Measures whit_stats.stages[].ms and whit_stats.shares, which on a CPU takes up to a tenth of
       the picture's time. Timed tiles may need kernels of their own, which the stats then count. */
    bool time_stages;
    /* Keeps colours alone, which takes less memory, and on a CPU less time: WHIT_AOV_IDS and
       WHIT_AOV_CUTS give WHIT_ERROR_USAGE. */
    bool color_only;
    uint32_t tile_size; /* pixels on a side, 16..1024; 0: chosen by measured time */
    const volatile bool *cancel;
    /* Called from the rendering thread with the share of the picture that is done, 0..1; may be
       NULL. */
    void (*progress)(void *user, double done);
    void *progress_user;
    /* If `step` is set, the picture is drawn in steps: first every `step_spacing`-th pixel of rows
       and columns, then the missing pixels for half of this spacing, and so on. Each pixel is drawn
       once, and the picture is the same. It must have at least 16 x 16 pixels and a fixed number of
       samples, fit into one buffer of the device, and `count` must be false; else it is drawn at
       once. `step` is called from the rendering thread with progress_user after each step but the
       last. */
    uint32_t step_spacing; /* 2, 4 or 8; 0: no steps */
    uint32_t step_aov;     /* what steps show: 1 + the index of an aov of `shader`, up to the number
                              of its aovs; 0: colours */
    void (*step)(void *user, const whit_step *step);
    double time_limit_s; /* from whit_renderer_create on, not below 0; 0: none */
    whit_load_path load_path;
    whit_traversal traversal;
    whit_numerics numerics;
    /* How the kernels work; these do not change the picture. `segments`: into how many parts work
       lists are divided, 1 or 2; 0: chosen for the device. `node_bytes`: the size of nodes that
       rays outside of packets read, 16 or 32; 0: chosen by the tree. Instances, WHIT_NUMERICS_FAST,
       `count` and other devices than CPUs have no nodes of 16 bytes, and use those of 32. */
    whit_packets packets;
    whit_classes classes;
    uint32_t segments, node_bytes;
    bool count; /* counts traversal costs, for whit_stats.costs and whit_renderer_cost_image; not
                   with adaptive samples */
    /* Functions in the place of whit's own, borrowed as long as the renderer lives; NULL: none. Its
       kernels are made before the first picture, whatever compile_async says. */
    const whit_shader *shader;
    const char *sliders; /* "NAME=VALUE,NAME=VALUE": values of the shader's sliders; read during the
                            call; NULL or "": the values of the file */
    bool skip_sliders;   /* entries of `sliders` that the shader does not have are ignored, not
                            refused */
    uint32_t trace_rays; /* rays that whit_trace has on the device at a time; 0: chosen by whit. A
                            smaller number takes smaller buffers */
} whit_renderer_params;

/* 640 x 480, one sample, 16 samples of an area light, depth 8, bailout WHIT_BAILOUT_DEFAULT, the
   rest zero. Calls use these where their params are NULL. */
whit_renderer_params whit_renderer_defaults(void);

/* `device` may be NULL: then only whit_trace on the CPU works, and the camera is not looked for.
   Renderers of one accel may be at different times. The accel then is posed anew, as by
   whit_renderer_set_time, whenever another renderer than before traces on the CPU, probes or is set
   to a view.
   WHIT_ERROR_USAGE for params out of range, a camera that does not exist, or a scene whose pictures
   were dropped; WHIT_ERROR_INPUT for
   a scene that has no finite pose at that time; WHIT_ERROR_STATUS for a camera in too many media;
   WHIT_ERROR_DEVICE, also where a kernel cannot be made. */
WHIT_CHECK whit_result whit_renderer_create(whit_device *device, whit_accel *accel,
                                            const whit_renderer_params *params,
                                            whit_renderer **out);
void whit_renderer_destroy(whit_renderer *renderer);

/* Renders the whole picture. WHIT_ERROR_STATUS when a kernel reported that its result cannot be
   trusted (logged in words); WHIT_ERROR_USAGE without a device; WHIT_ERROR_DEVICE,
   WHIT_ERROR_TIME_LIMIT, WHIT_ERROR_CANCELLED. May be called again: the same bytes. After an error
   there is no picture, also not the one before, whose memory was drawn over. */
WHIT_CHECK whit_result whit_renderer_render(whit_renderer *renderer);

/* Draws `count` small pictures (views) together, one for each of `cameras`, in the renderer's size:
   each is byte for byte the picture that a renderer with that camera draws. whit_renderer_image
   then gives them one below the other, as one image of `count` times the height, until
   whit_renderer_render is called, a view is set or a pixel probed. Views share tiles and
   dispatches, so that thousands of 64 x 64 take about the time of one picture with as many pixels
   (whit_renderer_params.many_pictures makes the kernels for that; docs/batch.md); memory is that of
   all of them, some 40 bytes a pixel. `cameras` are read during the call. WHIT_ERROR_USAGE for no
   or too many cameras, for a camera that a renderer refuses (logged with the number of the view),
   and for params with a shader, adaptive samples, `count` or `row_count`. Other errors as of
   whit_renderer_render. The picture before stays where the number of cameras or params are
   refused. */
WHIT_CHECK whit_result whit_renderer_render_views(whit_renderer *renderer,
                                                  const whit_camera *cameras, uint32_t count);

/* Sets the time of the animation: moves instances, lights and camera, and keeps mesh trees and
   pipelines. The picture is that of a renderer made at that time, byte for byte. WHIT_ERROR_USAGE
   for a time that is not finite, WHIT_ERROR_INPUT for one without a finite pose;
   WHIT_ERROR_DEVICE. */
WHIT_CHECK whit_result whit_renderer_set_time(whit_renderer *renderer, double time_s);

/* Prepares another picture of the same scene with the same kernels. Of `params` it takes width,
   height, first_row, row_count, camera, time_s, sampling, light_samples, bailout, depth,
   exposure_ev, soft_highlights, step_spacing, step_aov, few_pixels, reuse_rays, time_stages and
   sliders, and nothing else; the camera's name is borrowed until the next call
   that succeeds. The picture is that of a renderer made with these params, byte for byte.
   WHIT_ERROR_USAGE without a device; this and others as of whit_renderer_create. Params out of
   range leave the former view and picture, and so does a camera that is refused while time_s stays;
   after other errors the renderer may have no picture, and whit_renderer_render gives
   WHIT_ERROR_USAGE until a call succeeds. */
WHIT_CHECK whit_result whit_renderer_set_view(whit_renderer *renderer,
                                              const whit_renderer_params *params);

/* Whether `shader` is another version of the renderer's shader: a file with the same functions,
   which need the same of lights and shadows. */
bool whit_renderer_takes_shader(const whit_renderer *renderer, const whit_shader *shader);
/* As whit_renderer_set_view, and takes params->shader, another version of the renderer's shader.
   Only its kernels are made anew; the version before may be destroyed afterwards. WHIT_ERROR_USAGE,
   logged, where whit_renderer_takes_shader is false. After an error the renderer keeps the version
   before, and params->shader may be destroyed. */
WHIT_CHECK whit_result whit_renderer_set_shader(whit_renderer *renderer,
                                                const whit_renderer_params *params);

/* The name of an effect by index, in the order of whit_scene_get_effect; NULL past the last. */
const char *whit_effect_name(uint32_t index);
/* Whether whit_renderer_params.effects_added or effects_removed may have the effect: effects that
   geometry or camera decide cannot be switched, except that a lens can be removed, and code for
   spheres added. */
bool whit_effect_can_add(uint32_t index);
bool whit_effect_can_remove(uint32_t index);
/* Whether a renderer's kernels contain the effect. */
bool whit_renderer_compiles(const whit_renderer *renderer, uint32_t effect);

typedef enum whit_aov {
    WHIT_AOV_COLOR = 0, /* 4 floats: linear RGB, alpha 1 */
    WHIT_AOV_IDS,       /* 2 uint32: instance, primitive of the pixel's first sample */
    WHIT_AOV_CUTS,      /* 2 floats: weights of rays that were not traced, first because of
                           params.depth, then because of params.bailout: sums over rays of their
                           largest channel, means over samples */
    WHIT_AOV_DISTANCES, /* 1 float, after whit_renderer_render_views: from the origin of the camera
                           ray of the pixel's first sample to its hit, in world units; infinity: a
                           miss. It equals the t of whit_trace, except that the ray passes through
                           cut-outs, and that at WHIT_NUMERICS_EXACT it is not the exact t
                           rounded */
    WHIT_AOV_SHADER = 64, /* plus an index into whit_shader_info.aovs; 4 floats, the mean over
                             samples of the function's value for what the camera ray hits, 0 for a
                             miss */
} whit_aov;
/* WHIT_ERROR_USAGE where nothing was rendered, for aovs that the shader does not have, for ids
   where sampling.first leaves the first sample out, for cuts of a picture with adaptive samples,
   and for distances unless whit_renderer_render_views drew the picture; WHIT_ERROR_DEVICE. */
WHIT_CHECK whit_result whit_renderer_image(whit_renderer *renderer, whit_aov aov, whit_image **out);
/* Makes an image of colours displayed (.png, FLIP) with exposure_ev and soft_highlights of
   `params`. Images from renderers and references have those of their params already. */
void whit_image_display_as(whit_image *image, const whit_renderer_params *params);

typedef enum whit_ray_kind {
    WHIT_RAY_PRIMARY = 0,
    WHIT_RAY_SHADOW,
    WHIT_RAY_REFLECTED,
    WHIT_RAY_REFRACTED,
    WHIT_RAY_KINDS,
} whit_ray_kind;

/* Traversal costs; see struct gpu_cost in shaders/abi/bvh.h. All are sums, except stack, depth and
   max_*, which are maxima. */
typedef struct whit_cost {
    uint64_t rays;
    uint64_t inner_nodes; /* inner nodes opened: box tests are twice that */
    uint64_t leaves, instances, triangles;
    uint32_t stack, depth;
    /* Number of records. A record is one ray of a batch, or one sample of a pixel with all its rays
       of this kind. */
    uint64_t records;
    uint64_t stack_sum, depth_sum; /* sums over records; divided by `records` they are means */
    uint32_t max_inner_nodes, max_leaves, max_instances, max_triangles; /* largest in one record */
} whit_cost;

typedef enum whit_view {
    WHIT_VIEW_DEPTH = 0, /* deepest level of the trees that was visited */
    WHIT_VIEW_VISITS,    /* nodes opened: inner nodes, leaves, instances */
    WHIT_VIEW_BOXES,     /* box tests */
    WHIT_VIEW_TRIS,      /* triangle tests */
    WHIT_VIEW_STACK,     /* most entries on the node stack */
} whit_view;
/* One float per pixel: the cost of the rays of `kind` of its first sample (WHIT_RAY_KINDS: of all
   kinds). WHIT_ERROR_USAGE without params.count, or where nothing was rendered. */
WHIT_CHECK whit_result whit_renderer_cost_image(whit_renderer *renderer, whit_view view,
                                                whit_ray_kind kind, whit_image **out);

/* The time of one stage of the kernels. Only one tile in eight is timed: `ms` is extrapolated to
   all `rays` from the mean time per ray in these tiles. */
typedef struct whit_stage {
    char name[24];
    uint64_t rays; /* items that the stage worked on: rays; hits in shading stages, sums in the
                      stage that adds them up */
    double ms;     /* < 0: not measured, as without params.time_stages */
} whit_stage;
#define WHIT_STAGES 14

/* The share of hits with one material among those that a shading kernel worked on, in the timed
   tiles. It stands for the material's share of the kernel's time, which is not exact: a hit of one
   material may take longer than a hit of another. */
typedef struct whit_share {
    uint32_t stage;    /* index into whit_stats.stages */
    uint32_t material; /* index of the material in the scene */
    double share;      /* 0..1 */
} whit_share;
#define WHIT_SHARES 24

/* Pixels are counted by number of samples, in classes: 1, up to 4, up to 16, ... up to
   WHIT_SAMPLES_MAX. */
enum { WHIT_SAMPLE_LEVELS = 7 };

typedef struct whit_stats {
    double upload_ms, compile_ms, render_ms, render_device_ms; /* render_device_ms < 0: not
                                                                  measured; render_ms, in a call of
                                                                  params.progress: until then */
    uint64_t rays_primary, rays_shadow, rays_reflected, rays_refracted;
    uint64_t rays_straight;     /* sent on by surfaces that let light pass unbent: by opacity or a
                                   texture's alpha, as shadow catchers, by straight of scatter() */
    uint64_t rays_by_functions; /* rays of all kinds that functions of params.shader traced
                                   themselves */
    uint64_t rays_of_estimate;  /* traced only for whit_refine_info.cut_radiance: no rays of the
                                   picture, but their time is a part of render_ms */
    double mrays_per_s;         /* millions of rays per second: all rays, those of the estimate
                                   included, divided by render_ms */
    uint64_t device_bytes;
    /* Rays that were not traced because of params.depth and of params.bailout, and the largest sum
       of their weights in one pixel. */
    uint64_t rays_cut_depth, rays_cut_bailout;
    double weight_cut_depth, weight_cut_bailout;
    /* Upper bound of the error of any pixel channel due to rays and shadow rays that bailout left
       out, for a bailout of up to 1; < 0: not known. */
    double bailout_bound;
    uint64_t pixels_by_samples[WHIT_SAMPLE_LEVELS];
    uint32_t kernel_instructions; /* SPIR-V, of all functions of its kernels */
    uint32_t kernels_beside; /* how many of these kernels a second device translated to machine code
                                in parallel */
    bool general;            /* drawn by the general kernel: see params.compile_async */
    uint32_t dispatches, tiles, tile_size;
    uint32_t deferred;        /* WHIT_NUMERICS_EXACT: number of items of lists (a ray, or a hit with
                                 its shadow rays) that floats left open and integers finished */
    whit_load_path load_path; /* the path that was used, never WHIT_LOAD_AUTO */
    bool packets;             /* camera rays were traced in packets */
    whit_cost costs[WHIT_RAY_KINDS]; /* with params.count */
    whit_stage stages[WHIT_STAGES];  /* `rays` is 0 for stages that were not used */
    whit_share shares[WHIT_SHARES];  /* largest first; the rest is left out */
    uint32_t share_count;
} whit_stats;

/* All rays of a picture, without those of an estimate. */
static inline uint64_t whit_stats_rays(const whit_stats *stats)
{
    return stats->rays_primary + stats->rays_shadow + stats->rays_reflected +
           stats->rays_refracted + stats->rays_straight + stats->rays_by_functions;
}
void whit_renderer_get_stats(const whit_renderer *renderer, whit_stats *stats);
/* Adds the statistics of one more picture to those of others: counts and times are summed, weights
   and bounds are maxima, tile_size and device_bytes are those of the picture added. Where a stage
   was timed in one picture alone, its rays of both are taken to take as long each; shares of
   materials are means over the rays of a stage. Upload and compilation of `to` stay as they are. */
void whit_stats_add(const whit_stats *from, whit_stats *to);

/* ---- Rays ---- */

/* Directions need not have unit length; t is measured in lengths of `dir`. Hits have t_min <= t <=
   t_max. With a negative t_min hits behind the origin count, but some may be missed; at
   WHIT_NUMERICS_EXACT it counts as 0 (docs/numerics.md). */
typedef struct whit_ray {
    float origin[3], t_min, dir[3], t_max;
} whit_ray;
/* Triangles: `u`, `v` are the barycentric weights of the second and third vertex. Spheres: u and v
   are the normal in object space, mapped to the unit square (octahedral, +y in the middle). ng is
   the normal of the surface in world space, of any length, on the side that it has in object space:
   outwards from a sphere, along (v1 - v0) x (v2 - v0) from a triangle, and against that product of
   the vertices in world space where the instance mirrors. */
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

/* Finds the closest hit of each ray, or with `any` any hit (then only `primitive` != WHIT_NONE has
   a meaning). Rays miss whose origin or direction is not finite or whose t_min is NaN; a t_max of
   NaN is no limit. Cut-outs count as solid. `cost`: gets the cost of all rays together, or NULL
   (on the device it needs params.count). It is that of each ray alone; with WHIT_PACKETS_ON on the
   device a packet is one record and counts as one ray, its inner nodes have up to eight children,
   and its triangles are tested with all its rays. WHIT_ERROR_STATUS where the hits cannot be
   trusted, WHIT_ERROR_USAGE for what the renderer was not made for (no device, `count` false), and
   on the device after a change of time that failed halfway, until one succeeds;
   WHIT_ERROR_CANCELLED; WHIT_ERROR_DEVICE on the device. */
WHIT_CHECK whit_result whit_trace(whit_renderer *renderer, whit_trace_on on, const whit_ray *rays,
                                  uint64_t count, bool any, whit_hit *hits, whit_cost *cost);
/* Device time in ms of the traversals of the last whit_trace on the device, without transfers; < 0:
   not measured. */
double whit_trace_device_ms(const whit_renderer *renderer);

WHIT_C_END

#endif
