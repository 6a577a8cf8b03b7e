/* Materials and textures as the kernel reads them. */
#ifndef RENDER_TEXTURES_H
#define RENDER_TEXTURES_H

#include "render/renderer.h"

/* Records of the shading rows, made by material_records_init, which also uploads all texels. */
struct material_records {
    struct gpu_material *materials; /* one for each material of the scene */
    struct gpu_texture *uses;
    uint32_t use_count;
};
/* A material of the scene as the renderer's kernels draw it, with the effects that they have.
   Pointers in it belong to the scene. */
struct scene_material material_drawn(const struct renderer *renderer, uint32_t index);
/* Whether textures have mipmap levels. */
bool textures_minify(const struct renderer *renderer);
WHIT_CHECK whit_result material_records_init(struct renderer *renderer,
                                             struct material_records *records);
void material_records_finish(struct material_records *records);

#endif
