#include <inttypes.h>
#include <string.h>

#include "app/bvh/study.h"
#include "app/document.h"
#include "app/render/stats.h"

/* ---- Text ---- */

static void print_primitives(uint64_t triangles, uint64_t spheres)
{
    printf("%" PRIu64 " triangles", triangles);
    if (spheres)
        printf(" and %" PRIu64 " sphere%s", spheres, spheres == 1 ? "" : "s");
}

static void print_heading(const struct study *study)
{
    whit_scene_info scene;
    whit_scene_get_info(study->job.scene, &scene);
    printf("scene      %s: ", cli_shown(study->job.settings.scene));
    print_primitives(scene.triangle_count, scene.sphere_count);
    printf(" in %u instance%s of %u mesh%s\n", scene.instance_count,
           scene.instance_count == 1 ? "" : "s", scene.mesh_count,
           scene.mesh_count == 1 ? "" : "es");
    if (study->traced)
        stats_print_device("device     ", study->job.device);
    printf("measured   %u run%s of each, in turns: medians\n\n", study->run_count,
           study->run_count == 1 ? "" : "s");
}

static int name_width(const struct study *study)
{
    size_t width = strlen("builder");
    for (uint32_t i = 0; i < study->row_count; ++i) {
        size_t length = strlen(study->rows[i].name);
        width = length > width ? length : width;
    }
    return (int)width;
}

static void print_columns(const struct study *study, int width)
{
    printf("%-*s  %*s%9s%6s%8s%8s%9s%8s%8s", width, "", (int)(9 * study->thread_count), "build ms",
           "", "", "", "", "", "inner", "tests");
    if (study->traced)
        printf("%9s", "Mray/s");
    printf("\n%-*s  ", width, "builder");
    for (uint32_t i = 0; i < study->thread_count; ++i)
        printf("%7ut ", study->threads[i]);
    printf("%9s%6s%8s%8s%9s%8s%8s", "nodes", "depth", "SAH", "EPO", "overlap", "a line", "a line");
    for (uint32_t kind = 0; study->traced && kind < STUDY_KINDS; ++kind)
        printf("%9s", study_kind_names[kind]);
    putchar('\n');
}

static void print_row(const struct study *study, const struct study_row *row, int width)
{
    const whit_accel_report *report = &row->report;
    printf("%-*s  ", width, row->name);
    for (uint32_t i = 0; i < study->thread_count; ++i)
        printf("%8.2f ", row->build_ms[i].median);
    printf("%9u%6u%8.2f%8.3f%7.1f %%%8.2f%8.2f", row->info.node_count, row->info.depth,
           report->sah_cost, report->epo, 100.0 * report->overlap, report->measured_inner_nodes,
           report->measured_triangles);
    for (uint32_t kind = 0; study->traced && kind < STUDY_KINDS; ++kind) {
        if (study->rays[kind].count)
            printf("%9.3f", row->mrays_per_s[kind].median);
        else
            printf("%9s", "-");
    }
    putchar('\n');
}

static void print_bins(const char *title, const uint64_t *bins, uint32_t count)
{
    uint32_t shown = 0;
    printf("  %-9s", title);
    for (uint32_t i = 0; i < count; ++i) {
        if (bins[i] == 0)
            continue;
        if (shown > 0)
            printf(shown % 8 == 0 ? ",\n           " : ", ");
        printf("%u: %llu", i, (unsigned long long)bins[i]);
        ++shown;
    }
    puts(shown ? "" : "none");
}

static void print_rates(const struct study *study, const struct study_row *row)
{
    for (uint32_t kind = 0; study->traced && kind < STUDY_KINDS; ++kind) {
        const struct sample_summary *rate = &row->mrays_per_s[kind];
        if (study->rays[kind].count)
            printf("  %-9s%.3f Mray/s (%.3f to %.3f), %u rays\n", study_kind_names[kind],
                   rate->median, rate->min, rate->max, study->rays[kind].count);
    }
}

static void print_details(const struct study *study, const struct study_row *row)
{
    const whit_accel_info *info = &row->info;
    const whit_accel_report *report = &row->report;
    printf("\n%s\n", row->name);
    for (uint32_t i = 0; i < study->thread_count; ++i)
        printf("  %-9s%.2f ms (%.2f to %.2f) by %u thread%s\n", "build", row->build_ms[i].median,
               row->build_ms[i].min, row->build_ms[i].max, study->threads[i],
               study->threads[i] == 1 ? "" : "s");
    uint32_t primitives = info->triangle_count + info->sphere_count;
    printf("  %-9s%u nodes, %u leaves, ", "trees", info->node_count, info->leaf_count);
    print_primitives(info->triangle_count, info->sphere_count);
    printf(" in %u references (%.3f each), %.1f MiB\n", info->reference_count,
           primitives ? (double)info->reference_count / primitives : 0.0,
           (double)info->bytes / 1048576.0);
    printf("  %-9s%u, and %u over instances\n", "depth", info->depth, info->instance_depth);
    print_bins("at depth", report->leaves_at_depth, WHIT_DEPTH_BINS);
    print_bins("of size", report->leaves_of_size, WHIT_LEAF_BINS);
    printf("  %-9sSAH %.3f, EPO %.4f, siblings share %.2f %%\n", "cost", report->sah_cost,
           report->epo, 100.0 * report->overlap);
    printf(
        "  %-9s%.2f inner nodes and %.2f triangles a line by areas, %.2f and %.2f by %llu lines\n",
        "visits", report->predicted_inner_nodes, report->predicted_triangles,
        report->measured_inner_nodes, report->measured_triangles,
        (unsigned long long)report->measured_rays);
    print_rates(study, row);
    if (study->validate)
        puts("  valid    yes");
}

static int print_text(const struct study *study)
{
    int width = name_width(study);
    print_heading(study);
    print_columns(study, width);
    for (uint32_t i = 0; i < study->row_count; ++i)
        print_row(study, &study->rows[i], width);
    if (study->traced)
        printf("\nhits: %llu of %llu differ\n", (unsigned long long)study->differing,
               (unsigned long long)study->compared);
    for (uint32_t i = 0; i < study->row_count; ++i)
        print_details(study, &study->rows[i]);
    return cli_finish_stdout(EXIT_FINE);
}

/* ---- JSON ---- */

static void put_spread(json_t *object, const struct sample_summary *spread)
{
    document_number(object, "median", spread->median);
    document_number(object, "min", spread->min);
    document_number(object, "max", spread->max);
}

static void put_times(json_t *object, const struct sample_summary *spread_ms)
{
    document_ms(object, "median", spread_ms->median);
    document_ms(object, "min", spread_ms->min);
    document_ms(object, "max", spread_ms->max);
}

static json_t *build_document(const struct study *study, const struct study_row *row)
{
    json_t *list = document_array();
    for (uint32_t i = 0; i < study->thread_count; ++i) {
        json_t *entry = document_entry(list);
        document_count(entry, "threads", study->threads[i]);
        put_times(entry, &row->build_ms[i]);
    }
    return list;
}

/* A list of the bins up to the last one that is not empty. */
static json_t *bins_document(const uint64_t *bins, uint32_t count)
{
    json_t *list = document_array();
    while (count > 0 && bins[count - 1] == 0)
        --count;
    for (uint32_t i = 0; i < count; ++i)
        document_append(list, json_integer((json_int_t)bins[i]));
    return list;
}

static void put_visits(json_t *visits, double inner_nodes, double triangles)
{
    document_number(visits, "inner_nodes", inner_nodes);
    document_number(visits, "triangles", triangles);
}

static json_t *rates_document(const struct study *study, const struct study_row *row)
{
    json_t *rates = document_object();
    for (uint32_t kind = 0; kind < STUDY_KINDS; ++kind) {
        const char *name = study_kind_names[kind];
        if (study->traced && study->rays[kind].count)
            put_spread(document_child(rates, name), &row->mrays_per_s[kind]);
        else
            document_put(rates, name, json_null());
    }
    return rates;
}

static void put_row(json_t *object, const struct study *study, const struct study_row *row)
{
    const whit_accel_info *info = &row->info;
    const whit_accel_report *report = &row->report;
    document_text(object, "builder", row->name);
    document_put(object, "build_ms", build_document(study, row));
    document_count(object, "nodes", info->node_count);
    document_count(object, "leaves", info->leaf_count);
    document_count(object, "triangles", info->triangle_count);
    document_count(object, "spheres", info->sphere_count);
    document_count(object, "references", info->reference_count);
    document_count(object, "bytes", info->bytes);
    document_count(object, "depth", info->depth);
    document_count(object, "instance_depth", info->instance_depth);
    document_put(object, "leaves_at_depth",
                 bins_document(report->leaves_at_depth, WHIT_DEPTH_BINS));
    document_put(object, "leaves_of_size", bins_document(report->leaves_of_size, WHIT_LEAF_BINS));
    document_number(object, "sah_cost", report->sah_cost);
    document_number(object, "epo", report->epo);
    document_number(object, "overlap", report->overlap);
    put_visits(document_child(object, "predicted"), report->predicted_inner_nodes,
               report->predicted_triangles);
    put_visits(document_child(object, "measured"), report->measured_inner_nodes,
               report->measured_triangles);
    document_count(object, "measured_lines", report->measured_rays);
    document_put(object, "mrays_per_s", rates_document(study, row));
    document_put(object, "valid", study->validate ? json_true() : json_null());
}

static void put_scene(json_t *scene, const struct study *study)
{
    whit_scene_info info;
    whit_scene_get_info(study->job.scene, &info);
    document_text(scene, "file", study->job.settings.scene);
    document_hash(scene, "hash", info.hash);
    document_count(scene, "instances", info.instance_count);
    document_count(scene, "meshes", info.mesh_count);
    document_count(scene, "triangles", info.triangle_count);
    document_count(scene, "spheres", info.sphere_count);
}

static json_t *device_document(const struct study *study)
{
    if (!study->traced)
        return json_null();
    whit_device_info info;
    whit_device_get_info(study->job.device, &info);
    return document_device(&info);
}

static json_t *hits_document(const struct study *study)
{
    if (!study->traced)
        return json_null();
    json_t *hits = document_object();
    document_count(hits, "compared", study->compared);
    document_count(hits, "differing", study->differing);
    return hits;
}

static int print_json(const struct study *study)
{
    json_t *root = document_root();
    put_scene(document_child(root, "scene"), study);
    document_put(root, "device", device_document(study));
    document_count(root, "runs", study->run_count);
    json_t *rays = document_child(root, "rays");
    for (uint32_t kind = 0; kind < STUDY_KINDS; ++kind)
        document_count(rays, study_kind_names[kind], study->rays[kind].count);
    json_t *rows = document_list(root, "builders");
    for (uint32_t i = 0; i < study->row_count; ++i)
        put_row(document_entry(rows), study, &study->rows[i]);
    document_put(root, "hits", hits_document(study));
    return cli_print_json(root);
}

int study_print(const struct study *study)
{
    return study->json ? print_json(study) : print_text(study);
}
