/* Functions of libwhit for whit's own programs, beside whit.h: clocks, pictures in strips, kernels
   as drivers make them, parts of scenes for `whit check`. This header is not installed, the shared
   library does not export these functions, and they may change with every commit. */
#ifndef WHIT_PROGRAM_H
#define WHIT_PROGRAM_H

#include "whit_device.h"
#include "whit_image.h"
#include "whit_renderer.h"

/* ---- Shortage and clocks ---- */

/* Tells whether this process has run out of something at this moment, by its own limit (`ulimit
   -v`, `ulimit -n`) or the system's: "out of memory" where `room_bytes` cannot be had, "too many
   open files" where a few more descriptors cannot; NULL: neither. It names the cause where drivers
   and libraries crash or fail with other errors. Safe in signal handlers. */
const char *whit_shortage(uint64_t room_bytes);
/* The limit on memory by `params`, in bytes: theirs, or half of this machine's, as for scenes. */
uint64_t whit_memory_limit(const whit_load_params *params);
double whit_clock_ms(void);
double whit_clock_cpu_ms(void); /* processor time of all threads of this process */

/* ---- Pictures in strips ---- */

/* A picture that is written in strips of rows, from the top down, so that only one strip is in
   memory at a time. Each strip but the last has a multiple of WHIT_STRIP_ROWS rows. The file
   appears at commit, with the bytes that whit_image_save of the whole picture gives it. */
#define WHIT_STRIP_ROWS 16
typedef struct image_rows whit_image_strips;
/* `like`: a strip, which sets all properties of the picture but its height. `path`, `texts` and
   `log` are borrowed until commit or abandon. WHIT_ERROR_OUTPUT also for pipes. */
WHIT_CHECK whit_result whit_image_strips_begin(const char *path, const whit_image *like,
                                               uint32_t height, const whit_text *texts,
                                               uint32_t text_count, const whit_log *log,
                                               whit_image_strips **out);
WHIT_CHECK whit_result whit_image_strips_add(whit_image_strips *strips, const whit_image *strip);
/* Exactly one of the two ends the strips; abandon takes NULL too. WHIT_ERROR_OUTPUT: the file could
   not be written, and none is left. */
WHIT_CHECK whit_result whit_image_strips_commit(whit_image_strips *strips);
void whit_image_strips_abandon(whit_image_strips *strips);
/* As whit_renderer_image of WHIT_AOV_COLOR, but the image may have its pixels in common with the
   renderer: destroy it before the renderer draws again. WHIT_ERROR_USAGE and others as of
   whit_renderer_image. */
WHIT_CHECK whit_result whit_renderer_borrow_color(whit_renderer *renderer, whit_image **out);
/* The floats of a picture, to be changed; NULL where it has integers. */
float *whit_image_edit(whit_image *image);
/* Adds an owner to an image that nobody changes any more, and gives `image`, NULL for NULL. Each
   owner calls whit_image_destroy, from any thread; the last call frees the image. */
whit_image *whit_image_share(whit_image *image);

/* ---- Renderers ---- */

typedef struct whit_overlay {
    bool grid; /* a grid on the ground, hidden where objects stand before it */
    bool edges_of_instances, edges_of_primitives;
    const uint32_t *ids; /* hit identities between which edges are drawn, two words a pixel,
                            borrowed; NULL: those of the picture that the renderer has just drawn */
} whit_overlay;
/* Draws over `color`, a picture of the renderer's view. WHIT_ERROR_USAGE without a device and where
   nothing was rendered, WHIT_ERROR_DEVICE, WHIT_ERROR_MEMORY, WHIT_ERROR_CANCELLED. */
WHIT_CHECK whit_result whit_renderer_draw_over(whit_renderer *renderer, const whit_overlay *overlay,
                                               whit_image *color);

/* Estimates the traversal cost of the camera rays of the picture that was set last, without
   counting in its kernel: the twin traces to their first hit the rays of all pixels, or of a
   smaller picture of the same view with at most `pixels` pixels. It runs on the calling thread and
   takes some microseconds a ray. WHIT_ERROR_USAGE without a device, WHIT_ERROR_STATUS and
   WHIT_ERROR_CANCELLED as whit_trace. */
WHIT_CHECK whit_result whit_renderer_sample_costs(whit_renderer *renderer, uint32_t pixels,
                                                  whit_cost *cost);

/* whit_scene_get_camera at a finite time of the animation. WHIT_ERROR_MEMORY: it is that at
   time 0. */
WHIT_CHECK whit_result whit_scene_pose_camera(const whit_scene *scene, uint32_t index,
                                              double time_s, whit_camera_info *info);

/* Makes the camera ray through the middle of each pixel, row by row, at time 0, with the bits of
   those of kernels. WHIT_ERROR_USAGE where there is no such camera, or it is degenerate. */
WHIT_CHECK whit_result whit_camera_rays(const whit_scene *scene, const whit_camera *camera,
                                        uint32_t width, uint32_t height, const whit_log *log,
                                        whit_ray *rays);

/* ---- A device, opened beside other work ---- */

/* Runs whit_device_create in a thread of its own while the caller does something else, such as
   loading a scene. `params` is read, and its selector borrowed, until whit_device_open_end or
   _abandon; messages are logged by whit_device_open_end, in the thread that calls it. NULL when
   memory or threads run out: call whit_device_create instead. */
typedef struct whit_device_opening whit_device_opening;
WHIT_CHECK whit_device_opening *whit_device_open_begin(const whit_device_params *params,
                                                       const whit_log *log);
/* Waits for the thread, frees `opening` and gives what whit_device_create gave in the thread. */
WHIT_CHECK whit_result whit_device_open_end(whit_device_opening *opening, whit_device **out);
/* Call this in place of whit_device_open_end to drop the device: nothing is logged. Takes NULL. */
void whit_device_open_abandon(whit_device_opening *opening);
/* For programs that draw many small pictures: from this call on the device keeps its kernels, so
   that a later renderer that needs the same ones gets them at once. Call it before any renderer is
   made. */
void whit_device_keep_kernels(whit_device *device);
/* Number of kernels that the driver was asked to make so far. Two equal counts mean that nothing
   was compiled between them. */
uint64_t whit_device_kernels_made(const whit_device *device);
/* Whether a program draws faster when it opens the same device a second time and draws with both at
   once. True for a CPU device, unless kernels are compiled by one thread only, as under validation
   layers or in tests that count calls. */
bool whit_device_takes_peers(const whit_device *device);

/* ---- Kernels, looked at ---- */

/* A statistic that the driver gives for a kernel, under the driver's name for it
   (VK_KHR_pipeline_executable_properties). */
typedef struct whit_statistic {
    char name[64];
    double value;
} whit_statistic;
enum { WHIT_STATISTICS_MAX = 48, WHIT_KERNELS_MAX = 34 };
/* A kernel of a picture as the device's driver makes it. */
typedef struct whit_kernel {
    const char *name;      /* of its stage: "camera", "shade glass" */
    bool deferred;         /* at exact numerics: finishes the rays that the kernel before it in the
                              list deferred */
    uint32_t instructions; /* SPIR-V, of its functions */
    double create_ms;      /* wall clock; lavapipe compiles more at the first dispatch */
    whit_statistic statistics[WHIT_STATISTICS_MAX];
    uint32_t statistic_count; /* 0: the driver gives none */
} whit_kernel;

/* Sizes of the kernels as specialized for this renderer, and (general) with every effect compiled
   in. */
typedef struct whit_kernel_info {
    uint32_t instructions, general_instructions; /* SPIR-V, in functions of all kernels */
    uint32_t largest_instructions;               /* of the largest of the scene's own kernels */
    uint32_t bindings, general_bindings;         /* descriptors */
} whit_kernel_info;
/* Takes some 50 ms. WHIT_ERROR_USAGE without a device, WHIT_ERROR_DEVICE when the kernel cannot be
   specialized. */
WHIT_CHECK whit_result whit_renderer_get_kernel(const whit_renderer *renderer,
                                                whit_kernel_info *info);

/* Makes the kernels of a picture with these params one after the other, without drawing and without
   allocating memory of the device; without `make` only counts their instructions, and other figures
   are 0. `kernels`: room for WHIT_KERNELS_MAX; `params` may be NULL. WHIT_ERROR_USAGE for params
   that a renderer refuses too, WHIT_ERROR_DEVICE or _MEMORY where a kernel cannot be made. */
WHIT_CHECK whit_result whit_kernels_list(whit_device *device, whit_accel *accel,
                                         const whit_renderer_params *params, bool make,
                                         whit_kernel *kernels, uint32_t *count);

/* Gives the name of a kernel that contains functions of the shader, by index; NULL past the last.
   `words`: its SPIR-V. */
const char *whit_shader_kernel(const whit_shader *shader, uint32_t index, const uint32_t **words,
                               size_t *bytes);

/* The first gives the GLSL of such a kernel with all its includes, the second disassembles its
   `words` in the format of spirv-dis. To be released by whit_memory_destroy; NULL: there is no such
   kernel, no memory, or the words are damaged. */
char *whit_shader_kernel_text(const whit_shader *shader, uint32_t index);
char *whit_spirv_text(const uint32_t *words, size_t bytes);

/* The file that `whit shader new` writes: whit's own function, with comments on what it may use.
   NULL: there is no such hook, or no memory. To be released by whit_memory_destroy. */
char *whit_shader_template(whit_hook hook);
/* Removes from `sliders`, as in whit_renderer_params.sliders, what the shader has no use for. True:
   something was removed. */
bool whit_shader_keep_sliders(const whit_shader *shader, char *sliders);

/* ---- Parts of scenes, and faults in them ---- */

/* The kinds of parts that `whit check` divides a scene into. */
typedef enum whit_part_kind {
    WHIT_PART_MESH = 0,
    WHIT_PART_MATERIAL,
    WHIT_PART_TEXTURE, /* its decoded texels */
    WHIT_PART_LIGHT,
    WHIT_PART_CAMERA,
    WHIT_PART_ANIMATION,   /* keys of one property of one node */
    WHIT_PART_ENVIRONMENT, /* with ambient light, and the contact settings of a scene file */
    WHIT_PART_OBJECTS,     /* nodes and instances, which place meshes, and the list of parts;
                              materials and textures are not in that list, they come with the parts
                              that name them */
    WHIT_PART_KINDS,
} whit_part_kind;
/* "mesh", "material", ... */
const char *whit_part_kind_name(whit_part_kind kind);
typedef struct whit_part {
    whit_part_kind kind;
    const char *name; /* the file's name for it, made unique among its kind by `#2`, `#3`, ..., or
                         its number where the file gives none; show it by whit_text_show. A mesh has
                         the name of the first object that uses it, a texture that of its file
                         without folders. "" for environment and objects, of which there is one
                         each */
    uint64_t hash;    /* of the loaded data (decoded texels, imported meshes), not of the files */
} whit_part;
/* The parts of a scene, by kind, and within a kind in the scene's order. Things that whit itself
   adds to a scene are no parts, since they follow from the others. *parts with its names is one
   block, for whit_memory_destroy. WHIT_ERROR_MEMORY; WHIT_ERROR_USAGE for a scene whose pictures
   were dropped. */
WHIT_CHECK whit_result whit_scene_parts(const whit_scene *scene, whit_part **parts,
                                        uint32_t *count);

/* Describes how the part of this kind and name in `after` differs from that in `before`: "vertices
   2716 and 2717 moved by up to 0.0013"; "" where they are equal, or where one scene lacks the part.
   Writes at most `bytes` to `text`, including the 0 at the end. Names in it are as the files have
   them. WHIT_ERROR_MEMORY, WHIT_ERROR_USAGE as of whit_scene_parts. */
WHIT_CHECK whit_result whit_scene_part_change(const whit_scene *before, const whit_scene *after,
                                              whit_part_kind kind, const char *name, char *text,
                                              size_t bytes);
/* Makes a new scene with some parts of `before` and the rest of `after`. `back[i]`: part i in the
   order of whit_scene_parts of `before` comes from `before`. The objects part carries the list of
   parts: a part that only one of the scenes has comes and goes with it. Things that whit adds to a
   scene are made anew. With all or none of `back` the new scene has the hash of `before` or
   `after`. WHIT_ERROR_MEMORY; WHIT_ERROR_INPUT for parts that do not fit together; WHIT_ERROR_USAGE
   as above. */
WHIT_CHECK whit_result whit_scene_mix(const whit_scene *before, const whit_scene *after,
                                      const bool *back, whit_scene **out);

/* Faults that are put into a scene on purpose, to see whether they are noticed. */
typedef enum whit_fault_kind {
    WHIT_FAULT_VERTEX = 0, /* a vertex, or a sphere, moves by `amount` of its mesh's longest side */
    WHIT_FAULT_IOR,        /* a refractive index grows by `amount` */
    WHIT_FAULT_LIGHT,      /* a light, or an emissive material where there is no light, gets
                              brighter by the share `amount` */
    WHIT_FAULT_TEXELS,     /* the colours of a row of texels change by `amount` of their range */
    WHIT_FAULT_MATERIALS,  /* two materials swap their values, and emit `amount` */
    WHIT_FAULT_ORDER,      /* two objects swap their places in the file */
    WHIT_FAULT_KINDS,
} whit_fault_kind;
/* "vertex", "ior", ... */
const char *whit_fault_kind_name(whit_fault_kind kind);
typedef struct whit_fault {
    whit_fault_kind kind;
    uint64_t seed; /* chooses at random what is changed, but not by how much */
    double amount; /* VERTEX: below 0 moves the other way; MATERIALS: may be 0; ORDER: not read */
} whit_fault;
/* A copy of a scene with faults in it. WHIT_ERROR_USAGE, not logged, where the scene has nothing
   that one of the faults could change; other errors as of whit_scene_mix. */
WHIT_CHECK whit_result whit_scene_fault(const whit_scene *scene, const whit_fault *faults,
                                        uint32_t count, whit_scene **out);

#endif
