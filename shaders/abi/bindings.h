/* Binding numbers in set 0. */
#ifndef ABI_BINDINGS_H
#define ABI_BINDINGS_H

/* Every kernel. Storage and texel views of the same memory; SPEC_LOAD_PATH says which is read. */
#define BIND_NODES            0
#define BIND_NODE_TEXELS      1
#define BIND_TRIANGLES        2
#define BIND_TRIANGLE_TEXELS  3
#define BIND_INSTANCES        4
#define BIND_INSTANCE_TEXELS  5
#define BIND_STATUS           6
#define BIND_WAITING          7

/* The ray batch kernel. */
#define BIND_RAYS        8
#define BIND_HITS        9
#define BIND_TRACE_COSTS 10
#define BIND_TRACE_COUNT 11 /* bindings of that kernel */

/* The stages of a picture, and what one stage leaves to the next. */
#define BIND_SHADING             8
#define BIND_SHADING_TEXELS      9
#define BIND_TEXELS              10
#define BIND_TEXEL_TEXELS        11
#define BIND_FRAME               12
#define BIND_ENVIRONMENT         13
#define BIND_PIXELS              14
#define BIND_IDS                 15
#define BIND_LISTED              16
#define BIND_COSTS               17
#define BIND_PROBE               18
#define BIND_GENERATIONS         19
#define BIND_GENERATION_TEXELS   20
#define BIND_RAY_ROWS            21
#define BIND_RAY_TEXELS          22
#define BIND_RAY_MEDIA           23
#define BIND_MEDIA_TEXELS        24
#define BIND_RAY_KINDS           25
#define BIND_HIT_ROWS            26
#define BIND_HIT_TEXELS          27
#define BIND_HIT_LIST            28
#define BIND_LIST_TEXELS         29
#define BIND_LIT_ROWS            30
#define BIND_LIT_TEXELS          31
#define BIND_LIT_LIST            32
#define BIND_LIT_LIST_TEXELS     33
#define BIND_SUMS                34
#define BIND_SUM_TEXELS          35
#define BIND_CHILDREN            36
#define BIND_CHILD_TEXELS        37
#define BIND_CUTS                38
#define BIND_CUT_SUMS            39
#define BIND_NODE8_TEXELS        40
#define BIND_STAGES_COUNT        41

#endif
