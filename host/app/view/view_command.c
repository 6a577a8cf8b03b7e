/* `whit view`: takes the options of `whit render` and opens a window. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/arguments.h"
#include "app/commands.h"
#include "app/cost/cost_kept.h"
#include "app/render/layers.h"
#include "app/render/recipe.h"
#include "app/render/repeat.h"
#include "app/view/state_file.h"
#include "base/input.h"
#include "view/view.h"

static const struct setting_value values_remember[] = {{"yes", 1, NULL}, {"no", 0, NULL}, {0}};

static const char *const start_hint = "Drag turns the camera, the wheel comes nearer, H lists all "
                                      "keys. Drop a scene here to open it.";

enum { REMEMBER_UNSAID = 2 };

/* The options; strings are borrowed from the command line. */
struct view_request {
    struct job job;
    struct view_params view;
    const char *state;
    struct repeat repeat;
    double ui_scale;
    uint32_t remember; /* REMEMBER_UNSAID: as it suits */
};

static const struct setting options[] = {
    {"fullscreen", 0, NULL, "the whole screen",
     SETTING_AT_FLAG(struct view_request, view.fullscreen)},
    {"no-vsync", 0, NULL, "show pictures as they come, not as the screen does",
     SETTING_AT_FLAG(struct view_request, view.no_vsync)},
    {"frames", 0, "N", "end after N pictures were shown",
     SETTING_AT_COUNT(struct view_request, view.frames), .min = 1, .max = 1e9},
    {"record", 0, "FILE", "write down what the user does",
     SETTING_AT_NAME(struct view_request, view.record), .written = true},
    {"replay", 0, "FILE", "do what FILE says, and end",
     SETTING_AT_NAME(struct view_request, view.replay)},
    {"remember", 0, NULL,
     "cameras of scenes, from one run to the next (yes; no with\n"
     "--record and --replay)",
     SETTING_AT_CHOICE(struct view_request, remember), .values = values_remember},
    {"state", 0, "FILE",
     "options that Ctrl+S saved, one a line; those beside it\n"
     "here come after them",
     SETTING_AT_NAME(struct view_request, state)},
    REPEAT_OPTIONS(struct view_request, repeat),
    {"ui-scale", 0, "X", "of text and panels (the monitor's)",
     SETTING_AT_NUMBER(struct view_request, ui_scale), .min = 0.25, .max = 8.0},
    {"fresh", 0, NULL,
     "for --budget-ms and --max-error: measure anew what is kept\n"
     "with the scene",
     SETTING_AT_FLAG(struct view_request, view.fresh)},
    {"spend", 0, "S",
     "seconds that measuring costs may take, more or less: for\n"
     "--budget-ms and --max-error (20), for the list of P (12)",
     SETTING_AT_NUMBER(struct view_request, view.spend_s), .min = 0.1, .max = 1e6},
    {"blit", 0, NULL, "is gone: pictures are always copied to the window", .kind = SETTING_GONE},
    {0},
};

/* Time to save the camera after a signal, for which the window looks four times a second. */
enum { GRACE_MS = 1000 };

/* ---- Files of settings ---- */

static bool read_state(struct settings *settings, const char *path, char *said, size_t said_bytes)
{
    struct state_file file;
    bool read = state_file_open(&file, path, said, said_bytes) &&
                state_file_read(&file, &command_view, settings, said, said_bytes);
    free(file.text);
    return read;
}

/* view_params.load_state. The rights of files to read others stay those of the command line. */
static whit_result load_state(void *user, const char *path, struct settings *settings,
                              char *message, size_t message_bytes)
{
    struct settings loaded = settings_usual();
    const struct job *job = user;
    if (!read_state(&loaded, path, message, message_bytes))
        return WHIT_ERROR_INPUT;
    if (loaded.shader[0] && !job->compiler) {
        snprintf(message, message_bytes, "%.300s has --shader: `whit view --state` takes it", path);
        return WHIT_ERROR_INPUT;
    }
    loaded.picture.skip_sliders = settings->picture.skip_sliders;
    loaded.shader_reload = settings->shader_reload;
    for (const struct setting *row = settings_table; row->name; ++row) {
        if (row->trusted)
            setting_copy(row, settings, &loaded);
    }
    memcpy(loaded.scene, settings->scene, sizeof loaded.scene);
    loaded.reload = settings->reload;
    loaded.validation = settings->validation;
    *settings = loaded;
    return WHIT_OK;
}

/* view_params.save: the file that `whit render` would have written. */
static whit_result save_shot(const struct view_shot *shot, const char *path, const whit_log *log)
{
    struct recipe recipe;
    if (!recipe_init(&recipe, shot->settings, shot->scene, shot->shader, shot->device, shot->stats,
                     path, NULL))
        return WHIT_ERROR_MEMORY;
    whit_result result = shot->settings->aov[0]
                             ? layers_save_image(shot->color, path, &recipe, log)
                             : whit_image_save(shot->color, path, recipe.texts, recipe.count, log);
    recipe_finish(&recipe);
    return result;
}

/* view_params.tell */
static void tell(const whit_scene *scene)
{
    job_print_scene_notes(scene, true);
}

/* ---- The command ---- */

/* Finds the scene that opens when none is given: installed beside the program, or in the checkout
   that its build folder lies in. */
static const char *find_start(char *path, size_t bytes)
{
    static const char *const places[] = {"../share/whit/scenes", "../scenes", "../../scenes"};
    char own[SETTING_PATH_BYTES];
    ssize_t length = readlink("/proc/self/exe", own, sizeof own - 1);
    char *slash = NULL;
    if (length > 0) {
        own[length] = '\0';
        slash = strrchr(own, '/');
    }
    for (size_t i = 0; slash && i < sizeof places / sizeof *places; ++i) {
        snprintf(path, bytes, "%.*s/%s/default.json", (int)(slash - own), own, places[i]);
        if (access(path, R_OK) == 0)
            return path;
    }
    return NULL;
}

static int work(struct job *job, struct view_params *view)
{
    char *scene = job->settings.scene;
    uint32_t validation = 0;
    if (!scene[0]) {
        if (!find_start(scene, sizeof job->settings.scene)) {
            cli_error("name a scene: whit view SCENE");
            return EXIT_USAGE;
        }
        view->hint = start_hint;
    }
    view->settings = job->settings;
    view->cancel = &cli_cancel;
    view->end = job->settings.validation ? NULL : cli_end_soon;
    view->tell = job->settings.quiet ? NULL : tell;
    view->save = save_shot;
    view->load_state = load_state;
    view->load_user = job;
    view->load_figures = cost_kept_load_figures;
    view->save_figures = cost_kept_save_figures;
    cli_keep_what_is_done(GRACE_MS);
    cli_set_saving();
    if (settings_compiles(&job->settings)) {
        view->settings.picture.skip_sliders = true; /* the shader's file may have fewer sliders
                                                       after an edit */
        if (job_begin_compiler(job, NULL) != WHIT_OK)
            return EXIT_USAGE;
        view->compiler = job->compiler;
    }
    whit_result result = view_run(view, &cli_log_notes, &validation);
    if (result == WHIT_OK && cli_cancel)
        result = WHIT_ERROR_CANCELLED;
    if (result != WHIT_OK)
        return cli_exit_of(result);
    if (validation > 0)
        cli_error("the validation layers had %u messages", validation);
    return validation > 0 ? EXIT_DIFFERS : EXIT_FINE;
}

/* The file of --state is read first, so that the command line overrides it. */
static bool read_all(struct view_request *request, struct cli_reader *reader, int argc, char **argv)
{
    char said[1024];
    *request = (struct view_request){.remember = REMEMBER_UNSAID};
    job_init(&request->job, &command_view);
    cli_reader_init(reader, &command_view, argc, argv);
    if (!cli_read(reader, request, &request->job.settings))
        return false;
    const char *state = request->state;
    bool repeats = repeat_picture(reader, &request->repeat) != NULL;
    if (repeats && state)
        return cli_misuse(reader, "--state and the recipe of a picture: one of them");
    if (repeats)
        return repeat_read(&request->job, reader, request, &request->repeat, argc, argv);
    job_init(&request->job, &command_view);
    if (state && !read_state(&request->job.settings, state, said, sizeof said)) {
        cli_error("%s", said);
        reader->status = EXIT_USAGE;
        return false;
    }
    request->job.settings.given = 0; /* no conflict where the command line repeats an option of the
                                        file */
    cli_reader_init(reader, &command_view, argc, argv);
    return job_read(&request->job, reader, request, true);
}

static int run(const struct cli_command *command, int argc, char **argv)
{
    struct view_request request;
    struct cli_reader reader;
    (void)command;
    if (!read_all(&request, &reader, argc, argv))
        return reader.status;
    struct view_params *view = &request.view;
    bool as_it_suits = request.remember == REMEMBER_UNSAID;
    view->remember = as_it_suits ? !view->record && !view->replay : request.remember == 1;
    view->ui_scale = (float)request.ui_scale;
    job_start(&request.job);
    int status = work(&request.job, view);
    job_finish(&request.job);
    return status;
}

const struct cli_command command_view = {
    .name = "view",
    .arguments = "[SCENE] [options]",
    .summary = "Shows a scene in a window: turn it, switch how it is drawn, see what that costs.",
    .details =
        "Defaults are in brackets. H in the window lists its keys. Without a display there is\n"
        "`whit render`.\n"
        "A SCENE that cannot be shown is an error at once; one that is dropped later is not.\n"
        "Exit codes: 0 fine, 1 a promise failed, 2 bad usage or input, 3 no device or display,\n"
        "130 interrupted.\n",
    .options = options,
    .settings = IN_VIEW,
    .run = run,
};
