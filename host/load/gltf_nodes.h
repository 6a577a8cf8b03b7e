/* The node tree of a glTF. */
#ifndef LOAD_GLTF_NODES_H
#define LOAD_GLTF_NODES_H

#include "load/gltf.h"

/* Checks the tree, and finds the nodes that are drawn. */
whit_result gltf_plan_nodes(struct gltf *gltf);
whit_result gltf_add_nodes(struct gltf *gltf);

#endif
