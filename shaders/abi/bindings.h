/* Binding numbers in set 0. */
#ifndef ABI_BINDINGS_H
#define ABI_BINDINGS_H

/* Bindings of every kernel. A buffer and its texels are views of the same memory; SPEC_LOAD_PATH
   says which one is read. */
#define BIND_NODES            0
#define BIND_NODE_TEXELS      1
#define BIND_TRIANGLES        2
#define BIND_TRIANGLE_TEXELS  3
#define BIND_INSTANCES        4
#define BIND_INSTANCE_TEXELS  5
#define BIND_STATUS           6
#define BIND_DEFERRED          7
#define BIND_NODE8_TEXELS     8
#define BIND_QUANTIZED_TEXELS 9

/* Further bindings of the ray batch kernel (trace.comp). */
#define BIND_RAYS         10
#define BIND_BATCH_TEXELS 11 /* of BIND_RAYS */
#define BIND_HITS         12
#define BIND_TRACE_COSTS  13
#define BIND_TRACE_COUNT  14 /* number of bindings of that kernel */

/* Bindings of the stages of a picture, with the queues between them. */
#define BIND_SHADING             10
#define BIND_SHADING_TEXELS      11
#define BIND_TEXELS              12
#define BIND_TEXEL_TEXELS        13
#define BIND_FRAME               14
#define BIND_ENVIRONMENT         15
#define BIND_PIXELS              16
#define BIND_IDS                 17
#define BIND_LISTED              18
#define BIND_COSTS               19
#define BIND_PROBE               20
#define BIND_GENERATIONS         21
#define BIND_GENERATION_TEXELS   22
#define BIND_RAY_ROWS            23
#define BIND_RAY_TEXELS          24
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
#define BIND_CUTS                36
#define BIND_CUT_TEXELS          37
#define BIND_CUT_SUMS            38
#define BIND_AOVS                39
#define BIND_DBG                 40
#define BIND_VIEWS               41
#define BIND_DISTANCES           42
#define BIND_SHAPE_SHADOWS       43
#define BIND_HOOK_ROWS           44
#define BIND_HOOK_TEXELS         45
#define BIND_STAGES_COUNT        46

#endif
