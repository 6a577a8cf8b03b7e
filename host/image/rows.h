/* Writes pictures in strips of rows, so that no more than one strip is in memory. */
#ifndef IMAGE_ROWS_H
#define IMAGE_ROWS_H

#include "image/image.h"

struct image_rows;

/* All strips but the last have a multiple of this many rows. */
enum { IMAGE_STRIP_ROWS = 16 };

/* Begins a file like those of image_save. `shape` has the picture's size and channels, and `pixels`
   or `words` set as its kind; neither is read. `path`, `texts` and `log` must stay valid until the
   end. Pipes are refused: WHIT_ERROR_OUTPUT. */
WHIT_CHECK whit_result image_rows_begin(const whit_log *log, const char *path,
                                        const struct image *shape, const whit_text *texts,
                                        uint32_t text_count, struct image_rows **out);
/* Adds the next rows, from the top down. WHIT_ERROR_USAGE, logged, for a strip of another width or
   kind, or too many rows. Some errors are only reported by image_rows_commit. */
WHIT_CHECK whit_result image_rows_add(struct image_rows *rows, const struct image *strip);
/* Puts the file in its place, or removes it after an error; frees `rows`. The file has the same
   bytes as by image_save of the whole picture. */
WHIT_CHECK whit_result image_rows_commit(struct image_rows *rows);
void image_rows_abandon(struct image_rows *rows); /* NULL is fine */

#endif
