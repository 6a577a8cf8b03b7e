/* A scene with trees on a device of its own, ready to draw: what a change of scene, trees or kernel
   needs a new one of. Made in any thread, used by one at a time. */
#ifndef VIEW_SESSION_H
#define VIEW_SESSION_H

#include <stdatomic.h>

#include "settings/settings.h"

/* A loaded scene that several sessions, and whoever shows its names, hold. */
struct scene_ref {
    atomic_uint refs;
    whit_scene *scene;
    whit_scene_info info;
    struct settings settings; /* that it was loaded for */
    double load_ms;
};
struct scene_ref *scene_ref_take(struct scene_ref *ref); /* NULL is fine */
void scene_ref_drop(struct scene_ref *ref);              /* likewise */

/* A compiled file of hooks that sessions, and whoever shows its sliders, hold. */
struct shader_ref {
    atomic_uint refs;
    whit_shader *shader;
    whit_shader_info info;
    struct settings settings; /* that it was compiled for */
    double compile_ms;        /* from GLSL to SPIR-V */
};
struct shader_ref *shader_ref_take(struct shader_ref *ref); /* NULL is fine */
void shader_ref_drop(struct shader_ref *ref);               /* likewise */
/* The index of the function that shows `name` in place of colours; UINT32_MAX: there is none. */
uint32_t shader_ref_find_aov(const struct shader_ref *ref, const char *name);

enum session_stage {
    SESSION_SHADER,
    SESSION_LOADING,
    SESSION_BUILDING,
    SESSION_OPENING,
    SESSION_COMPILING,
    SESSION_DONE,
};
const char *session_stage_name(enum session_stage stage);

/* Room for as many errors of a shader as its compiler keeps, 32, with names and reasons of 512
   bytes. */
enum { SESSION_ERROR = 1100, SESSION_ERRORS = 34 * SESSION_ERROR };

struct session {
    void (*step)(void *user, const whit_step *step); /* of the picture that is drawn; or NULL */
    void *step_user;
    struct settings settings; /* of scene, trees and kernel; of the picture: last drawn */
    struct scene_ref *scene;
    struct shader_ref *shader; /* NULL: none */
    whit_accel *accel;
    whit_device *device;
    whit_renderer *renderer;
    volatile bool cancel; /* stops what it is at */
    whit_log log;         /* of all that the session is made of */
    void *owner;          /* of who made it, as is `error` */
    char error[512];
    char errors[SESSION_ERRORS];      /* all that is wrong with a shader, one a line; else "" */
    char refused[SETTING_PATH_BYTES]; /* folder of a file that the scene names and may not read; "":
                                         none */
    bool ready;
    whit_accel_info accel_info;
    whit_device_info device_info;
    double build_ms, compile_ms; /* of the trees; until the first pixels were there */
    _Atomic(float) part;         /* of the picture that is being drawn, 0..1; from any thread */
    float part_done,
        part_share; /* of it before what the renderer is drawing, and by that; 0: all */
    uint64_t last_use;
    uint64_t made; /* counts up: which of the engine's jobs it was made by, or made anew for another
                      version of the shader */
};

/* How far it is; both may be NULL. Read by other threads while session_open works. */
struct session_progress {
    _Atomic(int) stage; /* enum session_stage */
};

/* What a session is made from: the scene and the shader of its settings, where they are loaded
   already, else NULL; and the compiler of shaders, NULL where there is none. */
struct session_parts {
    struct scene_ref *scene;
    struct shader_ref *shader;
    whit_shader_compiler *compiler;
    bool awaits_version; /* it is to draw with the next version of the shader, and nothing before */
};

/* Loads, builds, opens and compiles. Reasons are logged: those of the scene and its trees by
   `scene_log`, which lives as long as the scene. `session` is zeroed but for `cancel` and what is
   its owner's; session_close ends it, also after a failure. */
WHIT_CHECK whit_result session_open(struct session *session, const struct settings *settings,
                                    const struct session_parts *parts, const whit_log *log,
                                    const whit_log *scene_log, struct session_progress *progress);
/* A session that has drawn with another version of the shader: compiles the one of `settings`,
   which differ from the session's in what its renderer can change, and draws the first step of
   their picture, for which the driver compiles; session->step is given it. Where the shader is
   wrong the session stays as it was; where its kernels cannot be made it has no renderer, and is to
   be closed. */
WHIT_CHECK whit_result session_reload(struct session *session, const struct settings *settings,
                                      const struct session_parts *parts,
                                      struct session_progress *progress);
/* How many messages the validation layers had of its device. */
uint32_t session_close(struct session *session);

#endif
