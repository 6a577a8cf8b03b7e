/* Skins of a glTF: vertices are moved to where its nodes have them at rest. */
#ifndef LOAD_GLTF_SKIN_H
#define LOAD_GLTF_SKIN_H

#include "load/gltf_geometry.h"

struct gltf_skin {
    struct affine *moves; /* by joint, of vertices that follow it alone */
    uint32_t joint_count;
};

/* Reads a skin of the file, which counts as taken memory until gltf_skin_finish. False: an error
   is logged. */
bool gltf_skin_read(const struct gltf *gltf, uint32_t index, struct gltf_skin *out);
void gltf_skin_finish(const struct gltf *gltf, struct gltf_skin *skin);
/* Moves the part's positions and normals from the mesh's space to that of the node tree. A
   primitive without joints stays as it is. */
bool gltf_skin_apply(const struct gltf *gltf, const struct gltf_skin *skin,
                     const struct gltf_primitive *primitive, struct part *part);

#endif
