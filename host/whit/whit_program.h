/* What whit's own programs use of libwhit beside whit.h: files that appear whole or not at all,
   clocks, pictures in strips, kernels as drivers make them, parts of scenes for `whit check`, what
   is kept from one run to the next. It is not installed, the shared library does not
   have it, and it may change with every commit. */
#ifndef WHIT_PROGRAM_H
#define WHIT_PROGRAM_H

#include "whit_device.h"
#include "whit_image.h"
#include "whit_renderer.h"

/* ---- Files and clocks ---- */

/* A file under construction, hidden beside `path`: commit renames it over `path`, abandon removes
   it. Exactly one of the two ends it. */
typedef struct whit_file whit_file;
/* WHIT_ERROR_OUTPUT where the file cannot be written. */
WHIT_CHECK whit_result whit_file_begin(const char *path, const whit_log *log, whit_file **out);
WHIT_CHECK whit_result whit_file_append(whit_file *file, const void *data, size_t size_bytes);
WHIT_CHECK whit_result whit_file_commit(whit_file *file);
void whit_file_abandon(whit_file *file);

/* Writes a whole file beside `path` and renames it. WHIT_ERROR_OUTPUT where it cannot be written.
 */
WHIT_CHECK whit_result whit_file_write(const char *path, const void *data, size_t size_bytes,
                                       const whit_log *log);
/* Removes unfinished output; safe in a signal handler. */
void whit_file_abandon_all(void);
uint64_t whit_peak_memory_bytes(void);
/* What this process has run out of at this moment, by a limit of its own (`ulimit -v`, `ulimit -n`)
   or the system's, for behind `: `: `room_bytes` of memory, or some descriptors; NULL: neither.
   What drivers and libraries then fail with has other names, or they crash. Safe in signal
   handlers. */
const char *whit_shortage(uint64_t room_bytes);
double whit_clock_ms(void);
double whit_clock_cpu_ms(void); /* used by all threads of this process */

/* ---- Pictures in strips ---- */

/* A picture that is written in strips of rows, from the top down, so that no more than one of them
   is in memory: each but the last has a multiple of WHIT_STRIP_ROWS rows. The file appears at
   commit, with the bytes that whit_image_save of the whole picture gives it. */
#define WHIT_STRIP_ROWS 16
typedef struct whit_image_strips whit_image_strips;
/* `like`: a strip, for all but the height. `texts` are borrowed until the end. WHIT_ERROR_OUTPUT
   also for pipes. */
WHIT_CHECK whit_result whit_image_strips_begin(const char *path, const whit_image *like,
                                               uint32_t height, const whit_text *texts,
                                               uint32_t text_count, const whit_log *log,
                                               whit_image_strips **out);
WHIT_CHECK whit_result whit_image_strips_add(whit_image_strips *strips, const whit_image *strip);
/* One of the two ends it; abandon takes NULL too. WHIT_ERROR_OUTPUT: the file could not be
   written, and there is none. */
WHIT_CHECK whit_result whit_image_strips_commit(whit_image_strips *strips);
void whit_image_strips_abandon(whit_image_strips *strips);
/* Makes an image of integers, as hit identities are: it copies width * height * channels of them
   from `words`. WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result whit_image_create_words(uint32_t width, uint32_t height, uint32_t channels,
                                               const uint32_t *words, whit_image **out);
/* The floats of a picture, to be changed; NULL where it has integers. */
float *whit_image_edit(whit_image *image);

/* ---- Renderers ---- */

typedef struct whit_overlay {
    bool grid; /* on the ground, behind what stands before it */
    bool edges_of_instances, edges_of_primitives;
    const uint32_t *ids; /* hit identities that edges are of, two a pixel, borrowed; NULL: those of
                            the picture that the renderer has just drawn */
} whit_overlay;
/* Draws over `color`, a picture of the renderer's view. WHIT_ERROR_USAGE where nothing
   was rendered, WHIT_ERROR_DEVICE, WHIT_ERROR_MEMORY, WHIT_ERROR_CANCELLED. */
WHIT_CHECK whit_result whit_renderer_draw_over(whit_renderer *renderer, const whit_overlay *overlay,
                                               whit_image *color);

/* Gives the choice that WHIT_CLASSES_AUTO makes for a renderer with these params: _ONE or _MANY,
   and _MANY too where the params are refused. */
whit_classes whit_classes_of(const whit_renderer_params *params);

/* What camera rays of the picture that was set last cost, without counting in its kernel: the twin
   traces those of at most `pixels` pixels, all or a smaller picture of the view, up to what they
   meet first. On the calling thread, some microseconds a ray. WHIT_ERROR_USAGE without a device,
   WHIT_ERROR_STATUS and WHIT_ERROR_CANCELLED as whit_trace. */
WHIT_CHECK whit_result whit_renderer_sample_costs(whit_renderer *renderer, uint32_t pixels,
                                                  whit_cost *cost);

/* ---- A device, opened beside other work ---- */

/* What whit_device_create does, in a thread of its own, while the caller does something else, such
   as loading a scene. `params` is read, and its selector borrowed, until the end; what there is to
   say is logged at the end, by the thread that asks for it. NULL when memory or threads run out:
   then whit_device_create is left. */
typedef struct whit_device_opening whit_device_opening;
WHIT_CHECK whit_device_opening *whit_device_open_begin(const whit_device_params *params,
                                                       const whit_log *log);
/* Waits; gives what whit_device_create would have given, and frees `opening`. */
WHIT_CHECK whit_result whit_device_open_end(whit_device_opening *opening, whit_device **out);
/* Instead: nothing is logged, and a device is destroyed again. NULL is fine. */
void whit_device_open_abandon(whit_device_opening *opening);
/* For programs that draw many small pictures: from here on kernels stay with the device, and who
   makes a renderer that needs the same ones has them at once. Before any renderer. */
void whit_device_keep_kernels(whit_device *device);
/* Kernels that the driver has been asked for so far: nothing was compiled between two equal counts.
 */
uint64_t whit_device_kernels_made(const whit_device *device);
/* Whether a program that opens the same device again gets further by drawing with both at once: a
   CPU, unless validation layers check or a test counts calls. */
bool whit_device_takes_peers(const whit_device *device);

/* ---- Kernels, looked at ---- */

/* A number that a driver tells of a kernel that it made, under a name of the driver's. */
typedef struct whit_statistic {
    char name[64];
    double value;
} whit_statistic;
enum { WHIT_STATISTICS_MAX = 48, WHIT_KERNELS_MAX = 30 };
/* A kernel of a picture as the device's driver makes it. */
typedef struct whit_kernel {
    const char *name;      /* of its stage: "camera", "shade glass" */
    bool deferred;         /* for the rays that the one before leaves open, at exact numerics */
    uint32_t instructions; /* SPIR-V, of its functions */
    double create_ms;      /* by the clock; lavapipe goes on at the first dispatch */
    whit_statistic statistics[WHIT_STATISTICS_MAX];
    uint32_t statistic_count; /* 0: the driver tells nothing */
} whit_kernel;

/* What is left of the kernel for this renderer, and of the same with every effect. */
typedef struct whit_kernel_info {
    uint32_t instructions, general_instructions; /* SPIR-V, in functions of all kernels */
    uint32_t largest_instructions;               /* of the largest of the scene's own kernels */
    uint32_t bindings, general_bindings;         /* descriptors */
} whit_kernel_info;
/* Takes some 50 ms. WHIT_ERROR_USAGE without a device, WHIT_ERROR_DEVICE when the kernel cannot be
   specialized. */
WHIT_CHECK whit_result whit_renderer_get_kernel(const whit_renderer *renderer,
                                                whit_kernel_info *info);

/* Makes the kernels of a picture with these params one after the other, and no picture: takes no
   memory of the device. `kernels`: room for WHIT_KERNELS_MAX; `params` may be NULL.
   WHIT_ERROR_USAGE for params that a renderer refuses too, WHIT_ERROR_DEVICE or _MEMORY where a
   kernel cannot be made. */
WHIT_CHECK whit_result whit_kernels_list(whit_device *device, whit_accel *accel,
                                         const whit_renderer_params *params, whit_kernel *kernels,
                                         uint32_t *count);
/* The same, but counts their instructions and makes none: other figures are 0. It
   gives what whit_kernels_list gives. */
WHIT_CHECK whit_result whit_kernels_count(whit_device *device, whit_accel *accel,
                                          const whit_renderer_params *params, whit_kernel *kernels,
                                          uint32_t *count);

/* The kernels that the shader has part in, by index; NULL past the last. `words`: SPIR-V. */
const char *whit_shader_kernel(const whit_shader *shader, uint32_t index, const uint32_t **words,
                               size_t *bytes);

/* The GLSL of such a kernel with all that it includes, and what stands in `words` of it in the form
   of spirv-dis. To be released by whit_memory_destroy; NULL: there is no such kernel, no memory, or
   damaged words. */
char *whit_shader_kernel_text(const whit_shader *shader, uint32_t index);
char *whit_spirv_text(const uint32_t *words, size_t bytes);

/* The file that `whit shader new` writes: whit's own function, with what it may use in comments.
   NULL: there is no such hook, or no memory. To be released by whit_memory_destroy. */
char *whit_shader_template(whit_hook hook);

/* ---- Parts of scenes, and faults in them ---- */

/* What a picture depends on, piece by piece. */
typedef enum whit_part_kind {
    WHIT_PART_MESH = 0,
    WHIT_PART_MATERIAL,
    WHIT_PART_TEXTURE, /* its decoded texels */
    WHIT_PART_LIGHT,
    WHIT_PART_CAMERA,
    WHIT_PART_ANIMATION,   /* keys of one property of one node */
    WHIT_PART_ENVIRONMENT, /* with ambient light, and what a scene file says of contact */
    WHIT_PART_OBJECTS,     /* nodes and instances: where meshes are; and which parts there are, but
                              for materials and textures, which come with those that name them */
    WHIT_PART_KINDS,
} whit_part_kind;
/* "mesh", "material", ... */
const char *whit_part_kind_name(whit_part_kind kind);
typedef struct whit_part {
    whit_part_kind kind;
    const char *name; /* as the file has it, made unique among its kind by `#2`, `#3`, ..., or its
                         number where it has none; show it by whit_text_show. Meshes are called
                         after the first object that has them, textures after their file without
                         folders; "" of environment and objects, of which there is one */
    uint64_t hash;    /* of what is loaded: of decoded texels and imported meshes, not of files */
} whit_part;
/* The parts of a scene, sorted as the scene has them within each kind. What whit adds to a scene is
   none, since it follows from the others. *parts with its names is one block, for
   whit_memory_destroy. WHIT_ERROR_MEMORY; WHIT_ERROR_USAGE for a scene whose pictures were
   dropped. */
WHIT_CHECK whit_result whit_scene_parts(const whit_scene *scene, whit_part **parts,
                                        uint32_t *count);

/* How the part of `after` differs from the one of that kind and name of `before`: "vertices 2716
   and 2717 moved by up to 0.0013"; "" where it does not, or where one of the two is not there. At
   most `bytes`, which end with a 0. Names in it are as the files have them. WHIT_ERROR_MEMORY,
   WHIT_ERROR_USAGE as of whit_scene_parts. */
WHIT_CHECK whit_result whit_scene_part_change(const whit_scene *before, const whit_scene *after,
                                              whit_part_kind kind, const char *name, char *text,
                                              size_t bytes);
/* A scene of its own that has some parts of `before` and the rest of `after`: `back` says of which
   parts, in the order of whit_scene_parts of `before`, it has those of `before`. Objects bring the
   lists of parts with them: a part that one scene alone has comes and goes with these. What whit
   adds to a scene is made anew. With all or none of `back` it has the hash of `before` or `after`.
   WHIT_ERROR_MEMORY; WHIT_ERROR_INPUT for what does not go together; WHIT_ERROR_USAGE as above. */
WHIT_CHECK whit_result whit_scene_mix(const whit_scene *before, const whit_scene *after,
                                      const bool *back, whit_scene **out);

/* Faults that are put into a scene on purpose, to see whether they are noticed. */
typedef enum whit_fault_kind {
    WHIT_FAULT_VERTEX = 0, /* a vertex, or a sphere, moves by `amount` of its mesh's longest side */
    WHIT_FAULT_IOR,        /* a refractive index grows by `amount` */
    WHIT_FAULT_LIGHT,      /* a light, or what glows where there is none, is brighter by `amount`
                              of what it was */
    WHIT_FAULT_TEXELS,     /* a row of texels goes by `amount` of its range */
    WHIT_FAULT_MATERIALS,  /* two materials have each other's values, and glow by `amount` */
    WHIT_FAULT_ORDER,      /* two objects have each other's place in the file */
    WHIT_FAULT_KINDS,
} whit_fault_kind;
/* "vertex", "ior", ... */
const char *whit_fault_kind_name(whit_fault_kind kind);
typedef struct whit_fault {
    whit_fault_kind kind;
    uint64_t seed; /* draws what is changed; not how much */
    double amount; /* of VERTEX below 0 the other way; of MATERIALS 0 too; of ORDER not read */
} whit_fault;
/* A copy of a scene with faults in it. WHIT_ERROR_USAGE, not logged, where it has nothing that one
   of them could change; else as whit_scene_mix. */
WHIT_CHECK whit_result whit_scene_fault(const whit_scene *scene, const whit_fault *faults,
                                        uint32_t count, whit_scene **out);

/* ---- What can be made again, kept from one run to the next ---- */

/* In $XDG_CACHE_HOME/whit or ~/.cache/whit, which is closed to others; nothing where that folder
   cannot be had, belongs to somebody else or may be written by others (a warning, once), and where
   WHIT_NO_CACHE is set. What is kept has a checksum; files used longest ago are removed beyond
   512 MiB, or $WHIT_CACHE_LIMIT MiB. libwhit keeps pipelines there. */

/* Reads what was kept under `name`. The caller releases *data, which has one zero byte behind its
   size, by whit_memory_destroy. False: nothing was kept, or it was damaged and is thrown away. */
bool whit_cache_read(const char *name, const whit_log *log, uint8_t **data, size_t *size_bytes);
/* `name`: of what and in which version it is; no slash, at most 200 bytes. What cannot be kept is
   not. */
void whit_cache_write(const char *name, const void *data, size_t size_bytes, const whit_log *log);
/* The folder, made when it is not there, for whit_memory_destroy. NULL: nothing is kept. */
char *whit_cache_folder(void);
typedef struct whit_cache_info {
    char folder[4096]; /* "": there is no such place */
    char why_not[128]; /* nothing is kept; "" when it is */
    uint64_t used_bytes, limit_bytes;
} whit_cache_info;
void whit_cache_get_info(whit_cache_info *info);

#endif
