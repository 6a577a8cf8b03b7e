/* `whit bench rays`: whit's kernels beside Embree's, on the same ray files. */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "rays.h"

enum { LARGE = 200000 }; /* triangles: above it the second goal counts */

/* The goals for each kind of rays: for small models, and for large ones. */
static const struct goal goals[RAYS_KINDS][2] = {
    [RAYS_CAMERA] = {{2.0, 3.5, true}, {0.8, 1.2, true}},
    [RAYS_SHADOW] = {{1.5, 2.5, true}, {0.6, 1.0, true}},
    [RAYS_BOUNCE] = {{0.6, 0.75, true}, {0.45, 0.6, true}},
};

/* ---- Rows ---- */

static void put_ns(const struct model *model, const struct sample_runs *times)
{
    struct table *table = &model->figures->section.table;
    if (times->count == 0 || model->count == 0)
        table_cell(table, "-");
    else
        table_cell(table, "%.*f", model->is_cpu ? 1 : 3,
                   sample_of(times).median * 1e6 / (double)model->count);
}

static json_t *row_document(const struct model *model, uint32_t kind, const struct batch *batches,
                            const struct agreement *agreement)
{
    static const char *const keys[] = {"whit_ms", "single_ms", "packets_ms", "stream_ms"};
    json_t *row = document_object(), *hits = document_object();
    document_text(row, "model", model->name);
    document_text(row, "rays", rays_kind_names[kind]);
    document_count(row, "triangles", model->loaded.info.triangle_count);
    document_count(row, "count", model->count);
    for (uint32_t order = 0; order < 2; ++order) {
        json_t *times = document_object();
        for (uint32_t side = 0; side < RAYS_BACK; ++side) {
            const struct sample_runs *of =
                side ? batch_quicker(&batches[order], (enum rays_side)side)
                     : &batches[order].sides[0];
            if (of->count)
                document_put(times, keys[side], figures_times(of));
        }
        document_put(row, order ? "shuffled" : "tiles", times);
    }
    document_count(hits, "compared", agreement->rays);
    document_count(hits, "met_by_one_alone", agreement->one_alone);
    document_count(hits, "other_ids", agreement->other_ids);
    document_count(hits, "other_t", agreement->other_t);
    document_put(row, "hits", hits);
    return row;
}

static void put_row(const struct model *model, uint32_t kind, const struct batch *batches,
                    const struct agreement *agreement)
{
    struct table *table = &model->figures->section.table;
    struct figure figure = {.unit = ""};
    const struct batch *tiles = &batches[0], *shuffled = &batches[1];
    struct sample_runs ratio =
        sample_ratio(batch_quicker(tiles, RAYS_SINGLE), &tiles->sides[RAYS_WHIT]);
    struct sample_runs other =
        sample_ratio(batch_quicker(shuffled, RAYS_SINGLE), &shuffled->sides[RAYS_WHIT]);
    snprintf(figure.name, sizeof figure.name, "%s, %s", model->name, rays_kind_names[kind]);
    if (ratio.count) {
        figure.value = sample_of(&ratio).median;
        figure.spread = sample_of(&ratio).spread;
        figure.goal = goals[kind][model->loaded.info.triangle_count > LARGE];
    } else {
        figure.value = NAN;
    }
    table_row(table);
    table_cell(table, "%s, %llu", model->name,
               (unsigned long long)model->loaded.info.triangle_count);
    table_cell(table, "%s", rays_kind_names[kind]);
    put_ns(model, &tiles->sides[RAYS_WHIT]);
    for (int side = RAYS_SINGLE; side < RAYS_BACK; ++side)
        put_ns(model, batch_quicker(tiles, (enum rays_side)side));
    table_cell(table, other.count ? "%.2f" : "-", sample_of(&other).median);
    figures_row(model->figures, &figure, row_document(model, kind, batches, agreement));
    if (agreement->one_alone + agreement->other_t > 0)
        section_say(&model->figures->section,
                    "%s: of %llu rays whit or Embree alone meets something on %llu, and t differs "
                    "on %llu.",
                    figure.name, (unsigned long long)agreement->rays,
                    (unsigned long long)agreement->one_alone,
                    (unsigned long long)agreement->other_t);
}

static whit_result run_kind(struct model *model, uint32_t kind)
{
    struct batch batches[2] = {0};
    struct agreement agreement = {0};
    whit_result result = WHIT_OK;
    for (uint32_t order = 0; result == WHIT_OK && order < 2; ++order)
        result = batch_run(model, &batches[order], (enum rays_kind)kind, order == 1, &agreement);
    if (result == WHIT_OK)
        put_row(model, kind, batches, &agreement);
    return result;
}

/* ---- Models ---- */

/* Names a model after the file of `path`, without its extension; letters that may be no part of a
   file name everywhere become `_`. */
static void name_model(struct model *model, const char *path)
{
    const char *slash = strrchr(path, '/'), *from = slash ? slash + 1 : path;
    size_t length = 0;
    for (;
         from[length] && strcmp(from + length, strrchr(from, '.') ? strrchr(from, '.') : "") != 0 &&
         length + 1 < sizeof model->name;
         ++length) {
        char c = from[length];
        bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        model->name[length] = plain || c == '-' ? c : '_';
    }
    model->name[length] = 0;
}

static whit_result prepare(struct model *model, const char *path)
{
    const struct bench *bench = model->bench;
    const whit_renderer_params params = {.width = 16, .height = 16, .cancel = &cli_cancel};
    name_model(model, path);
    whit_result result = bench_load_file(path, &model->loaded);
    if (result == WHIT_OK && model->loaded.info.triangle_count == 0) {
        cli_error("%s: has no triangles, which rays could meet", path);
        return WHIT_ERROR_INPUT;
    }
    if (result == WHIT_OK)
        result = whit_accel_create(model->loaded.scene, NULL, &model->accel);
    if (result == WHIT_OK)
        result = whit_renderer_create(bench->device, model->accel, &params, &model->renderer);
    if (result == WHIT_OK)
        result = study_camera_rays(model->loaded.scene, bench->width, bench->height, true,
                                   &model->camera);
    if (result != WHIT_OK)
        return result;
    size_t count = model->camera.count;
    model->hits = malloc(count * sizeof *model->hits);
    model->traced = malloc(count * sizeof *model->traced);
    model->rays = malloc(count * sizeof *model->rays);
    if (model->hits && model->traced && model->rays)
        return whit_trace(model->renderer, WHIT_TRACE_DEVICE, model->camera.rays, count, false,
                          model->hits, NULL);
    cli_error("out of memory");
    return WHIT_ERROR_MEMORY;
}

static whit_result begin_peer(struct model *model)
{
    char name[96];
    if (!peer_is_here())
        return WHIT_OK;
    if (model->loaded.info.sphere_count) {
        figures_leave_out(model->figures, "Embree", "its side has triangles alone, not spheres");
        return WHIT_OK;
    }
    snprintf(name, sizeof name, "%s.triangles", model->name);
    whit_result result = peer_write_triangles(model->loaded.scene, model->folder, name);
    model->has_peer = result == WHIT_OK;
    if (result == WHIT_OK)
        result = peer_begin(&model->peer, model->folder, name);
    if (result == WHIT_OK && model->figures->count == 0)
        section_say(&model->figures->section, "Beside Embree %s.", model->peer.version);
    return result;
}

static whit_result run_model(struct figures *figures, const char *path, const char *folder)
{
    struct bench *bench = figures->section.bench;
    struct model *model = calloc(1, sizeof *model);
    if (!model)
        return WHIT_ERROR_MEMORY;
    *model = (struct model){.bench = bench,
                            .figures = figures,
                            .peer = {.socket = -1},
                            .is_cpu = strcmp(bench->device_info.kind, "cpu") == 0};
    snprintf(model->folder, sizeof model->folder, "%s", folder);
    whit_result result = prepare(model, path);
    if (result == WHIT_OK)
        result = begin_peer(model);
    for (uint32_t kind = 0; result == WHIT_OK && kind < RAYS_KINDS; ++kind)
        result = run_kind(model, kind);
    peer_end(&model->peer);
    whit_renderer_destroy(model->renderer);
    whit_accel_destroy(model->accel);
    bench_unload(&model->loaded);
    free(model->camera.rays);
    free(model->hits);
    free(model->traced);
    free(model->rays);
    free(model);
    return result;
}

/* ---- The bench ---- */

/* Two of whit's scenes, and a terrain of 1.1 million triangles, or of fewer. */
static whit_result run_default(struct figures *figures, const char *folder)
{
    static const char *const names[] = {"54k", "atrium"};
    const struct bench *bench = figures->section.bench;
    char path[BENCH_PATH];
    whit_result result = WHIT_OK;
    for (size_t i = 0; result == WHIT_OK && i < 2; ++i) {
        result = bench_find(bench, names[i], path, sizeof path);
        if (result == WHIT_OK)
            result = run_model(figures, path, folder);
    }
    snprintf(path, sizeof path, "%s/terrain.json", folder);
    FILE *to = result == WHIT_OK ? fopen(path, "w") : NULL;
    if (!to)
        return result == WHIT_OK ? WHIT_ERROR_OUTPUT : result;
    fprintf(to,
            "{\"camera\": {\"eye\": [0, 4, 6], \"target\": [0, 0, 0], \"fov\": 40}, \"objects\": "
            "[{\"shape\": \"terrain\", \"size\": 12, \"height\": 2, \"steps\": %d, "
            "\"seed\": 3}]}\n",
            bench->quick ? 74 : 742);
    return fclose(to) == 0 ? run_model(figures, path, folder) : WHIT_ERROR_OUTPUT;
}

static void say_how(struct figures *figures)
{
    const struct bench *bench = figures->section.bench;
    const whit_device_info *device = &bench->device_info;
    bool is_cpu = strcmp(device->kind, "cpu") == 0;
    section_say(&figures->section,
                "%s, %s; %u x %u camera rays, runs in turns: %u; medians, with half the width of "
                "the middle half.",
                cli_shown(device->name), cli_shown(device->driver), bench->width, bench->height,
                bench->runs);
    section_say(&figures->section,
                is_cpu ? "ns: processor time of all threads a ray, from rays in device memory to "
                         "hits in device memory. Figure: times the speed of Embree's single rays."
                       : "ns: device time a ray, and time by the clock of Embree on all cores. "
                         "Figure: times the speed of Embree's single rays.");
    section_say(&figures->section,
                "Level `watertight` beside Embree ROBUST, on the same files: in tiles of 8x8, then "
                "`shuffled`. Shadow rays start at the light; Embree has them from the end where it "
                "is quicker.");
    if (bench->quick)
        section_say(&figures->section, "Quick run: few rays, not for figures to be quoted.");
}

static whit_result look_for(const char *path)
{
    if (access(path, R_OK) == 0)
        return WHIT_OK;
    cli_error("%s: cannot read: %s", path, strerror(errno));
    return WHIT_ERROR_INPUT;
}

static whit_result make_folder(const char *folder)
{
    if (mkdir(folder, 0777) == 0 || errno == EEXIST)
        return WHIT_OK;
    cli_error("%s: cannot be made: %s", folder, strerror(errno));
    return WHIT_ERROR_OUTPUT;
}

whit_result bench_rays(struct bench *bench)
{
    static const char *const heads[] = {"model, triangles", "rays",       "whit, ns", "single, ns",
                                        "packets, ns",      "stream, ns", "shuffled", NULL};
    static struct figures figures;
    char scratch[BENCH_SCRATCH];
    whit_result result = WHIT_OK;
    for (uint32_t i = 0; result == WHIT_OK && i < bench->name_count; ++i)
        result = look_for(bench->names[i]);
    if (result == WHIT_OK)
        result = bench->keep ? make_folder(bench->keep) : bench_scratch_make(scratch);
    if (result != WHIT_OK)
        return result;
    const char *folder = bench->keep ? bench->keep : scratch;
    uint32_t models = bench->name_count ? bench->name_count : 3;
    cli_keep_what_is_done(BENCH_GRACE_MS);
    figures_begin(&figures, bench, "rays", heads, models * RAYS_KINDS * 2 * (bench->runs + 1));
    say_how(&figures);
    if (!peer_is_here())
        figures_leave_out(&figures, "Embree",
                          "`whit-embree` is not beside this program; the build makes it where "
                          "Embree 3 is installed (Debian: libembree-dev)");
    for (uint32_t i = 0; result == WHIT_OK && i < bench->name_count; ++i)
        result = run_model(&figures, bench->names[i], folder);
    if (result == WHIT_OK && bench->name_count == 0)
        result = run_default(&figures, folder);
    if (!bench->keep)
        bench_scratch_remove(scratch);
    return figures_end(&figures, "Rays", result);
}
