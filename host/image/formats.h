/* The file formats behind image_save and image_load. Private to this module. */
#ifndef IMAGE_FORMATS_H
#define IMAGE_FORMATS_H

#include <stdio.h>

#include "image/image.h"

/* Limits of pictures that are read, per side in pixels and in bytes decoded: no format's header can
   be trusted on how large its contents are. */
enum { IMAGE_SIDE_MAX = 65535 };
#define IMAGE_BYTES_MAX ((uint64_t)1 << 30)

/* The formats that are written. */
enum image_format { IMAGE_UNKNOWN, IMAGE_PNG, IMAGE_EXR, IMAGE_PFM };
enum image_format image_format_of(const char *path);

/* A picture file in memory; `path` is for messages. */
struct image_source {
    const whit_log *log;
    const char *path;
    const uint8_t *data;
    size_t size_bytes;
};

/* A file that a picture is written to. Errors of `stream` are not checked here: file_write_commit
   looks at its error flag. */
struct image_target {
    const whit_log *log;
    const char *path;
    FILE *stream;
    const whit_text *texts;
    uint32_t text_count;
    const struct image_layer *layers; /* for EXR alone */
    uint32_t layer_count;
};

/* A list of key and value pairs; it owns the strings. A zeroed list is empty. */
struct text_list {
    whit_text *texts;
    uint32_t count, capacity;
};

/* Decode a file in memory, or its texts, in this process. Errors are logged. */
WHIT_CHECK whit_result image_decode(const struct image_source *source, struct image *image);
WHIT_CHECK whit_result image_decode_texts(const struct image_source *source,
                                          struct text_list *list);

/* Checks that the image can be saved under this path, by size, channels and extension; logs
   errors. */
WHIT_CHECK whit_result image_check_savable(const whit_log *log, const struct image *image,
                                           const char *path);

/* Checks that files of all formats keep the keys of these texts as they are; logs errors. */
WHIT_CHECK whit_result image_check_texts(const whit_log *log, const char *path,
                                         const whit_text *texts, uint32_t count);

/* False when memory runs out. */
bool text_list_add(struct text_list *list, const char *key, const char *value);
void text_list_finish(struct text_list *list);

/* Writes an image in the format of target->path, to a stream of its own; rows.c. */
WHIT_CHECK whit_result image_write_whole(const struct image_target *target,
                                         const struct image *image);

/* image_init for a file that is being read; a size beyond the limits above is a logged error. */
WHIT_CHECK whit_result image_init_loaded(const struct image_source *source, struct image *image,
                                         uint64_t width, uint64_t height, uint32_t channels,
                                         bool integers);

WHIT_CHECK whit_result png_write(const struct image_target *target, const struct image *image);
WHIT_CHECK whit_result png_load(const struct image_source *source, struct image *image);
WHIT_CHECK whit_result png_load_texts(const struct image_source *source, struct text_list *list);

WHIT_CHECK whit_result exr_load(const struct image_source *source, struct image *image);
WHIT_CHECK whit_result exr_load_texts(const struct image_source *source, struct text_list *list);

WHIT_CHECK whit_result pfm_load(const struct image_source *source, struct image *image);

/* Writers that take a picture in strips of rows, from the top down; all but the last strip have a
   multiple of 16 rows. `shape`: size, channels and kind of the picture; its pixels are not read.
   `target` must stay valid. NULL: memory ran out, which was logged. *_rows_end frees the writer and
   logs errors of any step. A stream that cannot seek gets an EXR at the end, which is kept in
   memory until then. */
struct exr_writer;
struct exr_writer *exr_rows_begin(const struct image_target *target, const struct image *shape);
void exr_rows_add(struct exr_writer *writer, const struct image *rows);
WHIT_CHECK whit_result exr_rows_end(struct exr_writer *writer);
struct png_writer;
/* `channels`: of the file, where grey may be RGB. */
struct png_writer *png_rows_begin(const struct image_target *target, const struct image *shape,
                                  uint32_t channels);
void png_rows_add(struct png_writer *writer, const struct image *rows);
WHIT_CHECK whit_result png_rows_end(struct png_writer *writer, bool whole);
/* Channels of the PNG of a whole image. */
uint32_t png_channels(const struct image *image);
/* Write the header of a PFM, which gives its size in bytes; and rows, the lowest first. */
size_t pfm_put_header(const struct image_target *target, const struct image *shape);
WHIT_CHECK whit_result pfm_put_rows(const struct image_target *target, const struct image *rows);

WHIT_CHECK whit_result hdr_load(const struct image_source *source, struct image *image);

#endif
