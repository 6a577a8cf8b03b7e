/* Reads pictures from files; decoders run in a child process. */
#ifndef IMAGE_IMAGE_REPLY_H
#define IMAGE_IMAGE_REPLY_H

#include "image/image.h"

/* Reads a PNG (converted from sRGB to linear; palettes, and 1 to 16 bits), EXR (half, float or uint
   channels; scanlines or tiles), PFM or HDR; the format is told by the content. At most 65535
   pixels per side and 1 GiB. A damaged file is one logged error; *image is then empty. `roots`:
   folders that the path may not lead out of, or NULL, as for file_read. `params`: for the child
   process; may be NULL. */
WHIT_CHECK whit_result image_load(const whit_log *log, const struct roots *roots, const char *path,
                                  const struct foreign_params *params, struct image *image);
/* Reads the recipe (texts) in a PNG or EXR; *texts and its strings are one block, free() it.
   `params` as above. */
WHIT_CHECK whit_result image_load_texts(const whit_log *log, const char *path,
                                        const struct foreign_params *params, whit_text **texts,
                                        uint32_t *text_count);

#endif
