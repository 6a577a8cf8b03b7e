/* Specialization constants: one list, read by both compilers. The host always passes all of them. A
   constant that is 0 takes its code out of the pipeline. */
#ifndef ABI_SPEC_H
#define ABI_SPEC_H

#include "base.h"

/* The buffers through which kernels read trees and textures: storage buffers, or uniform texel
   buffers over the same memory (twice as fast on lavapipe). */
#define LOAD_STORAGE 0u
#define LOAD_TEXEL   1u

/* Kinds of cameras. */
#define CAMERA_PERSPECTIVE  0u
#define CAMERA_ORTHOGRAPHIC 1u
#define CAMERA_LENS         2u /* perspective with a thin lens */
#define CAMERA_PANORAMA     3u /* equirectangular, all around */
#define CAMERA_EACH         4u /* SPEC_VIEWS: each view has a kind of its own */

#define FRESNEL_NONE    0u
#define FRESNEL_EXACT   1u
#define FRESNEL_SCHLICK 2u /* Schlick's approximation */

/* Whether media are tracked, and whether their surfaces may touch. */
#define MEDIA_NONE  0u
#define MEDIA_ALONE 1u /* surfaces of two media touch nowhere */
#define MEDIA_TOUCH 2u /* surfaces of several media may touch */

/* Whether triangle records of the meshes hold spheres. */
#define SPHERES_NONE 0u
#define SPHERES_SOME 1u
#define SPHERES_ONLY 2u /* no triangle at all */

/* The properties that have textures: bits 1 << SCENE_SLOT_*. Opacity may come from the alpha of a
   diffuse texture. */
#define TEXTURES_DIFFUSE        1u
#define TEXTURES_SPECULAR       2u
#define TEXTURES_EMISSION       4u
#define TEXTURES_METAL_ROUGH    32u
#define TEXTURES_OPACITY        64u
#define TEXTURES_TRANSMISSION   128u
#define TEXTURES_SPECULAR_LEVEL 256u
#define TEXTURES_ALL            511u

/* The ways in which textures are sampled: SCENE_SAMPLING_*. What no texture needs is left out. */
#define SAMPLING_FILTERED 1u
#define SAMPLING_REPEAT   2u
#define SAMPLING_CLAMP    4u
#define SAMPLING_MIRROR   8u
#define SAMPLING_SRGB     16u

/* Classes of materials. */
#define CLASS_PLAIN 0u
#define CLASS_GLASS 1u /* light passes through it */

/* Optional parts of the record of a lit hit (struct Lit). */
#define LIT_HAS_NG         1u /* a geometric normal apart from the shading normal */
#define LIT_HAS_HIGHLIGHT  2u
#define LIT_HAS_ABSORPTION 4u /* of the media around the point */

/* The largest SPEC_PACKET_STACK. */
#define PACKET_STACK_MAX 32u

/* The point that all rays of a packet share. */
#define BEAM_NONE   0u
#define BEAM_STARTS 1u /* the point where they start */
#define BEAM_ENDS   2u /* the light that they end at, or pass by within rounding */

/* Inputs of the optical depth of shadow filters, besides the record. */
#define FILTERS_PLAIN     0u
#define FILTERS_ABSORB    1u
#define FILTERS_PATTERNED 2u /* textures or vertex colours, too */

/* Functions of a user's file that replace whit's, in kernels that have room for them. */
#define HOOK_CAMERA  1u
#define HOOK_SURFACE 2u
#define HOOK_SHADE   4u
#define HOOK_SCATTER 8u
#define HOOK_MISS    16u
#define HOOK_POST    32u
#define HOOK_AOV     64u
#define HOOK_INTERSECT 128u

/* Parts of the work of kernel/hit.comp, the kernel of a user's surface() and shade(). */
#define HIT_PART_ALL   0u
#define HIT_PART_FETCH 1u /* stores what shade() gets of a hit in rows; only whit's code */
#define HIT_PART_CALL  2u /* calls shade() with these rows; small, so that it compiles fast */

/* The arithmetic that decides hits, see docs/numerics.md. */
#define NUMERICS_WATERTIGHT 0u
#define NUMERICS_FAST       1u /* Moeller and Trumbore, plain slabs: leaks */
#define NUMERICS_EXACT      2u /* as exact arithmetic would */

/*    id  name                 default  meaning */
#define GPU_SPEC_LIST(X)                                                                           \
    X(0, SPEC_GROUP_SIZE, 64)         /* invocations in a workgroup */                             \
    X(1, SPEC_LOAD_PATH, 0)           /* LOAD_* */                                                 \
    X(2, SPEC_STACK_SIZE, 64)         /* node stack entries, from the depth of the built trees */  \
    X(3, SPEC_INSTANCED, 1)           /* 0: one mesh, not moved: no instance tree, no transform */ \
    X(4, SPEC_ANY_HIT, 0)             /* any hit, not the closest: ray batches, shapes */       \
    X(5, SPEC_INTERLEAVE, 0)          /* workgroups interleaved: lavapipe halves their ids */      \
    X(6, SPEC_SECONDARY, 1)           /* rays call for further rays */                             \
    X(7, SPEC_SHADOWS, 1)                                                                          \
    X(8, SPEC_REFLECTION, 1)                                                                       \
    X(9, SPEC_REFRACTION, 1)                                                                       \
    X(10, SPEC_ABSORPTION, 1)                                                                      \
    X(11, SPEC_CUTOUTS, 1)            /* opacity decides hits, or lets light pass straight */      \
    X(12, SPEC_TEXTURES, 511)         /* TEXTURES_*; normal and bump maps are SPEC_NORMAL_MAPS */  \
    X(13, SPEC_NORMAL_MAPS, 1)                                                                     \
    X(14, SPEC_ENVIRONMENT_MAP, 1)                                                                 \
    X(15, SPEC_SMOOTH_NORMALS, 1)                                                                  \
    X(16, SPEC_VERTEX_COLORS, 1)                                                                   \
    X(17, SPEC_METAL_ROUGH, 1)                                                                     \
    X(18, SPEC_HIGHLIGHTS, 1)                                                                      \
    X(19, SPEC_LIGHTS, 255)           /* bit k: lights of kind k, LIGHT_* */                       \
    X(20, SPEC_CAMERA, 0)             /* CAMERA_* */                                               \
    X(21, SPEC_FILTERS, 1)            /* shadow rays pass through glass, tinted */                 \
    X(22, SPEC_SHORT_STACK, 0)        /* top of the node stack in registers: for lavapipe */       \
    X(23, SPEC_ORDER, 0)              /* ORDER_* */                                                \
    X(24, SPEC_COUNT, 0)              /* counters of traversal */                                  \
    X(25, SPEC_CLIPPED, 0)            /* leaves hold clipped triangles: boxes need a margin */     \
    X(26, SPEC_FLAT, 0)               /* one tree over all instances, in world space */            \
    X(27, SPEC_MEDIA, 2)              /* MEDIA_*: rays carry a stack of their media */             \
    X(28, SPEC_SPHERES, 1)            /* SPHERES_* */                                              \
    X(29, SPEC_FRESNEL, 1)            /* FRESNEL_* */                                              \
    X(30, SPEC_FILTER_DETAIL, 2)      /* FILTERS_* */                                              \
    X(31, SPEC_CULLING, 1)            /* one-sided triangles are not hit from behind */            \
    X(32, SPEC_CATCHERS, 1)           /* surfaces that show nothing but shadows */                 \
    X(33, SPEC_TERMINATOR, 1)         /* shadow rays start on the smooth surface */                \
    X(34, SPEC_EMISSION, 1)                                                                        \
    X(35, SPEC_LISTED, 1)             /* camera rays may be limited to listed pixels */            \
    X(36, SPEC_NUMERICS, 0)           /* NUMERICS_* */                                             \
    X(37, SPEC_PROBE, 0)              /* draws only the probed pixel, and records its rays */      \
    X(38, SPEC_SETTLES, 1)              /* NUMERICS_EXACT; 0: defers undecided rays */               \
    X(39, SPEC_PACKETS, 0)            /* rays of a subgroup of 8 lanes form a packet */            \
    X(40, SPEC_EIGHT_LANES, 0)        /* subgroups have 8 lanes and slow subgroup sums */          \
    X(41, SPEC_PACKET_RAYS, 1)        /* rays per lane */                                          \
    X(42, SPEC_PACKET_STACK, 16)      /* stack entries of a packet */                              \
    X(43, SPEC_BEAM, 0)               /* BEAM_*: what point the rays of packets share */           \
    X(44, SPEC_LIT_RAYS, 1)           /* SPEC_PACKET_RAYS of shadow rays of camera hits */         \
    X(45, SPEC_GENERATIONS, 3)        /* bit 0: camera rays; bit 1: later generations */           \
    X(46, SPEC_CLASSES, 1)            /* number of material classes: 1 or 2 */                     \
    X(47, SPEC_CROSSINGS, 1)          /* surfaces of the class bound media */                      \
    X(48, SPEC_LIT_PARTS, 7)          /* LIT_HAS_* */                                              \
    X(49, SPEC_SEGMENTS, 1)           /* segments of lists: 1 or 2 */                              \
    X(50, SPEC_SAMPLING, 31)          /* SAMPLING_* */                                             \
    X(51, SPEC_WIDE_ROWS, 0)          /* writes rows as 64-bit words: for lavapipe */                \
    X(52, SPEC_PRIORITIES, 1)         /* media have priorities where they overlap */               \
    X(53, SPEC_MINIFICATION, 1)       /* textures have mipmap levels */                            \
    X(54, SPEC_HOOKS, 0)              /* HOOK_*: which functions are a user's */                   \
    X(55, SPEC_FUEL, 0)               /* loop iterations granted to a call of these */             \
    X(56, SPEC_CHECK_WORDS, 1)        /* words with a bit for each check of a test */            \
    X(57, SPEC_AOVS, 0)               /* number of a user's aov functions */                      \
    X(58, SPEC_VIEWS, 0)              /* views of many cameras, one below the other */             \
    X(59, SPEC_HIT_PART, 0)           /* HIT_PART_* */                                            \
    X(60, SPEC_PIXEL_DATA, 1)         /* pixels get ids and weights of cut rays, too */            \
    X(61, SPEC_LIST_GROUP, 64)        /* SPEC_GROUP_SIZE of kernels that take items of lists */    \
    X(62, SPEC_DEFERRED_GROUP, 64)    /* SPEC_GROUP_SIZE of kernels for deferred items */          \
    X(63, SPEC_LIGHTS_EACH, 1)        /* most lights of a dispatch, where one list serves all */       \
    X(64, SPEC_DIRECT, 0)             /* STAGE_SHADE_DIRECT; of sums: the set has that stage */      \
    X(65, SPEC_QUANTIZED, 0)               /* traverse() reads struct gpu_quantized_node */

#ifdef __STDC_VERSION__
#define GPU_SPEC_FIELD(id, name, value) uint32_t name;
/* One word for each constant, in the order of their ids. */
struct gpu_spec {
    GPU_SPEC_LIST(GPU_SPEC_FIELD)
};
#undef GPU_SPEC_FIELD
#define GPU_SPEC_VALUE(id, name, value) .name = value,
#define GPU_SPEC_DEFAULTS               {GPU_SPEC_LIST(GPU_SPEC_VALUE)}
#define GPU_SPEC_COUNT                  ((uint32_t)(sizeof(struct gpu_spec) / sizeof(uint32_t)))
#else
#define GPU_SPEC_CONSTANT(id, name, value) layout(constant_id = id) const uint name = value;
GPU_SPEC_LIST(GPU_SPEC_CONSTANT)
#endif

#endif
