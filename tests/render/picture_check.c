/* Checks a picture of any scene:

       picture_check SCENE [full | threads | validated | stored | levels | all-levels | flat |
                            small-flat | stages | few-stages]

   The picture is finite, neither black nor of one colour, and nothing that may not change it does
   so by one bit: tiles, threads, load paths, builders, a kernel with more effects. The kernel made
   for the scene is smaller than the one with every effect, which traces the same rays, and none of
   a kind that the scene does not call for. `full`: also the whole kernel by storage buffers, for
   which the driver takes up to 7 s; else that load path has a kernel of camera rays and lights.
   `full` and `threads`: by one, two and three threads; else by one of these numbers, in turns
   (WHIT_TEST_OFFSET), as are tiles, texel buffers and builders on the one hand, storage buffers and
   the kernel with more effects on the other: `full` and WHIT_TEST_TIMES have all.
   `validated`: the same picture under GPU-assisted validation; `stored`: by storage buffers, as
   GPUs read. `levels`: the kernel with every effect beside the scene's own at one of the other
   levels of numerics; at `exact` both without refraction, whose traversal makes the driver take
   twice as long. `all-levels`: with it. `flat`: where the scene is one tree by itself, at most one
   pixel in 10,000 is more than 1/255 off what it is with instances, and as few show another
   primitive; `small-flat`: of a small picture. `stages`: by all ways of stages, at three levels;
   `few-stages`: by some, at one.

       picture_check PICTURE WIDTH HEIGHT

   A picture in a file is finite, of that size, neither black nor of one colour. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../cases.h"
#include "whit.h"
#include "whit_program.h"

enum { WIDTH = 64, HEIGHT = 48 };

static bool failed;

static void check(bool holds, const char *what)
{
    printf("%s  %s\n", holds ? "ok    " : "FAILED", what);
    fflush(stdout);
    failed = failed || !holds;
}

/* Nothing is wrong with these scenes: a warning is a failure, as is a message of the validation
   layers. */
static void on_message(void *user, whit_log_level level, const char *message)
{
    (void)user;
    (void)level;
    fprintf(stderr, "picture_check: %s\n", message);
    failed = true;
}

static const whit_log messages = {.fn = on_message, .level = WHIT_LOG_WARNING};

/* ---- One picture ---- */

/* Pixels that differ from their right neighbour. */
static uint32_t count_steps(const float *pixels, const whit_image_info *info)
{
    uint32_t steps = 0;
    for (uint32_t y = 0; y < info->height; ++y) {
        for (uint32_t x = 0; x + 1 < info->width; ++x) {
            const float *a = pixels + (size_t)(y * info->width + x) * info->channels;
            float difference = 0.0f;
            for (uint32_t c = 0; c < 3; ++c)
                difference += fabsf(a[c] - a[c + info->channels]);
            steps += difference > 1.0f / 512.0f;
        }
    }
    return steps;
}

static const char *find_fault(const whit_image *image, unsigned long width, unsigned long height)
{
    whit_image_info info;
    whit_image_get_info(image, &info);
    const float *pixels = whit_image_floats(image);
    if (!pixels || info.channels < 3 || info.width != width || info.height != height)
        return "it has another size or kind";
    double sum = 0.0;
    size_t count = (size_t)info.width * info.height * info.channels;
    for (size_t i = 0; i < count; ++i) {
        if (!isfinite(pixels[i]) || pixels[i] < 0.0f)
            return "it has a value that is negative or not finite";
        sum += (double)pixels[i];
    }
    if (sum / (double)count < 0.01)
        return "it is black";
    if (count_steps(pixels, &info) < info.width * info.height / 32)
        return "it shows hardly anything";
    return NULL;
}

static void check_picture(const char *path, const whit_image *image, unsigned long width,
                          unsigned long height)
{
    const char *fault = find_fault(image, width, height);
    if (fault)
        fprintf(stderr, "%s: %s\n", path, fault);
    check(!fault, "the picture is worth the name");
}

static void check_file(const char *path, const char *width, const char *height)
{
    whit_image *image = NULL;
    if (whit_image_load(path, NULL, &messages, &image) == WHIT_OK)
        check_picture(path, image, strtoul(width, NULL, 10), strtoul(height, NULL, 10));
    whit_image_destroy(image);
}

/* ---- Pictures of a scene ---- */

/* The objects that a picture is drawn with. */
struct subject {
    const char *path;
    whit_scene *scene;
    whit_accel *accel;
    whit_device *device;
};

struct drawn {
    whit_image *color, *ids;
    whit_stats stats;
};

static void drawn_finish(struct drawn *drawn)
{
    whit_image_destroy(drawn->color);
    whit_image_destroy(drawn->ids);
    *drawn = (struct drawn){.color = NULL};
}

static bool draw(const struct subject *subject, const whit_renderer_params *params,
                 struct drawn *out)
{
    whit_renderer_params sized = *params;
    whit_renderer *renderer = NULL;
    const whit_renderer_params usual = whit_renderer_defaults();
    sized.depth = usual.depth; /* nobody asks for others */
    sized.bailout = usual.bailout;
    sized.width = sized.width ? sized.width : WIDTH;
    sized.height = sized.height ? sized.height : HEIGHT;
    *out = (struct drawn){.color = NULL};
    bool done =
        whit_renderer_create(subject->device, subject->accel, &sized, &renderer) == WHIT_OK &&
        whit_renderer_render(renderer) == WHIT_OK &&
        whit_renderer_image(renderer, WHIT_AOV_COLOR, &out->color) == WHIT_OK &&
        whit_renderer_image(renderer, WHIT_AOV_IDS, &out->ids) == WHIT_OK;
    if (done)
        whit_renderer_get_stats(renderer, &out->stats);
    whit_renderer_destroy(renderer);
    check(done, "a picture is drawn");
    return done;
}

static bool same_colors(const struct drawn *a, const struct drawn *b)
{
    const float *x = whit_image_floats(a->color), *y = whit_image_floats(b->color);
    return memcmp(x, y, sizeof *x * 4 * WIDTH * HEIGHT) == 0;
}

static bool same_ids(const struct drawn *a, const struct drawn *b)
{
    const uint32_t *x = whit_image_words(a->ids), *y = whit_image_words(b->ids);
    return memcmp(x, y, sizeof *x * 2 * WIDTH * HEIGHT) == 0;
}

/* Over trees of its own where `trees` is not NULL. */
static void check_same(const struct subject *subject, const struct drawn *first,
                       const whit_accel_params *trees, const whit_renderer_params *params,
                       const char *way)
{
    char what[96];
    struct drawn other = {.color = NULL};
    struct subject own = *subject;
    bool built = !trees || whit_accel_create(subject->scene, trees, &own.accel) == WHIT_OK;
    if (trees)
        check(built, "other trees are built");
    if (built && draw(&own, params, &other)) {
        snprintf(what, sizeof what, "%s gives the same picture", way);
        check(same_colors(first, &other), what);
        snprintf(what, sizeof what, "%s gives the same identities", way);
        check(same_ids(first, &other), what);
    }
    drawn_finish(&other);
    if (built && trees)
        whit_accel_destroy(own.accel);
}

/* On a device of its own too; drivers read the environment when a device is made. */
static void check_apart(const struct subject *subject, const struct drawn *first,
                        const whit_accel_params *trees, const whit_renderer_params *params,
                        const char *way)
{
    struct subject other = *subject;
    bool made = whit_device_create(NULL, &messages, &other.device) == WHIT_OK;
    check(made, "another device comes up");
    if (!made)
        return;
    check_same(&other, first, trees, params, way);
    check(whit_device_validation_messages(other.device) == 0,
          "the validation layers had nothing to say");
    whit_device_destroy(other.device);
}

/* ---- The kernel with every effect ---- */

static bool is_called(const whit_scene *scene, const char *name)
{
    const char *effect;
    for (uint32_t i = 0; (effect = whit_effect_name(i)) != NULL; ++i) {
        whit_effect_info info;
        whit_scene_get_effect(scene, i, &info);
        if (strcmp(effect, name) == 0)
            return info.called;
    }
    return false;
}

static void check_rays(const struct subject *subject, const char *effect, uint64_t own,
                       uint64_t all)
{
    char what[96];
    snprintf(what, sizeof what, "--effects all traces as many rays of %s", effect);
    check(own == all, what);
    snprintf(what, sizeof what, "no ray of %s where the scene does not call for it", effect);
    check(all == 0 || is_called(subject->scene, effect), what);
}

static uint64_t effect_bit(const char *name)
{
    uint32_t index = 0;
    while (strcmp(whit_effect_name(index), name) != 0)
        ++index;
    return UINT64_C(1) << index;
}

static void check_all_effects(const struct subject *subject, const struct drawn *first,
                              whit_renderer_params params, uint64_t removed)
{
    struct drawn other;
    params.all_effects = true;
    params.effects_removed = removed;
    if (draw(subject, &params, &other)) {
        const whit_stats *own = &first->stats, *all = &other.stats;
        check(same_colors(first, &other), "--effects all gives the same picture");
        check(same_ids(first, &other), "--effects all gives the same identities");
        printf("        %u of %u instructions\n", own->kernel_instructions,
               all->kernel_instructions);
        check(own->kernel_instructions < all->kernel_instructions,
              "the kernel of the scene has fewer instructions");
        check_rays(subject, "shadows", own->rays_shadow, all->rays_shadow);
        check_rays(subject, "reflection", own->rays_reflected, all->rays_reflected);
        check_rays(subject, "refraction", own->rays_refracted, all->rays_refracted);
    }
    drawn_finish(&other);
}

/* ---- Ways to draw the same ---- */

static void check_storage(const struct subject *subject, const struct drawn *first, bool full)
{
    uint64_t removed =
        full ? 0 : effect_bit("shadows") | effect_bit("reflection") | effect_bit("refraction");
    const whit_renderer_params texel = {.load_path = WHIT_LOAD_TEXEL, .effects_removed = removed},
                               storage = {.load_path = WHIT_LOAD_STORAGE,
                                          .effects_removed = removed};
    struct drawn small;
    if (full)
        check_same(subject, first, NULL, &storage, "--load-path storage");
    else if (draw(subject, &texel, &small))
        check_same(subject, &small, NULL, &storage, "--load-path storage, of camera rays,");
    if (!full)
        drawn_finish(&small);
}

static void check_ways(const struct subject *subject, const struct drawn *first)
{
    const whit_accel_params median = {.build = WHIT_BUILD_MEDIAN};
    const whit_renderer_params tile = {.tile_size = 512, .packets = WHIT_PACKETS_ON},
                               texel = {.load_path = WHIT_LOAD_TEXEL}, usual = {.tile_size = 0};
    check_same(subject, first, NULL, &tile, "--tile-size 512 --packets on");
    check_same(subject, first, NULL, &texel, "--load-path texel");
    check_same(subject, first, &median, &usual, "--build median");
}

/* A number by which checks take turns: it depends on the scene, and changes with each commit
   (WHIT_TEST_OFFSET). */
static uint32_t turn_of(const struct subject *subject)
{
    const char *offset = getenv("WHIT_TEST_OFFSET");
    uint32_t turn = offset ? (uint32_t)strtoul(offset, NULL, 10) : 0;
    for (const char *c = subject->path; *c; ++c)
        turn += (unsigned char)*c;
    return turn;
}

/* Each number of threads of the driver's and of whit's own, over tiles that are larger and smaller
   than needed; one of them where not `all` are asked for. */
static void check_threads(const struct subject *subject, const struct drawn *first, bool all)
{
    static const char *const drivers[] = {"0", "1", "2"};
    static const uint32_t tiles[] = {16, 17, 32};
    for (uint32_t i = 0; i < 3; ++i) {
        if (!all && turn_of(subject) % 3 != i)
            continue;
        char way[64];
        const whit_accel_params trees = {.threads = i + 1};
        const whit_renderer_params params = {.tile_size = tiles[i]};
        snprintf(way, sizeof way, "--tile-size %u --threads %u, LP_NUM_THREADS=%s", tiles[i], i + 1,
                 drivers[i]);
        setenv("LP_NUM_THREADS", drivers[i], 1);
        check_apart(subject, first, &trees, &params, way);
    }
    unsetenv("LP_NUM_THREADS");
}

static void check_usual(const struct subject *subject, const char *what)
{
    const whit_renderer_params usual = {.tile_size = 0};
    struct drawn first;
    if (draw(subject, &usual, &first)) {
        check_picture(subject->path, first.color, WIDTH, HEIGHT);
        const whit_renderer_params storage = {.load_path = WHIT_LOAD_STORAGE};
        bool stored = strcmp(what, "stored") == 0;
        if (stored || strcmp(what, "validated") == 0) {
            setenv("WHIT_VALIDATION", "1", 1);
            check_apart(subject, &first, NULL, stored ? &storage : &usual,
                        "GPU-assisted validation");
        } else {
            bool full = strcmp(what, "full") == 0;
            bool all = full || cases_times() > 0;
            check_threads(subject, &first, all || strcmp(what, "threads") == 0);
            if (all || turn_of(subject) % 2 == 0)
                check_ways(subject, &first);
            if (all || turn_of(subject) % 2 == 1) {
                check_storage(subject, &first, full);
                check_all_effects(subject, &first, usual, 0);
            }
        }
    }
    drawn_finish(&first);
}

static void check_level(const struct subject *subject, whit_numerics level, bool refraction)
{
    uint64_t removed = refraction ? 0 : effect_bit("refraction");
    const whit_renderer_params params = {
        .packets = WHIT_PACKETS_ON, .numerics = level, .effects_removed = removed};
    struct drawn first;
    if (draw(subject, &params, &first))
        check_all_effects(subject, &first, params, removed);
    drawn_finish(&first);
}

/* All, or one of the two with each commit. */
static void check_levels(const struct subject *subject, bool all)
{
    if (all || cases_turn(0, 2))
        check_level(subject, WHIT_NUMERICS_FAST, true);
    if (all || cases_turn(1, 2))
        check_level(subject, WHIT_NUMERICS_EXACT, all);
}

/* ---- Options that choose kernels, queues and tiles ---- */

/* Checks that these options do not change the picture. `few`: only the first two, which combine the
   options of kernels. */
static void check_stages(const struct subject *subject, whit_numerics level, bool few)
{
    static const struct {
        const char *name;
        whit_renderer_params params;
    } ways[] = {
        {"--packets on --segments 1", {.packets = WHIT_PACKETS_ON, .segments = 1}},
        {"--packets off --classes many --nodes 16",
         {.packets = WHIT_PACKETS_OFF, .classes = WHIT_CLASSES_MANY, .node_bytes = 16}},
        {"--packets on", {.packets = WHIT_PACKETS_ON}},
        {"--packets off", {.packets = WHIT_PACKETS_OFF}},
        {"--classes one", {.classes = WHIT_CLASSES_ONE}},
        {"--classes many", {.classes = WHIT_CLASSES_MANY}},
        {"--segments 1", {.segments = 1}},
        {"--segments 2", {.segments = 2}},
        {"--nodes 16", {.node_bytes = 16}},
        {"--nodes 32", {.node_bytes = 32}},
        {"--tile-size 17", {.tile_size = 17}},
    };
    whit_renderer_params params = {.numerics = level};
    struct drawn first;
    if (draw(subject, &params, &first)) {
        for (size_t i = 0; i < (few ? 2 : sizeof ways / sizeof *ways); ++i) {
            params = ways[i].params;
            params.numerics = level;
            if (level != WHIT_NUMERICS_FAST || params.packets != WHIT_PACKETS_ON)
                check_same(subject, &first, NULL, &params, ways[i].name);
        }
    }
    drawn_finish(&first);
}

/* ---- One tree in world space ---- */

static void compare_trees(const struct drawn *flat, const struct drawn *instanced)
{
    const whit_compare_params params = {.no_flip = true};
    whit_difference colors, ids;
    bool compared =
        whit_image_compare(instanced->color, flat->color, &params, &messages, &colors, NULL) ==
            WHIT_OK &&
        whit_image_compare(instanced->ids, flat->ids, &params, &messages, &ids, NULL) == WHIT_OK;
    check(compared, "the pictures can be compared");
    if (!compared)
        return;
    printf("        of %" PRIu64 " pixels %" PRIu64 " more than 1/255 off, %" PRIu64
           " of other bytes, %" PRIu64 " other primitives\n",
           colors.pixel_count, colors.over_1_255, colors.differing_pixels, ids.differing_pixels);
    check(colors.over_1_255 * 10000 <= colors.pixel_count, "one pixel in 10,000 is off at most");
    check(ids.differing_pixels * 10000 <= colors.pixel_count, "and shows another primitive");
    check(colors.differing_pixels > 0, "one tree is of other triangles");
}

static void check_flat(const struct subject *subject, uint32_t width, uint32_t height)
{
    const whit_accel_params instances = {.instances = WHIT_INSTANCES_ON};
    const whit_renderer_params params = {.width = width, .height = height};
    struct subject other = *subject;
    struct drawn flat = {.color = NULL}, instanced = {.color = NULL};
    whit_scene_info scene;
    whit_accel_info trees;
    whit_scene_get_info(subject->scene, &scene);
    whit_accel_get_info(subject->accel, &trees);
    check(trees.one_tree == scene.one_tree, "the trees are those that the scene says");
    if (!scene.one_tree)
        return;
    bool made = whit_accel_create(subject->scene, &instances, &other.accel) == WHIT_OK;
    check(made, "trees of meshes are built");
    if (made && draw(subject, &params, &flat) && draw(&other, &params, &instanced))
        compare_trees(&flat, &instanced);
    drawn_finish(&flat);
    drawn_finish(&instanced);
    if (made)
        whit_accel_destroy(other.accel);
}

static void check_scene(const char *path, const char *what)
{
    struct subject subject = {.path = path};
    bool opened = whit_scene_load(path, NULL, &messages, &subject.scene) == WHIT_OK &&
                  whit_accel_create(subject.scene, NULL, &subject.accel) == WHIT_OK &&
                  whit_device_create(NULL, &messages, &subject.device) == WHIT_OK;
    check(opened, "the scene loads and the device comes up");
    if (opened)
        whit_device_keep_kernels(subject.device);
    bool all = strcmp(what, "all-levels") == 0;
    if (opened && (all || strcmp(what, "levels") == 0))
        check_levels(&subject, all);
    else if (opened && strcmp(what, "few-stages") == 0)
        check_stages(&subject, WHIT_NUMERICS_WATERTIGHT, true);
    else if (opened && strcmp(what, "stages") == 0) {
        check_stages(&subject, WHIT_NUMERICS_WATERTIGHT, false);
        check_stages(&subject, WHIT_NUMERICS_EXACT, false);
        check_stages(&subject, WHIT_NUMERICS_FAST, false);
    } else if (opened && strcmp(what, "flat") == 0)
        check_flat(&subject, 640, 480);
    else if (opened && strcmp(what, "small-flat") == 0)
        check_flat(&subject, 160, 125);
    else if (opened)
        check_usual(&subject, what);
    if (opened)
        check(whit_device_validation_messages(subject.device) == 0,
              "the validation layers had nothing to say");
    whit_device_destroy(subject.device);
    whit_accel_destroy(subject.accel);
    whit_scene_destroy(subject.scene);
}

int main(int argc, char **argv)
{
    const char *what = argc == 3 ? argv[2] : "";
    bool known = !*what || strcmp(what, "full") == 0 || strcmp(what, "threads") == 0 ||
                 strcmp(what, "validated") == 0 || strcmp(what, "stored") == 0 ||
                 strcmp(what, "levels") == 0 || strcmp(what, "all-levels") == 0 ||
                 strcmp(what, "flat") == 0 || strcmp(what, "small-flat") == 0 ||
                 strcmp(what, "stages") == 0 || strcmp(what, "few-stages") == 0;
    if (argc < 2 || argc > 4 || !known) {
        fputs(
            "usage: picture_check SCENE [full | validated | stored | levels | all-levels | flat | "
            "small-flat | stages | few-stages]\n"
            "       picture_check PICTURE WIDTH HEIGHT\n",
            stderr);
        return 2;
    }
    if (argc == 4)
        check_file(argv[1], argv[2], argv[3]);
    else
        check_scene(argv[1], what);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
