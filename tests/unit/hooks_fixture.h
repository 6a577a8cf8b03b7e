/* The compiler of users' files, and a scene that is drawn with their functions. */
#ifndef HOOKS_FIXTURE_H
#define HOOKS_FIXTURE_H

#include "scene_fixture.h"

static whit_shader_compiler *compiler;

static inline int hooks_begin(void **state)
{
    assert_int_equal(whit_shader_compiler_create(NULL, &warnings_log, &compiler), WHIT_OK);
    return device_begin(state);
}

/* The same with the default scene. */
static inline int hooks_begin_default(void **state)
{
    hooks_begin(state);
    scene_open(WHIT_SCENES_DIR "/default.json");
    return 0;
}

static inline int hooks_end(void **state)
{
    device_end(state);
    whit_shader_compiler_destroy(compiler);
    return 0;
}

static inline void drop_shader(whit_shader **at)
{
    whit_shader_destroy(*at);
}

/* Freed at the end of its block; a renderer with these functions is declared after them, or freed
   before. */
#define own_whit_shader __attribute__((cleanup(drop_shader), unused)) whit_shader

/* Loads functions from a temporary file with this text. */
static inline whit_result hooks_try(const char *text, whit_shader **shader)
{
    char path[] = "/tmp/whit_hooks_XXXXXX";
    int file = mkstemp(path);
    FILE *stream = file >= 0 ? fdopen(file, "w") : NULL;
    if (!stream || fputs(text, stream) < 0 || fclose(stream) != 0)
        return WHIT_ERROR_OUTPUT;
    whit_result result = whit_shader_load(compiler, path, false, shader);
    remove(path);
    return result;
}

/* Fails with what was logged. */
static inline whit_shader *hooks_load(const char *text)
{
    whit_shader *shader = NULL;
    if (hooks_try(text, &shader) != WHIT_OK)
        fail_msg("%s\n%s", text, messages.last_error);
    return shader;
}

/* The bit of an effect. */
static inline uint64_t effect(const char *name)
{
    for (uint32_t i = 0; whit_effect_name(i); ++i) {
        if (strcmp(whit_effect_name(i), name) == 0)
            return UINT64_C(1) << i;
    }
    fail_msg("no effect %s", name);
    return 0;
}

static inline uint64_t effects_compiled(const whit_renderer *renderer)
{
    uint64_t bits = 0;
    for (uint32_t i = 0; whit_effect_name(i); ++i)
        bits |= (uint64_t)whit_renderer_compiles(renderer, i) << i;
    return bits;
}

#endif
