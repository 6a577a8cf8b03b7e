/* The rays of a picture between its stages: generations of rays, their hits, and the hits that
   lights may reach.

   A ray has a number (id) within its tile. Camera rays are generation 0, and their ids are the
   slots of their pixels. A ray that is called for by a ray of generation g belongs to generation g
   + 1, whose ids follow those of g. No result depends on which id of its generation a ray gets. */
#ifndef ABI_QUEUES_H
#define ABI_QUEUES_H

#include "base.h"

/* Rows of 16 bytes. */
#define RAY_ROWS 4u /* origin, state; dir, record to skip; weight, instance to skip; media */
#define LIT_ROWS 8u /* of a lit hit, at most: see bind/lit.glsl */
#define HOOK_SURFACE_ROWS 3u /* of a hit that a user's surface() has changed */
#define HOOK_LIGHT_ROWS   1u /* of a hit with the light of a user's shade(); behind those of
                                surface() */
#define MET_ROWS 17u /* of an invocation of HIT_PART_FETCH: the ray, its media, struct Surface,
                        struct Optics */

/* The sizes in rows of gpu_tally, gpu_generation and gpu_items. */
#define TALLY_ROWS      2u
#define GENERATION_ROWS 25u
#define ITEMS_ROWS      2u

/* A bit in the word that names a hit's record: at NUMERICS_EXACT, the hit is the far end of a
   sphere. */
#define HIT_AT_EXIT 0x80000000u
/* The same bit in the word that names the record on which a ray starts: the ray skips all primitives
   of that instance (SKIP_ALL). */
#define RECORD_SKIPS_ALL 0x80000000u

/* sums[].w of a ray, as bits: which rays it called for, and the id of the first of them in
   SUM_ID_MASK. Their ids follow each other in this order. 0: it called for none. */
#define SUM_ID_MASK    0x0fffffffu
#define SUM_REFRACTED  0x10000000u
#define SUM_STRAIGHT   0x20000000u
#define SUM_REFLECTED  0x40000000u
/* The ray hit nothing. A user's miss() will give the light that it sees; until then its sum is the
   weight of that light. */
#define SUM_MISSED 0x0fffffffu
#define SUM_IS_CATCHER 0x80000000u /* a shadow catcher: its light, unweighted; the first row of its
                                      hit: that without shadows */

/* The lists of a generation: the items that wait for each stage. */
#define LIST_RAYS      0u
#define LIST_HITS      1u /* to be shaded, class by class */
#define LIST_LIT       3u /* hits that lights may reach, to be lit */
#define LIST_LIGHTS    4u /* the lit hits that a light may reach, one list for each light */
#define LISTS_COUNT    12u
#define CLASSES_MAX   2u /* classes of materials, CLASS_* */
#define LIGHT_LISTS    8u /* with more lights, and with SPEC_LIGHTS_EACH above 1, the first list
                             serves all of them */

/* A list: the arguments of the indirect dispatch over it, and its numbers of items. Lists have two
   segments where SPEC_SEGMENTS is 2: the first half of a dispatch's workgroups fills one from the
   front, the rest fill the other from the back. lavapipe gives each half to a thread of its own, so
   threads do not contend, and neighbours stay neighbours. */
struct gpu_items {
    gpu_uint groups, groups_y, groups_z, pad;
    gpu_uint front, back;
    gpu_uint shadow_rays; /* to the list's light; with more than LIGHT_LISTS lights, to all */
    gpu_uint pad0;
};
GPU_ASSERT_SIZE(gpu_items, 32)
#ifdef __STDC_VERSION__
typedef struct gpu_items gpu_items;
#endif

struct gpu_generation {
    gpu_items lists[LISTS_COUNT];
    gpu_uvec4 firsts; /* x: id of its first ray in the front segment; y: ids that earlier
                         generations have taken at the back */
};
GPU_ASSERT_SIZE(gpu_generation, 400)

/* Counters over all rays of the tile so far. */
struct gpu_tally {
    gpu_uint reflected, refracted;
    gpu_uint cut_depth, cut_bailout;
    gpu_uint cut_depth_weight, cut_bailout_weight; /* float bits: largest sum of a pixel */
    gpu_uint by_functions; /* rays traced by functions of a user's file */
    gpu_uint pad0;
};
GPU_ASSERT_SIZE(gpu_tally, 32)

#endif
