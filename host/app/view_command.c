/* whit view: the options of `whit render`, on a window. */
#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/commands.h"
#include "app/state_file.h"
#include "view/view.h"

enum view_id {
    ID_FULLSCREEN = PICTURE_ID_END,
    ID_NO_VSYNC,
    ID_BLIT,
    ID_FPS_GOAL,
    ID_FRAMES_SHOWN,
    ID_RECORD,
    ID_REPLAY,
    ID_REMEMBER,
    ID_STATE,
    ID_UI_SCALE,
    ID_SPEND,
};

static const struct setting_value values_remember[] = {{"yes", 1, NULL}, {"no", 0, NULL}, {0}};

static const struct cli_option options[] = {
    PICTURE_OPTION_PLACE,
    {ID_FULLSCREEN, "fullscreen", NULL, "the whole screen", NULL},
    {ID_NO_VSYNC, "no-vsync", NULL, "show pictures as they come, not as the screen does", NULL},
    {ID_BLIT, "blit", NULL, "copy pictures to the window, in place of writing them there", NULL},
    {ID_FPS_GOAL, "fps-goal", "F",
     "pictures a second to hold while something moves, by\n"
     "smaller ones (30)",
     NULL},
    {ID_FRAMES_SHOWN, "frames", "N", "end after N pictures were shown", NULL},
    {ID_RECORD, "record", "FILE", "write down what the user does", NULL},
    {ID_REPLAY, "replay", "FILE", "do what FILE says, and end", NULL},
    {ID_REMEMBER, "remember", NULL,
     "cameras of scenes, from one run to the next (yes; no with\n"
     "--record and --replay)",
     values_remember},
    {ID_STATE, "state", "FILE",
     "options that Ctrl+S saved, one a line; those beside it\n"
     "here come after them",
     NULL},
    {ID_UI_SCALE, "ui-scale", "X", "of text and panels (the monitor's)", NULL},
    {ID_SPEND, "spend", "S",
     "seconds that measuring costs may take, more or less: for\n"
     "--budget-ms and --max-error (20), for the list of P (12)",
     NULL},
    JOB_OPTION_TIME,
    PICTURE_OPTION_SHADING,
    PICTURE_OPTION_CHOICE,
    PICTURE_OPTION_VIEW,
    JOB_OPTION_DEVICE,
    JOB_OPTION_BUILD,
    JOB_OPTION_BUILDING,
    JOB_OPTION_WALKING,
    JOB_OPTION_LOADING,
    {JOB_VALIDATION, "validation", NULL, "run with the Vulkan validation layers", NULL},
    {'q', "quiet", NULL, "no notes, only errors", NULL},
    {0},
};

static const char *const start_hint = "Drag turns the camera, the wheel comes nearer, H lists all "
                                      "keys. Drop a scene here to open it.";

/* What the options say; its strings are borrowed. */
struct view_request {
    struct job job;
    struct render_request picture;
    struct view_params view;
    const char *state;
    double ui_scale;
    uint32_t remember; /* REMEMBER_UNSAID: as it suits */
};
enum { REMEMBER_UNSAID = 2 };
_Static_assert(JOB_ALLOWED_MOST <= (int)VIEW_ALLOWED, "what options name fits into settings");
/* After a signal: the window looks for it four times a second, and keeps the camera. */
enum { GRACE_MS = 1000 };

static void request_init(struct view_request *request)
{
    *request =
        (struct view_request){.picture = picture_request_default(), .remember = REMEMBER_UNSAID};
    job_init(&request->job);
}

/* What a file of settings may say; false where the option is another one. */
static bool read_setting(struct view_request *request, struct cli_reader *reader, int id)
{
    if (job_option(&request->job, reader, id) || picture_option(reader, id, &request->picture))
        return true;
    if (id == ID_FPS_GOAL)
        cli_number(reader, 0.1, 1000.0, &request->view.budget_fps);
    return id == ID_FPS_GOAL;
}

static void read_state_option(void *user, struct cli_reader *reader, int id)
{
    /* What files may reach is not for a file to say. */
    if (id == JOB_ALLOW_PATH || id == JOB_IMPORT_LIMIT || id == JOB_REQUIRE_SANDBOX ||
        id == JOB_MEMORY_LIMIT || !read_setting(user, reader, id))
        cli_misuse(reader, "--%s is nothing to be saved", reader->option->name);
}

static void read_option(struct view_request *request, struct cli_reader *reader, int id)
{
    struct view_params *view = &request->view;
    if (read_setting(request, reader, id))
        return;
    switch (id) {
    case ID_REMEMBER:
        cli_choice_unsigned(reader, &request->remember);
        break;
    case ID_FULLSCREEN:
        view->fullscreen = true;
        break;
    case ID_NO_VSYNC:
        view->no_vsync = true;
        break;
    case ID_BLIT:
        view->blit = true;
        break;
    case ID_FRAMES_SHOWN:
        cli_unsigned(reader, 1, 1000000000, &view->frames);
        break;
    case ID_RECORD:
        view->record = reader->value;
        break;
    case ID_REPLAY:
        view->replay = reader->value;
        break;
    case ID_STATE:
        request->state = reader->value;
        break;
    case ID_SPEND:
        cli_number(reader, 0.1, 1e6, &view->spend_s);
        break;
    case ID_UI_SCALE:
        if (cli_number(reader, 0.25, 8.0, &request->ui_scale))
            view->ui_scale = (float)request->ui_scale;
        break;
    default:
        break;
    }
}

static void read_options(struct view_request *request, struct cli_reader *reader, int argc,
                         char **argv)
{
    cli_reader_init(reader, &command_view, argc, argv);
    for (int id; (id = cli_next(reader)) != 0;)
        read_option(request, reader, id);
    if (!reader->positional && reader->status < 0)
        reader->positional = ""; /* the start scene */
}

/* The settings of a file, whose text is to outlive the request. */
static bool read_state(struct view_request *request, const char *path, struct state_file *file,
                       char *said, size_t said_bytes)
{
    struct cli_reader reader;
    if (!state_file_open(file, path, said, said_bytes) ||
        !state_file_read(file, &command_view, read_state_option, request, &reader, said,
                         said_bytes))
        return false;
    reader.positional = "";
    return job_options_done(&request->job, &reader) &&
           view_check(&reader, &request->picture.view) &&
           picture_check_choice(&reader, &request->picture);
}

/* ---- Settings ---- */

static void copy_text(char *to, size_t bytes, const char *text)
{
    snprintf(to, bytes, "%s", text ? text : "");
}

/* What options say, in the viewer's words. */
static void fill_settings(const struct job *job, const struct render_request *request,
                          struct view_settings *settings)
{
    char build[JOB_BUILD_NAME];
    job_build_name(&job->build, build);
    *settings = (struct view_settings){
        .memory_limit = job->memory_limit,
        .texture_limit = job->texture_limit,
        .validation = job->validation,
        .import_limit_s = job->import_limit_s,
        .require_sandbox = job->require_sandbox,
        .trees = job_accel_params(job),
        .picture = picture_request_params(request, job),
        .paint = request->view.given ? VIEW_PAINT_DEPTH + request->view.view : VIEW_PAINT_COLOR,
        .paint_rays = request->view.rays,
        .paint_scale = request->view.scale,
    };
    copy_text(settings->scene, sizeof settings->scene, job->scene_path);
    for (uint32_t i = 0; i < job->allowed_count; ++i)
        copy_text(settings->allowed[i], sizeof settings->allowed[i], job->allowed[i]);
    copy_text(settings->device, sizeof settings->device, job->device_name);
    copy_text(settings->camera, sizeof settings->camera, request->picture.camera);
    copy_text(settings->effects, sizeof settings->effects, request->effects);
    if (job->has_build)
        copy_text(settings->build, sizeof settings->build, build);
    char *opt = strstr(settings->build, "+opt"); /* stands beside */
    if (opt)
        *opt = '\0';
    whit_renderer_params *p = &settings->picture;
    p->camera = NULL;
    p->effects = NULL;
    p->load_path = NULL;
    p->cancel = NULL;
    p->time_limit_s = 0.0;
}

/* And back, for the recipe of a picture. */
static void fill_request(const struct view_settings *settings, struct job *job,
                         struct render_request *request, const char *path)
{
    const whit_renderer_params *p = &settings->picture;
    job->scene_path = settings->scene;
    job->time_s = p->time_s;
    job->texture_limit = settings->texture_limit;
    for (uint32_t i = 0; i < VIEW_ALLOWED && settings->allowed[i][0]; ++i)
        job->allowed[job->allowed_count++] = settings->allowed[i];
    job->instances = settings->trees.instances;
    job->numerics = p->numerics;
    request->output = path;
    request->picture = (struct picture){
        .width = p->width,
        .height = p->height,
        .camera = settings->camera[0] ? settings->camera : NULL,
        .samples = p->samples,
        .adaptive = p->adaptive,
        .depth = p->depth,
    };
    request->bailout = p->bailout;
    request->shadows = p->shadows;
    request->light_samples = p->light_samples;
    request->schlick = p->schlick;
    request->effects = settings->effects[0] ? settings->effects : NULL;
}

/* view_params.save: the file that `whit render` would have written. */
static whit_result save_shot(void *user, const struct view_shot *shot, const char *path)
{
    struct job job;
    struct render_request request = picture_request_default();
    struct recipe recipe;
    (void)user;
    job_init(&job);
    fill_request(shot->settings, &job, &request, path);
    job.scene = (whit_scene *)(uintptr_t)shot->scene; /* only read */
    if (!recipe_init(&recipe, &job, &request, shot->device, shot->stats))
        return WHIT_ERROR_MEMORY;
    whit_result result = whit_image_save(shot->color, path, recipe.texts, recipe.count, &cli_log);
    recipe_finish(&recipe);
    return result;
}

/* view_params.load_state */
static whit_result load_state(void *user, const char *path, struct view_state *state, char *message,
                              size_t message_bytes)
{
    struct view_request request;
    struct state_file file = {0};
    struct view_settings now = state->settings;
    (void)user;
    request_init(&request);
    bool read = read_state(&request, path, &file, message, message_bytes);
    if (read) {
        request.job.scene_path = now.scene;
        fill_settings(&request.job, &request.picture, &state->settings);
        state->settings.reload = now.reload;
        state->settings.validation = now.validation;
        state->settings.memory_limit = now.memory_limit;
        memcpy(state->settings.allowed, now.allowed, sizeof now.allowed);
        state->settings.import_limit_s = now.import_limit_s;
        state->settings.require_sandbox = now.require_sandbox;
        state->fps_goal = request.view.budget_fps;
    }
    free(file.text);
    return read ? WHIT_OK : WHIT_ERROR_INPUT;
}

/* ---- Scenes ---- */

enum { SCENES_MOST = 512 };

struct scene_list {
    char *paths[SCENES_MOST];
    uint32_t count;
};

static bool is_scene(const char *name)
{
    static const char *const endings[] = {".json", ".obj", ".gltf", ".glb", ".ply", ".stl"};
    size_t length = strlen(name);
    for (size_t i = 0; i < sizeof endings / sizeof *endings; ++i) {
        size_t end = strlen(endings[i]);
        if (length > end && strcmp(name + length - end, endings[i]) == 0)
            return name[0] != '.';
    }
    return false;
}

static int compare_paths(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

/* Scenes and models in a folder, by name. */
static void list_folder(struct scene_list *list, const char *folder)
{
    DIR *dir = opendir(folder[0] ? folder : ".");
    struct dirent *entry;
    while (dir && (entry = readdir(dir)) != NULL && list->count < SCENES_MOST) {
        size_t bytes = strlen(folder) + strlen(entry->d_name) + 1;
        char *path = is_scene(entry->d_name) ? malloc(bytes) : NULL;
        if (!path)
            continue;
        snprintf(path, bytes, "%s%s", folder, entry->d_name);
        list->paths[list->count++] = path;
    }
    if (dir)
        closedir(dir);
    qsort(list->paths, list->count, sizeof *list->paths, compare_paths);
}

static void list_beside(struct scene_list *list, const char *path)
{
    const char *slash = strrchr(path, '/');
    char folder[VIEW_PATH];
    snprintf(folder, sizeof folder, "%.*s", slash ? (int)(slash - path) + 1 : 0, path);
    list_folder(list, folder);
}

static void list_finish(struct scene_list *list)
{
    for (uint32_t i = 0; i < list->count; ++i)
        free(list->paths[i]);
}

/* whit's own scene to begin with: beside the installed program, or where it was built. */
static const char *find_start(char *path, size_t bytes)
{
    char own[VIEW_PATH];
    ssize_t length = readlink("/proc/self/exe", own, sizeof own - 1);
    char *slash = NULL;
    if (length > 0) {
        own[length] = '\0';
        slash = strrchr(own, '/');
    }
    if (slash) {
        *slash = '\0';
        snprintf(path, bytes, "%.900s/../share/whit/scenes/default.json", own);
        if (access(path, R_OK) == 0)
            return path;
    }
    snprintf(path, bytes, "%s/default.json", WHIT_SCENES_DIR);
    return access(path, R_OK) == 0 ? path : NULL;
}

/* ---- The command ---- */

static int work(struct job *job, const struct render_request *request, struct view_params *view)
{
    char start[VIEW_PATH];
    struct scene_list scenes = {0};
    uint32_t validation = 0;
    if (!job->scene_path) {
        job->scene_path = find_start(start, sizeof start);
        view->hint = start_hint;
    }
    if (!job->scene_path) {
        cli_error("name a scene: whit view SCENE");
        return EXIT_USAGE;
    }
    if (strlen(job->scene_path) >= VIEW_PATH) {
        cli_error("%s: the path is too long", job->scene_path);
        return EXIT_USAGE;
    }
    fill_settings(job, request, &view->settings);
    view->wish = (struct view_wish){request->budget_ms, request->max_error};
    list_beside(&scenes, job->scene_path);
    view->scenes = (const char *const *)scenes.paths;
    view->scene_count = scenes.count;
    view->fps = job->fps;
    view->cancel = &cli_cancel;
    view->save = save_shot;
    view->load_state = load_state;
    cli_keep_what_is_done(GRACE_MS);
    cli_set_saving();
    whit_result result = view_run(view, &cli_log, &validation);
    list_finish(&scenes);
    if (result == WHIT_OK && cli_cancel)
        result = WHIT_ERROR_CANCELLED;
    if (result != WHIT_OK)
        return cli_exit_of(result);
    if (validation > 0)
        cli_error("the validation layers had %u messages", validation);
    return validation > 0 ? EXIT_DIFFERS : EXIT_FINE;
}

static int run_with(struct view_request *request, struct cli_reader *reader)
{
    struct job *job = &request->job;
    if (!job_options_done(job, reader) || !view_check(reader, &request->picture.view) ||
        !picture_check_choice(reader, &request->picture))
        return reader->status;
    if (job->scene_path && !job->scene_path[0])
        job->scene_path = NULL;
    struct view_params *view = &request->view;
    bool as_it_suits = request->remember == REMEMBER_UNSAID;
    view->remember = as_it_suits ? !view->record && !view->replay : request->remember == 1;
    int status = work(job, &request->picture, &request->view);
    job_finish(job);
    return status;
}

static int run(const struct cli_command *command, int argc, char **argv)
{
    struct cli_reader reader;
    struct view_request request;
    struct state_file file = {0};
    char said[600];
    (void)command;
    request_init(&request);
    read_options(&request, &reader, argc, argv);
    const char *state = reader.status < 0 ? request.state : NULL;
    if (state) { /* comes first, so that the command line has the last word */
        request_init(&request);
        if (!read_state(&request, state, &file, said, sizeof said)) {
            cli_error("%s", said);
            free(file.text);
            return EXIT_USAGE;
        }
        read_options(&request, &reader, argc, argv);
    }
    int status = run_with(&request, &reader);
    free(file.text);
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
    .run = run,
};
