/* Materials and textures as the kernel reads them. */
#ifndef RENDER_TEXTURES_H
#define RENDER_TEXTURES_H

#include "render/renderer.h"

/* Uploads all texels and makes the records that use them. */
struct material_records {
    struct gpu_material *materials; /* one for each of the scene's */
    struct gpu_texture *uses;
    uint32_t use_count;
};
/* A material of the scene as kernels of the renderer's effects draw it; it borrows all that it
   points to. */
struct scene_material material_drawn(const struct renderer *renderer, uint32_t index);
/* Whether textures have smaller levels, for what is far away. */
bool textures_minify(const struct renderer *renderer);
WHIT_CHECK whit_result material_records_init(struct renderer *renderer,
                                             struct material_records *records);
void material_records_finish(struct material_records *records);

#endif
