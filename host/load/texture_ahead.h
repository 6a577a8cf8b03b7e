/* Pictures that all cores decode at once, before load_texture is called for one after another. */
#ifndef LOAD_TEXTURE_AHEAD_H
#define LOAD_TEXTURE_AHEAD_H

#include "load/texture.h"

/* Names a picture that load_texture will be called for, by the same arguments; data stay valid
   until load_textures_end. */
void load_texture_soon(struct scene *scene, const char *path, const uint8_t *data,
                       size_t size_bytes, const whit_load_params *params);
/* Decodes the named pictures by all cores at once, for load_texture to find them. What cannot be
   decoded here is left to load_texture, which has the same results with and without these calls. */
void load_textures_ahead(struct scene *scene, const whit_load_params *params);
/* Frees the decoded pictures that load_texture was not called for. */
void load_textures_end(struct scene *scene);

/* --- for texture.c -------------------------------------------------------------------------- */

/* Replaces a source that has the key of its file alone by one that load_texture_soon has read. */
void texture_take_source(struct scene *scene, struct texture_source *source);
/* Gives what picture_read would, once for each picture, which then is the caller's. False: it was
   not decoded ahead, is damaged, or has more than `pixels_max` pixels. */
bool texture_take_picture(struct scene *scene, const struct texture_source *source,
                          uint64_t pixels_max, struct picture *out);

#endif
