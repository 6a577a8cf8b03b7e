/* Writes the triangles of a scene to a file: `whit scene --triangles`. */
#include "app/scene/listing.h"
#include "base/file.h"
#include "whit/whit_program.h"

_Static_assert(sizeof(whit_triangle) == 44, "records of --triangles have no padding");

struct triangle_writer {
    struct file_write file;
    whit_result result;
};

static bool write_triangle(void *user, const whit_triangle *triangle)
{
    struct triangle_writer *writer = user;
    if (!cli_cancel)
        writer->result = file_write_append(&cli_log, &writer->file, triangle, sizeof *triangle);
    return !cli_cancel && writer->result == WHIT_OK;
}

whit_result triangles_write(const whit_scene *scene, double time_s, const char *path)
{
    struct triangle_writer writer = {.result = WHIT_OK};
    whit_result result = file_write_begin(&cli_log, path, &writer.file);
    if (result != WHIT_OK)
        return result;
    result = whit_scene_triangles(scene, time_s, write_triangle, &writer);
    if (result == WHIT_ERROR_CANCELLED && writer.result != WHIT_OK)
        result = writer.result;
    if (result == WHIT_OK)
        cli_set_saving();
    return file_write_end(&cli_log, &writer.file, result);
}
