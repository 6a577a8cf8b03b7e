/* The node tree. */
#ifndef LOAD_GLTF_NODES_H
#define LOAD_GLTF_NODES_H

#include "load/gltf.h"

/* Checks it and finds what is drawn. */
whit_result gltf_plan_nodes(struct gltf *gltf);
whit_result gltf_add_nodes(struct gltf *gltf);

#endif
