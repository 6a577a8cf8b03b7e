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
    whit_shader_compiler *compiler; /* for --shader */
    whit_shader *shader;
    uint64_t recipe_hash;  /* hash of the scene in the recipe of the picture that is repeated; 0:
                              none */
    char recipe_part[512]; /* the PART_KEY text in that recipe: which part of a picture it is; "": a
                              whole picture */
    bool keeps_axes;       /* `--up auto` does not turn a model: see job_load */
    const whit_log *log;   /* log of the device; NULL: cli_log */
    double start_ms, load_ms, accel_ms, device_ms; /* device_ms: how long the program waited for the
                                                      device */
};

/* Sets the job's settings to the defaults of the command. */
void job_init(struct job *job, const struct cli_command *command);
/* Reads all options, checks that settings go together, and takes the first argument as the scene;
   `optional`: it may be missing. job_check: only does the latter, where options were read. */
bool job_read(struct job *job, struct cli_reader *reader, void *own, bool optional);
bool job_check(struct job *job, struct cli_reader *reader, bool optional);
/* Prepares caches and drivers by environment variables, of which those that are set stay as they
   are, and starts the clock of --time-limit. Call it before threads are started and before
   Vulkan. */
void job_start(const struct job *job);

/* Whether there is a device that whit can use. */
bool job_any_device(void);
/* Starts to open the device in a thread, for which job_open_device waits. Errors are printed there,
   and not at all if the program ends before. */
void job_begin_device(struct job *job);
/* Starts the process that compiles shaders, which logs to `log`; NULL: it logs nothing. */
WHIT_CHECK whit_result job_begin_compiler(struct job *job, const whit_log *log);
/* Compiles the file of --shader and the stages of --stages, if given, by the job's compiler, which
   is started if it is not running. Call it before anything else is loaded: the compiler's process
   is forked with the memory that the program has then. */
WHIT_CHECK whit_result job_load_shader(struct job *job);
/* The steps of a job, to be called in this order. Errors were printed. */
whit_result job_load(struct job *job);
/* Fits the settings to the job's scene where it was loaded before; job_load does this itself. */
WHIT_CHECK whit_result job_take_scene(struct job *job);
whit_result job_build(struct job *job);
whit_result job_open_device(struct job *job);
/* WHIT_OK unless the user has stopped the program or its time limit has passed. */
whit_result job_still_wanted(void);
/* Prints the notes of the scene: warnings, and with `all` also notes on what whit added. The first
   function prints nothing where --quiet is given. */
void job_print_notes(const struct job *job, bool all);
void job_print_scene_notes(const whit_scene *scene, bool all);
/* The information on a shader; zeroed for NULL. */
whit_shader_info job_shader_info(const whit_shader *shader);
/* Writes the names of the functions that a shader replaces; gives their number. */
uint32_t job_functions(const whit_shader_info *shader, const char *names[WHIT_HOOKS]);
/* The renderer params for the job's settings, with the rest of the time limit; they borrow from the
   job. */
whit_renderer_params job_picture(const struct job *job);
/* EXIT_DIFFERS where the validation layers reported anything. */
int job_check_validation(const struct job *job);
void job_finish(struct job *job);

#endif
