/* Cameras of scene files, and files with nothing but cameras. */
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/text.h"
#include "base/vec.h"
#include "load/scene_animation.h"
#include "load/scene_cameras.h"

#define FILE_BYTES_MAX ((uint64_t)256 << 20)
#define RADIANS        (PI / 180.0)

/* The kind of camera by its keys: `height` is orthographic, `panorama` a panorama, else
   perspective. Refuses keys that do not go together. */
static bool read_camera_kind(struct reader *reader, const struct place *place, const json_t *object,
                             struct scene_camera *out)
{
    static const char *const foreign[] = {"fov", "height", "lens", "focus"};
    bool panorama = false, parallel = json_object_get(object, "height") != NULL;
    if (!reader_bool(reader, place, object, "panorama", &panorama))
        return false;
    for (size_t i = 0; panorama && i < sizeof foreign / sizeof *foreign; ++i) {
        struct place here = {place, foreign[i], 0};
        if (json_object_get(object, foreign[i]))
            return reader_fail(reader, &here, "a panorama has no `%s`", foreign[i]);
    }
    struct place at_height = {place, "height", 0}, at_lens = {place, "lens", 0},
                 at_focus = {place, "focus", 0};
    if (parallel && json_object_get(object, "fov"))
        return reader_fail(reader, &at_height,
                           "`height` (a parallel view) and `fov` exclude each other");
    if (parallel && json_object_get(object, "lens"))
        return reader_fail(reader, &at_lens, "a parallel view (`height`) has no lens");
    if (json_object_get(object, "focus") && !json_object_get(object, "lens"))
        return reader_fail(reader, &at_focus, "`focus` is of a camera with a `lens`");
    out->kind = panorama   ? WHIT_CAMERA_PANORAMA
                : parallel ? WHIT_CAMERA_ORTHOGRAPHIC
                           : WHIT_CAMERA_PERSPECTIVE;
    return true;
}

bool reader_camera(struct reader *reader, const struct place *place, const json_t *object)
{
    static const char *const keys[] = {"name", "eye",   "target",   "up",     "fov",       "height",
                                       "lens", "focus", "panorama", "aspect", "animation", NULL};
    const char *name = "camera";
    double fov = 40.0;
    struct scene_camera camera = {.eye = {0, 0, 5}, .up = {0, 1, 0}, .node = SCENE_NONE};
    if (!reader_object(reader, place, object, keys) ||
        !reader_string(reader, place, object, "name", &name) ||
        !reader_numbers(reader, place, object, "eye", 3, camera.eye) ||
        !reader_numbers(reader, place, object, "target", 3, camera.target) ||
        !reader_numbers(reader, place, object, "up", 3, camera.up) ||
        !reader_number(reader, place, object, "fov", 0.001, 179.9, &fov) ||
        !reader_float(reader, place, object, "height", 1e-15, 1e15, &camera.height) ||
        !reader_float(reader, place, object, "lens", 0.0, 1e15, &camera.lens_radius) ||
        !reader_float(reader, place, object, "focus", 1e-15, 1e15, &camera.focus_distance) ||
        !reader_float(reader, place, object, "aspect", 0.01, 100.0, &camera.aspect) ||
        !read_camera_kind(reader, place, object, &camera))
        return false;
    if (!(double3_distance(camera.eye, camera.target) > 0.0))
        return reader_fail(reader, place, "`eye` and `target` are the same point");
    camera.fov_y = (float)(fov * RADIANS);
    if (!reader_moving_node(reader, place, object, name, &camera.node))
        return false;
    camera.name = scene_text(reader->scene, name);
    return scene_add_camera(reader->scene, camera) != SCENE_NONE || reader_no_memory(reader);
}

bool reader_cameras(struct reader *reader, const struct place *place, const json_t *value)
{
    if (!json_is_array(value))
        return reader_fail(reader, place, "cameras in [ ] are expected");
    for (size_t i = 0; i < json_array_size(value); ++i) {
        struct place here = {place, NULL, i};
        if (!reader_camera(reader, &here, json_array_get(value, i)))
            return false;
    }
    return true;
}

/* ---- Files of cameras alone ---- */

static bool read_view(struct reader *reader, const struct place *place, const json_t *object)
{
    struct place at_animation = {place, "animation", 0};
    if (json_object_get(object, "animation"))
        return reader_fail(reader, &at_animation, "cameras of views stand still");
    return reader_camera(reader, place, object);
}

static bool read_array(struct reader *reader)
{
    const struct place place = {0};
    json_t *root = reader_parse(reader);
    bool read = root != NULL;
    for (size_t i = 0; read && i < json_array_size(root); ++i) {
        struct place here = {&place, NULL, i};
        read = read_view(reader, &here, json_array_get(root, i));
    }
    json_decref(root);
    return read;
}

/* Reads one camera per line, skipping empty lines. Lines are parsed one by one, so that a million
   of them do not need memory for one large JSON tree. */
static bool read_lines(struct reader *reader, char *text, size_t size_bytes)
{
    const struct place place = {0};
    bool read = true;
    for (char *line = text, *end; read && line < text + size_bytes; line = end + 1) {
        end = memchr(line, '\n', (size_t)(text + size_bytes - line));
        end = end ? end : text + size_bytes;
        *end = '\0';
        reader->text = line;
        reader->text_bytes = (size_t)(end - line);
        if (strspn(line, " \t\r") < reader->text_bytes) {
            json_t *root = reader_parse(reader);
            read = root && read_view(reader, &place, root);
            json_decref(root);
        }
        ++reader->lines_before;
    }
    return read;
}

whit_result load_cameras(struct scene *scene, const char *path)
{
    uint8_t *text = NULL;
    struct reader reader = {.scene = scene, .path = path, .plain_material = SCENE_NONE};
    whit_result result =
        file_read(&scene->log, NULL, path, FILE_BYTES_MAX, &text, &reader.text_bytes);
    if (result != WHIT_OK)
        return result;
    reader.text = (const char *)text;
    const char *first = reader.text + text_mark_bytes(reader.text);
    bool is_array = first[strspn(first, " \t\r\n")] == '[';
    bool read =
        is_array ? read_array(&reader) : read_lines(&reader, (char *)text, reader.text_bytes);
    if (read && scene->camera_count == 0) {
        log_error(&scene->log, "%s: there is no camera in it", path);
        read = false;
        reader.result = WHIT_ERROR_INPUT;
    }
    free(text);
    return read ? WHIT_OK : reader.result;
}
