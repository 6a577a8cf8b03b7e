/* The rays of probed pixels are all rays of the picture, and add up to its colour; the CPU agrees
   with every ray; kernels of pictures have no code for probes. */
#include "../cases.h"
#include "device/pipeline.h"
#include "picture_fixture.h"
#include "render/probe.h"
#include "render/renderer.h"
#include "render_scenes.h"
#include "unit.h"

enum { SIDE = 8 };

/* ---- Checks of every probed pixel ---- */

/* Sums over the probes of all pixels of a picture. */
struct sums {
    uint64_t kinds[RAY_KIND_COUNT], cut_depth, cut_bailout;
    uint64_t ends[PROBE_BLOCKED + 1];
    uint64_t rays, passed, exact, exact_equal, straight, through;
};

static uint32_t kind_of(const struct probe_ray *ray)
{
    return ray->traced.kind & PROBE_KIND_MASK;
}

static bool is_cut(const struct probe_ray *ray)
{
    return ray->traced.end == PROBE_DEPTH || ray->traced.end == PROBE_BAILOUT;
}

static void add_to_sums(const struct probe_report *report, struct sums *sums)
{
    for (uint32_t i = 0; i < report->ray_count; ++i) {
        const struct probe_ray *ray = &report->rays[i];
        bool straight = ray->traced.kind & PROBE_STRAIGHT;
        ++sums->ends[ray->traced.end];
        sums->cut_depth += ray->traced.end == PROBE_DEPTH;
        sums->cut_bailout += ray->traced.end == PROBE_BAILOUT;
        /* A ray that goes straight on through a blended surface is of no kind of its own. */
        sums->kinds[kind_of(ray)] += !straight && !is_cut(ray);
        sums->straight += straight && !is_cut(ray);
        sums->through += (ray->traced.kind & PROBE_THROUGH) != 0;
        sums->passed += ray->passed;
        sums->exact += ray->exact_known;
        sums->exact_equal += ray->exact_known && ray->exact_equal;
        ++sums->rays;
    }
}

static double distance_between(const float a[3], const float b[3])
{
    return hypot(hypot((double)a[0] - (double)b[0], (double)a[1] - (double)b[1]),
                 (double)a[2] - (double)b[2]);
}

static double size_of(const float a[3])
{
    return distance_between(a, (const float[3]){0, 0, 0});
}

/* Asserts that ray `i` fits the ray that it comes from. */
static void assert_child(const struct probe_ray *rays, uint32_t i)
{
    const struct probe_ray *ray = &rays[i], *parent = &rays[ray->parent];
    assert_true(ray->parent < i);
    assert_int_equal(ray->generation, parent->generation + 1);
    assert_int_equal(parent->traced.end, PROBE_HIT);
    assert_true(parent->traced.primitive != HIT_NONE);
    /* Also where a ray leaves a plane through 0: see next_float of shaders/lib/spawn.glsl. */
    for (int k = 0; k < 3; ++k)
        assert_int_not_equal(fpclassify(ray->traced.origin[k]), FP_SUBNORMAL);
    if (kind_of(ray) == RAY_SHADOW) {
        assert_true(ray->traced.end == PROBE_REACHED || ray->traced.end == PROBE_BLOCKED);
    } else {
        /* Where media touch the next ray starts at the last of the surfaces that are crossed. */
        double far = distance_between(ray->traced.origin, parent->traced.point);
        assert_true(far <= 1e-4 * (1.0 + size_of(parent->traced.point)));
        for (int k = 0; k < 3; ++k)
            assert_true(ray->traced.weight[k] <= parent->traced.weight[k] * 1.000001f);
    }
    if (!is_cut(ray))
        assert_true(fabs(size_of(ray->traced.dir) - 1.0) < 1e-5);
}

static void assert_ray(const struct probe_ray *rays, uint32_t i)
{
    const struct probe_ray *ray = &rays[i];
    bool shadow = kind_of(ray) == RAY_SHADOW;
    if (i == 0) {
        assert_int_equal(ray->parent, HIT_NONE);
        assert_int_equal(kind_of(ray), RAY_PRIMARY);
        for (int k = 0; k < 3; ++k)
            assert_true(ray->traced.weight[k] == 1.0f);
    } else {
        assert_child(rays, i);
    }
    if (!ray->equal)
        fail_msg("ray %u, kind %u, end %u: device t %.9g of %u/%u, twin t %.9g of %u/%u", i,
                 kind_of(ray), ray->traced.end, (double)ray->traced.t, ray->traced.instance,
                 ray->traced.primitive, (double)ray->twin.t, ray->twin.instance,
                 ray->twin.primitive);
    assert_int_not_equal(ray->traced.end, PROBE_DEFERRED);
    if (ray->traced.end == PROBE_HIT)
        assert_true(isfinite(ray->traced.t) && ray->traced.material != HIT_NONE);
    if (ray->traced.end == PROBE_MISSED)
        assert_true(isinf(ray->traced.t) && ray->traced.primitive == HIT_NONE);
    for (int k = 0; shadow && k < 3; ++k)
        assert_true(ray->traced.added[k] >= 0.0f && ray->traced.added[k] <= 1.0f &&
                    (ray->traced.end == PROBE_REACHED || ray->traced.added[k] == 0.0f));
}

/* Asserts that the rays of one sample add up to its colour. Each ray adds its own light and that of
   the rays that are refracted, go straight on and are reflected. The sum has the same bits, except
   behind shadow catchers, which take their share of all of it at once. */
static void assert_sum_is_color(const struct probe_report *report)
{
    uint32_t count = report->ray_count;
    float(*brought)[3][3] = calloc(count, sizeof *brought);
    bool straight_on = false;
    assert_non_null(brought);
    for (uint32_t i = count; i-- > 0;) {
        const struct probe_ray *ray = &report->rays[i];
        bool straight = ray->traced.kind & PROBE_STRAIGHT;
        float sum[3];
        if (kind_of(ray) == RAY_SHADOW)
            continue;
        straight_on |= straight;
        for (int k = 0; k < 3; ++k)
            sum[k] = ray->traced.added[k] + brought[i][0][k] + brought[i][1][k] + brought[i][2][k];
        if (i > 0)
            memcpy(brought[ray->parent][straight                        ? 1
                                        : kind_of(ray) == RAY_REFLECTED ? 2
                                                                        : 0],
                   sum, sizeof sum);
        else if (!straight_on)
            assert_memory_equal(sum, report->color, sizeof sum);
        for (int k = 0; i == 0 && k < 3; ++k)
            assert_true(fabsf(sum[k] - report->color[k]) <= 1e-6f * (1.0f + sum[k]));
    }
    free(brought);
}

static void assert_report(const struct probe_report *report)
{
    assert_true(report->ray_count > 0);
    for (uint32_t i = 0; i < report->ray_count; ++i)
        assert_ray(report->rays, i);
    assert_int_equal(report->differing, 0);
    if (report->samples == 1 && report->dropped == 0)
        assert_sum_is_color(report);
}

/* ---- A picture, pixel by pixel ---- */

/* Freed at the end of its block. */
#define own_report __attribute__((cleanup(probe_report_finish), unused)) struct probe_report

/* Probes a pixel; records at most `max` rays, 0: all. */
static struct probe_report probe(const struct fixture *f, uint32_t x, uint32_t y, uint32_t max)
{
    struct probe_report report;
    assert_int_equal(renderer_probe(f->renderer, x, y, max, &report), WHIT_OK);
    assert_report(&report);
    return report;
}

static struct sums probe_picture(struct fixture *f)
{
    struct sums sums = {0};
    own_picture before = render_picture(f);
    const whit_stats *stats = &before.stats;
    uint32_t width = before.color.width, pixels = width * before.color.height;
    for (uint32_t i = 0; i < pixels; ++i) {
        own_report report = probe(f, i % width, i / width, 0);
        assert_int_equal(report.dropped, 0);
        assert_memory_equal(report.color, &before.color.pixels[4 * (size_t)i], 3 * sizeof(float));
        assert_int_equal(report.rays[0].traced.instance, before.ids.words[2 * (size_t)i]);
        assert_int_equal(report.rays[0].traced.primitive, before.ids.words[2 * (size_t)i + 1]);
        add_to_sums(&report, &sums);
    }
    if (stats->rays_primary == pixels) {
        assert_int_equal(sums.kinds[RAY_PRIMARY], stats->rays_primary);
        assert_int_equal(sums.kinds[RAY_SHADOW], stats->rays_shadow);
        assert_int_equal(sums.kinds[RAY_REFLECTED], stats->rays_reflected);
        assert_int_equal(sums.kinds[RAY_REFRACTED], stats->rays_refracted);
        assert_int_equal(sums.straight, stats->rays_straight);
        assert_int_equal(sums.cut_depth, stats->rays_cut_depth);
        assert_int_equal(sums.cut_bailout, stats->rays_cut_bailout);
    }
    /* The picture and its figures are what they were. */
    whit_stats later;
    own_image after = {0};
    renderer_get_stats(f->renderer, &later);
    assert_int_equal(later.dispatches, stats->dispatches);
    assert_true(later.render_ms == stats->render_ms);
    assert_int_equal(renderer_read_color(f->renderer, &after), WHIT_OK);
    assert_same_image("after probes", &after, &before.color);
    print_message("  %llu rays: %llu shadow, %llu reflected, %llu refracted, %llu straight; cut "
                  "%llu + %llu; %llu surfaces let rays pass; exact agrees with %llu of %llu\n",
                  (unsigned long long)sums.rays, (unsigned long long)sums.kinds[RAY_SHADOW],
                  (unsigned long long)sums.kinds[RAY_REFLECTED],
                  (unsigned long long)sums.kinds[RAY_REFRACTED], (unsigned long long)sums.straight,
                  (unsigned long long)sums.cut_depth, (unsigned long long)sums.cut_bailout,
                  (unsigned long long)sums.passed, (unsigned long long)sums.exact_equal,
                  (unsigned long long)sums.exact);
    return sums;
}

static const whit_renderer_params small = {
    .width = SIDE, .height = SIDE, .camera = GLASS_CAMERA, .depth = 5, .bailout = 0.05};

static void assert_all_kinds(const struct sums *sums)
{
    for (uint32_t k = 0; k < RAY_KIND_COUNT; ++k)
        assert_true(sums->kinds[k] > 0);
    assert_true(sums->cut_depth > 0 && sums->cut_bailout > 0);
    assert_true(sums->ends[PROBE_MISSED] > 0 && sums->ends[PROBE_REACHED] > 0);
    assert_true(sums->exact > sums->rays / 2 && sums->exact_equal > 0);
}

/* surfaces_let_rays_pass checks the same only at `exact`, whose kernels take longest to compile;
   scenes_of_all_kinds has surfaces that let rays pass at other levels. */
TEST_BY_TURNS(rays_are_those_of_the_picture, 0, 2)
{
    own_fixture f = fixture_open(glass_scene(), NULL, &small);
    struct sums sums = probe_picture(&f);
    assert_all_kinds(&sums);
}

/* ---- Surfaces that let rays pass ---- */

/* Objects behind each other: a cut-out by a texture, a blended box, a one-sided pane, a shadow
   catcher, a ball and a block of glass, and a mirror, under a lamp and a flat emitter. */
static struct scene *sieve_scene(void)
{
    struct scene *scene = dark_scene((double[]){0, 1.5, 7}, (double[]){0, 0.8, 0});
    uint32_t texture = add_two_texels(scene, 40, 250);
    struct scene_material m = matte(0.7f, 0.6f, 0.5f);
    add_object(scene, mesh_plane(12), m, 0, 0, 0);
    use_texture(&m, SCENE_SLOT_OPACITY, texture);
    m.alpha = SCENE_ALPHA_MASK;
    m.alpha_cutoff = 0.5f;
    add_object(scene, mesh_box(1.5, 1.2, 0.1), m, -0.6, 0.9, 2);
    m = matte(0.2f, 0.5f, 0.9f);
    m.alpha = SCENE_ALPHA_BLEND;
    m.opacity = 0.4f;
    add_object(scene, mesh_box(0.8, 1.5, 0.1), m, 0.9, 0.9, 1.5);
    m = matte(0.5f, 0.5f, 0.5f);
    m.one_sided = true;
    add_object(scene, mesh_box(8, 8, 14), m, 0, 3, 1.5); /* around all, seen from inside */
    m = material_plain("catcher");
    m.shadow_catcher = true;
    add_object(scene, mesh_box(1, 0.1, 1), m, 1.2, 0.1, 2.6);
    m = material_plain("glass");
    set_rgb(m.transmission, 0.9f, 0.8f, 0.9f);
    m.ior = 1.5f;
    m.fresnel = true;
    struct scene_mesh ball = mesh_balls((const double[]){0, 0, 0, 0.5}, 1);
    add_object(scene, ball, m, 0.2, 0.6, 0.4);
    add_object(scene, mesh_box(0.5, 0.4, 0.3), m, -1.4, 0.3, 2.8);
    m = material_plain("mirror");
    set_rgb(m.reflection, 0.8f, 0.8f, 0.8f);
    add_object(scene, mesh_box(3, 2.5, 0.2), m, 0, 1.2, -1.5);
    scene_put_lamp(scene, 2, 3.5, 4, 6.0f);
    scene_put_light(scene, emitter(WHIT_LIGHT_RECTANGLE, (double[]){-1, 5, 0}, (double[]){1, 0, 0},
                                   (double[]){0, 0, 1}, 3));
    return scene;
}

static const whit_renderer_params sieve_params = {
    .width = SIDE, .height = 6, .depth = 3, .bailout = 0.05, .light_samples = 4};

TEST_BY_TURNS(surfaces_let_rays_pass, 1, 2)
{
    whit_renderer_params params = sieve_params;
    params.numerics = NUMERICS_EXACT;
    own_fixture f = fixture_open(sieve_scene(), NULL, &params);
    struct sums sums = probe_picture(&f);
    assert_true(sums.passed > 0 && sums.straight > 0);
    assert_true(sums.ends[PROBE_BLOCKED] > 0);
    assert_all_kinds(&sums);
    assert_int_equal(sums.exact_equal, sums.exact);
}

TEST(trees_do_not_matter)
{
    static const whit_accel_params trees[] = {{.build = WHIT_BUILD_NONE},
                                              {.instances = WHIT_INSTANCES_OFF}};
    whit_renderer_params params = sieve_params;
    params.effects_removed = UINT64_C(1) << SCENE_EFFECT_REFRACTION |
                             UINT64_C(1) << SCENE_EFFECT_TEXTURES |
                             UINT64_C(1) << SCENE_EFFECT_AREA_LIGHTS;
    for (size_t i = 0; i < sizeof trees / sizeof *trees; ++i) {
        if (!cases_turn(i, 2))
            continue;
        own_fixture f = fixture_open(sieve_scene(), &trees[i], &params);
        struct sums sums = probe_picture(&f);
        assert_true(sums.ends[PROBE_BLOCKED] > 0 && sums.passed > 0);
    }
}

/* ---- Scenes from files ---- */

/* Media that touch and absorb, spheres, cut-outs in textures, lamps made of glowing surfaces. */
TEST(scenes_of_all_kinds)
{
    static const struct {
        const char *name;
        bool through, straight; /* wine that touches its glass; cut-outs */
    } scenes[] = {
        {"default", false, false}, {"glass-of-water", true, false}, {"layers", false, true}};
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; ++i) {
        if (!cases_turn(i, 3))
            continue;
        whit_renderer_params params = {.width = 6, .height = 5, .depth = 6, .light_samples = 1};
        own_fixture f = fixture_open(file_scene(scenes[i].name), NULL, &params);
        print_message("  %s\n", scenes[i].name);
        struct sums sums = probe_picture(&f);
        assert_true(sums.kinds[RAY_SHADOW] > 0 && sums.kinds[RAY_REFRACTED] > 0);
        assert_true(sums.passed > 0);
        assert_true(!scenes[i].through || sums.through > 0);
        assert_true(!scenes[i].straight || sums.straight > 0);
    }
}

/* When the renderer's time or view changes, the probe's passes and buffers change as well. */
TEST_BY_TURNS(another_time_and_size, 0, 2)
{
    const whit_renderer_params params = {.width = SIDE, .height = 6, .depth = 3};
    own_fixture f = fixture_open(file_scene("spin"), NULL, &params);
    struct sums before = probe_picture(&f);
    assert_int_equal(renderer_set_time(f.renderer, 0.7), WHIT_OK);
    struct sums after = probe_picture(&f);
    assert_true(before.rays > 0 && after.rays > 0 && before.rays != after.rays);
    whit_renderer_params other = params;
    other.width = 12;
    other.height = 9; /* two rows of blocks */
    other.depth = 4;
    assert_int_equal(renderer_set_view(f.renderer, &other), WHIT_OK);
    probe_picture(&f);
}

/* ---- More samples, less room, and nothing ---- */

TEST_BY_TURNS(color_is_of_all_samples, 1, 2)
{
    whit_renderer_params params = small;
    params.sampling.count = 4;
    params.width = params.height = 4;
    own_fixture f = fixture_open(glass_scene(), NULL, &params);
    struct sums four = probe_picture(&f);
    assert_int_equal(four.kinds[RAY_PRIMARY], 4 * 4);
    /* An adaptive picture begins with 4 samples. */
    own_image picture = color_of(glass_scene(), NULL, &params);
    params.sampling.count = 0;
    params.sampling = (whit_sampling){.kind = WHIT_SAMPLING_ADAPTIVE, .contrast = 1.0};
    fixture_renew(&f, &params);
    own_report report = probe(&f, 3, 2, 0);
    assert_int_equal(report.samples, 4);
    assert_memory_equal(report.color, &picture.pixels[4 * (2 * 4 + 3)], 3 * sizeof(float));
}

/* The pixel with the most rays. */
static uint32_t busiest_pixel(struct fixture *f, uint32_t *rays)
{
    uint32_t best = 0;
    *rays = 0;
    for (uint32_t i = 0; i < SIDE * SIDE; ++i) {
        own_report report = probe(f, i % SIDE, i / SIDE, 0);
        best = report.ray_count > *rays ? i : best;
        *rays = report.ray_count > *rays ? report.ray_count : *rays;
    }
    return best;
}

TEST(rays_without_room_are_counted)
{
    own_fixture f = fixture_open(glass_scene(), NULL, &small);
    uint32_t all, pixel = busiest_pixel(&f, &all);
    own_report whole = probe(&f, pixel % SIDE, pixel / SIDE, 0);
    assert_int_equal(whole.dropped, 0);
    assert_true(all > 10);
    for (uint32_t max = 1; max < all; max += 4) {
        own_report part = probe(&f, pixel % SIDE, pixel / SIDE, max);
        assert_int_equal(part.ray_count, max);
        assert_int_equal(part.dropped, all - max);
        assert_memory_equal(part.color, whole.color, sizeof part.color);
    }
}

TEST(pixels_outside_are_refused)
{
    own_fixture f = fixture_open(glass_scene(), NULL, &small);
    struct probe_report report;
    assert_int_equal(renderer_probe(f.renderer, SIDE, 0, 0, &report), WHIT_ERROR_USAGE);
    assert_int_equal(renderer_probe(f.renderer, 0, SIDE, 0, &report), WHIT_ERROR_USAGE);
    assert_null(report.rays);
    own_report last = probe(&f, SIDE - 1, SIDE - 1, 0);
    whit_renderer_params later = small;
    later.sampling = (whit_sampling){.count = 4, .first = 4};
    assert_int_equal(renderer_set_view(f.renderer, &later), WHIT_OK);
    assert_int_equal(renderer_probe(f.renderer, 0, 0, 0, &report), WHIT_ERROR_USAGE);
    assert_null(report.rays);
}

static struct pipeline_info kernel_of(const struct pass *pass)
{
    struct pipeline_info info;
    pipeline_get_info(pass->pipeline, &info);
    assert_true(info.specialized);
    return info;
}

/* Before the first probe a renderer has no kernel or buffer for it; afterwards the probe has
   kernels of its own, and those of pictures are the same as before. */
TEST(pictures_know_nothing_of_it)
{
    own_fixture f = fixture_open(glass_scene(), NULL, &small);
    struct renderer *r = f.renderer;
    assert_int_equal(renderer_render(f.renderer), WHIT_OK);
    assert_null(r->probe.records);
    assert_null(r->probe.buffers.pixels);
    assert_null(r->probe.stages.set.passes[STAGE_SHADE].pipeline);
    uint64_t bytes = r->scene_buffers.bytes;
    const struct pass *shading = &r->picture.stages.set.passes[STAGE_SHADE];
    struct pipeline_info before = kernel_of(shading);
    assert_false(before.bindings >> BIND_PROBE & 1);
    own_report report = probe(&f, 2, 2, 0);
    struct pipeline_info after = kernel_of(shading),
                         probe = kernel_of(&r->probe.stages.set.passes[STAGE_SHADE]);
    assert_int_equal(after.instructions, before.instructions);
    assert_true(after.bindings == before.bindings);
    assert_true(probe.bindings >> BIND_PROBE & 1);
    assert_true(probe.instructions > before.instructions);
    assert_true(r->scene_buffers.bytes > bytes);
    print_message("  %u instructions, %u of a probe\n", before.instructions, probe.instructions);
}
