#include <string.h>

#include "app/document.h"
#include "app/render/stats.h"
#include "app/settings_json.h"
#include "base/platform.h"

/* ---- Costs by kind of ray ---- */

enum { FIGURES = 7 };
static const char *const figure_names[FIGURES] = {"inner_nodes", "boxes", "leaves", "triangles",
                                                  "instances",   "stack", "depth"};

/* Means per ray, and for stack and depth per sample of a pixel; the largest in one sample of a
   pixel. */
static void find_figures(const whit_cost *cost, double means[FIGURES], uint64_t max[FIGURES])
{
    double rays = cost->rays ? (double)cost->rays : 1.0;
    double records = cost->records ? (double)cost->records : 1.0;
    means[0] = (double)cost->inner_nodes / rays;
    means[1] = 2.0 * means[0];
    means[2] = (double)cost->leaves / rays;
    means[3] = (double)cost->triangles / rays;
    means[4] = (double)cost->instances / rays;
    means[5] = (double)cost->stack_sum / records;
    means[6] = (double)cost->depth_sum / records;
    max[0] = cost->max_inner_nodes;
    max[1] = 2 * (uint64_t)cost->max_inner_nodes;
    max[2] = cost->max_leaves;
    max[3] = cost->max_triangles;
    max[4] = cost->max_instances;
    max[5] = cost->stack;
    max[6] = cost->depth;
}

static void print_kind(const char *name, const whit_cost *cost)
{
    double means[FIGURES];
    uint64_t max[FIGURES];
    find_figures(cost, means, max);
    printf("  %-10s %10llu", name, (unsigned long long)cost->rays);
    for (int i = 0; i < FIGURES; ++i)
        printf(" %9.2f", means[i]);
    printf("\n  %-10s %10s", "", "most");
    for (int i = 0; i < FIGURES; ++i)
        printf(" %9llu", (unsigned long long)max[i]);
    putchar('\n');
}

static void print_costs(const whit_stats *stats)
{
    printf("costs of a ray: means, and most in one sample of a pixel\n  %-10s %10s", "", "rays");
    for (int i = 0; i < FIGURES; ++i)
        printf(" %9s", figure_names[i]);
    putchar('\n');
    for (int kind = 0; kind < WHIT_RAY_KINDS; ++kind) {
        if (stats->costs[kind].rays)
            print_kind(value_word(values_rays, kind), &stats->costs[kind]);
    }
}

static void put_kind(json_t *kind, const whit_cost *cost)
{
    double means[FIGURES];
    uint64_t max[FIGURES];
    find_figures(cost, means, max);
    document_count(kind, "rays", cost->rays);
    json_t *mean = document_child(kind, "mean"), *largest = document_child(kind, "max");
    for (int i = 0; i < FIGURES; ++i) {
        document_number(mean, figure_names[i], means[i]);
        document_count(largest, figure_names[i], max[i]);
    }
}

static void put_costs(json_t *costs, const whit_stats *stats)
{
    for (int kind = 0; kind < WHIT_RAY_KINDS; ++kind)
        put_kind(document_child(costs, value_word(values_rays, kind)), &stats->costs[kind]);
}

/* ---- All figures ---- */

struct figures {
    whit_scene_info scene;
    whit_accel_info tree;
    whit_device_info device;
    whit_kernel_info kernel;  /* zeros where it is not known */
    const whit_stats *render; /* of the sequence */
    const struct sequence *sequence;
    bool frames; /* the sequence has frames */
};

static void put_times(json_t *times, const struct job *job, const struct figures *figures)
{
    document_ms(times, "load_ms", job->load_ms);
    document_ms(times, "build_ms", figures->tree.build_ms);
    document_ms(times, "build_instances_ms", figures->tree.instance_build_ms);
    document_ms(times, "device_ms", job->device_ms);
    document_ms(times, "upload_ms", figures->render->upload_ms);
    document_ms(times, "compile_ms", figures->render->compile_ms);
    document_ms(times, "render_ms", figures->render->render_ms);
    document_ms(times, "render_device_ms", document_known(figures->render->render_device_ms));
    document_ms(times, "save_ms", figures->sequence->save_ms);
    document_ms(times, "total_ms", whit_clock_ms() - job->start_ms);
}

static void put_scene(json_t *scene, const struct job *job, const struct figures *figures)
{
    document_text(scene, "file", job->settings.scene);
    document_hash(scene, "hash", figures->scene.hash);
    document_count(scene, "file_bytes", figures->scene.file_bytes);
    document_count(scene, "instances", figures->scene.instance_count);
    document_count(scene, "triangles", figures->scene.triangle_count);
}

static void put_picture(json_t *picture, const struct job *job,
                        const struct render_request *request)
{
    document_text(picture, "file", request->output);
    document_text(picture, "ids", request->ids);
    settings_describe(&job->settings, IN_RENDER, picture);
}

/* The number of rays that were not traced, and the largest weight that they could have added to a
   pixel. */
static void put_cut(json_t *cut, uint64_t count, double weight)
{
    document_count(cut, "rays", count);
    document_number(cut, "weight_of_a_pixel", weight);
}

static void put_rays(json_t *rays, const struct job *job, const struct figures *figures)
{
    document_count(rays, "primary", figures->render->rays_primary);
    document_count(rays, "shadow", figures->render->rays_shadow);
    document_count(rays, "reflected", figures->render->rays_reflected);
    document_count(rays, "refracted", figures->render->rays_refracted);
    document_count(rays, "straight", figures->render->rays_straight);
    if (job->shader)
        document_count(rays, "by_functions", figures->render->rays_by_functions);
    document_count(rays, "total", whit_stats_rays(figures->render));
    document_number(rays, "mrays_per_s", figures->render->mrays_per_s);
    put_cut(document_child(rays, "cut_by_depth"), figures->render->rays_cut_depth,
            figures->render->weight_cut_depth);
    put_cut(document_child(rays, "cut_by_bailout"), figures->render->rays_cut_bailout,
            figures->render->weight_cut_bailout);
    document_number(rays, "bailout_bound", document_known(figures->render->bailout_bound));
}

static void put_kernel(json_t *kernel, const struct figures *figures)
{
    document_count(kernel, "instructions", figures->kernel.instructions);
    document_count(kernel, "largest_instructions", figures->kernel.largest_instructions);
    document_count(kernel, "general_instructions", figures->kernel.general_instructions);
    document_count(kernel, "translated_beside", figures->render->kernels_beside);
    document_count(kernel, "bindings", figures->kernel.bindings);
    document_count(kernel, "general_bindings", figures->kernel.general_bindings);
    document_flag(kernel, "general", figures->render->general);
}

/* The shares that materials have in the time of a shading kernel; NULL where the stage is no
   shading kernel, or none of its tiles was timed. */
static json_t *shares_document(const struct job *job, const struct figures *figures, uint32_t stage)
{
    json_t *shares = NULL;
    for (uint32_t i = 0; i < figures->render->share_count; ++i) {
        const whit_share *share = &figures->render->shares[i];
        if (share->stage != stage)
            continue;
        whit_material_info material;
        whit_scene_get_material(job->scene, share->material, &material);
        shares = shares ? shares : document_array();
        json_t *object = document_entry(shares);
        document_count(object, "material", share->material);
        document_text(object, "name", material.name);
        document_put(object, "share", json_real(share->share));
    }
    return shares;
}

static void put_stages(json_t *stages, const struct job *job, const struct figures *figures)
{
    for (int i = 0; i < WHIT_STAGES; ++i) {
        const whit_stage *stage = &figures->render->stages[i];
        if (!stage->rays)
            continue;
        json_t *object = document_entry(stages);
        document_text(object, "name", stage->name);
        document_count(object, "rays", stage->rays);
        document_ms(object, "ms", document_known(stage->ms));
        json_t *shares = shares_document(job, figures, (uint32_t)i);
        if (shares)
            document_put(object, "shares", shares);
    }
}

static void put_pixels(json_t *pixels, const struct figures *figures)
{
    static const char *const samples[] = {"1", "4", "16", "64"};
    for (int i = 0; i < 4; ++i)
        document_count(pixels, samples[i], figures->render->pixels_by_samples[i]);
}

static void put_refined(json_t *object, const struct figures *figures)
{
    const struct refined *refined = &figures->sequence->refined;
    document_count(object, "samples", refined->now.samples);
    document_number(object, "rmse_estimate", document_known(refined->now.error));
    document_number(object, "rmse_estimate_of_cuts", document_known(refined->now.error_of_cuts));
    document_number(object, "cut_radiance", refined->now.cut_radiance);
    document_count(object, "estimate_rays", figures->render->rays_of_estimate);
    document_flag(object, "reached", refined->reached);
}

static void put_tree(json_t *tree, const whit_accel_info *info)
{
    document_flag(tree, "one", info->one_tree);
    document_count(tree, "nodes", info->node_count);
    document_count(tree, "leaves", info->leaf_count);
    document_count(tree, "triangles", info->triangle_count);
    document_count(tree, "spheres", info->sphere_count);
    document_count(tree, "depth", info->depth);
    document_count(tree, "instance_depth", info->instance_depth);
    document_number(tree, "sah_cost", info->sah_cost);
    document_count(tree, "bytes", info->bytes);
}

static void put_frame_times(json_t *object, const struct frame_times *times)
{
    document_ms(object, "build_instances_ms", times->instances_ms);
    document_ms(object, "upload_ms", times->upload_ms);
    document_ms(object, "render_ms", times->render_ms);
    document_ms(object, "save_ms", times->save_ms);
}

static void put_frames(json_t *frames, const struct job *job, const struct sequence *sequence)
{
    document_count(frames, "count", sequence->count);
    document_count(frames, "kept", sequence->kept);
    document_number(frames, "fps", job->settings.fps);
    put_frame_times(document_child(frames, "median"), &sequence->median);
    json_t *each = document_list(frames, "each");
    for (uint32_t i = 0; i < sequence->count; ++i) {
        json_t *frame = document_entry(each);
        document_count(frame, "frame", sequence->each[i].frame);
        document_number(frame, "time_s", sequence->each[i].time_s);
        put_frame_times(frame, &sequence->each[i]);
    }
}

static int print_json(const struct job *job, const struct render_request *request,
                      const struct figures *figures)
{
    json_t *root = document_root();
    put_scene(document_child(root, "scene"), job, figures);
    put_picture(document_child(root, "picture"), job, request);
    document_put(root, "device", document_device(&figures->device));
    put_times(document_child(root, "times"), job, figures);
    put_rays(document_child(root, "rays"), job, figures);
    put_stages(document_list(root, "stages"), job, figures);
    put_kernel(document_child(root, "kernel"), figures);
    if (job->settings.picture.sampling.kind == WHIT_SAMPLING_ADAPTIVE)
        put_pixels(document_child(root, "pixels_by_samples"), figures);
    if (job->settings.paint != PAINT_COLOR || request->counters)
        put_costs(document_child(root, "costs"), figures->render);
    put_tree(document_child(root, "tree"), &figures->tree);
    if (figures->sequence->refined.now.samples)
        put_refined(document_child(root, "refine"), figures);
    if (figures->frames)
        put_frames(document_child(root, "frames"), job, figures->sequence);
    if (part_is_given(&request->part))
        document_put(root, "part", part_document(&request->part, &job->settings));
    json_t *work = document_child(root, "work");
    document_count(work, "dispatches", figures->render->dispatches);
    document_count(work, "tiles", figures->render->tiles);
    document_count(work, "tile_size", figures->render->tile_size);
    document_count(work, "deferred", figures->render->deferred);
    document_text(work, "load_path", value_word(values_load_path, (int)figures->render->load_path));
    document_flag(work, "packets", figures->render->packets);
    json_t *memory = document_child(root, "memory");
    document_count(memory, "host_peak_bytes", platform_peak_memory_bytes());
    document_count(memory, "device_bytes", figures->render->device_bytes);
    return cli_print_json(root);
}

static void print_time(const char *name, double ms)
{
    printf("  %-18s %10.1f ms\n", name, ms);
}

static void print_times(const struct job *job, const struct figures *figures)
{
    puts("times");
    print_time("load", job->load_ms);
    print_time("build", figures->tree.build_ms);
    print_time("build instances", figures->tree.instance_build_ms);
    print_time("device", job->device_ms);
    print_time("upload", figures->render->upload_ms);
    print_time("compile", figures->render->compile_ms);
    print_time("render", figures->render->render_ms);
    if (figures->render->render_device_ms >= 0.0)
        print_time("  on the device", figures->render->render_device_ms);
    print_time("save", figures->sequence->save_ms);
    print_time("total", whit_clock_ms() - job->start_ms);
}

/* Prints nothing where no ray was cut. */
static void print_cut(const char *name, uint64_t count, double weight)
{
    if (count)
        printf("  %-18s %10llu   of weight %.3g at most in a pixel\n", name,
               (unsigned long long)count, weight);
}

static void print_rays(const struct figures *figures)
{
    puts("rays");
    printf("  %-18s %10llu\n", "primary", (unsigned long long)figures->render->rays_primary);
    printf("  %-18s %10llu\n", "shadow", (unsigned long long)figures->render->rays_shadow);
    printf("  %-18s %10llu\n", "reflected", (unsigned long long)figures->render->rays_reflected);
    printf("  %-18s %10llu\n", "refracted", (unsigned long long)figures->render->rays_refracted);
    if (figures->render->rays_straight)
        printf("  %-18s %10llu\n", "straight", (unsigned long long)figures->render->rays_straight);
    if (figures->render->rays_by_functions)
        printf("  %-18s %10llu\n", "by functions",
               (unsigned long long)figures->render->rays_by_functions);
    printf("  %-18s %10llu   %.2f Mray/s\n", "total",
           (unsigned long long)whit_stats_rays(figures->render), figures->render->mrays_per_s);
    print_cut("cut by --depth", figures->render->rays_cut_depth, figures->render->weight_cut_depth);
    print_cut("cut by --bailout", figures->render->rays_cut_bailout,
              figures->render->weight_cut_bailout);
    if (figures->render->rays_cut_bailout == 0)
        return;
    if (figures->render->bailout_bound >= 0.0)
        printf("  no pixel is off by more than %.3g because of --bailout\n",
               figures->render->bailout_bound);
    else
        puts("  how far off a pixel can be because of --bailout is not known for this scene");
}

/* Prints the materials that at least a hundredth of the stage's hits have. */
static void print_shares(const struct job *job, const struct figures *figures, uint32_t stage)
{
    for (uint32_t i = 0; i < figures->render->share_count; ++i) {
        const whit_share *share = &figures->render->shares[i];
        if (share->stage != stage || share->share < 0.01)
            continue;
        whit_material_info material;
        whit_scene_get_material(job->scene, share->material, &material);
        printf("    %5.1f %% of its hits: %u %s\n", 100.0 * share->share, share->material,
               cli_shown(material.name));
    }
}

static void print_stages(const struct job *job, const struct figures *figures)
{
    puts("stages                     ms       rays  ns a ray   of one tile in eight, by time "
         "stamps");
    for (int i = 0; i < WHIT_STAGES; ++i) {
        const whit_stage *stage = &figures->render->stages[i];
        if (stage->rays && stage->ms >= 0.0)
            printf("  %-18s %8.1f %10llu %9.1f\n", stage->name, stage->ms,
                   (unsigned long long)stage->rays, stage->ms * 1e6 / (double)stage->rays);
        else if (stage->rays)
            printf("  %-18s %8s %10llu\n", stage->name, "-", (unsigned long long)stage->rays);
        print_shares(job, figures, (uint32_t)i);
    }
}

static void print_samples(const struct figures *figures)
{
    const uint64_t *pixels = figures->render->pixels_by_samples;
    printf("pixels\n  of 1 sample %llu, of 4 %llu, of 16 %llu, of 64 %llu\n",
           (unsigned long long)pixels[0], (unsigned long long)pixels[1],
           (unsigned long long)pixels[2], (unsigned long long)pixels[3]);
}

static void print_refined(const struct figures *figures)
{
    const struct refined *refined = &figures->sequence->refined;
    printf("refined\n  %u samples a pixel", refined->now.samples);
    if (refined->now.error >= 0.0)
        printf(", an RMSE of %.3g may be left, %.3g of it of rays that were cut",
               refined->now.error, refined->now.error_of_cuts);
    putchar('\n');
    if (figures->render->rays_of_estimate)
        printf("  %llu rays more, for this estimate alone\n",
               (unsigned long long)figures->render->rays_of_estimate);
}

static void print_kernel(const struct figures *figures)
{
    const whit_kernel_info *kernel = &figures->kernel;
    if (kernel->general_instructions)
        printf("kernels\n  %u of %u instructions, %u in the largest, %u of %u bindings%s\n",
               kernel->instructions, kernel->general_instructions, kernel->largest_instructions,
               kernel->bindings, kernel->general_bindings,
               figures->render->general ? "; drawn by the general ones" : "");
}

static void print_frame(const char *name, const struct frame_times *times)
{
    printf("  %-10s %15.3f %10.3f %10.1f %10.1f\n", name, times->instances_ms, times->upload_ms,
           times->render_ms, times->save_ms);
}

static void print_frames(const struct sequence *sequence)
{
    puts("frames            instances ms  upload ms  render ms    save ms");
    for (uint32_t i = 0; i < sequence->count; ++i) {
        char name[16];
        snprintf(name, sizeof name, "%u", sequence->each[i].frame);
        print_frame(name, &sequence->each[i]);
    }
    print_frame("median", &sequence->median);
}

/* The driver's text without the device's name, with which some drivers begin: "llvmpipe (LLVM 15)",
   "llvmpipe Mesa 22.3". */
static const char *driver_of(const whit_device_info *device)
{
    size_t word = strcspn(device->name, " ");
    bool same = word && strncmp(device->name, device->driver, word) == 0;
    return same && device->driver[word] == ' ' ? device->driver + word + 1 : device->driver;
}

void stats_print_device(const char *label, const whit_device *device)
{
    whit_device_info info;
    whit_device_get_info(device, &info);
    printf("%s%s (%s)\n", label, cli_shown(info.name), cli_shown(driver_of(&info)));
}

static int print_text(const struct job *job, const struct render_request *request,
                      const struct figures *figures)
{
    const whit_accel_info *tree = &figures->tree;
    printf("scene      %s: %llu triangles in %u instance%s\n", cli_shown(job->settings.scene),
           (unsigned long long)figures->scene.triangle_count, figures->scene.instance_count,
           figures->scene.instance_count == 1 ? "" : "s");
    const whit_renderer_params *picture = &job->settings.picture;
    char samples[32] = "adaptive";
    if (picture->sampling.kind == WHIT_SAMPLING_FIXED)
        snprintf(samples, sizeof samples, "%u", picture->sampling.count);
    printf("picture    %s: %u x %u, %s samples a pixel, depth %u\n", cli_shown(request->output),
           picture->width, picture->height, samples, picture->depth);
    stats_print_device("device     ", job->device);
    print_times(job, figures);
    print_rays(figures);
    print_stages(job, figures);
    if (picture->sampling.kind == WHIT_SAMPLING_ADAPTIVE)
        print_samples(figures);
    if (figures->sequence->refined.now.samples)
        print_refined(figures);
    print_kernel(figures);
    if (job->settings.paint != PAINT_COLOR || request->counters)
        print_costs(figures->render);
    printf("trees\n  %s%u nodes, %u leaves, %u triangles, depth %u + %u, SAH cost %.2f\n",
           tree->one_tree ? "one in world space: " : "", tree->node_count, tree->leaf_count,
           tree->triangle_count, tree->instance_depth, tree->depth, tree->sah_cost);
    if (figures->frames)
        print_frames(figures->sequence);
    printf("work\n  %u dispatches, %u tiles of %u pixels a side, trees through %s loads%s\n",
           figures->render->dispatches, figures->render->tiles, figures->render->tile_size,
           value_word(values_load_path, (int)figures->render->load_path),
           figures->render->packets ? ", camera rays in packets" : "");
    if (figures->render->deferred > 0)
        printf("  %u steps of pixels' rays took more than floats\n", figures->render->deferred);
    printf("memory\n  host %.1f MiB at most, device %.1f MiB\n",
           (double)platform_peak_memory_bytes() / 1048576.0,
           (double)figures->render->device_bytes / 1048576.0);
    return cli_finish_stdout(EXIT_FINE);
}

int stats_print(const struct job *job, const struct render_request *request,
                const whit_renderer *renderer, const struct sequence *sequence)
{
    struct figures figures = {.render = &sequence->stats,
                              .sequence = sequence,
                              .frames = request->frames.given && !request->cameras.file};
    if (job->settings.stats == STATS_NONE)
        return EXIT_FINE;
    whit_scene_get_info(job->scene, &figures.scene);
    whit_accel_get_info(job->accel, &figures.tree);
    whit_device_get_info(job->device, &figures.device);
    if (whit_renderer_get_kernel(renderer, &figures.kernel) != WHIT_OK)
        figures.kernel = (whit_kernel_info){0};
    return job->settings.stats == STATS_JSON ? print_json(job, request, &figures)
                                             : print_text(job, request, &figures);
}
