/* Writes the triangles of a scene to a file: `whit scene --triangles`. */
#include <stdlib.h>

#include "app/scene/listing.h"
#include "base/file.h"
#include "whit/whit_program.h"

enum { TRIANGLE_BATCH = 4096 };
_Static_assert(sizeof(whit_triangle) == 44, "records of --triangles have no padding");

struct triangle_writer {
    struct file_write file;
    whit_triangle batch[TRIANGLE_BATCH];
    uint32_t used;
    whit_result result;
};

static bool write_batch(struct triangle_writer *writer)
{
    writer->result = file_write_append(&cli_log, &writer->file, writer->batch,
                                       writer->used * sizeof writer->batch[0]);
    writer->used = 0;
    return writer->result == WHIT_OK;
}

static bool write_triangle(void *user, const whit_triangle *triangle)
{
    struct triangle_writer *writer = user;
    writer->batch[writer->used++] = *triangle;
    if (cli_cancel)
        return false;
    return writer->used < TRIANGLE_BATCH || write_batch(writer);
}

whit_result triangles_write(const whit_scene *scene, double time_s, const char *path)
{
    struct triangle_writer *writer = calloc(1, sizeof *writer);
    if (!writer)
        return cli_no_memory();
    whit_result result = file_write_begin(&cli_log, path, &writer->file);
    if (result != WHIT_OK)
        goto done;
    result = whit_scene_triangles(scene, time_s, write_triangle, writer);
    if (result == WHIT_ERROR_CANCELLED && writer->result != WHIT_OK)
        result = writer->result;
    if (result == WHIT_OK && !write_batch(writer))
        result = writer->result;
    if (result == WHIT_OK) {
        cli_set_saving();
        result = file_write_commit(&cli_log, &writer->file);
    } else {
        file_write_abandon(&writer->file);
    }
done:
    free(writer);
    return result;
}
