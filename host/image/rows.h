/* Pictures that are written in strips of rows, so that no more than one strip is in memory. */
#ifndef IMAGE_ROWS_H
#define IMAGE_ROWS_H

#include "image/image.h"

struct image_rows;

/* Strips but for the last one have a multiple of so many rows. */
enum { IMAGE_STRIP_ROWS = 16 };

/* Begins a file as image_save names and writes it. `shape` has the sizes, channels and kind of the
   picture; which of its pixels or words is set tells the kind, and neither is read. `path`, `texts`
   and `log` have to stay until the end. Pipes are refused, WHIT_ERROR_OUTPUT. */
WHIT_CHECK whit_result image_rows_begin(const whit_log *log, const char *path,
                                        const struct image *shape, const whit_text *texts,
                                        uint32_t text_count, struct image_rows **out);
/* The next rows, from the top down. WHIT_ERROR_USAGE, logged, for a strip of another width or kind,
   or too many rows. Some errors are told by image_rows_commit alone. */
WHIT_CHECK whit_result image_rows_add(struct image_rows *rows, const struct image *strip);
/* Puts the file in its place, or after an error removes it; frees `rows`. The bytes are those of
   image_save of the whole picture. */
WHIT_CHECK whit_result image_rows_commit(struct image_rows *rows);
void image_rows_abandon(struct image_rows *rows); /* NULL is fine */

#endif
