/* Textures from files and from memory. */
#ifndef LOAD_TEXTURE_H
#define LOAD_TEXTURE_H

#include "load/load.h"
#include "load/picture.h"

/* Adds an 8-bit texture from a file, or from memory (`data` non-NULL; `path` is then only its
   name). A file that was loaded before gives the same index again. If it cannot be read, a warning
   is noted and *index is a 1x1 magenta texture; but if `reason` is non-NULL, nothing is noted or
   added, *reason says why, and the result is WHIT_ERROR_INPUT. */
WHIT_CHECK whit_result load_texture(struct scene *scene, const char *path, const uint8_t *data,
                                    size_t size_bytes, const whit_load_params *params,
                                    uint32_t *index, const char **reason);

/* --- for texture_ahead.c -------------------------------------------------------------------- */

/* Identifies a picture that may have several names, by its file's inode or by a hash of its bytes.
   Keys are in one table with names, which never equal a key, since they have no zero bytes. */
struct texture_key {
    uint64_t kind, damaged, limit, words[4];
};

/* The encoded bytes of a texture, and the keys under which it will be found. */
struct texture_source {
    const uint8_t *data;
    uint8_t *owned;
    size_t size_bytes;
    struct texture_key keys[2]; /* the last one may be a hash of the bytes: see `hashed` */
    uint32_t key_count;
    bool hashed;    /* the last key is a hash of the bytes */
    bool too_large; /* exceeds the scene's memory limit, which was logged */
};

/* Adds the key of the file; without one, where the file cannot be found, nothing. */
void texture_key_file(const char *path, const whit_load_params *params,
                      struct texture_source *source);
/* Reads the file, if there are no data yet, and adds the key of its bytes. A failure is not logged,
   but told in `reason`. */
whit_result texture_read(const struct scene *scene, const char *path,
                         const whit_load_params *params, struct texture_source *source,
                         char reason[FOREIGN_REASON_BYTES]);

#endif
