/* The nodes of one mesh tree in 16 bytes each, for traversal of trees without instances. */
#ifndef ACCEL_QUANTIZED_H
#define ACCEL_QUANTIZED_H

#include "accel/accel.h"

/* Whether steps of a grid over the tree's box are floats far from overflow and underflow. */
bool accel_can_quantize(const struct accel_mesh *mesh);
/* Whether most boxes on the grid are nearly as small as they were. They are not where a large
   ground or one far triangle leaves few steps for the rest. Needs accel_can_quantize. */
bool accel_quantizes_well(const struct accel *accel, const struct accel_mesh *mesh);
/* The tree's nodes by their indices in accel->nodes, behind a struct gpu_quantized_grid in the
   place of node 0: mesh->first_node + mesh->node_count elements, which the caller frees. Needs
   accel_can_quantize. NULL: out of memory. */
struct gpu_quantized_node *accel_quantize(const struct accel *accel, const struct accel_mesh *mesh);

#endif
