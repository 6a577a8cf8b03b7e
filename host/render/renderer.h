/* The renderer from inside: shared by the files of render/ alone. */
#ifndef RENDER_RENDERER_H
#define RENDER_RENDERER_H

#include "abi/bindings.h"
#include "abi/queues.h"
#include "abi/shade.h"
#include "abi/spec.h"
#include "device/commands.h"
#include "picture/bodies.h"
#include "picture/camera.h"
#include "picture/environment.h"
#include "picture/media.h"
#include "picture/sequence.h"
#include "render/portable.h"
#include "render/render.h"
#include "shader/program.h"

/* The scene in device memory. `none` stands in for what the scene lacks. */
struct scene_buffers {
    struct buffer *nodes, *triangles, *instances;
    struct buffer *shading; /* rows of materials, texture uses, lights, triangles */
    struct buffer *texels, *environment, *frame;
    struct buffer *none;
    uint32_t environment_size, uv_sets;
    bool smooth_normals, colors; /* what the shading rows hold */
    bool texel_loads;
    struct buffer *nodes8; /* with renderer->packets */
    uint64_t bytes;
};

/* What the stages of a picture leave to each other, of one tile (abi/queues.h). */
struct queue_buffers {
    struct buffer *generations, *empty; /* gpu_tally and gpu_generation; as they begin */
    struct buffer *rays, *hits, *lit, *sums, *hit_list, *cuts, *cut_sums;
    struct buffer *lit_list;
    struct buffer
        *deferred; /* NUMERICS_EXACT: rays, or lit hits of a light, that floats leave open */
    struct buffer *hook_rows;     /* of hits: what a user's surface() and shade() have said */
    struct buffer *shape_shadows; /* of lit hits, with a user's shape: two words each */
    struct buffer *kinds; /* RAY_*, with params.count; how far rays have come, for textures */
    uint32_t generation_count, ray_capacity, lit_capacity;
    uint64_t bytes;
};

/* The pixels of one band of rows, and the rays of one chunk. */
struct pixel_buffers {
    struct buffer
        *pixels; /* behind them partial sums of samples, `levels` for each slot; last, from
                    `before_post` on, what a user's post() is given: all pixels once more */
    struct buffer *ids;
    struct buffer *costs;  /* of a chunk: RAY_KIND_COUNT a slot; NULL: nothing is counted */
    struct buffer *listed; /* slots whose camera rays are traced; NULL: all always are */
    struct buffer *status;
    struct buffer *aovs;      /* see bind/queues.glsl; NULL: the shader has no functions for it */
    struct buffer *distances; /* NULL: the picture has one camera */
    struct queue_buffers queues;
    uint32_t band_y;      /* first row that they hold now */
    uint32_t band_rows;   /* rows the pixel buffers hold, a multiple of 8 */
    uint32_t chunk_slots; /* pixels that the queues hold */
    uint32_t levels;
    uint32_t before_post; /* 0: there is no post() */
    uint64_t bytes;       /* of all of them, also counted in scene_buffers.bytes */
};

/* A kernel, and where rays may wait (SPEC_SETTLES) the one that takes what the first has put on the
   list of deferred rays, else NULL. */
struct pass {
    struct pipeline *pipeline, *deferred;
    uint32_t rays_each;                     /* items that an invocation takes */
    struct binding_set *set, *deferred_set; /* what they work on */
};

/* In the order in which a generation of rays goes through them; the last one from the youngest
   generation back to the first. */
enum stage {
    STAGE_CAMERA,
    STAGE_CLOSEST,
    STAGE_SHADE,
    STAGE_SHADE_GLASS,
    STAGE_SHADOW,
    STAGE_SHADOW_LATER,
    STAGE_RESOLVE, /* into pixels */
    STAGE_RESOLVE_LATER,
    STAGE_MISS,      /* of a user's function */
    STAGE_SHAPE,     /* likewise, before rays go through the trees */
    STAGE_HIT,       /* likewise, of what rays have met */
    STAGE_HIT_FETCH, /* HIT_PART_FETCH and HIT_PART_CALL, which stand in for STAGE_HIT until it is
                        made */
    STAGE_HIT_CALL,
    STAGE_AOV,  /* likewise, beside the colour */
    STAGE_POST, /* likewise, of pixels that have all samples */
    STAGE_COUNT
};

/* The kernels that draw a picture together. */
struct stage_set {
    struct pass
        passes[STAGE_COUNT];    /* empty where a stage has nothing to do, or shares another's */
    enum stage of[STAGE_COUNT]; /* whose kernel a stage runs: its own, or a later one's */
    uint32_t classes;           /* of materials, each with a shading kernel of its own */
    bool calls[CLASSES_MAX];    /* whether hits of a class call for rays */
    bool asks;                  /* whether hits ask lights, for stages of their own */
};

/* How long each stage of the tile being drawn takes, see stage_times.c. */
struct stage_times {
    uint32_t tiles; /* so far */
    bool on;        /* the tile is timed */
    uint32_t row;   /* of the span that is open; RENDER_STAGE_COUNT: none */
    uint32_t rows[COMMANDS_SPANS], span_count;
    double ms[RENDER_STAGE_COUNT];
};

/* What went through a stage in the tiles of the picture that were timed. */
struct stage_sample {
    uint64_t items;
    double ms;
};

struct stages {
    struct stage_set set;
    struct stage_times times;
    uint32_t expected;       /* generations of the last tile */
    bool full;               /* a queue was, in the last submission */
    uint64_t *material_hits; /* of each class and material, in timed tiles; NULL: none so far */
    uint32_t blocks_max;     /* of tiles, since one was too large; 0: as many as fit */
    uint32_t rays_min; /* that the queues have room for, since a block was too large for them */
};

struct trace_state {
    struct buffer *rays, *hits, *costs;
    struct buffer *deferred; /* work list; NULL where no ray waits */
    struct pass singles[2];  /* for closest hits, for any */
    struct pass beams[2];    /* likewise, of rays that start at one point, in packets */
    uint32_t capacity;       /* rays */
    uint64_t together;       /* rays of the last batch that walked in packets */
    double device_ms;
    uint32_t deferred_count; /* rays of the last batch that floats left open */
};

/* The pixels of a picture that a pass draws: from (x, y) on every so-many-th. */
struct lattice {
    uint32_t x, y, spacing_x, spacing_y; /* spacing: 1, 2, 4, 8 */
    uint32_t width, height;              /* how many, those above params.first_row among them */
};

/* What one picture in the making knows. An adaptive one, or one in steps, is made in several
   passes. */
struct progress {
    struct lattice lattice; /* of the pass */
    double start_ms;
    uint32_t tile;
    uint64_t work_done, work_total; /* block samples of the pass */
    double before, share;           /* of the picture: of passes before, of this one */
    uint32_t samples;               /* a pixel, in this pass */
    bool listed;                    /* it draws only pixels that `levels` gives these samples */
    bool aovs_alone;                /* it leaves colours and identities as they are */
    uint8_t *levels; /* of each pixel: 1: 4 samples, 2: 16, 3: 64; NULL when not adaptive */
};

/* With params.compile_async: see async.c. */
struct async_state {
    struct async_job *job; /* the specialised kernel in the making; NULL: none is */
    bool general;          /* renderer->picture.stages.set is of general kernels */
};

/* Views of many cameras, which a picture has one below the other. */
struct views {
    uint32_t count;  /* 0: the picture has one camera */
    uint32_t held;   /* that the buffers and kernels of the picture are made for */
    uint32_t camera; /* CAMERA_* that kernels are made for */
    struct gpu_view *all;
    struct buffer *buffer; /* has them too */
};

/* The buffers that the stages read and write, the kernels bound to them, and the figures of what
   was drawn. A renderer has two: one for pictures, one for probed pixels. */
struct target {
    struct renderer *renderer;
    struct pixel_buffers buffers;
    struct stages stages;
    whit_stats stats;
    struct stage_sample timed[RENDER_STAGE_COUNT];
    bool probed;            /* rays are recorded, those of listed pixels alone (probe.c) */
    struct buffer *records; /* of a probe: gpu_probe, and gpu_probe_ray */
    struct buffer *dbg;     /* of a probe with dbg(x): as hook/record.glsl; NULL before the first */
};

/* All that decides the colours of a picture, but for its kernels. */
struct kept_view {
    struct gpu_frame frame;
    float sliders[SLIDERS_MAX];
    double time_s;
    uint32_t samples, first_sample, first_row, rows;
};

/* The picture whose colours the device still has, as post() of a user's file was given them. */
struct kept_picture {
    bool known; /* false: there is none any more */
    bool aovs;  /* what is beside the colours is of the file in hand */
    struct kept_view view;
    whit_stats stats;
    struct stage_sample timed[RENDER_STAGE_COUNT];
};

struct renderer {
    whit_log log;
    struct device *device;
    struct accel *accel;
    const struct scene *scene;
    whit_renderer_params params;
    struct scene_pose pose;
    struct scene_effects effects; /* that kernels are made for: see effects_choose */
    struct scene_buffers scene_buffers;
    struct target picture;
    struct target probe; /* a row of blocks; without buffers before the first probe */
    struct views views;
    bool packets; /* rays of pictures may walk in packets, through nodes of eight children */
    uint32_t packet_rays; /* of a lane, in these */
    bool few_kernels;     /* one for several stages and materials, since the renderer was made */
    bool wide;            /* there are such nodes on the device */
    struct kept_picture kept;
    struct trace_state trace;
    struct async_state async;
    struct commands *commands;
    struct gpu_frame frame;
    struct portable_params portable;    /* where params.portable asks for it */
    float sliders[SLIDERS_MAX];         /* of params.shader */
    uint32_t reaches_decide;            /* bits SHADER_REACHES_*: by which effects are chosen */
    uint64_t effects_unasked;           /* of params.effects_removed, for the shader alone */
    struct bodies bodies;               /* of media, of the frame's pose */
    struct image color, ids, cuts;      /* of the last picture, where it has more than one band */
    struct image aovs;                  /* likewise: a pixel beside itself for each function */
    struct image distances;             /* likewise */
    struct image costs[RAY_KIND_COUNT]; /* of first samples; empty where a kind has no rays */
    double create_ms;
    /* What the pipelines were made for. */
    bool *worn; /* of each material: some primitive has it */
    uint32_t node_stack_size, packet_stack_size;
    bool single_identity;
    bool has_secondary; /* the scene calls for more than camera rays */
    bool between_times; /* another time was only set in part */
    bool rendered;
};

enum { RENDER_GROUP_SIZE = 128, RENDER_BLOCK_PIXELS = 64 };
/* Bytes of the status buffer (shaders/bind/trees.glsl) where status_loop and status_shape are. */
enum { STATUS_LOOP_AT = 8, STATUS_SHAPE_AT = 12 };
enum { READ_SLICE = 4096 }; /* pixels that are read at once */
enum { ADAPTIVE_MAX = 64 }; /* samples of a pixel of an adaptive picture */

/* Says that there is none on the host for `what`, and returns WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result render_no_memory(const struct renderer *renderer, const char *what);
/* Whether surfaces leave rays, for the parameters and effects of the renderer. */
bool renderer_bounces(const struct renderer *renderer);
/* Fills in of a zeroed renderer what needs no memory of the device. Call renderer_finish in any
 * case.
 */
WHIT_CHECK whit_result renderer_init(struct renderer *renderer, const whit_log *log,
                                     struct device *device, struct accel *accel,
                                     const whit_renderer_params *params);
void renderer_finish(struct renderer *renderer);
/* The kernel of the picture, where there is none yet. */
WHIT_CHECK whit_result renderer_compile(struct renderer *renderer);

#endif
