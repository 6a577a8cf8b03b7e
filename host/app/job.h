/* A scene that is loaded, built and traced on a device: what `render` and `trace` share. */
#ifndef APP_JOB_H
#define APP_JOB_H

#include "app/arguments.h"
#include "whit/whit_program.h"

struct job {
    struct settings settings;
    whit_scene *scene;
    whit_accel *accel;
    whit_device *device;
    whit_device_opening *opening;
    whit_shader_compiler *compiler; /* of --shader */
    whit_shader *shader;
    uint64_t recipe_hash;  /* of the scene, as a picture's recipe says; 0: nothing does */
    char recipe_part[512]; /* which part of a picture it was drawn as, likewise; "": the whole */
    bool keeps_axes;       /* `--up auto` turns no model: see job_load */
    const whit_log *log;   /* of the device; NULL: cli_log */
    double start_ms, load_ms, accel_ms, device_ms; /* of the device: that the program waited */
};

/* With the settings that are usual for the command. */
void job_init(struct job *job, const struct cli_command *command);
/* Reads all options, checks settings against each other, and takes the first argument for the
   scene, which need not be there where `optional`. */
bool job_read(struct job *job, struct cli_reader *reader, void *own, bool optional);
/* Prepares the caches and starts the clock of --time-limit. */
void job_start(const struct job *job);

/* Starts to open the device in a thread, for job_open_device to wait for; what fails is said
   there, and nowhere if the program ends before. */
void job_begin_device(struct job *job);
/* The process that compiles shaders, which logs to `log`; NULL: nothing. */
WHIT_CHECK whit_result job_begin_compiler(struct job *job, const whit_log *log);
/* Compiles the file of --shader and the stages of --stages, where there are any, by the job's
   compiler, which begins unless it has. Before anything else is loaded: the compiler's process has
   the memory that the program has then. */
WHIT_CHECK whit_result job_load_shader(struct job *job);
/* Each step before the next one. Failures were said. */
whit_result job_load(struct job *job);
/* Fits the settings to the job's scene, which was loaded before: what job_load does behind it. */
WHIT_CHECK whit_result job_take_scene(struct job *job);
whit_result job_build(struct job *job);
whit_result job_open_device(struct job *job);
/* Whether nobody has stopped the program, and its time limit has not passed. */
whit_result job_still_wanted(void);
/* Prints the notes of the scene: warnings, and with `all` what was added as well. */
void job_print_notes(const struct job *job, bool all);
/* Names of the functions that a shader stands in for; gives their number. */
uint32_t job_functions(const whit_shader_info *shader, const char *names[WHIT_HOOKS]);
/* A renderer's params for the settings, within what is left of the time limit; borrows them. */
whit_renderer_params job_picture(const struct job *job);
/* EXIT_DIFFERS when the validation layers had anything to say. */
int job_check_validation(const struct job *job);
void job_finish(struct job *job);

#endif
