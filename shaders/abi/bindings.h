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

/* The Whitted kernel. */
#define BIND_SHADING        8
#define BIND_SHADING_TEXELS 9
#define BIND_TEXELS         10
#define BIND_TEXEL_TEXELS   11
#define BIND_FRAME          12
#define BIND_ENVIRONMENT    13
#define BIND_PIXELS         14
#define BIND_IDS            15
#define BIND_COUNTS         16
#define BIND_RAY_STACKS     17
#define BIND_WORK_IN        18
#define BIND_WORK_OUT       19
#define BIND_COSTS          20
#define BIND_RAY_MEDIA      21
#define BIND_PROBE          22
#define BIND_WHITTED_COUNT  23

#endif
