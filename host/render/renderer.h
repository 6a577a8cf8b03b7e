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

/* The planes of a picture: values of 32 bits for each pixel. The image of PLANE_AOVS has one column
   for each aov of each pixel. */
enum plane_name { PLANE_COLOR, PLANE_IDS, PLANE_CUTS, PLANE_DISTANCES, PLANE_AOVS, PLANES };

/* The scene in device memory. `none` is a small buffer that is bound in place of each buffer that
   the scene does not need. */
struct scene_buffers {
    struct buffer *nodes, *triangles, *instances;
    struct buffer *shading; /* rows of materials, texture uses, lights, triangles */
    struct buffer *texels, *environment, *frame;
    struct buffer *none;
    uint32_t environment_size, uv_sets;
    bool smooth_normals, colors; /* whether the shading rows hold them */
    bool texel_loads;
    struct buffer *nodes8;    /* nodes of eight children; NULL unless renderer->wide */
    struct buffer *quantized; /* struct gpu_quantized_node; NULL unless renderer->quantized */
    uint64_t bytes;
};

/* The queues between the stages of a picture, for the tile being drawn (abi/queues.h). */
struct queue_buffers {
    /* A gpu_tally, then the gpu_generations; `empty` has their initial contents. */
    struct buffer *generations, *empty;
    struct buffer *rays, *hits, *lit, *sums, *hit_list, *cuts, *cut_sums;
    struct buffer *lit_list;
    /* NUMERICS_EXACT: the rays, or the lit hits of a light, whose hits floats leave open. */
    struct buffer *deferred;
    struct buffer *hook_rows;     /* results of a user's surface() and shade(), by hit */
    struct buffer *shape_shadows; /* for a user's intersect(): two words a lit hit */
    struct buffer *kinds; /* by ray: RAY_* (params.count, probes), distance so far (mipmaps) */
    uint32_t generation_count, ray_capacity, lit_capacity;
    uint64_t bytes;
};

/* The pixels of one band (a range of rows of 8x8 blocks), and the queues of one chunk (a run of
   blocks of the band: a tile). A slot is a pixel's place in a chunk. */
struct pixel_buffers {
    struct buffer *pixels; /* the pixels; then `levels` partial sums of samples for each slot; then,
                              from `before_post` on, the pixels as a user's post() is given them */
    struct buffer *ids;
    struct buffer *costs;  /* costs of a chunk: RAY_KIND_COUNT a slot; NULL: not counted */
    struct buffer *listed; /* pixels of the band that a pass draws; NULL: passes draw all */
    struct buffer *status;
    struct buffer *aovs;      /* see bind/queues.glsl; NULL: the shader has no aov */
    struct buffer *distances; /* NULL: the picture has one camera */
    struct queue_buffers queues;
    uint32_t band_y;      /* first row of the picture in the pixel buffers */
    uint32_t band_rows;   /* rows that the pixel buffers hold, a multiple of 8 */
    uint32_t chunk_slots; /* slots that the queues have room for */
    uint32_t levels;
    uint32_t before_post; /* 0: there is no post() */
    uint64_t bytes;       /* of all these buffers; scene_buffers.bytes includes them */
};

/* The kernel of a stage. `deferred` (NULL where no ray can be deferred) is a second kernel, made
   with SPEC_SETTLES, that runs on the rays that the first one has put on the list of deferred
   rays. */
struct pass {
    struct pipeline *pipeline, *deferred;
    uint32_t rays_each;                     /* rays or hits that an invocation takes */
    struct binding_set *set, *deferred_set; /* the buffers bound to each */
};

/* In the order in which a generation of rays goes through them. STAGE_RESOLVE* come last, from the
   youngest generation back to the camera rays. */
enum stage {
    STAGE_CAMERA,
    STAGE_CLOSEST,
    STAGE_SHADE,
    STAGE_SHADE_GLASS,
    STAGE_SHADE_DIRECT, /* as STAGE_SHADE, and what the shadow stages add to its hits */
    STAGE_SHADOW,
    STAGE_SHADOW_LATER,
    STAGE_RESOLVE, /* generation 0: the sums go into the pixels */
    STAGE_RESOLVE_LATER,
    STAGE_MISS,        /* a user's miss() */
    STAGE_SHAPE,       /* a user's intersect(), before rays go through the trees */
    STAGE_SHAPE_LIGHT, /* the same for shadow rays */
    STAGE_HIT,         /* a user's surface() and shade(), at hits */
    /* HIT_PART_FETCH and HIT_PART_CALL: they stand in for STAGE_HIT until its kernel is made. */
    STAGE_HIT_FETCH,
    STAGE_HIT_CALL,
    STAGE_AOV,  /* a user's aovs, at hits of camera rays */
    STAGE_POST, /* a user's post(), for pixels that have all samples */
    STAGE_COUNT
};

/* The kernels that draw a picture together. */
struct stage_set {
    struct pass passes[STAGE_COUNT]; /* empty: nothing to do, or the kernel of another stage */
    enum stage of[STAGE_COUNT];      /* the stage whose kernel each runs: itself, or a later one */
    uint32_t classes;                /* classes of materials; each has its own shading kernel */
    uint32_t hit_rows;               /* as variant_hit_rows() */
    uint32_t lights_each;            /* lights of a dispatch: SPEC_LIGHTS_EACH, or 1 */
    bool shares_hits;        /* whether lights take their hits from one list, few as they are */
    bool calls[CLASSES_MAX]; /* whether hits of a class send further rays */
    bool asks;               /* whether hits go on to the shadow stages */
    bool asks_directly; /* whether any hits do where STAGE_SHADE_DIRECT shades opaque surfaces */
};

/* Times of the stages of the tile that is being drawn, see stage_times.c. */
struct stage_times {
    uint32_t tiles; /* drawn so far */
    bool on;        /* the tile is timed */
    uint32_t row;   /* RENDER_STAGE_* of the open span; RENDER_STAGE_COUNT: none */
    uint32_t rows[COMMANDS_SPANS], span_count;
    double ms[RENDER_STAGE_COUNT];
};

/* The items that a stage worked on in the timed tiles of a picture, and the time that they took. */
struct stage_sample {
    uint64_t items;
    double ms;
};

struct stages {
    struct stage_set set;
    struct stage_times times;
    uint32_t expected;       /* number of generations of the last tile */
    bool full;               /* a queue overflowed in the last submission */
    bool may_cut;            /* loops that are cut short are no error: the tile is drawn again */
    bool cut;                /* with may_cut: loops were cut short in the last submission */
    bool no_direct;          /* STAGE_SHADE_DIRECT is not used, since its loops were cut short */
    uint64_t *material_hits; /* by class and material, in timed tiles; NULL: none yet */
    /* Blocks that a tile may have, since a larger one overflowed a queue; 0: as many as fit. */
    uint32_t blocks_max;
    /* Rays that the queues get room for at least, since one block overflowed them. */
    uint32_t rays_min;
};

struct trace_state {
    struct buffer *rays, *hits, *costs;
    struct buffer *deferred; /* rays left to a second dispatch; NULL: there are never any */
    /* [0]: kernels for single rays, [1]: for packets of rays that start at one point; of both [0]
       for the closest hit, [1] for any hit. */
    struct pass passes[2][2];
    uint32_t capacity; /* rays that the buffers hold */
    uint64_t together; /* rays of the last batch that were traced in packets */
    double device_ms;
    uint32_t deferred_count; /* rays of the last batch that floats left open */
};

/* The pixels of a picture that a pass draws: (x, y), and from there every spacing_x-th column of
   every spacing_y-th row. */
struct lattice {
    uint32_t x, y, spacing_x, spacing_y; /* spacing: 1, 2, 4 or 8 */
    uint32_t width, height; /* columns and rows; includes rows above params.first_row */
};

/* The progress of a picture. Adaptive pictures and pictures in steps take several passes. */
struct progress {
    struct lattice lattice; /* drawn by the pass */
    double start_ms;
    uint32_t tile;
    uint64_t work_done, work_total; /* samples of blocks in this pass */
    double before, share;           /* shares of the picture, 0..1: earlier passes, this pass */
    uint32_t samples;               /* samples of a pixel in this pass */
    uint64_t listed; /* pixels that the pass draws, whose level asks for `samples`; 0: all */
    bool aovs_alone; /* draws aovs only; colours and ids stay */
    uint8_t *levels; /* by pixel: base-4 logarithm of its samples; NULL: not adaptive */
};

/* For params.compile_async: see async.c. */
struct async_state {
    struct async_job *job; /* the specialised kernel in the making; NULL: none is */
    bool general;          /* renderer->picture.stages.set has general kernels */
};

/* Views of many cameras: one picture that has them one below the other. */
struct views {
    uint32_t count;  /* 0: the picture has one camera */
    uint32_t held;   /* views that buffers and kernels are made for */
    uint32_t camera; /* CAMERA_* that the kernels are made for */
    struct gpu_view *all;
    struct buffer *buffer; /* `all` on the device */
};

/* The buffers that the stages read and write, the kernels bound to them, and the figures of what
   was drawn. A renderer has two: one for pictures, one for probed pixels. */
struct target {
    struct renderer *renderer;
    struct pixel_buffers buffers;
    struct stages stages;
    whit_stats stats;
    struct stage_sample timed[RENDER_STAGE_COUNT];
    bool probed;            /* only listed pixels are drawn, and rays recorded (probe.c) */
    struct buffer *records; /* result of a probe: a gpu_probe, then gpu_probe_rays */
    struct buffer *dbg;     /* values of dbg(x), as in hook/record.glsl; NULL: none yet */
};

/* All that decides the colours of a picture, but for its kernels. */
struct kept_view {
    struct gpu_frame frame;
    float sliders[SLIDERS_MAX];
    double time_s;
    uint32_t samples, first_sample, first_row, rows;
};

/* The picture whose colours are still on the device, as they are given to post() of a user's
   file. */
struct kept_picture {
    bool known; /* false: no picture is kept */
    bool aovs;  /* the kept aovs are those of the current shader */
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
    struct scene_effects effects; /* effects that kernels are made with: see effects_choose */
    struct scene_buffers scene_buffers;
    struct target picture;
    struct target probe; /* holds one row of blocks; no buffers before the first probe */
    struct views views;
    bool packets;         /* rays of pictures are traced in packets, on bvh8 */
    uint32_t packet_rays; /* rays that each lane of a packet has */
    bool few_kernels;     /* one kernel for several stages and all materials: render_few_kernels */
    bool wide;            /* nodes of eight children are on the device */
    bool quantized;       /* rays that are not in packets read nodes of 16 bytes */
    const struct accel_mesh *graded; /* the mesh whose tree grades_well tells of; NULL: none yet */
    bool grades_well;                /* accel_quantizes_well, which looks at all nodes */
    uint32_t
        tile; /* pixels on a side of the last tile that was drawn in little time; 0: none was */
    struct kept_picture kept;
    struct trace_state trace;
    struct async_state async;
    struct commands *commands;
    struct gpu_frame frame;
    struct portable_params portable; /* used with params.portable */
    float sliders[SLIDERS_MAX];      /* slider values of params.shader */
    uint32_t reaches_decide;         /* SHADER_REACHES_* bits that effects depend on: hooks.c */
    uint64_t effects_unasked;    /* effects removed only because the shader needs none of them */
    struct bodies bodies;        /* bodies of media in the current pose */
    struct image planes[PLANES]; /* the last picture, where it has several bands; empty: not kept */
    struct image costs[RAY_KIND_COUNT]; /* costs of first samples; empty for a kind without rays */
    double create_ms;
    /* Properties of the scene that the pipelines were made for (up to has_secondary). */
    uint8_t *worn; /* of scene_worn_materials */
    uint32_t node_stack_size, packet_stack_size;
    bool single_identity, clipped;
    bool has_secondary; /* surfaces send rays on: renderer_bounces */
    /* A change of time, or of view, failed halfway: no picture can be drawn. */
    bool between_times, between_views;
    bool rendered;
};

enum { RENDER_GROUP_SIZE = 128, RENDER_BLOCK_PIXELS = 64 };
/* Byte offsets of status_loop and status_shape in the status buffer (shaders/bind/trees.glsl). */
enum { STATUS_LOOP_AT = 8, STATUS_SHAPE_AT = 12 };

/* Why there is nothing to read: renderer->rendered is false. */
#define RENDER_NO_PICTURE                                                                          \
    "there is no picture: none was rendered since the renderer was made, changed or failed"
/* Logs that host memory ran out for `what`, and returns WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result render_no_memory(const struct renderer *renderer, const char *what);
/* Whether surfaces send rays on, with the parameters and effects of the renderer. */
bool renderer_bounces(const struct renderer *renderer);
/* Fills in the parts of a zeroed renderer that need no device memory. Call renderer_finish also
   after an error. */
WHIT_CHECK whit_result renderer_init(struct renderer *renderer, const whit_log *log,
                                     struct device *device, struct accel *accel,
                                     const whit_renderer_params *params);
void renderer_finish(struct renderer *renderer);
/* Makes the kernels of the picture where there are none yet, and binds them. */
WHIT_CHECK whit_result renderer_compile(struct renderer *renderer);
/* Makes the buffers of pixels anew, for the picture as it is now. */
WHIT_CHECK whit_result retarget_pixels(struct renderer *renderer);
/* Forgets the figures of the last picture, and keeps what was measured before it. */
void stats_clear(struct target *target);
/* Call it after passes_finish. */
void trace_finish(struct trace_state *trace);

#endif
