/* Milliseconds of a whole picture: load, trees, and frames with camera rays only, with shadows, and
   with the full Whitted ray tree, interleaved.

       bench_frame SCENE [--size WxH] [--runs N] [--device D] [--levels]

   With --levels each at every numeric level, with the median of what the runs of a level take of
   the run of the level before it, by CPU time. Printed are medians and half the width of the middle
   half of the runs, wall clock and CPU time of all threads. The first frame of each kind, which
   compiles, is shown apart. Uses whit.h alone. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "whit.h"

enum { RUNS_MAX = 99, KINDS = 3, LEVELS = 3 };

/* By whit_numerics. */
static const char *const level_names[] = {"watertight", "fast", "exact"};

struct kind {
    const char *name;
    whit_numerics numerics;
    bool no_bounces, no_shadows;
    whit_renderer *renderer;
    double first_ms, wall_ms[RUNS_MAX], cpu_ms[RUNS_MAX];
    whit_stats stats;
};

static void print_message(void *user, whit_log_level level, const char *message)
{
    (void)user;
    (void)level;
    fprintf(stderr, "bench_frame: %s\n", message);
}

static double cpu_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *values, int count, double *spread)
{
    qsort(values, (size_t)count, sizeof *values, compare_doubles);
    *spread = 0.5 * (values[3 * count / 4] - values[count / 4]);
    return values[count / 2];
}

static bool run(struct kind *kind, int at)
{
    double wall = whit_clock_ms(), cpu = cpu_ms();
    if (whit_renderer_render(kind->renderer) != WHIT_OK)
        return false;
    wall = whit_clock_ms() - wall;
    whit_renderer_get_stats(kind->renderer, &kind->stats);
    if (at < 0) {
        kind->first_ms = wall - kind->stats.compile_ms;
        return true;
    }
    kind->wall_ms[at] = wall;
    kind->cpu_ms[at] = cpu_ms() - cpu;
    return true;
}

static void print_kind(struct kind *kind, int runs)
{
    double wall_spread, cpu_spread;
    double wall = median(kind->wall_ms, runs, &wall_spread);
    double cpu = median(kind->cpu_ms, runs, &cpu_spread);
    const whit_stats *s = &kind->stats;
    double rays =
        (double)(s->rays_primary + s->rays_shadow + s->rays_reflected + s->rays_refracted);
    printf("  %-13s %-10s %8.1f ms +- %5.1f   CPU %8.1f ms +- %5.1f   %5.2f Mray, %6.2f Mray/s   "
           "compile %.0f ms, first frame %.0f ms\n",
           kind->name, level_names[kind->numerics], wall, wall_spread, cpu, cpu_spread, rays * 1e-6,
           rays / wall * 1e-3, s->compile_ms, kind->first_ms);
}

/* Of the CPU time of a level that of the level before it: medians of pairs, with the middle half.
 */
static void print_ratio(const char *name, const struct kind *level, const struct kind *before,
                        int runs)
{
    double ratios[RUNS_MAX], spread;
    for (int i = 0; i < runs; ++i)
        ratios[i] = level->cpu_ms[i] / before->cpu_ms[i];
    double ratio = median(ratios, runs, &spread);
    printf("  %-13s %s takes %5.1f %% +- %.1f of the CPU time of %s\n", name,
           level_names[level->numerics], 100.0 * ratio, 100.0 * spread,
           level_names[before->numerics]);
}

/* fast, watertight, exact: each against the one before, before print_kind sorts the runs. */
static void print_levels(const struct kind *kinds, int runs)
{
    for (int k = 0; k < KINDS; ++k) {
        print_ratio(kinds[k].name, &kinds[k + KINDS], &kinds[k], runs);
        print_ratio(kinds[k].name, &kinds[k + 2 * KINDS], &kinds[k + KINDS], runs);
    }
}

static void name_levels(struct kind *kinds)
{
    static const whit_numerics levels[LEVELS] = {WHIT_NUMERICS_FAST, WHIT_NUMERICS_WATERTIGHT,
                                                 WHIT_NUMERICS_EXACT};
    for (int i = 0; i < LEVELS * KINDS; ++i) {
        kinds[i] = kinds[i % KINDS];
        kinds[i].numerics = levels[i / KINDS];
    }
}

static bool bench(const char *path, const char *selector, whit_renderer_params params, int runs,
                  bool all_levels)
{
    const whit_log log = {.fn = print_message, .level = WHIT_LOG_WARNING};
    static struct kind kinds[KINDS * LEVELS] = {
        {.name = "camera rays", .no_bounces = true, .no_shadows = true},
        {.name = "with shadows", .no_bounces = true},
        {.name = "full Whitted"}};
    int count = all_levels ? KINDS * LEVELS : KINDS;
    if (all_levels)
        name_levels(kinds);
    whit_scene *scene = NULL;
    whit_accel *accel = NULL;
    whit_device *device = NULL;
    double start = whit_clock_ms();
    bool fine = whit_scene_load(path, NULL, &log, &scene) == WHIT_OK;
    double loaded = whit_clock_ms();
    fine = fine && whit_accel_create(scene, NULL, &accel) == WHIT_OK;
    double built = whit_clock_ms();
    const whit_device_params device_params = {.selector = selector};
    fine = fine && whit_device_create(&device_params, &log, &device) == WHIT_OK;
    for (int k = 0; fine && k < count; ++k) {
        params.no_bounces = kinds[k].no_bounces;
        params.no_shadows = kinds[k].no_shadows;
        params.numerics = kinds[k].numerics;
        fine = whit_renderer_create(device, accel, &params, &kinds[k].renderer) == WHIT_OK;
    }
    for (int i = -1; fine && i < runs; ++i) {
        for (int k = 0; fine && k < count; ++k)
            fine = run(&kinds[k], i);
    }
    if (fine) {
        whit_scene_info info;
        whit_device_info where;
        whit_scene_get_info(scene, &info);
        whit_device_get_info(device, &where);
        printf("%s at %u x %u: %llu triangles, %u instances, %u lights; %s (%s); %d runs\n", path,
               params.width, params.height, (unsigned long long)info.triangle_count,
               info.instance_count, info.light_count, where.name, where.driver, runs);
        printf("  load %.1f ms, trees %.1f ms, peak memory %.0f MiB, files %.1f MiB\n",
               loaded - start, built - loaded, (double)whit_peak_memory_bytes() / 1048576.0,
               (double)info.file_bytes / 1048576.0);
        if (all_levels)
            print_levels(kinds, runs);
        for (int k = 0; k < count; ++k)
            print_kind(&kinds[k], runs);
    }
    for (int k = 0; k < count; ++k)
        whit_renderer_destroy(kinds[k].renderer);
    whit_device_destroy(device);
    whit_accel_destroy(accel);
    whit_scene_destroy(scene);
    return fine;
}

int main(int argc, char **argv)
{
    const char *path = NULL, *selector = NULL;
    whit_renderer_params params = {.width = 1280, .height = 720};
    int runs = 7;
    bool all_levels = false;
    for (int i = 1; i < argc; ++i) {
        if (strcmp(argv[i], "--size") == 0 && i + 1 < argc)
            sscanf(argv[++i], "%ux%u", &params.width, &params.height);
        else if (strcmp(argv[i], "--runs") == 0 && i + 1 < argc)
            runs = atoi(argv[++i]);
        else if (strcmp(argv[i], "--device") == 0 && i + 1 < argc)
            selector = argv[++i];
        else if (strcmp(argv[i], "--levels") == 0)
            all_levels = true;
        else
            path = argv[i];
    }
    if (!path || runs < 1 || runs > RUNS_MAX) {
        fprintf(stderr,
                "usage: bench_frame SCENE [--size WxH] [--runs N] [--device D] [--levels]\n");
        return 2;
    }
    return bench(path, selector, params, runs, all_levels) ? 0 : 1;
}
