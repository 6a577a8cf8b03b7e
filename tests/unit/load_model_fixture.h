/* A folder of small files, and a scene to load them into. */
#ifndef LOAD_MODEL_FIXTURE_H
#define LOAD_MODEL_FIXTURE_H

#include "../scenes.h"
#include "base/array.h"
#include "folder_fixture.h"
#include "load/model.h"

static struct {
    whit_log log;
    struct scene *scene;
} fixture;

static inline int fixture_begin(void **state)
{
    if (folder_begin(state) != 0)
        return -1;
    fixture.log = messages_log(&messages);
    fixture.scene = scene_create(&fixture.log, "test");
    return fixture.scene && roots_allow(&fixture.log, &fixture.scene->roots, folder) == WHIT_OK
               ? 0
               : -1;
}

static inline int fixture_end(void **state)
{
    scene_destroy(fixture.scene);
    return folder_end(state);
}

/* Writes a file of JSON, in whose text ' stands for "; gives its path. */
__attribute__((format(printf, 2, 3))) static inline const char *put_json(const char *name,
                                                                         const char *format, ...)
{
    char *text = NULL;
    size_t bytes;
    FILE *stream = open_memstream(&text, &bytes);
    assert_non_null(stream);
    va_list values;
    va_start(values, format);
    assert_true(vfprintf(stream, format, values) >= 0);
    va_end(values);
    assert_int_equal(fclose(stream), 0);
    for (char *at = text; (at = strchr(at, '\''));)
        *at = '"';
    const char *path = put_text(name, text);
    free(text);
    return path;
}

static inline whit_result fixture_load(const char *path)
{
    return load_model(fixture.scene, path, SCENE_NONE, true, true, NULL);
}

/* Loads a file, which adds one mesh or more; gives the last one. */
static inline const struct scene_mesh *fixture_mesh(const char *path)
{
    if (fixture_load(path) != WHIT_OK)
        fail_msg("%s", messages.last_error);
    return &fixture.scene->meshes[fixture.scene->mesh_count - 1];
}

/* Checks that loading fails with one error, which names the file and contains `reason`. */
static inline void fixture_refused(const char *path, const char *reason)
{
    messages.errors = 0;
    if (fixture_load(path) != WHIT_ERROR_INPUT)
        fail_msg("no error with `%s`", reason);
    assert_int_equal(messages.errors, 1);
    assert_non_null(strstr(messages.last_error, path));
    if (!strstr(messages.last_error, reason))
        fail_msg("`%s` is not in `%s`", reason, messages.last_error);
}

static inline bool fixture_noted(const char *text)
{
    for (uint32_t i = 0; i < fixture.scene->note_count; i++)
        if (strstr(fixture.scene->notes[i].text, text))
            return true;
    return false;
}

static inline const struct scene_material *material_named(const struct scene *scene,
                                                          const char *name)
{
    for (uint32_t i = 0; i < scene->material_count; ++i) {
        if (strcmp(scene->materials[i].name, name) == 0)
            return &scene->materials[i];
    }
    fail_msg("no material `%s`", name);
    return NULL;
}

#endif
