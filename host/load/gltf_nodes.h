/* The node tree of a glTF. */
#ifndef LOAD_GLTF_NODES_H
#define LOAD_GLTF_NODES_H

#include "load/gltf.h"

/* Checks the tree, and finds the nodes that are drawn. */
whit_result gltf_plan_nodes(struct gltf *gltf);
/* Adds the drawn nodes to the scene, without what hangs on them. */
whit_result gltf_place_nodes(struct gltf *gltf);
/* Adds the meshes, cameras and lights of the nodes. */
whit_result gltf_fill_nodes(struct gltf *gltf);
/* Mesh and skin of a node of the file, as indices of the file; SCENE_NONE: it has none. */
bool gltf_node_mesh(const struct gltf *gltf, uint32_t node, uint32_t *mesh, uint32_t *skin);

#endif
