#include "app/arguments.h"
#include "app/commands.h"
#include "app/document.h"
#include "app/job.h"
#include "base/path.h"
#include <math.h>

enum metric {
    METRIC_RMSE,
    METRIC_RELMSE,
    METRIC_LARGEST,
    METRIC_MEAN,
    METRIC_OVER, /* this metric and the following ones count pixels that are not finite */
    METRIC_DIFFERING,
    METRIC_FLIP,
    METRIC_COUNT
};
static const struct setting_value values_metric[] = {
    {"rmse", METRIC_RMSE, NULL},       {"relmse", METRIC_RELMSE, NULL},
    {"largest", METRIC_LARGEST, NULL}, {"mean", METRIC_MEAN, NULL},
    {"over", METRIC_OVER, NULL},       {"differing", METRIC_DIFFERING, NULL},
    {"flip", METRIC_FLIP, NULL},       {0}};

struct compare {
    const char *paths[2];
    const char *diff, *flip, *json; /* or NULL */
    double tolerance;               /* < 0: none */
    uint32_t metric;                /* METRIC_COUNT: not given */
    bool has_metric;
    whit_compare_params params;
    struct job job; /* its settings say how the pictures are read */
    whit_image *images[2], *flip_map;
    whit_image_info info;
    whit_difference found;
};

static const struct setting options[] = {
    {"tolerance", 0, "X", "exit code 1 when the metric is over X",
     SETTING_AT_NUMBER(struct compare, tolerance), .max = 1e30},
    {"metric", 0, "NAME",
     "which one --tolerance is for, and the only one that is printed:\n"
     "rmse relmse largest mean over differing flip (flip; of hit\n"
     "identities differing)",
     SETTING_AT_CHOICE(struct compare, metric), .values = values_metric},
    {"diff", 0, "FILE",
     "B - A: .png as colours, blue where B is darker, brown where it is\n"
     "brighter; .exr .pfm as linear numbers",
     SETTING_AT_NAME(struct compare, diff), .written = true},
    {"flip", 0, "FILE", "FLIP of each pixel: .png as a heat map; .exr .pfm as numbers",
     SETTING_AT_NAME(struct compare, flip), .written = true},
    {"json", 0, "FILE", "all metrics as JSON", SETTING_AT_NAME(struct compare, json),
     .written = true},
    {"ppd", 0, "N", "for FLIP: pixels in one degree of what is seen, 1 to 1000 (67.02)",
     SETTING_AT_NUMBER(struct compare, params.pixels_per_degree), .min = 1.0, .max = 1000.0},
    {0},
};

/* ---- Figures ---- */

static double share_of(const struct compare *compare, uint64_t pixels)
{
    return (double)pixels / (double)compare->found.pixel_count;
}

static double value_of(const struct compare *compare, uint32_t metric)
{
    const whit_difference *found = &compare->found;
    switch (metric) {
    case METRIC_RMSE:
        return found->rmse;
    case METRIC_RELMSE:
        return found->relative_mse;
    case METRIC_LARGEST:
        return found->largest;
    case METRIC_MEAN:
        return (found->mean[0] + found->mean[1] + found->mean[2]) / 3.0;
    case METRIC_OVER:
        return share_of(compare, found->over_1_255);
    case METRIC_DIFFERING:
        return share_of(compare, found->differing_pixels);
    default:
        return found->flip_mean;
    }
}

static double resolution_of(const struct compare *compare)
{
    double given = compare->params.pixels_per_degree;
    return given > 0.0 ? given : WHIT_FLIP_PIXELS_PER_DEGREE;
}

static void print_metric(const struct compare *compare, uint32_t metric)
{
    const whit_difference *found = &compare->found;
    unsigned long long pixels = found->pixel_count;
    printf("  %-10s %.6g", value_word(values_metric, (int)metric), value_of(compare, metric));
    if (metric == METRIC_MEAN)
        printf("  (B - A: red %.6g, green %.6g, blue %.6g)", found->mean[0], found->mean[1],
               found->mean[2]);
    else if (metric == METRIC_OVER)
        printf("  (%llu of %llu pixels more than 1/255 apart as displayed)",
               (unsigned long long)found->over_1_255, pixels);
    else if (metric == METRIC_DIFFERING)
        printf("  (%llu of %llu pixels not the same)", (unsigned long long)found->differing_pixels,
               pixels);
    else if (metric == METRIC_FLIP)
        printf("  (mean; largest %.6g; %.2f pixels a degree)", found->flip_largest,
               resolution_of(compare));
    putchar('\n');
}

static void print_head(const struct compare *compare)
{
    const whit_image_info *info = &compare->info;
    printf("A %s\nB %s\n", cli_shown(compare->paths[0]), cli_shown(compare->paths[1]));
    printf("  %u x %u pixels%s\n", info->width, info->height,
           info->integers ? ", hit identities" : "");
}

static int print_text(const struct compare *compare)
{
    const whit_difference *found = &compare->found;
    if (compare->job.settings.quiet || cli_is_piped(compare->json))
        return EXIT_FINE;
    if (compare->has_metric) {
        print_metric(compare, compare->metric);
        return cli_finish_stdout(EXIT_FINE);
    }
    print_head(compare);
    for (uint32_t metric = 0; metric < METRIC_COUNT; ++metric) {
        if (!compare->info.integers || metric == METRIC_DIFFERING)
            print_metric(compare, metric);
    }
    if (!compare->info.integers)
        printf("  %-10s %llu in A, %llu in B, of %llu pixels\n", "nonfinite",
               (unsigned long long)found->nonfinite_a, (unsigned long long)found->nonfinite_b,
               (unsigned long long)found->pixel_count);
    return cli_finish_stdout(EXIT_FINE);
}

/* Adds a number that has no meaning for images of hit identities, for which it is null. */
static void put_number(const struct compare *compare, json_t *object, const char *key, double value)
{
    document_number(object, key, compare->info.integers ? (double)NAN : value);
}

/* Pixels that are not finite in only one of the two pictures are in no mean, so with such pixels no
   tolerance for a mean is met. */
static bool is_within(const struct compare *compare)
{
    const whit_difference *found = &compare->found;
    bool sees_all = compare->metric >= METRIC_OVER;
    if (found->nonfinite_differing && !sees_all)
        return false;
    return fabs(value_of(compare, compare->metric)) <= compare->tolerance;
}

static whit_result save_json(const struct compare *compare)
{
    const whit_difference *found = &compare->found;
    bool integers = compare->info.integers;
    json_t *root = document_root(), *flip = integers ? json_null() : document_object();
    document_text(root, "a", compare->paths[0]);
    document_text(root, "b", compare->paths[1]);
    document_count(root, "width", compare->info.width);
    document_count(root, "height", compare->info.height);
    document_flag(root, "integers", integers);
    document_count(root, "pixels", found->pixel_count);
    document_count(root, "differing_pixels", found->differing_pixels);
    document_count(root, "over_1_255", found->over_1_255);
    document_count(root, "nonfinite_a", found->nonfinite_a);
    document_count(root, "nonfinite_b", found->nonfinite_b);
    document_count(root, "nonfinite_differing", found->nonfinite_differing);
    put_number(compare, root, "rmse", found->rmse);
    put_number(compare, root, "relative_mse", found->relative_mse);
    put_number(compare, root, "largest", found->largest);
    document_numbers(root, "mean", found->mean, 3);
    if (!integers) {
        document_number(flip, "mean", found->flip_mean);
        document_number(flip, "largest", found->flip_largest);
        document_number(flip, "pixels_per_degree", resolution_of(compare));
    }
    document_put(root, "flip", flip);
    document_text(root, "metric", value_word(values_metric, (int)compare->metric));
    document_number(root, "tolerance", document_known(compare->tolerance));
    document_put(root, "within",
                 compare->tolerance >= 0.0 ? json_boolean(is_within(compare)) : json_null());
    return document_save(root, compare->json);
}

/* ---- Tolerance ---- */

static int judge(const struct compare *compare)
{
    const whit_difference *found = &compare->found;
    if (compare->tolerance < 0.0 || is_within(compare))
        return EXIT_FINE;
    double value = value_of(compare, compare->metric);
    if (fabs(value) <= compare->tolerance)
        cli_error("%s is within %.6g, but leaves out %llu pixels that differ and are not finite",
                  value_word(values_metric, (int)compare->metric), compare->tolerance,
                  (unsigned long long)found->nonfinite_differing);
    else
        cli_error("%s is %.6g, over %.6g", value_word(values_metric, (int)compare->metric), value,
                  compare->tolerance);
    return EXIT_DIFFERS;
}

/* ---- Pictures ---- */

/* Saves a .png as a heat map, other files as numbers. */
static whit_result save_values(const whit_image *values, const char *path,
                               const whit_heat_params *heat)
{
    whit_image *colours = NULL;
    whit_result result = WHIT_OK;
    if (path_is(path, "png"))
        result = whit_image_heat(values, heat, &colours);
    if (result == WHIT_OK) {
        cli_set_saving();
        result = whit_image_save(colours ? colours : values, path, NULL, 0, &cli_log);
    }
    whit_image_destroy(colours);
    return result;
}

static whit_result save_diff(const struct compare *compare)
{
    const whit_heat_params heat = {.is_signed = true, .title = "B - A", .unit = "linear"};
    whit_image *difference = NULL;
    whit_result result =
        whit_image_subtract(compare->images[0], compare->images[1], &cli_log, &difference);
    if (result == WHIT_OK)
        result = save_values(difference, compare->diff, &heat);
    whit_image_destroy(difference);
    return result;
}

static whit_result save_flip(const struct compare *compare)
{
    const whit_heat_params heat = {.scale = 1.0, .title = "FLIP", .unit = "0: looks the same"};
    return save_values(compare->flip_map, compare->flip, &heat);
}

static whit_result save_all(const struct compare *compare)
{
    whit_result result = WHIT_OK;
    if (compare->diff)
        result = save_diff(compare);
    if (result == WHIT_OK && compare->flip)
        result = save_flip(compare);
    if (result == WHIT_OK && compare->json)
        result = save_json(compare);
    return result;
}

/* ---- Work ---- */

static whit_result check_pair(struct compare *compare)
{
    whit_image_info a, b;
    const char *const *paths = compare->paths;
    whit_image_get_info(compare->images[0], &a);
    whit_image_get_info(compare->images[1], &b);
    compare->info = a;
    if (a.width != b.width || a.height != b.height)
        cli_error("%s is %u x %u, %s is %u x %u: only pictures of one size can be compared",
                  paths[0], a.width, a.height, paths[1], b.width, b.height);
    else if (a.integers != b.integers)
        cli_error("%s holds hit identities, %s colours", paths[!a.integers], paths[a.integers]);
    else if (a.integers && a.channels != b.channels)
        cli_error("%s has %u channels of integers, %s %u", paths[0], a.channels, paths[1],
                  b.channels);
    else if (a.integers && (compare->diff || compare->flip))
        cli_error("--%s: hit identities have no colours", compare->diff ? "diff" : "flip");
    else if (a.integers && compare->has_metric && compare->metric != METRIC_DIFFERING)
        cli_error("--metric %s: of hit identities there is only `differing`",
                  value_word(values_metric, (int)compare->metric));
    else
        return WHIT_OK;
    return WHIT_ERROR_INPUT;
}

/* Checks the memory for both pictures and FLIP by the first one, before the second is decoded. */
static whit_result check_memory(const struct compare *compare, const whit_load_params *load)
{
    enum { FLIP_BYTES = 52 }; /* of a pixel, as image_flip says */
    const double mebibyte = 1 << 20;
    const char *path = compare->paths[0];
    whit_image_info info;
    whit_image_get_info(compare->images[0], &info);
    bool flip = !info.integers && !compare->params.no_flip;
    double bytes = (double)info.width * info.height *
                   (2.0 * sizeof(float) * info.channels + (flip ? FLIP_BYTES : 0));
    double limit = (double)whit_memory_limit(load);
    if (bytes <= limit)
        return WHIT_OK;
    cli_error(
        "%s: comparing pictures of %u x %u pixels would take %.4g MiB of memory; the limit is "
        "%.4g MiB (--memory-limit)%s",
        path, info.width, info.height, bytes / mebibyte, limit / mebibyte,
        flip ? ", and other metrics than FLIP take less (--metric)" : "");
    return WHIT_ERROR_INPUT;
}

static whit_result find_out(struct compare *compare)
{
    const char *folders[SETTING_FOLDERS_MAX];
    whit_load_params load = settings_load(&compare->job.settings, folders);
    whit_result result = WHIT_OK;
    load.cancel = &cli_cancel;
    compare->params.no_flip =
        compare->has_metric && compare->metric != METRIC_FLIP && !compare->flip && !compare->json;
    for (int i = 0; result == WHIT_OK && i < 2; ++i) {
        result = whit_image_load(compare->paths[i], &load, &cli_log, &compare->images[i]);
        if (result == WHIT_OK && i == 0)
            result = check_memory(compare, &load);
        if (result == WHIT_OK)
            result = job_still_wanted();
    }
    if (result == WHIT_OK)
        result = check_pair(compare);
    if (result != WHIT_OK)
        return result;
    if (compare->info.integers)
        compare->metric = METRIC_DIFFERING;
    result = whit_image_compare(compare->images[0], compare->images[1], &compare->params, &cli_log,
                                &compare->found, &compare->flip_map);
    return result == WHIT_OK ? job_still_wanted() : result;
}

static int work(struct compare *compare)
{
    whit_result result = find_out(compare);
    if (result == WHIT_OK)
        result = save_all(compare);
    int status = result == WHIT_OK ? print_text(compare) : cli_exit_of(result);
    if (status == EXIT_FINE)
        status = judge(compare);
    whit_image_destroy(compare->images[0]);
    whit_image_destroy(compare->images[1]);
    whit_image_destroy(compare->flip_map);
    return status;
}

/* ---- Options ---- */

static bool check_picture(struct cli_reader *reader, const char *option, const char *path)
{
    if (!path || whit_image_format_known(path, false))
        return true;
    return cli_misuse(reader, "%s %s: .png, .exr or .pfm is needed", option, path);
}

static bool check_request(struct cli_reader *reader, struct compare *compare)
{
    compare->paths[0] = reader->positional;
    compare->paths[1] = reader->others[0];
    if (!compare->paths[1])
        return cli_misuse(reader, "%s missing", compare->paths[0] ? "B is" : "A and B are");
    return check_picture(reader, "--diff", compare->diff) &&
           check_picture(reader, "--flip", compare->flip) &&
           cli_no_dash(reader, "--json", compare->json, "for a pipe give /dev/stdout") &&
           cli_check_writable(reader, compare->diff) && cli_check_writable(reader, compare->flip) &&
           cli_check_writable(reader, compare->json);
}

static int run(const struct cli_command *command, int argc, char **argv)
{
    struct cli_reader reader;
    struct compare compare = {.tolerance = -1.0, .metric = METRIC_COUNT};
    job_init(&compare.job, command);
    cli_reader_init(&reader, command, argc, argv);
    if (!cli_read(&reader, &compare, &compare.job.settings) || !check_request(&reader, &compare))
        return reader.status;
    compare.has_metric = compare.metric != METRIC_COUNT;
    if (!compare.has_metric)
        compare.metric = METRIC_FLIP;
    return work(&compare);
}

const struct cli_command command_compare = {
    .name = "compare",
    .arguments = "A B [options]",
    .summary = "Measures how picture B differs from A, the reference.",
    .details =
        "A and B are PNG, EXR, PFM or HDR, any mix; PNG is taken from sRGB to linear. Metrics are\n"
        "over linear RGB, alpha counts only as `differing` and `over`; FLIP is of the pictures as\n"
        "displayed. Pixels that are not finite are left out of all but `over`, `differing` and\n"
        "`flip`; with them no other metric passes a tolerance.\n",
    .options = options,
    .settings = IN_COMPARE,
    .others_max = 1,
    .run = run,
};
