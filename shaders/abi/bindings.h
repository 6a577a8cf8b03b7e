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

/* Cut-outs need these in traversal, shading needs them anyway. */
#define BIND_MATERIALS        7
#define BIND_TEXTURES         8
#define BIND_TEXELS           9
#define BIND_TEXEL_TEXELS     10
#define BIND_TRIANGLE_UVS     11

/* The ray batch kernel. */
#define BIND_RAYS             12
#define BIND_HITS             13
#define BIND_TRACE_COUNT      14 /* bindings of that kernel */

/* The Whitted kernel. */
#define BIND_TRIANGLE_MATERIALS 12
#define BIND_TRIANGLE_NORMALS   13
#define BIND_TRIANGLE_COLORS    14
#define BIND_FRAME              15
#define BIND_LIGHTS             16
#define BIND_ENVIRONMENT        17
#define BIND_PIXELS             18
#define BIND_IDS                19
#define BIND_COUNTS             20
#define BIND_RAY_STACKS         21
#define BIND_WORK_IN            22
#define BIND_WORK_OUT           23
#define BIND_WHITTED_COUNT      24

#endif
