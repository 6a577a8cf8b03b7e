/* `whit bench rays`: compares whit's kernels with Embree and the driver's own ray tracing on the
   same files of rays. */
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/bvh/study_rays.h"
#include "base/path.h"
#include "bench/rays_batch.h"

enum { LARGE = 200000 }; /* number of triangles above which the second goal counts */

/* The goals for each kind of rays: for small models, and for large ones. */
static const struct goal goals[RAYS_KINDS][2] = {
    [RAYS_CAMERA] = {{2.0, 3.5, true}, {0.8, 1.2, true}},
    [RAYS_SHADOW] = {{1.5, 2.5, true}, {0.6, 1.0, true}},
    [RAYS_BOUNCE] = {{0.6, 0.75, true}, {0.45, 0.6, true}},
};

/* ---- Rows ---- */

static void put_ns(const struct model *model, const struct sample_runs *times)
{
    struct table *table = model->table;
    if (times->count == 0 || model->count == 0)
        table_cell(table, "-");
    else
        table_cell(table, "%.*f", model->bench->is_cpu ? 1 : 3,
                   sample_of(times).median * 1e6 / (double)model->count);
}

static json_t *hits_document(const struct agreement *agreement)
{
    json_t *hits = document_object();
    document_count(hits, "compared", agreement->rays);
    document_count(hits, "met_by_one_alone", agreement->one_alone);
    document_count(hits, "other_ids", agreement->other_ids);
    document_count(hits, "other_t", agreement->other_t);
    return hits;
}

static void put_visits(json_t *row, const char *key, const whit_cost *cost)
{
    json_t *visits = document_child(row, key);
    document_count(visits, "records", cost->records);
    document_count(visits, "inner_nodes", cost->inner_nodes);
    document_count(visits, "triangles", cost->triangles);
}

static json_t *row_document(const struct model *model, uint32_t kind, const struct batch *batches,
                            const struct visits *visits,
                            const struct agreement agreement[PEER_KINDS])
{
    static const char *const keys[] = {"whit_ms", "single_ms", "packets_ms", "stream_ms",
                                       "pipeline_ms"};
    json_t *row = document_object();
    document_text(row, "model", model->name);
    document_text(row, "rays", rays_kind_names[kind]);
    document_count(row, "triangles", model->loaded.info.triangle_count);
    document_count(row, "count", model->count);
    for (uint32_t order = 0; order < 2; ++order) {
        json_t *times = document_child(row, order ? "shuffled" : "tiles");
        for (uint32_t side = 0; side < RAYS_BACK; ++side) {
            const struct sample_runs *of =
                side ? batch_quicker(&batches[order], (enum rays_side)side)
                     : &batches[order].sides[0];
            if (of->count)
                document_put(times, keys[side], table_times(of));
        }
    }
    put_visits(row, "packets", &visits->together);
    put_visits(row, "alone", &visits->alone);
    document_put(row, "hits", hits_document(&agreement[PEER_EMBREE]));
    document_put(row, "pipeline_hits", hits_document(&agreement[PEER_PIPELINE]));
    return row;
}

/* Says what packets visit, where at least half of the rays are in packets. */
static void say_visits(struct table *table, const char *name, const struct visits *visits)
{
    double walks = (double)visits->together.records, rays = (double)visits->alone.records;
    if (walks > 0.0 && walks < 0.5 * rays)
        table_say(table,
                  "%s: packets, and rays that are in none, open %.1f nodes (of eight children in "
                  "packets) and test %.1f triangles for %.1f rays on average; a ray alone opens "
                  "%.1f nodes of two children and tests %.1f triangles.",
                  name, (double)visits->together.inner_nodes / walks,
                  (double)visits->together.triangles / walks, rays / walks,
                  (double)visits->alone.inner_nodes / rays, (double)visits->alone.triangles / rays);
}

static void put_row(const struct model *model, uint32_t kind, const struct batch *batches,
                    const struct visits *visits, const struct agreement agreement[PEER_KINDS])
{
    struct table *table = model->table;
    const struct batch *tiles = &batches[0], *shuffled = &batches[1];
    const struct goal goal = goals[kind][model->loaded.info.triangle_count > LARGE];
    struct figure figure =
        table_ratio(batch_quicker(tiles, RAYS_SINGLE), &tiles->sides[RAYS_WHIT], goal);
    struct figure other =
        table_ratio(batch_quicker(shuffled, RAYS_SINGLE), &shuffled->sides[RAYS_WHIT], goal);
    snprintf(figure.name, sizeof figure.name, "%s, %s", model->name, rays_kind_names[kind]);
    table_row(table);
    table_cell(table, "%s, %llu", model->name,
               (unsigned long long)model->loaded.info.triangle_count);
    table_cell(table, "%s", rays_kind_names[kind]);
    put_ns(model, &tiles->sides[RAYS_WHIT]);
    for (int side = RAYS_SINGLE; side < RAYS_BACK; ++side)
        put_ns(model, batch_quicker(tiles, (enum rays_side)side));
    table_cell(table, isnan(other.value) ? "-" : "%.2f", other.value);
    table_figure(table, &figure, row_document(model, kind, batches, visits, agreement));
    say_visits(table, figure.name, visits);
    for (int peer = 0; peer < PEER_KINDS; ++peer)
        if (agreement[peer].one_alone + agreement[peer].other_t > 0)
            table_say(table,
                      "%s: of %llu rays whit or %s alone meets something on %llu, and t differs "
                      "on %llu.",
                      figure.name, (unsigned long long)agreement[peer].rays, peer_names[peer],
                      (unsigned long long)agreement[peer].one_alone,
                      (unsigned long long)agreement[peer].other_t);
}

static whit_result run_kind(struct model *model, uint32_t kind)
{
    struct batch batches[2] = {0};
    struct agreement agreement[PEER_KINDS] = {0};
    struct visits visits = {0};
    whit_result result = batch_run(model, &batches[0], (enum rays_kind)kind, false, agreement);
    if (result == WHIT_OK)
        result = batch_count(model, &visits);
    if (result == WHIT_OK)
        result = batch_run(model, &batches[1], (enum rays_kind)kind, true, agreement);
    if (result == WHIT_OK)
        put_row(model, kind, batches, &visits, agreement);
    return result;
}

/* ---- Models ---- */

/* Names a model after the file of `path`, without its extension; characters that not every file
   system allows become `_`. */
static void name_model(struct model *model, const char *path)
{
    const char *from = path_name(path), *dot = strrchr(from, '.');
    snprintf(model->name, sizeof model->name, "%.*s",
             (int)(dot ? (size_t)(dot - from) : strlen(from)), from);
    for (char *c = model->name; *c; ++c)
        *c = isalnum((unsigned char)*c) || *c == '-' ? *c : '_';
}

static whit_result prepare(struct model *model, const char *path)
{
    const struct bench_request *ask = &model->bench->ask;
    const whit_renderer_params params = {.width = 16, .height = 16, .cancel = &cli_cancel};
    name_model(model, path);
    whit_result result = bench_load_trees(path, &model->loaded);
    if (result == WHIT_OK && model->loaded.info.triangle_count == 0)
        return CLI_FAIL(WHIT_ERROR_INPUT, "%s: has no triangles, which rays could meet", path);
    if (result == WHIT_OK)
        result = whit_renderer_create(model->bench->device, model->loaded.accel, &params,
                                      &model->renderer);
    if (result == WHIT_OK)
        result =
            study_camera_rays(model->loaded.scene, ask->width, ask->height, true, &model->camera);
    if (result != WHIT_OK)
        return result;
    size_t count = model->camera.count;
    model->hits = malloc(count * sizeof *model->hits);
    model->traced = malloc(count * sizeof *model->traced);
    model->rays = malloc(count * sizeof *model->rays);
    if (!model->hits || !model->traced || !model->rays)
        return WHIT_ERROR_MEMORY;
    return whit_trace(model->renderer, WHIT_TRACE_DEVICE, model->camera.rays, count, false,
                      model->hits, NULL);
}

static whit_result begin_peer(struct model *model, enum peer_kind kind, const char *triangles)
{
    struct peer *peer = &model->peers[kind];
    const char *why_not = peer_why_not(kind, &model->loaded.info);
    if (why_not && !peer_why_not(kind, NULL)) /* else the table says it once for all models */
        table_leave_out(model->table, peer_names[kind], why_not);
    if (why_not)
        return WHIT_OK;
    whit_result result = peer_begin(peer, kind, model->bench, model->loaded.scene, triangles);
    model->has_peer[kind] = result == WHIT_OK && !peer->why_not[0];
    bool is_first = model->table->line_count == 1; /* only the head is there */
    if (result != WHIT_OK || !is_first)
        return result;
    if (peer->why_not[0])
        table_leave_out(model->table, peer_names[kind], peer->why_not);
    else
        table_say(model->table, "Beside %s (%s).", peer_names[kind], peer->version);
    return result;
}

static whit_result run_model(struct table *table, const char *path)
{
    char triangles[96];
    struct model *model = calloc(1, sizeof *model);
    if (!model)
        return WHIT_ERROR_MEMORY;
    model->bench = table->bench;
    model->table = table;
    whit_result result = prepare(model, path);
    snprintf(triangles, sizeof triangles, "%s.triangles", model->name);
    for (int kind = 0; result == WHIT_OK && kind < PEER_KINDS; ++kind)
        result = begin_peer(model, (enum peer_kind)kind, triangles);
    for (uint32_t kind = 0; result == WHIT_OK && kind < RAYS_KINDS; ++kind)
        result = run_kind(model, kind);
    for (int kind = 0; kind < PEER_KINDS; ++kind)
        peer_end(&model->peers[kind]);
    whit_renderer_destroy(model->renderer);
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
static whit_result run_usual(struct table *table)
{
    static const char *const names[] = {"54k", "atrium"};
    const struct bench *bench = table->bench;
    char path[BENCH_PATH], text[256];
    whit_result result = WHIT_OK;
    for (size_t i = 0; result == WHIT_OK && i < 2; ++i) {
        result = bench_find(bench, names[i], path);
        if (result == WHIT_OK)
            result = run_model(table, path);
    }
    snprintf(text, sizeof text,
             "{\"camera\": {\"eye\": [0, 4, 6], \"target\": [0, 0, 0], \"fov\": 40}, \"objects\": "
             "[{\"shape\": \"terrain\", \"size\": 12, \"height\": 2, \"steps\": %d, "
             "\"seed\": 3}]}\n",
             bench->ask.quick ? 74 : 742);
    bench_file(bench, "terrain.json", path);
    if (result == WHIT_OK)
        result = bench_write(bench, "terrain.json", text, strlen(text));
    return result == WHIT_OK ? run_model(table, path) : result;
}

static void say_how(struct table *table)
{
    table_say(
        table,
        table->bench->is_cpu
            ? "ns: processor time of all threads a ray, from rays in device memory to hits in "
              "device memory. Figure: times the speed of Embree's single rays. driver: the "
              "driver's own ray-tracing pipeline."
            : "ns: device time a ray, and time by the clock of Embree on all cores. Figure: "
              "times the speed of Embree's single rays. driver: the driver's own ray-tracing "
              "pipeline.");
    table_say(table,
              "One camera ray a pixel. Level `watertight` beside Embree ROBUST, on the same files: "
              "in tiles of 8x8, then `shuffled`. Shadow rays start at the light; Embree has them "
              "from the end where it is quicker.");
}

whit_result bench_rays(struct bench *bench)
{
    static const char *const heads[] = {"model, triangles", "rays",        "whit, ns",
                                        "single, ns",       "packets, ns", "stream, ns",
                                        "driver, ns",       "shuffled",    NULL};
    const struct bench_request *ask = &bench->ask;
    struct table table;
    whit_result result = bench_look_for(bench);
    if (result != WHIT_OK)
        return result;
    uint32_t models = ask->name_count ? ask->name_count : 3;
    table_begin(&table, bench, "rays", heads, true, models * RAYS_KINDS * 2 * (ask->runs + 1));
    say_how(&table);
    for (int kind = 0; kind < PEER_KINDS; ++kind)
        if (peer_why_not((enum peer_kind)kind, NULL))
            table_leave_out(&table, peer_names[kind], peer_why_not((enum peer_kind)kind, NULL));
    for (uint32_t i = 0; result == WHIT_OK && i < ask->name_count; ++i)
        result = run_model(&table, ask->names[i]);
    if (result == WHIT_OK && ask->name_count == 0)
        result = run_usual(&table);
    return table_end(&table, "Rays", result);
}
