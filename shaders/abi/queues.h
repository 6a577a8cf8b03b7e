/* The rays of a picture between its stages: generations of rays, what they met, what is lit there.

   A ray has a number (id) within its tile. Camera rays are generation 0, and their ids are those of
   the pixels' slots; a ray that is called for by one of generation g belongs to generation g + 1, whose
   ids follow those of g. Nothing depends on which of its generation's ids a ray gets. */
#ifndef ABI_QUEUES_H
#define ABI_QUEUES_H

#include "base.h"

/* Rows of 16 bytes. */
#define RAY_ROWS 4u /* origin, state; dir, record to skip; weight, its instance; media */
#define LIT_ROWS 8u /* at most, see bind/lit.glsl */
#define HOOK_SURFACE_ROWS 3u /* of a hit that a user's surface() has changed */
#define HOOK_LIGHT_ROWS   1u /* of a hit whose light a user's shade() has said, behind these */
#define MET_ROWS 17u /* of an invocation, HIT_PART_FETCH: the ray, its media, struct Surface, struct Optics */

/* The sizes in rows of gpu_tally, gpu_generation and gpu_items. */
#define TALLY_ROWS      2u
#define GENERATION_ROWS 25u
#define ITEMS_ROWS      2u

/* A bit in the word of a hit's record: at NUMERICS_EXACT, the hit is the far end of a sphere. */
#define HIT_AT_EXIT 0x80000000u

/* sums[].w of a ray, as bits: which rays it calls for, whose ids follow each other in this order, and the
   first id. 0: none. */
#define SUM_ID_MASK    0x0fffffffu
#define SUM_REFRACTED  0x10000000u
#define SUM_STRAIGHT   0x20000000u
#define SUM_REFLECTED  0x40000000u
/* The ray has met nothing, and a user's miss() is to say what it sees, by the weight that is its sum. */
#define SUM_MISSED 0x0fffffffu
#define SUM_IS_CATCHER 0x80000000u /* its light, unweighted; without shadows in the first row of its hit */

/* The lists of a generation: what waits for each stage. */
#define LIST_RAYS      0u
#define LIST_HITS      1u /* to be shaded, class by class */
#define LIST_LIT       3u /* hits that lights may reach, to be lit */
#define LIST_LIGHTS    4u /* the lit hits that a light may reach, one list a light */
#define LISTS_COUNT    12u
#define CLASSES_MAX   2u /* of materials, CLASS_* */
#define LIGHT_LISTS    8u /* with more lights than that the first list is of all */

/* The arguments of an indirect dispatch, and the items that it is for. Lists have two segments where
   SPEC_SEGMENTS is 2: one is filled from the front by the first half of a dispatch's workgroups, the
   other from the back by the rest. lavapipe gives each half to a thread of its own; so threads do not
   contend, and what was near stays near. */
struct gpu_items {
    gpu_uint groups, groups_y, groups_z, pad;
    gpu_uint front, back;
    gpu_uint shadow_rays; /* that the hits of the list took to its light */
    gpu_uint pad0;
};
GPU_ASSERT_SIZE(gpu_items, 32)
#ifdef __STDC_VERSION__
typedef struct gpu_items gpu_items;
#endif

struct gpu_generation {
    gpu_items lists[LISTS_COUNT];
    gpu_uvec4 firsts; /* ids: of its first ray in front; how many are behind those at the back; 0, 0 */
};
GPU_ASSERT_SIZE(gpu_generation, 400)

/* Counters over all rays of the tile so far. */
struct gpu_tally {
    gpu_uint reflected, refracted;
    gpu_uint cut_depth, cut_bailout;
    gpu_uint cut_depth_weight, cut_bailout_weight; /* bits of floats: the largest sum of a pixel */
    gpu_uint by_functions; /* traced by functions of a user's file */
    gpu_uint pad0;
};
GPU_ASSERT_SIZE(gpu_tally, 32)

#endif
