/* `whit shader`: describes and tries a file of functions, prints templates, and extracts functions
   from pictures. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "app/arguments.h"
#include "app/commands.h"
#include "app/shader/attempt.h"
#include "app/shader/extract.h"
#include "base/file.h"
#include "base/text.h"

struct shader_options {
    struct job job;
    const char *dump, *scene, *into;
    bool json;
};

static const struct setting options[] = {
    {"scene", 0, "SCENE",
     "beside which kernels are made, tests run and expectations are\n"
     "held; without one a small scene of whit's own",
     SETTING_AT_NAME(struct shader_options, scene)},
    {"dump", 0, "FOLDER",
     "write the kernels with the file in them there: GLSL with all\n"
     "that it includes, SPIR-V and its text",
     SETTING_AT_NAME(struct shader_options, dump)},
    {"into", 0, "FOLDER",
     "where extract writes to, a folder that is not there yet\n"
     "(called as the picture is)",
     SETTING_AT_NAME(struct shader_options, into)},
    {"json", 0, NULL, "print JSON", SETTING_AT_FLAG(struct shader_options, json)},
    {0},
};

/* ---- new ---- */

static int print_template(struct cli_reader *reader)
{
    char list[256] = "";
    if (!reader->others[0])
        return CLI_MISUSE(reader, "new: which function? `whit shader new shade > my.glsl`");
    unsigned hook = 0;
    for (; hook < WHIT_HOOKS && strcmp(reader->others[0], whit_hook_name((whit_hook)hook)) != 0;
         ++hook)
        snprintf(list + strlen(list), sizeof list - strlen(list), "%s%s", hook ? ", " : "",
                 whit_hook_name((whit_hook)hook));
    if (hook == WHIT_HOOKS)
        return CLI_MISUSE(reader, "new %s: one of %s is needed", reader->others[0], list);
    char *text = whit_shader_template((whit_hook)hook);
    if (!text)
        return cli_exit_of(cli_no_memory());
    fputs(text, stdout);
    whit_memory_destroy(text);
    return cli_finish_stdout(EXIT_FINE);
}

/* ---- A file ---- */

static const char *const kind_words[] = {[WHIT_SLIDER_NUMBER] = "slider",
                                         [WHIT_SLIDER_COLOR] = "color",
                                         [WHIT_SLIDER_TOGGLE] = "toggle",
                                         [WHIT_SLIDER_CHOICE] = "choice"};

static void write_value(const whit_slider *slider, char *text, size_t bytes)
{
    const float *value = slider->value;
    switch (slider->kind) {
    case WHIT_SLIDER_NUMBER:
        snprintf(text, bytes, "%g", (double)value[0]);
        break;
    case WHIT_SLIDER_COLOR:
        snprintf(text, bytes, "#%02x%02x%02x", (unsigned)(value[0] * 255.0f + 0.5f),
                 (unsigned)(value[1] * 255.0f + 0.5f), (unsigned)(value[2] * 255.0f + 0.5f));
        break;
    case WHIT_SLIDER_TOGGLE:
        snprintf(text, bytes, "%s", value[0] != 0.0f ? "on" : "off");
        break;
    case WHIT_SLIDER_CHOICE:
        snprintf(text, bytes, "%s", slider->words[(uint32_t)value[0]]);
    }
}

/* Writes the values that --set takes for the slider: " (1 to 8)" or " (plain, warm)"; nothing for
   colours and toggles. */
static void write_range(const whit_slider *slider, char *text, size_t bytes)
{
    if (slider->kind == WHIT_SLIDER_NUMBER)
        text_add(text, bytes, " (%g to %g)", (double)slider->min, (double)slider->max);
    for (uint32_t i = 0; i < slider->word_count; ++i)
        text_add(text, bytes, "%s%s", i ? ", " : " (", slider->words[i]);
    text_add(text, bytes, "%s", slider->word_count ? ")" : "");
}

static void print_text(const whit_shader *shader, const char *path)
{
    whit_shader_info info;
    const uint32_t *words;
    size_t bytes;
    whit_shader_get_info(shader, &info);
    const char *names[WHIT_HOOKS];
    uint32_t name_count = job_functions(&info, names);
    printf("%s: %u file%s, %s", cli_shown(path), info.file_count, info.file_count == 1 ? "" : "s",
           name_count ? "functions" : "tests alone");
    for (uint32_t i = 0; i < name_count; ++i)
        printf("%s %s", i ? "," : "", names[i]);
    printf("%s\n", info.traces ? "; they trace rays" : "");
    for (uint32_t i = 0; i < info.aov_count; ++i)
        printf("  --aov %s\n", info.aovs[i]);
    for (uint32_t i = 0; i < info.slider_count; ++i) {
        const whit_slider *slider = &info.sliders[i];
        char value[64], range[256] = "";
        write_value(slider, value, sizeof value);
        write_range(slider, range, sizeof range);
        printf("  --set %s=%s%s%s%s\n", slider->name, value, range, slider->help[0] ? "  " : "",
               cli_shown(slider->help));
    }
    printf("  kernels:");
    for (uint32_t i = 0;; ++i) {
        const char *name = whit_shader_kernel(shader, i, &words, &bytes);
        if (!name)
            break;
        printf("%s %s", i ? "," : "", name);
    }
    printf("%s%u instructions with all that they may need\n", info.kernel_count ? "; " : " none, ",
           info.instructions);
    if (info.fuel)
        printf("  fuel: %u iterations of loops in a call\n", info.fuel);
    else
        printf("  trusted: loops and indices are not bounded\n");
}

static json_t *list_texts(const char *const *texts, uint32_t count)
{
    json_t *list = document_array();
    for (uint32_t i = 0; i < count; ++i)
        document_text(document_entry(list), "name", texts[i]);
    return list;
}

static void put_slider(json_t *object, const whit_slider *slider)
{
    char value[64];
    write_value(slider, value, sizeof value);
    document_text(object, "name", slider->name);
    document_text(object, "kind", kind_words[slider->kind]);
    document_text(object, "value", value);
    document_text(object, "help", slider->help);
    if (slider->kind == WHIT_SLIDER_NUMBER) {
        document_float(object, "min", slider->min);
        document_float(object, "max", slider->max);
    }
    if (slider->kind == WHIT_SLIDER_CHOICE)
        document_put(object, "words", list_texts(slider->words, slider->word_count));
}

static json_t *list_kernels(const whit_shader *shader)
{
    const uint32_t *words;
    size_t bytes;
    const char *name;
    json_t *list = document_array();
    for (uint32_t i = 0; (name = whit_shader_kernel(shader, i, &words, &bytes)); ++i) {
        json_t *object = document_entry(list);
        document_text(object, "name", name);
        document_count(object, "spirv_bytes", bytes);
    }
    return list;
}

static int print_json(const whit_shader *shader, const struct attempt *attempt)
{
    whit_shader_info info;
    whit_shader_get_info(shader, &info);
    const char *names[WHIT_HOOKS];
    json_t *object = document_root();
    document_put(object, "files", list_texts(info.files, info.file_count));
    document_put(object, "functions", list_texts(names, job_functions(&info, names)));
    document_put(object, "aovs", list_texts(info.aovs, info.aov_count));
    json_t *sliders = document_list(object, "sliders");
    for (uint32_t i = 0; i < info.slider_count; ++i)
        put_slider(document_entry(sliders), &info.sliders[i]);
    document_put(object, "kernels", list_kernels(shader));
    document_count(object, "instructions", info.instructions);
    document_flag(object, "traces", info.traces);
    document_flag(object, "trusted", info.fuel == 0);
    document_count(object, "fuel", info.fuel);
    document_hash(object, "hash", info.hash);
    attempt_describe(attempt, object);
    return cli_print_json(object);
}

/* Writes FOLDER/NAMEENDING, unless the shader was read from there. */
static whit_result dump_data(const whit_shader *shader, const char *folder, const char *name,
                             const char *ending, const void *data, size_t bytes)
{
    char path[4096];
    whit_shader_info info;
    whit_shader_get_info(shader, &info);
    snprintf(path, sizeof path, "%s/%s%s", folder, name, ending);
    for (uint32_t i = 0; i < info.file_count; ++i) {
        if (cli_same_file(path, info.files[i]))
            return CLI_FAIL(WHIT_ERROR_OUTPUT, "%s: is a file of the shader: --dump another FOLDER",
                            path);
    }
    return file_write_whole(&cli_log, path, data, bytes);
}

/* Writes `text` to a file and frees it. `text` NULL is an error, which is printed here. */
static whit_result dump_text(const whit_shader *shader, const char *folder, const char *name,
                             const char *ending, char *text)
{
    if (!text)
        return CLI_FAIL(WHIT_ERROR_MEMORY, "%s%s: its text cannot be had", name, ending);
    whit_result result = dump_data(shader, folder, name, ending, text, strlen(text));
    whit_memory_destroy(text);
    return result;
}

static whit_result dump_kernel(const whit_shader *shader, uint32_t index, const char *folder,
                               bool *more)
{
    const uint32_t *words;
    size_t bytes;
    const char *name = whit_shader_kernel(shader, index, &words, &bytes);
    *more = name != NULL;
    if (!name)
        return WHIT_OK;
    whit_result result = dump_data(shader, folder, name, ".spv", words, bytes);
    if (result == WHIT_OK)
        result = dump_text(shader, folder, name, ".comp", whit_shader_kernel_text(shader, index));
    if (result == WHIT_OK)
        result = dump_text(shader, folder, name, ".spvasm", whit_spirv_text(words, bytes));
    return result;
}

static whit_result dump(const whit_shader *shader, const char *folder)
{
    whit_result result = WHIT_OK;
    bool more = true;
    if (mkdir(folder, 0777) != 0 && errno != EEXIST)
        return CLI_FAIL(WHIT_ERROR_OUTPUT, "%s: cannot be made: %s", folder, strerror(errno));
    for (uint32_t i = 0; result == WHIT_OK && more; ++i)
        result = dump_kernel(shader, i, folder, &more);
    return result;
}

static int extract(struct cli_reader *reader, const struct shader_options *request)
{
    const char *folders[SETTING_FOLDERS_MAX];
    const whit_load_params params = settings_load(&request->job.settings, folders);
    if (reader->others[0])
        return extract_run(reader->others[0], request->into, &params);
    return CLI_MISUSE(reader, "extract: out of which picture? `whit shader extract toon.png`");
}

/* Tries the compiled shader on the device and prints what was found, before any later error. --dump
   comes last, so that it includes the tests' kernel. */
static int examine(struct job *job, const struct shader_options *request, const char *path)
{
    struct attempt attempt = {0};
    whit_result result = attempt_make(job, request->scene, &attempt);
    int status = cli_exit_of(result);
    if (result == WHIT_OK && request->json)
        status = print_json(job->shader, &attempt);
    if (result == WHIT_OK && !request->json) {
        print_text(job->shader, path);
        attempt_print(&attempt);
        status = cli_finish_stdout(EXIT_FINE);
    }
    if (result == WHIT_OK)
        attempt_say(&attempt);
    if (status == EXIT_FINE)
        status = attempt_status(&attempt);
    attempt_finish(&attempt);
    if (request->dump && dump(job->shader, request->dump) != WHIT_OK)
        status = EXIT_USAGE;
    return status == EXIT_FINE ? job_check_validation(job) : status;
}

static int run(const struct cli_command *command, int argc, char **argv)
{
    struct cli_reader reader;
    struct shader_options request = {0};
    struct job *job = &request.job;
    char why[SETTING_WHY_BYTES];
    job_init(job, command);
    cli_reader_init(&reader, command, argc, argv);
    if (!cli_read(&reader, &request, &job->settings))
        return reader.status;
    if (reader.positional && strcmp(reader.positional, "new") == 0)
        return print_template(&reader);
    if (reader.positional && strcmp(reader.positional, "extract") == 0)
        return extract(&reader, &request);
    if (request.into)
        return CLI_MISUSE(&reader, "--into is for `whit shader extract PICTURE`");
    if (!reader.positional || reader.others[0])
        return CLI_MISUSE(&reader,
                          "one FILE is needed, or `new` and the name of a function, or `extract` "
                          "and a picture");
    if (!settings_read(settings_row("shader"), reader.positional, &job->settings, why))
        return CLI_MISUSE(&reader, "FILE%s", why);
    whit_result result = job_load_shader(job);
    int status =
        result == WHIT_OK ? examine(job, &request, reader.positional) : cli_exit_of(result);
    job_finish(job);
    return status;
}

const struct cli_command command_shader = {
    .name = "shader",
    .arguments = "FILE | new FUNCTION | extract PICTURE [options]",
    .summary = "Compiles a file of shader functions, runs its tests, begins one, or takes it out "
               "of a picture.",
    .details =
        "Functions: camera, surface, shade, scatter, miss, post, intersect, and those below\n"
        "`//@ aov NAME` (new aov). See docs/shaders.md.\n"
        "Tests (`//@ test`) run for 4,096 seeds each; what the file expects (`//@ expect`) is\n"
        "held against a picture without it.\n"
        "Exit codes: 0 fine, 1 a test, an expectation or the fuel of a loop, 2 it does not\n"
        "compile: FILE:LINE says where, 3 no device for tests.\n",
    .options = options,
    .settings = IN_SHADER,
    .others_max = 1,
    .run = run,
};
