/* assimp's scene as a GLB, in the importer's child. */
#ifndef LOAD_IMPORTER_GLB_H
#define LOAD_IMPORTER_GLB_H

#include "load/importer.h"

struct aiScene;
struct aiExportDataBlob;

/* Exports a GLB in metres with y upwards, without skins, animations, lights and cameras, which it
   counts in *counts. `metres`: the unit of a 3MF. Changes *scene, which is NULL behind it where
   assimp has released it; the caller releases the blob. NULL: aiGetErrorString() says why. */
const struct aiExportDataBlob *importer_glb(const struct aiScene **scene,
                                            const struct import_request *request, double metres,
                                            struct import_counts *counts);

#endif
