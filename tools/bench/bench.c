/* whit-bench: all benches in one program, by which `whit bench` replaces its process. */
#define _GNU_SOURCE
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "app/arguments.h"
#include "base/file.h"
#include "bench/process.h"
#include "whit/whit_program.h"

static whit_result (*const benches[BENCH_COUNT])(struct bench *) = {
    [BENCH_REPORT] = bench_report,   [BENCH_BUILD] = bench_build, [BENCH_VIEW] = bench_view,
    [BENCH_RAYS] = bench_rays,       [BENCH_FRAME] = bench_frame, [BENCH_START] = bench_start,
    [BENCH_SHADERS] = bench_shaders, [BENCH_VIEWS] = bench_views, [BENCH_LOOK] = bench_look,
};

/* ---- What benches share ---- */

whit_result bench_step(struct bench *bench)
{
    ++bench->step;
    cli_progress_update(&bench->progress, (double)bench->step / bench->step_count);
    return cli_cancel ? WHIT_ERROR_CANCELLED : WHIT_OK;
}

void bench_file(const struct bench *bench, const char *name, char path[BENCH_PATH])
{
    snprintf(path, BENCH_PATH, "%.2000s/%.150s", bench->folder, name);
}

whit_result bench_write(const struct bench *bench, const char *name, const void *data, size_t bytes)
{
    char path[BENCH_PATH];
    bench_file(bench, name, path);
    return file_write_whole(&cli_log, path, data, bytes);
}

static bool find_file(const char *name, char path[BENCH_PATH])
{
    char *whole = realpath(name, NULL);
    if (whole)
        snprintf(path, BENCH_PATH, "%s", whole);
    free(whole);
    return whole != NULL;
}

bool bench_find_beside(const struct bench *bench, const char *name, char path[BENCH_PATH])
{
    /* Places relative to the program, for a build and an installation. */
    static const char *const beside[] = {"../scenes", "../../scenes", "../share/whit/scenes"};
    const char *slash = strrchr(bench->whit, '/');
    char file[BENCH_PATH];
    snprintf(file, sizeof file, "%s/%s", bench->ask.scenes ? bench->ask.scenes : "scenes", name);
    bool found = find_file(file, path);
    for (size_t i = 0; !found && slash && !bench->ask.scenes && i < 3; ++i) {
        snprintf(file, sizeof file, "%.*s/%s/%s", (int)(slash - bench->whit), bench->whit,
                 beside[i], name);
        found = find_file(file, path);
    }
    return found;
}

whit_result bench_find(const struct bench *bench, const char *name, char path[BENCH_PATH])
{
    bool is_file = strpbrk(name, "/.") != NULL;
    char file[BENCH_PATH];
    snprintf(file, sizeof file, "%s.json", name);
    if (is_file ? find_file(name, path) : bench_find_beside(bench, file, path))
        return WHIT_OK;
    if (is_file)
        cli_error("%s: is not there", cli_shown(name));
    else if (bench->ask.scenes)
        cli_error("%s/%s: cannot read: %s", bench->ask.scenes, file, strerror(errno));
    else
        cli_error("%s is not here: --scenes FOLDER says where whit's scenes are", file);
    return WHIT_ERROR_INPUT;
}

whit_result bench_look_for(const struct bench *bench)
{
    for (uint32_t i = 0; i < bench->ask.name_count; ++i) {
        const char *path = bench->ask.names[i];
        if (access(path, R_OK) != 0)
            return CLI_FAIL(WHIT_ERROR_INPUT, "%s: cannot read: %s", path, strerror(errno));
    }
    return WHIT_OK;
}

whit_result bench_load(const char *path, struct bench_scene *scene)
{
    const whit_load_params params = {.cancel = &cli_cancel};
    whit_result result = whit_scene_load(path, &params, &cli_log_errors, &scene->scene);
    if (result == WHIT_OK)
        whit_scene_get_info(scene->scene, &scene->info);
    return result == WHIT_OK && cli_cancel ? WHIT_ERROR_CANCELLED : result;
}

whit_result bench_load_trees(const char *path, struct bench_scene *scene)
{
    whit_result result = bench_load(path, scene);
    return result == WHIT_OK ? whit_accel_create(scene->scene, NULL, &scene->accel) : result;
}

void bench_unload(struct bench_scene *scene)
{
    whit_accel_destroy(scene->accel);
    whit_scene_destroy(scene->scene);
    *scene = (struct bench_scene){0};
}

/* ---- The program ---- */

static whit_result make_folder(struct bench *bench)
{
    const char *scratch = getenv("TMPDIR"), *keep = bench->ask.keep;
    if (keep)
        snprintf(bench->folder, sizeof bench->folder, "%s", keep);
    else
        snprintf(bench->folder, sizeof bench->folder, "%.480s/whit-bench-XXXXXX",
                 scratch && scratch[0] ? scratch : "/tmp");
    bool is_there =
        keep ? mkdir(keep, 0777) == 0 || errno == EEXIST : mkdtemp(bench->folder) != NULL;
    if (!is_there)
        cli_error("%s: cannot be made: %s", bench->folder, strerror(errno));
    return is_there ? WHIT_OK : WHIT_ERROR_OUTPUT;
}

static whit_result write_json(struct bench *bench)
{
    const struct bench_request *ask = &bench->ask;
    json_t *root = document_root();
    document_text(root, "bench", bench_kinds[ask->which].name);
    json_t *device = document_child(root, "device");
    document_text(device, "name", bench->device_info.name);
    document_text(device, "driver", bench->device_info.driver);
    json_t *settings = document_child(root, "settings");
    document_flag(settings, "quick", ask->quick);
    document_count(settings, "width", ask->width);
    document_count(settings, "height", ask->height);
    if (bench_kinds[ask->which].is_single) {
        document_count(settings, "samples", 1);
        document_count(settings, "depth", 0);
    }
    document_count(settings, "runs", ask->runs);
    document_put(root, "tables", json_incref(bench->tables));
    return document_save_text(document_line(root), ask->json);
}

static int work(struct bench *bench)
{
    const whit_device_params params = settings_device(&bench->ask.settings);
    whit_result result = make_folder(bench);
    if (result != WHIT_OK)
        return cli_exit_of(result);
    cli_keep_what_is_done(BENCH_GRACE_MS);
    bench->tables = document_array();
    result = whit_device_create(&params, &cli_log, &bench->device);
    if (result == WHIT_OK) {
        whit_device_get_info(bench->device, &bench->device_info);
        bench->is_cpu = bench->device_info.kind == WHIT_DEVICE_CPU;
        result = benches[bench->ask.which](bench);
    }
    if (bench->ask.json && (result == WHIT_OK || json_array_size(bench->tables) > 0)) {
        whit_result written = write_json(bench);
        result = result == WHIT_OK ? written : result;
    }
    json_decref(bench->tables);
    whit_device_destroy(bench->device);
    if (!bench->ask.keep)
        process_remove_folder(bench->folder);
    return result == WHIT_OK ? cli_finish_stdout(EXIT_FINE) : cli_exit_of(result);
}

int main(int argc, char **argv)
{
    static const struct cli_command command = {.name = "bench",
                                               .arguments = "[BENCH]",
                                               .others_max = CLI_OTHERS_MAX,
                                               .options = bench_options,
                                               .settings = IN_BENCH};
    static struct bench bench;
    struct cli_reader reader;
    if (argc < 4)
        return CLI_FAIL(EXIT_USAGE, "whit-bench is called by `whit bench BENCH`");
    cli_catch_interrupts();
    bench.whit = argv[1];
    cli_reader_init(&reader, &command, argc - 2, argv + 2);
    if (!bench_read(&reader, &bench.ask))
        return reader.status;
    return work(&bench);
}
