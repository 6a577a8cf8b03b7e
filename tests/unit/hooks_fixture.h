/* A device that keeps its kernels, the compiler of users' files, and a scene that is drawn with
 * their functions. */
#ifndef HOOKS_FIXTURE_H
#define HOOKS_FIXTURE_H

#include "unit.h"
#include "whit.h"
#include "whit_program.h"

static whit_device *device;
static whit_shader_compiler *compiler;
static whit_scene *scene;
static whit_accel *accel;
static char logged[4096], warned[4096]; /* the last error, the last warning */

static inline void keep_message(void *user, whit_log_level level, const char *message)
{
    (void)user;
    if (level == WHIT_LOG_ERROR)
        snprintf(logged, sizeof logged, "%s", message);
    else
        snprintf(warned, sizeof warned, "%s", message);
}

static const whit_log keeps = {.fn = keep_message, .level = WHIT_LOG_WARNING};

/* `path`: of the scene; NULL: none. */
static inline bool hooks_begin(const char *path)
{
    bool fine = whit_shader_compiler_create(NULL, &keeps, &compiler) == WHIT_OK &&
                whit_device_create(NULL, &keeps, &device) == WHIT_OK &&
                (!path || (whit_scene_load(path, NULL, &keeps, &scene) == WHIT_OK &&
                           whit_accel_create(scene, NULL, &accel) == WHIT_OK));
    if (fine)
        whit_device_keep_kernels(device);
    else
        print_error("%s\n", logged);
    return fine;
}

static inline void hooks_end(void)
{
    whit_accel_destroy(accel);
    whit_scene_destroy(scene);
    whit_device_destroy(device);
    whit_shader_compiler_destroy(compiler);
}

/* Setup and teardown of tests that load scenes of their own. */
static inline int hooks_setup(void **state)
{
    (void)state;
    return hooks_begin(NULL) ? 0 : -1;
}

static inline int hooks_teardown(void **state)
{
    (void)state;
    hooks_end();
    return 0;
}

/* From a file of `text`, which is gone afterwards. */
static inline whit_result hooks_load(const char *text, whit_shader **shader)
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

#endif
