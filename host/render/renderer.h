/* The renderer from inside: shared by the files of render/ alone. */
#ifndef RENDER_RENDERER_H
#define RENDER_RENDERER_H

#include "abi/bindings.h"
#include "abi/queues.h"
#include "abi/shade.h"
#include "abi/spec.h"
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
        *deferred;      /* NUMERICS_EXACT: rays, or lit hits of a light, that floats leave open */
    struct buffer *own; /* of hits: what a user's surface() and shade() have said */
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
    STAGE_MISS,  /* of a user's function */
    STAGE_SHAPE, /* likewise, before rays go through the trees */
    STAGE_HIT,   /* likewise, of what rays have met */
    STAGE_AOV,   /* likewise, beside the colour */
    STAGE_POST,  /* likewise, of pixels that have all samples */
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

/* With params.compile_async: see beside.c. */
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

/* renderer.c: whether surfaces leave rays, for the parameters and effects of the renderer. */
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

/* pixels.c: the bits of the steps of a ray of a picture of this depth, 8..16: gpu_frame. */
uint32_t pixels_slot_shift(uint32_t depth);

/* pixels.c: target->buffers, for the parameters and effects of the renderer, for bands of up to
   `height` rows and chunks of `tile_size` (0: as large as is fit). */
WHIT_CHECK whit_result pixels_create(struct target *target, uint32_t height, uint32_t tile_size);
void target_finish(struct target *target);
/* Before pictures of another size or depth: its pixels, and what is bound to them. */
void target_drop_pixels(struct target *target);
/* Partial sums that the most samples of a pixel leave at once. */
uint32_t pixels_levels(const whit_renderer_params *params);
/* Blocks of 8 x 8 that cover `pixels` in a row or column. */
uint32_t pixels_blocks_across(uint32_t pixels);

/* costs.c: all of it does nothing without params.count. */
WHIT_CHECK whit_result costs_create(struct target *target);
void costs_clear(struct renderer *renderer);
/* Takes over what the kernels counted for one sample of `chunk`, which was just drawn: the next
   chunk counts in the same slots. */
WHIT_CHECK whit_result costs_add(struct target *target, const struct gpu_chunk *chunk);

/* queues.c: target->buffers.queues, of target->buffers.chunk_slots slots. */
WHIT_CHECK whit_result queues_create(struct target *target);
void queues_finish(struct queue_buffers *queues);
/* Room for more rays of a tile, where the device has it. What is bound to the queues must be bound
   anew. */
bool queues_can_grow(const struct target *target);
WHIT_CHECK whit_result queues_grow(struct target *target);

/* upload.c */
/* Says that there is none on the host for `what`, and returns WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result render_no_memory(const struct renderer *renderer, const char *what);
WHIT_CHECK whit_result upload_scene(struct renderer *renderer);
/* How kernels read the trees, and whether rays walk in packets; upload_scene begins with it. */
void upload_choose(struct renderer *renderer);
/* Chooses packets anew for the number of rays that the picture has now; before the frame is filled.
 */
WHIT_CHECK whit_result upload_choose_packets(struct renderer *renderer);
/* Makes the nodes of eight that packets need on the host, and says what stack they take. */
WHIT_CHECK whit_result upload_widen(struct renderer *renderer);
/* Whether rays can walk in packets here, as far as device, trees and parameters go. */
bool upload_can_widen(const struct renderer *renderer);
/* Nodes of eight children, where there are none yet: renderer->wide. */
WHIT_CHECK whit_result upload_wide(struct renderer *renderer);
void upload_finish(struct scene_buffers *buffers);
WHIT_CHECK whit_result upload_words(struct renderer *renderer, const void *data,
                                    uint64_t size_bytes, uint32_t uses, const char *name,
                                    struct buffer **out);
/* What another pose changes: instances with their tree, lights. Passes bound to buffers that had to
   grow are gone afterwards. */
WHIT_CHECK whit_result upload_pose(struct renderer *renderer);
/* textures.c: uploads all texels and makes the records that use them. */
struct material_records {
    struct gpu_material *materials; /* one for each of the scene's */
    struct gpu_texture *uses;
    uint32_t use_count;
};
/* A material of the scene as kernels of the renderer's effects draw it; it borrows all that it
   points to. */
struct scene_material material_drawn(const struct renderer *renderer, uint32_t index);
/* Whether textures have smaller levels, for what is far away. */
bool textures_minify(const struct renderer *renderer);
WHIT_CHECK whit_result material_records_init(struct renderer *renderer,
                                             struct material_records *records);
void material_records_finish(struct material_records *records);
/* lights.c: the rows of all lights of the pose. */
WHIT_CHECK whit_result lights_write(struct renderer *renderer);
/* Bits 1 << LIGHT_* of the kinds in `pose`. */
uint32_t lights_kinds(const struct scene_pose *pose);
/* The number of points sampled on each flat emitter; 1 where the pose has none. */
uint32_t lights_samples(const struct renderer *renderer);
/* environment.c */
WHIT_CHECK whit_result upload_environment(struct renderer *renderer);
/* effects.c: WHIT_ERROR_USAGE, logged, for effects that cannot be added or left out. */
WHIT_CHECK whit_result effects_check(const whit_log *log, const whit_renderer_params *params);
/* What the scene calls for, as `effects` says, more and less what `params` say; what
   does nothing without something else that is off is off too. */
void effects_choose(const whit_renderer_params *params, struct scene_effects *effects);
/* Sets the constants that effects switch. */
void effects_switch(const struct scene_effects *effects, struct gpu_spec *spec);

/* bailout_bound.c: by how much a pixel of the last picture may differ for the rays that --bailout
   cut; < 0: no bound is known (emissive surfaces as points, highlights of flat emitters, a light on
   a surface). */
double bailout_bound(const struct renderer *renderer);

/* variants.c: which constants a scene gets, and the pipelines made with them. */
struct gpu_spec variant_spec(const struct target *target);
/* The same with every effect. */
struct gpu_spec variant_general_spec(const struct target *target);
/* Every effect that the renderer's buffers allow and its params do not remove. */
struct gpu_spec variant_async_spec(const struct target *target);
/* Classes of materials that have shading kernels of their own. */
uint32_t variant_classes(const struct target *target);
/* Whether one kernel draws what has several elsewhere: renderer->few_kernels, and probes. */
bool variant_few_kernels(const struct target *target);
/* Whether the shading kernel with `spec` sends rays on: CALLS_RAYS of bind/queues.glsl. */
bool variant_calls_rays(const struct gpu_spec *spec);
/* Whether rays that floats leave open wait for a dispatch of their own: at NUMERICS_EXACT, unless
   they are counted or probed, which is to tell of every ray at once. */
bool variant_has_deferred(const struct target *target);
/* Rows of 16 bytes of a hit: HIT_ROWS of bind/queues.glsl. */
uint32_t variant_hit_rows(const struct renderer *renderer);
/* What is needed to make the pipelines of a stage; stands alone, and is not to be copied or moved.
 */
struct variant_job {
    struct gpu_spec spec;
    enum binding_kind kinds[BIND_STAGES_COUNT];
    struct pipeline_params params;
};
/* pass->pipeline and, where rays wait, pass->looks. */
WHIT_CHECK whit_result variant_job_run(struct device *device, const struct variant_job *job,
                                       struct pass *pass);
/* Whether a kernel leaves rays to a second one that has exact integers, and the constants of that.
 */
bool variant_defers(const struct pipeline_params *params, struct gpu_spec *spec);
/* `spec`: of the set of stages, which has `classes` shading kernels. */
void variant_job_init(const struct target *target, const struct gpu_spec *spec, uint32_t classes,
                      enum stage stage, struct variant_job *job);
/* Makes the binding sets of the pass. */
WHIT_CHECK whit_result variant_bind_stage(const struct target *target, struct pass *pass);
/* `beams`: for rays that start at one point, which then needs renderer->wide and
   variant_has_beams. */
WHIT_CHECK whit_result variant_create_trace(struct renderer *renderer, bool any, bool beams,
                                            struct pass *pass);
/* The kernel that runs the tests of params.shader, into `found`. */
WHIT_CHECK whit_result variant_create_tests(const struct target *target, struct buffer *found,
                                            struct pass *pass);
bool variant_has_beams(const struct renderer *renderer);
/* CAMERA_* that kernels are made for. */
uint32_t variant_camera(const struct renderer *renderer);
void pass_finish(struct pass *pass);
/* Keeps the pipeline. */
void pass_unbind(struct pass *pass);
void passes_finish(struct renderer *renderer);

/* stages.c: pictures in stages. */
/* What is needed to make a set of kernels; stands alone, and is not to be copied or moved. */
struct stages_job {
    struct gpu_spec spec;
    uint32_t classes;
    bool asks;                  /* as of a set */
    bool wanted[STAGE_COUNT];   /* a kernel of its own */
    enum stage of[STAGE_COUNT]; /* as of a set */
    struct variant_job stages[STAGE_COUNT];
};
/* `own`: the kernels for the scene, else general ones with `spec`. `few`: one kernel for stages
   that differ by their generation alone. */
void stages_job_init(const struct target *target, const struct gpu_spec *spec, bool own, bool few,
                     struct stages_job *job);
WHIT_CHECK whit_result stages_job_run(struct device *device, const struct stages_job *job,
                                      struct stage_set *out);
/* Takes over a set, which is empty afterwards, in place of the one that there was. */
WHIT_CHECK whit_result stages_take(struct target *target, struct stage_set *set);
/* Where there is a set: makes those of its kernels anew that are others since
   renderer->params.shader is in the place of `before`. After an error there is none. */
WHIT_CHECK whit_result stages_replace(struct target *target, const whit_shader *before);
/* Makes the scene's own set where there is none. */
WHIT_CHECK whit_result stages_compile(struct target *target);
/* Binds the set to the buffers that there are, where it is not bound. */
WHIT_CHECK whit_result stages_bind(struct target *target);
/* Has the kernels of a set that was just made and bound translated to machine code by two cores,
   where the driver's cache has none of it and the driver would use one core. Errors are the
   device's; where a stop is asked for, what is left is translated when it is dispatched. */
WHIT_CHECK whit_result translation_share(struct target *target, const struct stages_job *job);
bool stage_set_is_made(const struct stage_set *set);
bool stages_are_made(const struct target *target);
void stages_unbind(struct stages *stages);
void stage_set_finish(struct stage_set *set);
/* All rays of one sample of one chunk. *longest_ms: of its submissions. */
WHIT_CHECK whit_result stages_sample(struct target *target, const struct gpu_chunk *chunk,
                                     const struct progress *progress, double *longest_ms);

uint64_t stages_generation_offset(uint32_t generation);

/* material_shares.c: of the tile in hand, whose queues are as its generations and its camera rays
   have left them. WHIT_ERROR_MEMORY, logged. */
WHIT_CHECK whit_result material_shares_add(struct target *target,
                                           const struct gpu_generation *generations,
                                           uint32_t generation_count, uint32_t camera_rays);
/* Before another picture. */
void material_shares_clear(struct target *target);
/* stats->shares. */
void material_shares_get(const struct target *target, whit_stats *stats);

/* stage_times.c: target->stats.stages, and rays_shadow with it. */
void stage_times_begin(struct target *target);
/* A submission begins, whose first span is open. */
void stage_times_submission(struct target *target);
/* What is recorded from here on belongs to `row`. */
void stage_times_next(struct target *target, uint32_t row);
/* The submission is done. */
void stage_times_take(struct target *target);
/* A tile is done, of `generations`, with so many items that waited. */
WHIT_CHECK whit_result stage_times_end(struct target *target, const struct gpu_chunk *chunk,
                                       uint32_t generations, uint32_t deferred);
/* Fills in names, and the times of all items. */
void stage_times_scale(const struct renderer *renderer, whit_stats *stats);

/* beside.c: renderer->picture.stages are the best kernels that there are without waiting for them:
   at first the general one, while a thread compiles the specialised one, and from some later call
   on that. The thread logs when it fails; the general kernel then stays. */
WHIT_CHECK whit_result async_prepare(struct renderer *renderer);
/* Waits for the thread. */
void async_finish(struct renderer *renderer);

/* hooks.c: what the functions of params.shader call for, beside what the scene does. */
void hooks_take(struct renderer *renderer);
/* Its code of a kernel, for a probe with dbg(x) that which records; NULL: whit's own serves. */
const struct shader_code *hooks_code(const struct target *target, const char *kernel);
/* How often dbg(x) stands in it, where `target` records what it is; else 0. */
uint32_t hooks_dbg_count(const struct target *target);
/* Its functions whose values are kept beside the colour. A probe calls them for what dbg(x) is. */
uint32_t hooks_aov_count(const struct target *target);
/* WHIT_ERROR_USAGE, logged, for sliders that the shader has not. */
WHIT_CHECK whit_result hooks_read_sliders(struct renderer *renderer, const char *sliders);
/* Finds the material of its shape in the scene, which may have none of that name. */
WHIT_CHECK whit_result hooks_find_material(struct renderer *renderer);
/* Forgets loops that had no fuel left, and answers for a shape that were wrong. */
WHIT_CHECK whit_result hooks_clear_status(const struct target *target);
/* Adds to the text which file has functions in the place of whit's; nothing where there is none. */
void hooks_describe_file(const struct renderer *renderer, char *text, size_t text_bytes);
/* What ran out of iterations, as the status buffer names it. */
void hooks_describe_fuel(const struct target *target, char *text, size_t text_bytes);
/* Which answer for a shape was wrong, likewise. */
void hooks_describe_shape(const struct target *target, char *text, size_t text_bytes);

/* trace.c */
void trace_finish(struct trace_state *trace);

/* frame_uniform.c: all of renderer->frame but the rows. */
WHIT_CHECK whit_result frame_fill(struct renderer *renderer);
/* The buffer that holds it, and the values of sliders behind it. */
WHIT_CHECK whit_result frame_create(struct renderer *renderer);
/* Writes both to the device, as they are. */
WHIT_CHECK whit_result frame_write(const struct renderer *renderer);
/* Fills the record and writes both to the device. */
WHIT_CHECK whit_result frame_upload(struct renderer *renderer);

/* views.c: rows that the picture has in memory; views have whole rows of blocks. */
uint32_t views_rows(const struct renderer *renderer);
/* Rows of one view among these. */
uint32_t views_stride(const struct renderer *renderer);
/* Rows of the whole picture, of all views. */
uint32_t views_picture_rows(const struct renderer *renderer);
/* Rows that its images have. */
uint32_t views_image_rows(const struct renderer *renderer);
/* Writes for each view of the chunk where the sample in hand passes through its lens. */
WHIT_CHECK whit_result views_take_sample(struct renderer *renderer, const struct gpu_chunk *chunk);
/* Back to the picture of one camera; nothing where it is that. */
WHIT_CHECK whit_result views_leave(struct renderer *renderer);
void views_finish(struct views *views);

/* readback.c: a picture of one band and one pass stays on the device until it is asked for. */
bool readback_is_late(const struct renderer *renderer);
/* Row `y` of an aov, where the picture is read late. `row`: room for all of them. */
WHIT_CHECK whit_result readback_aov_row(const struct renderer *renderer, uint32_t index, uint32_t y,
                                        float *row, float *to);
/* What the device holds of `rows` finished rows from `band_y` on, into the picture and the
   statistics. Ids are those of the first pass. */
WHIT_CHECK whit_result readback_band(struct renderer *renderer, const struct progress *progress,
                                     uint32_t band_y, uint32_t rows);
/* How many pixels of the band are not finite as yet, and in the picture the first of them. */
WHIT_CHECK whit_result readback_non_finite(const struct target *target, uint32_t *x, uint32_t *y,
                                           uint32_t *count);

/* stats.c: forgets the last picture, and keeps what was measured before it. */
void stats_clear(struct target *target);

/* adaptive_samples.c: everything around the passes of an adaptive picture, which tiles.c makes. */
/* Gives every pixel of `color` that differs from one of its 8 neighbours by more than `contrast`,
   in some channel as displayed (linear, 0..1), the level `level`. The number of such pixels. */
uint64_t adaptive_mark(const struct image *color, double contrast, uint8_t level, uint8_t *levels);
/* Lists the pixels of the chunk that the pass draws: their number is chunk->listed. */
WHIT_CHECK whit_result adaptive_list(struct target *target, const struct progress *progress,
                                     struct gpu_chunk *chunk);
/* Whether pixel `index` of the picture is drawn by the pass. */
bool adaptive_draws(const struct progress *progress, size_t index);

/* steps.c: all pixels of the rows that are drawn. */
struct lattice lattice_whole(const struct renderer *renderer);
/* gpu_chunk.lattice */
uint32_t lattice_word(const struct lattice *lattice);
bool steps_are_wanted(const struct renderer *renderer);
/* Shows what is drawn of the picture, every `spacing`-th pixel of rows and columns. */
WHIT_CHECK whit_result steps_give(const struct renderer *renderer, uint32_t spacing);
/* The picture in steps, with params.step after each but the last. */
WHIT_CHECK whit_result steps_render(struct renderer *renderer, struct progress *progress);

/* reuse.c: whether the colours that are kept are those of the picture that is asked for. */
bool reuse_is_possible(const struct renderer *renderer);
/* The picture, where reuse_is_possible: calls post() for each pixel once more, and the functions
   beside the colour where these are others. Statistics stay. */
WHIT_CHECK whit_result reuse_render(struct renderer *renderer);
/* After a picture was drawn: notes of which view, samples and sliders its colours are. */
void reuse_note(struct renderer *renderer);
/* Whether the picture that is kept stays what it is also where the next one is cancelled. */
bool reuse_outlives(const struct renderer *renderer);

/* retarget.c: buffers of pixels for the picture as it is now, in place of those that there are. */
WHIT_CHECK whit_result retarget_pixels(struct renderer *renderer);

/* tiles.c: `samples` of all pixels of progress->lattice, or of those of them that progress->levels
   gives so many. */
WHIT_CHECK whit_result render_pass(struct renderer *renderer, uint32_t samples,
                                   struct progress *progress);
/* Sample `index` of the `samples` of a pass, into a chunk whose blocks are set. */
void render_take_sample(const struct target *target, uint32_t index, uint32_t samples,
                        struct gpu_chunk *chunk);

/* params.c: without trees, whose price is known, WHIT_ERROR_USAGE where the rays that an invocation
   traces take more iterations of loops together than the driver grants it; else WHIT_OK. */
WHIT_CHECK whit_result params_check_loops(const struct renderer *renderer);

/* tiles.c: of a pass over all pixels that begins now. */
struct progress render_progress(const struct renderer *renderer);
/* The picture, of one camera or of many. */
WHIT_CHECK whit_result render_all(struct renderer *renderer);

/* tiles.c: what submissions are made of. */
WHIT_CHECK whit_result render_stop_asked(const struct renderer *renderer,
                                         const struct progress *progress);
/* Empties a list of deferred rays, if there is one. Barriers are the caller's. */
void render_clear_deferred(struct renderer *renderer, struct buffer *deferred);
/* Goes on, behind a barrier, with what the dispatch before has left on the list. `push`: for it,
   with `waiting` set. */
void render_take_deferred(struct target *target, const struct pass *pass, struct buffer *deferred,
                          const void *push, uint32_t push_bytes);
/* Workgroups of the camera rays of a chunk. */
uint32_t render_groups(const struct gpu_chunk *chunk);
/* Pixel `i` of block `block`, as slot_pixel() of the kernel. False when outside of the picture. */
bool render_slot_pixel(const struct renderer *renderer, uint32_t block, uint32_t i, uint32_t *x,
                       uint32_t *y);
WHIT_CHECK whit_result render_finish_submission(struct target *target);

/* tiles.c: what kernels have listed as waiting since `deferred_clear`. */
WHIT_CHECK whit_result deferred_clear(struct target *target);
WHIT_CHECK whit_result deferred_read(const struct target *target, uint32_t *count);

/* tiles.c: logs what the bits say. WHIT_OK when there are none. */
WHIT_CHECK whit_result status_check(struct target *target);

#endif
