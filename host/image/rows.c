/* Writes pictures, whole or in strips of rows, so that no more than one strip is in memory. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "image/formats.h"
#include "image/rows.h"

struct image_rows {
    struct file_write file;
    struct image_target target;
    struct image shape; /* without pixels */
    struct png_writer *png;
    struct exr_writer *exr;
    size_t header_bytes; /* size of a PFM's header, to find rows: its last row comes first */
    uint32_t y;          /* rows written so far */
    whit_result result;
};

static whit_result fail(struct image_rows *rows)
{
    return log_failure(rows->target.log, WHIT_ERROR_OUTPUT, "%s: cannot be written in strips: %s",
                       rows->target.path, strerror(errno));
}

/* Begins the writer of the format. `channels`: of a PNG. */
static whit_result begin(struct image_rows *rows, uint32_t channels)
{
    enum image_format format = image_format_of(rows->target.path);
    if (format == IMAGE_PFM)
        rows->header_bytes = pfm_put_header(&rows->target, &rows->shape);
    else if (format == IMAGE_EXR)
        rows->exr = exr_rows_begin(&rows->target, &rows->shape);
    else
        rows->png = png_rows_begin(&rows->target, &rows->shape, channels);
    return rows->header_bytes || rows->exr || rows->png ? WHIT_OK : WHIT_ERROR_MEMORY;
}

/* Opens the file. `whole`: all rows come at once, so that a pipe will do. */
static whit_result open_rows(const struct image_target *target, const struct image *shape,
                             uint32_t channels, bool whole, struct image_rows **out)
{
    struct image_rows *rows = calloc(1, sizeof *rows);
    *out = NULL;
    if (!rows)
        return log_failure(target->log, WHIT_ERROR_MEMORY, "%s: out of memory", target->path);
    whit_result result = file_write_begin(target->log, target->path, &rows->file);
    if (result != WHIT_OK) {
        free(rows);
        return result;
    }
    rows->shape = *shape;
    rows->target = *target;
    rows->target.stream = rows->file.stream;
    bool seeks = whole || fseeko(rows->file.stream, 0, SEEK_CUR) == 0;
    result = seeks ? begin(rows, channels) : fail(rows);
    if (result == WHIT_OK)
        *out = rows;
    else
        image_rows_abandon(rows);
    return result;
}

whit_result image_rows_begin(const whit_log *log, const char *path, const struct image *shape,
                             const whit_text *texts, uint32_t text_count, struct image_rows **out)
{
    const struct image_target target = {
        .log = log, .path = path, .texts = texts, .text_count = text_count};
    *out = NULL;
    whit_result result = image_check_savable(log, shape, path);
    if (result == WHIT_OK)
        result = image_check_texts(log, path, texts, text_count);
    return result == WHIT_OK ? open_rows(&target, shape, shape->channels, false, out) : result;
}

static whit_result put_pfm_rows(struct image_rows *rows, const struct image *strip)
{
    uint64_t below = rows->shape.height - rows->y - strip->height;
    uint64_t row_bytes = (uint64_t)strip->width * (strip->channels == 1 ? 1 : 3) * sizeof(float);
    if (strip->height < rows->shape.height && /* a whole picture may go into a pipe */
        fseeko(rows->target.stream, (off_t)(rows->header_bytes + below * row_bytes), SEEK_SET))
        return fail(rows);
    return pfm_put_rows(&rows->target, strip);
}

whit_result image_rows_add(struct image_rows *rows, const struct image *strip)
{
    const struct image *shape = &rows->shape;
    if (strip->width != shape->width || strip->channels != shape->channels ||
        !strip->words != !shape->words || strip->height > shape->height - rows->y) {
        log_error(rows->target.log, "%s: a strip of another shape", rows->target.path);
        rows->result = WHIT_ERROR_USAGE;
    } else if (rows->exr) {
        exr_rows_add(rows->exr, strip);
    } else if (rows->png) {
        png_rows_add(rows->png, strip);
    } else if (rows->result == WHIT_OK) {
        rows->result = put_pfm_rows(rows, strip);
    }
    rows->y += strip->height;
    return rows->result;
}

/* Ends the format's writer and frees it. `whole`: all rows were added. */
static whit_result end(struct image_rows *rows, bool whole)
{
    whit_result result = WHIT_OK;
    if (rows->exr)
        result = exr_rows_end(rows->exr);
    if (rows->png)
        result = png_rows_end(rows->png, whole);
    return rows->result == WHIT_OK ? result : rows->result;
}

whit_result image_rows_commit(struct image_rows *rows)
{
    const whit_log *log = rows->target.log;
    bool whole = rows->y == rows->shape.height;
    if (!whole && rows->result == WHIT_OK) {
        log_error(log, "%s: %u of %u rows", rows->target.path, rows->y, rows->shape.height);
        rows->result = WHIT_ERROR_USAGE;
    }
    whit_result result = file_write_end(log, &rows->file, end(rows, whole));
    free(rows);
    return result;
}

void image_rows_abandon(struct image_rows *rows)
{
    static const whit_log silent = {0};
    if (!rows)
        return;
    rows->target.log = &silent;
    whit_result ignored = end(rows, false);
    (void)ignored;
    file_write_abandon(&rows->file);
    free(rows);
}

whit_result image_write_whole(const struct image_target *target, const struct image *image)
{
    struct image_rows *rows;
    uint32_t channels = image->pixels ? png_channels(image) : image->channels;
    whit_result result = open_rows(target, image, channels, true, &rows);
    if (result != WHIT_OK)
        return result;
    result = image_rows_add(rows, image);
    whit_result end_result = image_rows_commit(rows);
    return result == WHIT_OK ? end_result : result;
}
