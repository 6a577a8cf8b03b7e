/* libwhit: a Whitted ray tracer on Vulkan compute. This header is the whole public face; see
   tests/example/example.c for a program that uses nothing else.

   Ownership: what a function creates, its destroy function ends; destroy accepts NULL. Handles
   borrow what they were made from: scene <- accel <- renderer -> device; destroy in reverse order.
   In every params struct, 0 means the default, and NULL params mean all defaults; params are read
   during the call only. On failure an out parameter is NULL or untouched, the reason went to the
   log callback as one line (where the call or a handle has one), and the result says which kind it
   was.

   Threads: different handles may be used from different threads; one handle from one at a time. A
   `cancel` flag may be set from anywhere, a signal handler included. */
#ifndef WHIT_H
#define WHIT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "whit_base.h"

#ifdef __cplusplus
extern "C" {
#endif

#define WHIT_VERSION "0.1.0"
#define WHIT_NONE    UINT32_MAX /* no primitive, no instance: a miss */

typedef struct whit_scene whit_scene;       /* geometry, materials, lights, cameras */
typedef struct whit_accel whit_accel;       /* trees over one scene, on the CPU */
typedef struct whit_device whit_device;     /* one Vulkan device */
typedef struct whit_renderer whit_renderer; /* an accel on a device, with settings */
typedef struct whit_image whit_image;       /* pixels in host memory */

/* Where messages go. Zeroed: nowhere. */
typedef struct whit_log {
    whit_log_fn fn;
    void *user;
    whit_log_level level; /* messages above it are not made */
} whit_log;

/* ---- Scene ---- */

typedef struct whit_load_params {
    double time_limit_s;         /* for a foreign importer; 0: 60 */
    uint64_t memory_limit_bytes; /* for a foreign importer; 0: 4 GiB */
    uint32_t texture_limit;      /* longest side, larger ones are halved; 0: 4096 */
    const volatile bool *cancel; /* polled; NULL: never */
} whit_load_params;

/* .json scene files and .obj .gltf .glb .ply .stl models. */
WHIT_CHECK whit_result whit_scene_load(const char *path, const whit_load_params *params,
                                       const whit_log *log, whit_scene **out);
void whit_scene_destroy(whit_scene *scene);
/* Frees the texels that the scene holds on the host, for programs that make no further renderer
   from it: making one is WHIT_ERROR_USAGE afterwards. Renderers made before are not touched. */
void whit_scene_drop_pictures(whit_scene *scene);

typedef struct whit_scene_info {
    uint32_t mesh_count, instance_count, node_count, material_count, texture_count, light_count,
        camera_count, note_count, effect_count;
    uint64_t mesh_triangle_count; /* each mesh once */
    uint64_t triangle_count;      /* over all instances */
    uint64_t sphere_count;        /* likewise */
    uint64_t file_bytes;          /* of all files read */
    uint64_t hash;
    uint32_t channel_count;  /* animated properties of nodes */
    double time_end_s;       /* 0: nothing moves */
    double lo[3], hi[3];     /* world bounds at time 0; lo > hi when empty */
    const char *environment; /* "gradient" or "map": what rays that miss see */
    bool environment_made_by_whit;
} whit_scene_info;
void whit_scene_get_info(const whit_scene *scene, whit_scene_info *info);

/* Item `index` of a kind, described; zeroed when there is no such item. Strings live as long as
   the scene. */
typedef struct whit_mesh_info {
    const char *name;
    uint32_t vertex_count, triangle_count, group_count, sphere_count;
    bool has_normals, has_uvs, has_colors;
} whit_mesh_info;
typedef struct whit_material_info {
    const char *name, *file; /* file: NULL when made by whit */
    uint32_t line;
    const char *model; /* "phong", "metal-rough", "unlit" */
    int32_t illum;     /* -1: none */
    float diffuse[3], specular[3], emission[3], reflection[3], transmission[3];
    float shininess, ior, opacity, metallic, roughness;
    uint32_t texture_count;
} whit_material_info;
typedef struct whit_light_info {
    const char *name;
    const char *kind; /* "point", "directional", "spot", "area-sample", "rectangle", "triangle" */
    double position[3], direction[3]; /* world, at time 0 */
    float color[3];
    bool made_by_whit;
} whit_light_info;
typedef struct whit_camera_info {
    const char *name;
    const char *kind;                /* "perspective", "orthographic", "panorama" */
    double eye[3], target[3], up[3]; /* world, at time 0 */
    double fov_y_degrees, height;
    double lens_radius, focus_distance; /* world units; 0: a pinhole; 0: the target's distance */
    bool made_by_whit;
} whit_camera_info;
typedef struct whit_instance_info {
    const char *name;
    uint32_t mesh;
    double object_to_world[12]; /* row-major 3x4, at time 0 */
} whit_instance_info;
typedef struct whit_effect_info {
    const char *name;
    bool called;
    const char *reason; /* "" when not called for */
} whit_effect_info;
typedef struct whit_note_info {
    bool warning;
    const char *text;
} whit_note_info;
void whit_scene_get_mesh(const whit_scene *scene, uint32_t index, whit_mesh_info *info);
void whit_scene_get_material(const whit_scene *scene, uint32_t index, whit_material_info *info);
void whit_scene_get_light(const whit_scene *scene, uint32_t index, whit_light_info *info);
void whit_scene_get_camera(const whit_scene *scene, uint32_t index, whit_camera_info *info);
void whit_scene_get_instance(const whit_scene *scene, uint32_t index, whit_instance_info *info);
void whit_scene_get_effect(const whit_scene *scene, uint32_t index, whit_effect_info *info);
void whit_scene_get_note(const whit_scene *scene, uint32_t index, whit_note_info *info);

/* Every world-space triangle at `time_s`, in the order of instance, then primitive. Spheres are not
   among them. */
typedef struct whit_triangle {
    float vertices[9];
    uint32_t instance, primitive;
} whit_triangle;
/* fn returns false to stop (then the result is WHIT_ERROR_CANCELLED). */
WHIT_CHECK whit_result whit_scene_triangles(const whit_scene *scene, double time_s,
                                            bool (*fn)(void *user, const whit_triangle *triangle),
                                            void *user);

/* ---- Trees ---- */

typedef enum whit_build {
    WHIT_BUILD_BINNED = 0,  /* surface area heuristic over equal bins */
    WHIT_BUILD_MEDIAN,      /* halves */
    WHIT_BUILD_SWEEP,       /* surface area heuristic over every position */
    WHIT_BUILD_SPATIAL,     /* splits space too, which may put a triangle in several leaves */
    WHIT_BUILD_SWEEP_NAIVE, /* the tree of SWEEP in quadratic time, for comparison */
    WHIT_BUILD_NONE,        /* no tree: rays test every triangle */
} whit_build;

typedef struct whit_accel_params {
    whit_build build;
    bool optimize;                       /* improve the finished trees by reinsertion */
    uint32_t bins;                       /* of WHIT_BUILD_BINNED, 2..256; 0: the measured default */
    uint32_t leaf_limit;                 /* triangles in a leaf, 1..15; 0: 4 */
    float spatial_alpha, spatial_budget; /* of WHIT_BUILD_SPATIAL: see docs/cli.md; 0: defaults;
                                            budget < 0: none */
    uint32_t threads;                    /* 0: one a core; never changes the tree */
    whit_build instance_build; /* of the tree over instances: WHIT_BUILD_BINNED or _MEDIAN */
    bool instance_refit;       /* moving instances keep their tree, with new boxes */
    bool flatten;              /* no tree over instances: one tree over all their triangles */
    bool validate;             /* check the tree after the build (always in debug builds) */
    const char
        *tree_path;      /* mesh trees saved by whit_accel_save, instead of building; NULL: build */
    double time_limit_s; /* for WHIT_BUILD_SWEEP_NAIVE; 0: none */
    const volatile bool *cancel;
} whit_accel_params;

WHIT_CHECK whit_result whit_accel_create(const whit_scene *scene, const whit_accel_params *params,
                                         whit_accel **out);
void whit_accel_destroy(whit_accel *accel);

typedef struct whit_accel_info {
    uint32_t node_count, leaf_count, triangle_count, depth, instance_depth;
    uint32_t
        reference_count; /* triangles in leaves: more than triangle_count where some are split */
    uint64_t bytes;
    double build_ms, instance_build_ms, sah_cost; /* sah_cost: of the largest mesh */
    char builder[48]; /* of the mesh trees, also of saved ones: "binned:7", "spatial+opt" */
} whit_accel_info;
void whit_accel_get_info(const whit_accel *accel, whit_accel_info *info);

/* Checks every tree: each triangle in a leaf, children inside parents, indices in range, no cycle,
   leaf sizes, depth. WHIT_ERROR_STATUS, with the first violation in the log. */
WHIT_CHECK whit_result whit_accel_validate(const whit_accel *accel);
/* Saves the mesh trees with a checksum, for whit_accel_params.tree_path and the same scene. */
WHIT_CHECK whit_result whit_accel_save(const whit_accel *accel, const char *path);

enum { WHIT_DEPTH_BINS = 130, WHIT_LEAF_BINS = 16 };
/* What trees are like: of all mesh trees together, a mesh with several instances once. */
typedef struct whit_accel_report {
    uint64_t leaves_at_depth[WHIT_DEPTH_BINS]; /* the root is depth 0 */
    uint64_t leaves_of_size[WHIT_LEAF_BINS];   /* triangles in a leaf */
    double sah_cost;                           /* mean over meshes, weighted by area */
    double epo;              /* end-point overlap (Aila, Karras and Laine 2013, section 3) */
    double overlap;          /* area shared by siblings, relative to the area of their parents */
    double predicted_visits; /* of a random line that meets the root: pairs, by areas */
    double predicted_triangles;
    double measured_visits; /* the same of random rays on the CPU */
    double measured_triangles;
    uint64_t measured_rays;
} whit_accel_report;
WHIT_CHECK whit_result whit_accel_get_report(const whit_accel *accel, whit_accel_report *report);

/* A box of a tree's node, in world space: parallel to the axes of its own space, not always to the
   world's. Corner i has the upper end of axis k where bit k of i is set. */
typedef struct whit_box {
    float corners[8][3];
    uint32_t instance; /* WHIT_NONE: of the tree over instances, or of one tree over all of them */
    uint32_t level;    /* the root is 0 */
    bool leaf;
} whit_box;
/* The nodes at `level`, and the leaves above it, of the tree over instances, or of the mesh trees
   of every instance, at `time_s`, which the accel must stand at. At most `most` of them; *boxes is
   one block, free() it. *total: how many there are. */
WHIT_CHECK whit_result whit_accel_boxes(const whit_accel *accel, double time_s, bool over_instances,
                                        uint32_t level, uint64_t most, whit_box **boxes,
                                        uint64_t *total);

/* ---- Devices ---- */

typedef struct whit_device_info {
    uint32_t index;
    char name[256], driver[256], api_version[32];
    char kind[16]; /* "discrete", "integrated", "virtual", "cpu", "other" */
    uint64_t memory_bytes, max_storage_range_bytes;
    uint32_t subgroup_size;
    bool float64, int64, timestamps, usable;
    bool automatic;    /* the one that "auto" takes */
    char why_not[128]; /* when not usable */
} whit_device_info;

/* *infos is one block; free() it. */
WHIT_CHECK whit_result whit_device_list(const whit_log *log, whit_device_info **infos,
                                        uint32_t *count);

typedef struct whit_device_params {
    const char *selector; /* NULL or "auto"; a number; part of a name */
    bool validation;      /* Vulkan validation layers, with their messages in the log */
} whit_device_params;

WHIT_CHECK whit_result whit_device_create(const whit_device_params *params, const whit_log *log,
                                          whit_device **out);
/* The same in a thread of its own, while the caller does something else, such as loading a scene.
   `params` is read, and its selector borrowed, until the end; what there is to say is logged at the
   end, by the thread that asks for it. NULL when memory or threads run out: then whit_device_create
   is left. */
typedef struct whit_device_opening whit_device_opening;
WHIT_CHECK whit_device_opening *whit_device_open_begin(const whit_device_params *params,
                                                       const whit_log *log);
/* Waits; gives what whit_device_create would have given, and frees `opening`. */
WHIT_CHECK whit_result whit_device_open_end(whit_device_opening *opening, whit_device **out);
/* Instead: nothing is logged, and a device is destroyed again. NULL is fine. */
void whit_device_open_abandon(whit_device_opening *opening);
void whit_device_destroy(whit_device *device);
void whit_device_get_info(const whit_device *device, whit_device_info *info);
uint32_t whit_device_validation_messages(const whit_device *device);

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
    WHIT_NUMERICS_EXACT, /* as exact arithmetic says for the given floats, t rounded to nearest;
                            needs trees when on a device. Spheres: as watertight */
} whit_numerics;

typedef struct whit_renderer_params {
    uint32_t width, height; /* pixels; 0: 640 x 480 */
    const char *camera;     /* name or index of a camera of the scene, or
                               "ex,ey,ez,tx,ty,tz,ux,uy,uz,fov_degrees"; NULL: the first */
    double time_s;          /* of the animation */
    uint32_t samples;       /* a pixel: 1, 4, 16 or 64; 0: 1 */
    uint32_t depth;         /* most bounces; 0: 8 */
    bool no_bounces;        /* depth 0: what the primary ray sees, with its shadows */
    double bailout;         /* rays that can add less than this to a pixel are not traced;
                               0: 1/1024, < 0: all are */
    bool no_shadows;
    double adaptive;        /* pixels that differ from a neighbour by more than this get 16 samples
                               instead of 4, and then 64; `samples` is not read; 0: off */
    uint32_t light_samples; /* of an area light, a fixed pattern: 1, 4, 16 or 64; 0: 16 */
    bool schlick;           /* Schlick's approximation in place of exact Fresnel */
    bool opaque_shadows;    /* glass and blended surfaces cast full shadows */
    /* "auto" or NULL: what the scene calls for; "all": everything; "+NAME,-NAME,...": what it calls
       for with some effects (whit_effect_name) more, or less; "all,-NAME,...": all but some. Less
       changes the picture. */
    const char *effects;
    /* Draw with the general kernel, which is compiled first when no cache has it, while a thread
       compiles that of the scene; the pictures are the same. Errors of that thread are logged from
       it. Without trees: not done. */
    bool compile_beside;
    uint32_t tile_size; /* pixels on a side, 16..512; 0: by measured time */
    const volatile bool *cancel;
    /* Called from the rendering thread with the share done, 0..1; may be NULL. */
    void (*progress)(void *user, double done);
    void *progress_user;
    double time_limit_s;   /* from whit_renderer_create on; 0: none */
    const char *load_path; /* "auto" or NULL, "storage", "texel": how kernels read trees */
    whit_traversal traversal;
    whit_numerics numerics;
    bool count; /* count what traversals cost: for whit_stats.costs and whit_renderer_cost_image */
} whit_renderer_params;

/* `device` may be NULL: then only whit_trace on the CPU works. */
WHIT_CHECK whit_result whit_renderer_create(whit_device *device, whit_accel *accel,
                                            const whit_renderer_params *params,
                                            whit_renderer **out);
void whit_renderer_destroy(whit_renderer *renderer);

/* Renders the whole picture. WHIT_ERROR_STATUS when a kernel reported that it must not be trusted
   (logged in words). May be called again: the same bytes. */
WHIT_CHECK whit_result whit_renderer_render(whit_renderer *renderer);

/* Goes to another time of the animation: moves instances, lights and camera, keeps mesh trees and
   pipelines. The picture is that of a renderer made at that time, byte for byte. */
WHIT_CHECK whit_result whit_renderer_set_time(whit_renderer *renderer, double time_s);

/* Another picture of the same scene with the same kernel: takes over width, height, camera, time_s,
   samples, adaptive, light_samples, bailout, depth and no_bounces, and nothing else. `camera` is
   borrowed until the next call. The picture is that of a renderer made with these, byte for byte.
   After an error there is nothing to render before a call that succeeds. */
WHIT_CHECK whit_result whit_renderer_set_view(whit_renderer *renderer,
                                              const whit_renderer_params *params);

/* Effects by index, in the order of whit_scene_get_effect; NULL past the last. */
const char *whit_effect_name(uint32_t index);
/* Whether whit_renderer_params.effects may say "+NAME" and "-NAME" of it: what geometry or camera
   decide cannot be switched. */
bool whit_effect_can_add(uint32_t index);
bool whit_effect_can_remove(uint32_t index);
/* Whether the kernel of a renderer has an effect in it. */
bool whit_renderer_compiles(const whit_renderer *renderer, uint32_t effect);

/* What is left of the kernel for this renderer, and of the same with every effect. */
typedef struct whit_kernel_info {
    uint32_t instructions, general_instructions; /* SPIR-V, in functions */
    uint32_t bindings, general_bindings;         /* descriptors */
} whit_kernel_info;
/* Takes some 50 ms. WHIT_ERROR_USAGE without a device, WHIT_ERROR_DEVICE when the kernel cannot be
   specialized. */
WHIT_CHECK whit_result whit_renderer_get_kernel(const whit_renderer *renderer,
                                                whit_kernel_info *info);

typedef enum whit_aov {
    WHIT_AOV_COLOR = 0, /* 4 floats: linear RGB, alpha 1 */
    WHIT_AOV_IDS,       /* 2 uint32: instance, primitive of the pixel's first sample */
} whit_aov;
WHIT_CHECK whit_result whit_renderer_image(whit_renderer *renderer, whit_aov aov, whit_image **out);

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
    uint64_t pairs; /* inner nodes opened: box tests are twice that */
    uint64_t leaves, instances, triangles;
    uint32_t stack, depth;
    /* A record is a ray of a batch, or a sample of a pixel that has rays of the kind. */
    uint64_t records;
    uint64_t stack_sum, depth_sum; /* over records: means are these over `records` */
    uint32_t most_pairs, most_leaves, most_instances, most_triangles; /* in one record */
} whit_cost;

typedef enum whit_view {
    WHIT_VIEW_DEPTH = 0, /* deepest level of the trees that was looked at */
    WHIT_VIEW_VISITS,    /* nodes opened: pairs + leaves + instances */
    WHIT_VIEW_BOXES,     /* box tests */
    WHIT_VIEW_TRIS,      /* triangle tests */
    WHIT_VIEW_STACK,     /* most refs on the node stack */
} whit_view;
/* One number a pixel, as floats of one channel: what the rays of `kind` of its first sample cost
   (WHIT_RAY_KINDS: of all kinds). With params.count. */
WHIT_CHECK whit_result whit_renderer_cost_image(whit_renderer *renderer, whit_view view,
                                                whit_ray_kind kind, whit_image **out);

typedef struct whit_stats {
    double upload_ms, compile_ms, render_ms, render_device_ms; /* device: < 0 when not measured */
    uint64_t rays_primary, rays_shadow, rays_reflected, rays_refracted;
    double mrays_per_s; /* all rays over render_ms */
    uint64_t device_bytes;
    /* Rays that were not traced, and the largest sum of their weights in one pixel: depth, for
       params.depth; bailout, for params.bailout. */
    uint64_t rays_cut_depth, rays_cut_bailout;
    double weight_cut_depth, weight_cut_bailout;
    /* No pixel channel is off by more than this for rays cut by bailout; < 0: not known. */
    double bailout_bound;
    uint64_t pixels_by_samples[4]; /* of 1, 4, 16 and 64 samples */
    uint32_t kernel_instructions;  /* SPIR-V, of its functions; see whit_renderer_get_kernel */
    bool general;                  /* drawn by the general kernel: see params.compile_beside */
    uint32_t dispatches, tiles, tile_size;
    const char *load_path;           /* "storage" or "texel" */
    whit_cost costs[WHIT_RAY_KINDS]; /* with params.count */
} whit_stats;
void whit_renderer_get_stats(const whit_renderer *renderer, whit_stats *stats);

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
   that are not finite miss. Cut-outs count as solid. */
WHIT_CHECK whit_result whit_trace(whit_renderer *renderer, whit_trace_on on, const whit_ray *rays,
                                  uint64_t count, bool any, whit_hit *hits, whit_cost *cost);
/* Device time of the traversals of the last whit_trace on the device, without transfers; < 0: not
   measured. */
double whit_trace_device_ms(const whit_renderer *renderer);

/* ---- The reference ---- */

/* The same picture in double, on the CPU, written a second time: what kernels get wrong is the
   difference to it. See host/reference/reference.h. */
typedef struct whit_reference whit_reference;

/* `accel` is borrowed until whit_reference_destroy and goes to params->time_s: no renderer may be
   at work on it. Of `params` size, camera, time, samples, depth, bailout, shadows, Fresnel, area
   lights, cancel, progress and time_limit_s (of one whit_reference_render) are obeyed; adaptive
   samples and effects left out are WHIT_ERROR_USAGE. `threads`: 0: one a core; the same bytes for
   any number. */
WHIT_CHECK whit_result whit_reference_create(whit_accel *accel, const whit_renderer_params *params,
                                             uint32_t threads, whit_reference **out);
void whit_reference_destroy(whit_reference *reference);
/* `ids`, as WHIT_AOV_IDS, may be NULL. WHIT_ERROR_CANCELLED and WHIT_ERROR_TIME_LIMIT leave no
   picture. WHIT_ERROR_STATUS: a ray was in too many media. */
WHIT_CHECK whit_result whit_reference_render(whit_reference *reference, whit_image **color,
                                             whit_image **ids);

typedef enum whit_tree_kind {
    WHIT_TREE_PRIMARY = 0,
    WHIT_TREE_SHADOW,
    WHIT_TREE_REFLECTED,
    WHIT_TREE_REFRACTED,
    WHIT_TREE_STRAIGHT, /* through a blended surface or a shadow catcher */
    WHIT_TREE_KINDS,
} whit_tree_kind;

typedef enum whit_tree_end {
    WHIT_TREE_MISS = 0, /* left the scene: sees the sky */
    WHIT_TREE_SURFACE,  /* met a surface, whose rays follow */
    WHIT_TREE_OPAQUE,   /* met a surface that calls for no further ray */
    WHIT_TREE_UNSEEN,   /* passed a surface between two places of the same medium */
    WHIT_TREE_LIGHT,    /* of shadow rays: came to the light */
    WHIT_TREE_BLOCKED,  /* of shadow rays: met something opaque */
    WHIT_TREE_ABSORBED, /* nothing is left of it */
    WHIT_TREE_DEPTH,    /* not traced, for the limit of bounces */
    WHIT_TREE_BAILOUT,  /* not traced, for what little it can add */
    WHIT_TREE_ENDS,
} whit_tree_end;

typedef struct whit_tree_ray {
    uint32_t kind, end; /* whit_tree_kind, whit_tree_end */
    uint32_t parent;    /* index, smaller than its own; WHIT_NONE: it comes from the camera */
    uint32_t bounces;
    double origin[3], dir[3]; /* unit */
    double
        t; /* of what it met; of shadow rays at the latest that of the light; infinity: nothing */
    uint32_t instance, primitive, material; /* of what it met, or WHIT_NONE */
    uint32_t medium;                        /* material that it travels in; WHIT_NONE: air */
    uint32_t light, point; /* of shadow rays: light of the scene (else WHIT_NONE), point of it */
    double normal[3];      /* of shading, where it met something that is seen; else 0 */
    double weight[3];      /* of its radiance in the sample; of shadow rays the share that passes */
    double radiance[3];    /* what it added to the sample; 0 for shadow rays */
} whit_tree_ray;

/* "reflected", "no further ray"; NULL past the last. */
const char *whit_tree_kind_name(uint32_t kind);
const char *whit_tree_end_name(uint32_t end);

/* The ray tree of one sample (0: the first) of a pixel from the upper left; the sum of `radiance`
   is the sample's colour. whit_tree_rays_destroy() ends it. WHIT_ERROR_USAGE outside of the
   picture. */
WHIT_CHECK whit_result whit_reference_rays(whit_reference *reference, uint32_t x, uint32_t y,
                                           uint32_t sample, whit_tree_ray **rays, uint32_t *count);
void whit_tree_rays_destroy(whit_tree_ray *rays);

/* ---- One pixel ---- */

/* Why a ray ended. */
typedef enum whit_probe_end {
    WHIT_PROBE_MISSED = 0, /* it meets nothing, and sees the environment */
    WHIT_PROBE_OPAQUE,     /* it meets a surface that calls for no further ray */
    WHIT_PROBE_DIVIDED,    /* it meets a surface that reflects it or lets it through */
    WHIT_PROBE_ABSORBED,   /* too little is left of it behind what it went through */
    WHIT_PROBE_DEPTH,      /* not traced: its bounces were used up */
    WHIT_PROBE_BAILOUT,    /* not traced: it could add less than params.bailout */
    WHIT_PROBE_REACHED,    /* shadow rays: all of the light passes */
    WHIT_PROBE_FILTERED,   /* shadow rays: some of it does */
    WHIT_PROBE_BLOCKED,    /* shadow rays */
    WHIT_PROBE_ENDS,
} whit_probe_end;
/* "missed", "hit, opaque", "hit, goes on", ... */
const char *whit_probe_end_name(whit_probe_end end);

typedef struct whit_probe_hit {
    double t;                     /* infinity: none */
    uint32_t instance, primitive; /* WHIT_NONE: none */
} whit_probe_hit;

typedef struct whit_probe_ray {
    whit_ray_kind kind;
    bool straight; /* it is what passes a blended surface, a shadow catcher, or a surface that has
                      the same medium on both sides */
    whit_probe_end end;
    uint32_t parent;     /* index of the ray that it comes from, below its own; WHIT_NONE: none */
    uint32_t generation; /* 0: the camera ray */
    whit_ray ray;        /* one that was not traced starts where its parent ended */
    float weight[3];     /* of what it brings to the pixel; shadow rays: of their surface */
    float added[3]; /* radiance that it added, without its branches, by weight; shadow rays: the
                       share of the light that passes */
    /* What the device met, its twin on the CPU, and exact arithmetic. Without trees the device does
       not know what blocks a light. */
    whit_probe_hit device, twin, exact;
    bool equal; /* twin: ids and every bit of t, and of u and v. Whether a cut-out is solid is the
                   device's word; shadow rays: any blocker that the device may have met */
    bool exact_known; /* false: not traced, or a sphere is in the way of a ray that is no camera ray
                       */
    bool exact_equal; /* ids (shadow rays: blocked or not), at WHIT_NUMERICS_EXACT t as well */
    uint32_t passed;  /* cut-outs, and one-sided surfaces from behind, that it went through; shadow
                         rays: also filters, and what casts no shadow */
    /* Of what it met; WHIT_NONE: nothing. */
    uint32_t material;
    float point[3], normal[3];    /* unit, interpolated, to the ray's side; without bump maps */
    bool inside;                  /* met from inside */
    uint32_t medium;              /* material of what it went through; WHIT_NONE: air */
    float ior;                    /* of that */
    uint32_t light, light_sample; /* shadow rays; else WHIT_NONE */
} whit_probe_ray;

typedef struct whit_probe_report {
    uint32_t x, y;
    uint32_t samples; /* that `color` is of; of an adaptive picture the 4 of its first pass */
    float color[4];   /* as in the picture: the same bytes */
    /* The tree of the first sample: a ray is followed by its shadow rays, then by its branches,
       each with its own, in the order in which they were traced. The first one is the camera ray.
     */
    whit_probe_ray *rays;
    uint32_t ray_count;
    uint32_t dropped;   /* rays that there was no room for */
    uint32_t differing; /* rays of which the twin says something else */
} whit_probe_report;

/* Traces pixel (x, y), from the upper left, once more, and nothing else; the picture that was
   rendered stays. The first call compiles a kernel. `most_rays`: that are recorded; 0: 16383, which
   is the limit. WHIT_ERROR_USAGE outside of the picture. */
WHIT_CHECK whit_result whit_probe(whit_renderer *renderer, uint32_t x, uint32_t y,
                                  uint32_t most_rays, whit_probe_report **out);
void whit_probe_report_destroy(whit_probe_report *report);

/* ---- Hard cases ---- */

/* Meshes and rays at which ray tracers fail, traced at every level of numerics, on the device and
   by its twin, and held against exact arithmetic: docs/numerics.md, "whit hard". */

typedef struct whit_hard_params {
    uint32_t rays;      /* of a row: at least 512, for the hash; 0: 20000 */
    uint32_t levels;    /* bits 1u << whit_numerics; 0: all of them */
    uint32_t threads;   /* on the CPU; 0: one a core */
    const char *filter; /* of the built-in cases those with this in their name; NULL: all, and then
                           there is a hash */
    const volatile bool *cancel;
    double time_limit_s; /* 0: none */
    void (*progress)(void *user, double done);
    void *progress_user;
} whit_hard_params;

/* One level at one case. Every count is of `rays`. */
typedef struct whit_hard_row {
    const char *name;  /* "sphere from inside" */
    const char *place; /* "1e5", "as vertices, x1e-6" */
    whit_numerics numerics;
    uint64_t rays;
    uint64_t hits;       /* exactly */
    uint64_t undecided;  /* rays that came by a sphere: they count as nothing below */
    uint64_t misses;     /* of rays that hit, exactly */
    uint64_t leaks;      /* misses of rays that start inside a closed surface; of others, those that
                            pass neither an outline nor an open edge */
    uint64_t false_hits; /* of rays that miss, exactly */
    uint64_t other_ids;  /* another primitive than exactly */
    uint64_t wrong_keys; /* the right one, but t is not the exact t's rounding */
    uint64_t wrong; /* of misses, false hits and wrong ids: no bound of float errors excuses them */
    uint64_t double_hits; /* a second primitive at the same place, where exactly there is none */
    uint64_t self_hits;   /* on the surface that the ray started from */
    uint64_t differing;   /* rays whose hits on the device and of the twin differ by a bit */
    double ulp_most;      /* error of t, in floats between it and the exact one's rounding */
    double device_ms, twin_ms; /* of `rays`; device: < 0 where not measured */
    bool unanswered; /* the device said that its hits are not to be trusted, as where a driver ends
                        long loops: the twin's are judged */
    bool promised;   /* that there are no leaks: false for cracks that are there */
    bool kept;       /* all that the level promises */
} whit_hard_row;

typedef struct whit_hard_report {
    whit_hard_row *rows;
    uint32_t row_count;
    uint64_t hash;       /* of the exact identities of a fixed set of rays; 0 for a user's scene */
    uint64_t hash_met;   /* of the device's at WHIT_NUMERICS_EXACT; 0 when not traced */
    uint32_t broken;     /* rows that did not keep a promise */
    uint32_t unanswered; /* rows without an answer of the device */
    /* Of a user's scene, vertices with equal coordinates being one. */
    uint64_t triangles, edges, open_edges, crowded_edges, flipped_edges, duplicates;
} whit_hard_report;

/* `scene` NULL: the built-in cases. `device` NULL: the twin's hits are judged. WHIT_OK also where
   promises are broken: see `broken`. */
WHIT_CHECK whit_result whit_hard_run(whit_device *device, const whit_scene *scene,
                                     const whit_hard_params *params, const whit_log *log,
                                     whit_hard_report **out);
void whit_hard_report_destroy(whit_hard_report *report);

typedef struct whit_hard_view_params {
    uint32_t width, height; /* 0: 640 x 480 */
    const char *camera;     /* as in whit_renderer_params */
    double time_s;
    whit_numerics numerics;
    uint32_t threads;
} whit_hard_view_params;
/* What camera rays hit, as grey lit from the eye; red where that is wrong: a leak, or beyond the
   bounds of the level's errors; yellow where it is another primitive than exactly, or none, within
   them. Cut-outs count as solid. `scene` NULL: the sphere of the built-in cases. `wrong_pixels`
   and `other_pixels` count the two. Other arguments as for whit_hard_run. */
WHIT_CHECK whit_result whit_hard_view(whit_device *device, const whit_scene *scene,
                                      const whit_hard_view_params *params, const whit_log *log,
                                      uint64_t *wrong_pixels, uint64_t *other_pixels,
                                      whit_image **out);

/* ---- Judged rays ---- */

/* Rays of a scene with what exact arithmetic says of them (docs/numerics.md), to hold hits against:
   those of its camera, and rays aimed at its vertices, edges and triangles (of `whit hard`: from in
   and around its bounds). Both are the same on every machine. `scene` is borrowed. */
typedef struct whit_judge whit_judge;
typedef struct whit_judge_params {
    bool aimed;         /* else from the camera */
    uint32_t count;     /* about as many; 0: 20000. Of a scene without triangles none are aimed. */
    const char *camera; /* as in whit_renderer_params */
    uint32_t width, height; /* the camera's picture, for its shape; 0: 640 x 480 */
    double time_s;
    uint32_t threads; /* 0: one a core */
} whit_judge_params;
WHIT_CHECK whit_result whit_judge_create(const whit_scene *scene, const whit_judge_params *params,
                                         const whit_log *log, whit_judge **out);
void whit_judge_destroy(whit_judge *judge);
const whit_ray *whit_judge_rays(const whit_judge *judge, uint64_t *count);

/* Of `rays`. Where a ray came by a sphere the answer is that of the walk in double. */
typedef struct whit_judgement {
    uint64_t rays, hits; /* hits: exactly */
    uint64_t misses, false_hits, other_ids;
    uint64_t leaks; /* of misses, as in whit_hard_row */
    uint64_t wrong; /* of misses, false hits and other ids: no bound of float errors excuses them;
                       of `exact` all, but where rays came by spheres: then as of `watertight` */
    uint64_t non_finite; /* hits with a t, u or v that is no number */
    /* |dt| / t where the primitive is right, in floats between t and the exact one's rounding; not
       of hits nearer than 2^-20 of the origin's coordinates. */
    uint64_t ulp_rays;
    double ulp_median, ulp_999, ulp_most; /* ulp_999: of 99.9 % of them it is at most this */
} whit_judgement;
/* `hits`: one for each of the rays, in their order, found at `numerics`. */
WHIT_CHECK whit_result whit_judge_hits(const whit_judge *judge, whit_numerics numerics,
                                       const whit_hit *hits, whit_judgement *out);

/* ---- Images ---- */

typedef struct whit_image_info {
    uint32_t width, height, channels;
    bool integers;
} whit_image_info;
void whit_image_get_info(const whit_image *image, whit_image_info *info);
/* width * height * channels values, row 0 at the top; the other one gives NULL. */
const float *whit_image_floats(const whit_image *image);
const uint32_t *whit_image_words(const whit_image *image);

/* Of a picture of floats what its .png holds: RGBA, width * height * 4 bytes. */
void whit_image_display_bytes(const whit_image *image, uint8_t *rgba);

typedef struct whit_text {
    const char *key, *value;
} whit_text;
/* .png (8-bit sRGB), .exr and .pfm (float); integers only .exr. Atomic. `texts` is the recipe kept
   inside the picture. */
WHIT_CHECK whit_result whit_image_save(const whit_image *image, const char *path,
                                       const whit_text *texts, uint32_t text_count,
                                       const whit_log *log);
WHIT_CHECK whit_result whit_image_load(const char *path, const whit_log *log, whit_image **out);
/* `pixels`: width * height * channels linear floats, row 0 at the top, copied; channels: 1, 3, 4.
 */
WHIT_CHECK whit_result whit_image_create(uint32_t width, uint32_t height, uint32_t channels,
                                         const float *pixels, whit_image **out);
/* The picture whose .png holds these RGBA bytes; alpha is left out. */
WHIT_CHECK whit_result whit_image_create_display(uint32_t width, uint32_t height,
                                                 const uint8_t *rgba, whit_image **out);
void whit_image_destroy(whit_image *image);

/* True for a path that whit_image_save can write; `integers` asks for hit identities. */
bool whit_image_format_known(const char *path, bool integers);

/* A picture of one channel as a heat map with a legend below: colours that the colour-blind can
   tell apart (viridis), dark is 0, bright is `scale` and above. Linear RGB, at least as wide as a
   legend that can be read: narrower pictures are centred. */
typedef struct whit_heat_params {
    double scale;      /* 0: whit_image_heat_scale */
    const char *title; /* of the legend, or NULL; ASCII, shortened when it does not fit */
    const char *unit;  /* of the numbers, at the legend's right end, or NULL */
    bool is_signed;    /* from -scale (blue) over 0 (white) to scale (brown); of three channels the
                          one farthest from 0 */
} whit_heat_params;
/* The 99.5th percentile, rounded up to a number that reads well; of the largest value where that
   is 0; 1 where all are. */
double whit_image_heat_scale(const whit_image *values);
WHIT_CHECK whit_result whit_image_heat(const whit_image *values, const whit_heat_params *params,
                                       whit_image **out);

/* How `b` differs from `a`, the reference; over RGB, linear, unless said otherwise. Grey counts as
   three equal channels, a missing alpha as 1. Of hit identities only pixel_count and
   differing_pixels mean something. */
typedef struct whit_difference {
    uint64_t pixel_count;
    uint64_t differing_pixels; /* by any bit, alpha included */
    uint64_t over_1_255;       /* a channel is more than 1/255 apart as displayed (8-bit sRGB) */
    uint64_t nonfinite_a, nonfinite_b; /* pixels; they are left out of what follows, up to flip */
    uint64_t nonfinite_differing;      /* of differing_pixels those not finite in one or both */
    double rmse;                       /* root of the mean squared error */
    double relative_mse;               /* mean of (b - a)^2 / (a^2 + 0.01) */
    double largest;                    /* of any channel */
    double mean[3];                    /* of b - a: above 0 where b is brighter */
    /* LDR-FLIP (Andersson et al. 2020): 0, looks the same, to 1; of pictures as displayed, clamped
       to [0, 1], with what is not finite as magenta. */
    double flip_mean, flip_largest;
} whit_difference;
/* A screen of 0.7 m with 3840 pixels, seen from 0.7 m. */
#define WHIT_FLIP_PIXELS_PER_DEGREE 67.02064327658226
typedef struct whit_compare_params {
    bool no_flip;             /* leave FLIP out, which takes most of the time: both are 0 then */
    double pixels_per_degree; /* of who looks at the pictures, 1 to 1000;
                                 0: WHIT_FLIP_PIXELS_PER_DEGREE */
} whit_compare_params;
/* WHIT_ERROR_INPUT when sizes or kinds differ. `flip_map`: NULL, or gets FLIP of each pixel as one
   channel (NULL without FLIP). */
WHIT_CHECK whit_result whit_image_compare(const whit_image *a, const whit_image *b,
                                          const whit_compare_params *params, const whit_log *log,
                                          whit_difference *out, whit_image **flip_map);
/* b - a, linear RGB, for whit_image_heat with is_signed, or to be saved as it is: NAN where either
   is not finite. */
WHIT_CHECK whit_result whit_image_subtract(const whit_image *a, const whit_image *b,
                                           const whit_log *log, whit_image **out);

/* The bytes of a PNG, as whit_image_save writes it; free() them. */
WHIT_CHECK whit_result whit_image_encode_png(const whit_image *image, const whit_text *texts,
                                             uint32_t text_count, const whit_log *log,
                                             uint8_t **data, size_t *size_bytes);

/* ---- Files ---- */

/* A file under construction, hidden beside `path`: commit renames it over `path`, abandon removes
   it. Exactly one of the two ends it. */
typedef struct whit_file whit_file;
WHIT_CHECK whit_result whit_file_begin(const char *path, const whit_log *log, whit_file **out);
WHIT_CHECK whit_result whit_file_append(whit_file *file, const void *data, size_t size_bytes);
WHIT_CHECK whit_result whit_file_commit(whit_file *file);
void whit_file_abandon(whit_file *file);

/* Writes a whole file beside `path` and renames it. */
WHIT_CHECK whit_result whit_file_write(const char *path, const void *data, size_t size_bytes,
                                       const whit_log *log);
/* Where whit keeps what it can make again: $XDG_CACHE_HOME/whit or ~/.cache/whit, made when it is
   not there; free() it. NULL: there is none, or WHIT_NO_CACHE is set. */
char *whit_cache_folder(void);
/* Removes unfinished output; safe in a signal handler. */
void whit_file_abandon_all(void);
uint64_t whit_peak_memory_bytes(void);
double whit_clock_ms(void);
double whit_clock_cpu_ms(void); /* used by all threads of this process */

#ifdef __cplusplus
}
#endif

#endif
