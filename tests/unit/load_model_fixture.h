/* A folder of small files, and a scene to load them into. */
#ifndef LOAD_MODEL_FIXTURE_H
#define LOAD_MODEL_FIXTURE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/array.h"
#include "load/model.h"

enum { FIXTURE_FILES = 16 };

struct fixture {
    char folder[32];
    char *files[FIXTURE_FILES];
    uint32_t file_count, errors;
    char last_error[600];
    whit_log log;
    struct scene *scene;
};

static inline void fixture_hear(void *user, whit_log_level level, const char *message)
{
    struct fixture *fixture = user;
    if (level != WHIT_LOG_ERROR)
        return;
    fixture->errors++;
    snprintf(fixture->last_error, sizeof fixture->last_error, "%s", message);
}

static inline int fixture_begin(void **state)
{
    struct fixture *fixture = calloc(1, sizeof *fixture);
    if (!fixture)
        return -1;
    strcpy(fixture->folder, "/tmp/whit-model-XXXXXX");
    fixture->log = (whit_log){.fn = fixture_hear, .user = fixture, .level = WHIT_LOG_INFO};
    fixture->scene = scene_create(&fixture->log, "test");
    *state = fixture;
    if (!mkdtemp(fixture->folder) || !fixture->scene)
        return -1;
    return roots_allow(&fixture->log, &fixture->scene->roots, fixture->folder) == WHIT_OK ? 0 : -1;
}

/* Removes the files that it has written. */
static inline void fixture_forget(struct fixture *fixture)
{
    for (uint32_t i = 0; i < fixture->file_count; i++) {
        unlink(fixture->files[i]);
        free(fixture->files[i]);
    }
    fixture->file_count = 0;
}

static inline int fixture_end(void **state)
{
    struct fixture *fixture = *state;
    fixture_forget(fixture);
    scene_destroy(fixture->scene);
    int result = rmdir(fixture->folder);
    free(fixture);
    return result;
}

/* The path of a new file; owned by the fixture, which removes it. */
static inline const char *fixture_write(struct fixture *fixture, const char *name, const void *data,
                                        size_t size_bytes)
{
    char *path = string_format("%s/%s", fixture->folder, name);
    assert_non_null(path);
    assert_true(fixture->file_count < FIXTURE_FILES);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(data, 1, size_bytes, file), size_bytes);
    assert_int_equal(fclose(file), 0);
    fixture->files[fixture->file_count++] = path;
    return path;
}

static inline const char *fixture_text(struct fixture *fixture, const char *name, const char *text)
{
    return fixture_write(fixture, name, text, strlen(text));
}

static inline whit_result fixture_load(struct fixture *fixture, const char *path)
{
    return load_model(fixture->scene, path, SCENE_NONE, true, true, NULL);
}

/* Loading fails with one error, which names the file and holds `reason`. */
static inline void fixture_refused(struct fixture *fixture, const char *path, const char *reason)
{
    assert_int_equal(fixture_load(fixture, path), WHIT_ERROR_INPUT);
    assert_int_equal(fixture->errors, 1);
    assert_non_null(strstr(fixture->last_error, path));
    if (!strstr(fixture->last_error, reason))
        fail_msg("`%s` is not in `%s`", reason, fixture->last_error);
}

static inline bool fixture_noted(const struct fixture *fixture, const char *text)
{
    for (uint32_t i = 0; i < fixture->scene->note_count; i++)
        if (strstr(fixture->scene->notes[i].text, text))
            return true;
    return false;
}

#endif
