/* A scene with its trees on a device of its own, ready to draw. Another scene, tree or kernel needs
   another session. Made in any thread, used by one thread at a time. */
#ifndef VIEW_SESSION_H
#define VIEW_SESSION_H

#include <stdatomic.h>

#include "settings/settings.h"

/* Paths of files, each once, malloc'ed. */
struct file_list {
    int64_t since_ns; /* before the first was read, by watch_now_ns */
    char **paths;
    uint32_t count, capacity;
};
void file_list_finish(struct file_list *list);

/* A loaded scene. Several sessions, and whatever shows its names, hold references. */
struct scene_ref {
    atomic_uint refs;
    whit_scene *scene;
    whit_scene_info info;
    struct settings settings; /* settings that it was loaded for */
    struct file_list files;   /* files that it was read from, and missing ones that it names */
};
struct scene_ref *scene_ref_take(struct scene_ref *ref); /* NULL is fine */
void scene_ref_drop(struct scene_ref *ref);              /* NULL is fine */

/* A compiled shader (a user's file). Sessions, and whatever shows its sliders, hold references. */
struct shader_ref {
    atomic_uint refs;
    whit_shader *shader;
    whit_shader_info info;
    struct settings settings; /* settings that it was compiled for */
    int64_t since_ns;         /* before its first file was read, by watch_now_ns */
};
struct shader_ref *shader_ref_take(struct shader_ref *ref); /* NULL is fine */
void shader_ref_drop(struct shader_ref *ref);               /* NULL is fine */
/* The index of the shader's aov `name`; UINT32_MAX: there is none. */
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

/* SESSION_ERROR: room for one line, a file name and a reason of up to 512 bytes each, with line and
   column. SESSION_ERRORS: room for the 32 errors that a shader compiler keeps, for the line "and N
   more errors", and one line to spare. */
enum { SESSION_ERROR = 1100, SESSION_ERRORS = 34 * SESSION_ERROR };

struct session {
    void (*step)(void *user, const whit_step *step); /* gets steps of a picture; or NULL */
    void *step_user;
    struct settings settings;  /* those of its scene, trees and kernel, and of its last picture */
    struct scene_ref *scene;   /* after a failure it may be without `scene` and `info` */
    struct shader_ref *shader; /* NULL: none */
    whit_accel *accel;
    whit_device *device;
    whit_renderer *renderer;
    volatile bool cancel; /* stops what the session is doing */
    bool time_stages;     /* as whit_renderer_params.time_stages */
    whit_log log;         /* log of all its parts */
    void *owner;          /* belongs to the session's maker, as `error` does */
    char error[512];
    char errors[SESSION_ERRORS]; /* all errors of the shader, one a line; "": none */
    /* Folder of a file that the scene names but may not read; "": none. */
    char refused[SETTING_PATH_BYTES];
    bool ready;
    _Atomic(int) stage; /* enum session_stage: what is being made; read by any thread */
    whit_accel_info accel_info;
    whit_device_info device_info;
    double build_ms, compile_ms; /* building trees; compiling, up to the first pixels */
    _Atomic(float) part; /* share of the current picture that is done, 0..1; read by any thread */
    /* Shares of the picture: done before the renderer's current call, and drawn by that call
       (0: all). */
    float part_done, part_share;
    uint64_t last_use;
    /* Number of the engine's job that has made the session, or adapted it to another version of the
       shader. */
    uint64_t made;
};

/* Parts that a session is made from: the scene and the shader of its settings if they are loaded
   already, else NULL; and the compiler of shaders, NULL if there is none. */
struct session_parts {
    struct scene_ref *scene;
    struct shader_ref *shader;
    whit_shader_compiler *compiler;
    bool awaits_version; /* made for the next version of the shader: it draws nothing before */
    bool moves;          /* no step of the picture is wanted, since other pictures are drawn */
};

/* The parameters of a picture with the session's settings, which they borrow. */
whit_renderer_params session_picture(const struct session *session);
/* Loads the scene, builds trees, opens the device and compiles. Errors are logged: those of the
   scene and its trees by `scene_log`, which must live as long as the scene. `session` is zeroed
   except for `cancel` and its owner's fields. Call session_close also after a failure. */
WHIT_CHECK whit_result session_open(struct session *session, const struct settings *settings,
                                    const struct session_parts *parts, const whit_log *log,
                                    const whit_log *scene_log);
/* Adapts a session to another version of the shader. `settings` differ from the session's only in
   what its renderer can change. Compiles that version, and draws the first step of the picture,
   since drivers compile then; session->step gets it. If the view moves, a small picture is drawn
   instead. If the shader is wrong, or no camera can be chosen, the session stays as it was. If its
   kernels cannot be made, the session has no renderer and has to be closed. */
WHIT_CHECK whit_result session_reload(struct session *session, const struct settings *settings,
                                      const struct session_parts *parts);
/* Frees everything. Returns the number of messages that the validation layers had about its
   device. */
uint32_t session_close(struct session *session);

#endif
