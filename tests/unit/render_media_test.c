/* Media that are nested, touch, leak, or hold the camera. */
#include "media_fixture.h"
#include "render/variants.h"
#include "unit.h"

static const double FOV = 0.5;

/* ---- Plane layers, by Snell and Fresnel ---- */

/* A medium from z = -half to half. */
struct layer {
    double half;
    float ior;
    uint32_t priority;
};

static struct scene *layer_scene(const struct layer *layers, int count)
{
    struct scene *scene = dark_scene((double[]){0, 0, 5}, (double[]){0, 0, 0});
    scene->cameras[0].fov_y = (float)FOV;
    for (int i = 0; i < count; ++i)
        add_object(scene, mesh_box(40, 40, 2 * layers[i].half),
                   clear_glass(layers[i].ior, layers[i].priority), 0, 0, 0);
    add_coordinate_wall(scene, -4, 8);
    return scene;
}

/* Up to three media; the visible interfaces are at z[i], with index n[i] in front of each, and air
   behind the last one. */
struct stack {
    const char *name;
    struct layer layers[3];
    int layer_count, count;
    double z[6], n[6];
};

/* The way of a ray from z = 5 to z = -4: its distance sideways, and the share of the light that
   arrives. `slope`: that of the ray at the start. */
static void pass_layers(const struct stack *s, double slope, double *aside, double *share)
{
    double sine = slope / sqrt(1.0 + slope * slope), at = 5.0;
    *aside = 0.0;
    *share = 1.0;
    for (int i = 0; i <= s->count; ++i) {
        double here = i < s->count ? s->n[i] : 1.0, next = i == s->count ? -4.0 : s->z[i];
        double sin_here = sine / here, cos_here = sqrt(1.0 - sin_here * sin_here);
        *aside += (at - next) * sin_here / cos_here;
        at = next;
        if (i < s->count)
            *share *= 1.0 - fresnel(cos_here, here, i + 1 < s->count ? s->n[i + 1] : 1.0);
    }
}

/* The depth is the number of interfaces: light that is reflected between them needs more bounces
   than that, and is not in the picture. */
static void check_layers(const struct stack *s)
{
    const whit_renderer_params params = {.width = 24, .height = 24, .depth = (uint32_t)s->count};
    own_image image = color_of(layer_scene(s->layers, s->layer_count), NULL, &params);
    double worst = 0.0, worst_share = 0.0;
    for (uint32_t i = 0; i < 24 * 24; ++i) {
        const float *color = &image.pixels[4 * (size_t)i];
        double slope[2], aside, share;
        pixel_slope(&image, i % 24, i / 24, FOV, slope);
        double length = hypot(slope[0], slope[1]);
        pass_layers(s, length, &aside, &share);
        for (int k = 0; k < 2; ++k)
            worst = fmax(worst, fabs(wall_coordinate(color, k, 8) - aside * slope[k] / length));
        worst_share = fmax(worst_share, fabs((double)color[2] / share - 1.0));
    }
    print_message("  %s: off by %.2g sideways, by %.2g of the light\n", s->name, worst,
                  worst_share);
    /* At each interface and at the wall: gamma(7) of vertices whose coordinates are 20, the error
       bound of a hit point (docs/numerics.md). Light: a few roundings a Fresnel term. */
    assert_true(worst < (s->count + 1) * 7 * 20 * 0x1p-24);
    assert_true(worst_share < s->count * 8 * 0x1p-24);
}

TEST_BY_TURNS(layers_bend_as_snell_says, 0, 4)
{
    static const struct stack stacks[] = {
        {"a slab", {{0.3, 1.5f, 0}}, 1, 2, {0.3, -0.3}, {1.0, 1.5}},
        /* With equal priorities the medium that was entered last counts; priorities that demand
           just this give the same. */
        {"a bubble in glass in water",
         {{1.5, 1.33f, 0}, {1.0, 1.5f, 0}, {0.4, 1.0f, 0}},
         3,
         6,
         {1.5, 1.0, 0.4, -0.4, -1.0, -1.5},
         {1.0, 1.33, 1.5, 1.0, 1.5, 1.33}},
        {"the same by priorities",
         {{0.4, 1.0f, 9}, {1.0, 1.5f, 4}, {1.5, 1.33f, 1}},
         3,
         6,
         {1.5, 1.0, 0.4, -0.4, -1.0, -1.5},
         {1.0, 1.33, 1.5, 1.0, 1.5, 1.33}},
        /* A surface that neither bends nor reflects. */
        {"equal indices",
         {{1.5, 1.33f, 0}, {1.0, 1.33f, 0}},
         2,
         4,
         {1.5, 1.0, -1.0, -1.5},
         {1.0, 1.33, 1.33, 1.33}},
    };
    for (size_t i = 0; i < sizeof stacks / sizeof *stacks; ++i)
        check_layers(&stacks[i]);
}

/* The medium with the highest priority counts, whichever was entered last: the others inside it
   cannot be seen. */
TEST_BY_TURNS(priority_hides_what_is_inside, 1, 4)
{
    static const struct stack hidden = {
        "hidden",   {{1.5, 1.33f, 2}, {1.0, 1.5f, 1}, {0.4, 1.0f, 0}}, 3, 2, {1.5, -1.5},
        {1.0, 1.33}};
    check_layers(&hidden);
}

/* The code that looks for touching surfaces is compiled only for scenes that need it; where it is
   not needed, it changes nothing. */
TEST_BY_TURNS(lone_bodies_need_less, 2, 4)
{
    const struct layer layers[] = {{1.5, 1.33f, 0}, {1.0, 1.5f, 0}};
    const uint32_t expected[] = {MEDIA_NONE, MEDIA_ALONE, MEDIA_TOUCH};
    for (int count = 0; count < 3; ++count) {
        struct image images[2];
        for (int all = 0; all < 2; ++all) {
            const whit_renderer_params params = {
                .width = 16, .height = 16, .depth = 6, .all_effects = all};
            own_fixture f = fixture_open(layer_scene(layers, count), NULL, &params);
            struct gpu_spec spec = variant_spec(&f.renderer->picture);
            assert_int_equal(spec.SPEC_MEDIA, all ? MEDIA_TOUCH : expected[count]);
            images[all] = render(&f);
        }
        assert_same_image("with every effect", &images[0], &images[1]);
        image_finish(&images[0]);
        image_finish(&images[1]);
    }
}

/* Two bodies that share a plane, with other triangles there. At `exact` the float t of a hit may be
   behind that of the other surface, whose exact t is the same: then only exact keys find it. */
TEST(shared_faces_are_found_at_every_level)
{
    struct image images[2];
    for (int exact = 0; exact < 2; ++exact) {
        struct scene *scene = dark_scene((double[]){3, 2, 6}, (double[]){0, 0, 0});
        struct scene_material red = clear_glass(1.5f, 0), green = red;
        set_sky(scene, 1, 1, 1);
        set_rgb(red.absorption, 0, 1, 1);
        set_rgb(green.absorption, 1, 0, 1);
        add_object(scene, mesh_box(2, 2, 2), red, 0, 0, 1);
        add_object(scene, mesh_box(3, 2.5, 1), green, 0, 0, -0.5);
        const whit_renderer_params params = {.width = 40,
                                             .height = 40,
                                             .depth = 4,
                                             .numerics =
                                                 exact ? NUMERICS_EXACT : NUMERICS_WATERTIGHT};
        own_fixture f = fixture_open(scene, NULL, &params);
        assert_int_equal(variant_spec(&f.renderer->picture).SPEC_MEDIA, MEDIA_TOUCH);
        images[exact] = render(&f);
    }
    double worst = 0;
    for (size_t i = 0; i < 4 * (size_t)(40 * 40); ++i)
        worst = fmax(worst, fabs((double)(images[0].pixels[i] - images[1].pixels[i])));
    print_message("  %.2g apart at most\n", worst);
    assert_true(worst < 1e-4);
    image_finish(&images[0]);
    image_finish(&images[1]);
}

/* A mesh and its mirror image touch in a face, through which rays go from the first instance into
   the second: by the same triangle of both. */
TEST(mirrored_bodies_share_a_triangle)
{
    const whit_renderer_params params = {.width = 40, .height = 40, .depth = 4};
    const struct affine mirror = {{-1, 0, 0, 2, 0, 1, 0, 0, 0, 0, 1, 0}};
    struct image images[2];
    for (int flat = 0; flat < 2; ++flat) {
        struct scene *scene = dark_scene((double[]){-6, 1, 2}, (double[]){1, 0, 0});
        struct scene_material red = clear_glass(1.5f, 0);
        set_sky(scene, 1, 1, 1);
        set_rgb(red.absorption, 0, 0.2f, 0.4f);
        uint32_t box = scene_put(scene, mesh_box(2, 2, 2), &(struct put){.material = &red});
        scene_put_again(scene, box, &(struct put){.matrix = &mirror});
        const whit_accel_params accel = {.instances =
                                             flat ? WHIT_INSTANCES_OFF : WHIT_INSTANCES_ON};
        images[flat] = color_of(scene, &accel, &params);
    }
    double worst = 0;
    for (size_t i = 0; i < 4 * (size_t)(40 * 40); ++i)
        worst = fmax(worst, fabs((double)(images[0].pixels[i] - images[1].pixels[i])));
    assert_true(worst < 1e-4);
    image_finish(&images[0]);
    image_finish(&images[1]);
}

/* ---- The list of media ---- */

static struct scene *shell_scene(int count)
{
    struct scene *scene = dark_scene((double[]){0, 0, 20}, (double[]){0, 0, 0});
    set_sky(scene, 1, 1, 1);
    for (int i = 0; i < count; ++i) {
        double side = 10.0 - 0.5 * i;
        add_object(scene, mesh_box(side, side, side), clear_glass(1.0f + 0.02f * (float)(i + 1), 0),
                   0, 0, 0);
    }
    return scene;
}

TEST(ninth_medium_is_an_error)
{
    static const int counts[] = {8, 9, 16};
    for (int i = 0; i < 3; ++i) {
        const whit_renderer_params params = {
            .width = 8, .height = 8, .depth = 20, .bailout = WHIT_BAILOUT_DEFAULT};
        own_fixture f = fixture_open(shell_scene(counts[i]), NULL, &params);
        own_image image = {0};
        assert_int_equal(renderer_render(f.renderer), i == 0 ? WHIT_OK : WHIT_ERROR_STATUS);
        if (i == 0) {
            assert_int_equal(renderer_read_color(f.renderer, &image), WHIT_OK);
            assert_true(middle(&image)[0] > 0.9f && middle(&image)[0] < 1.0001f);
        }
    }
}

/* Balls with holes: rays leave media that they never entered, and enter some that they never leave.
 */
TEST_BY_TURNS(open_meshes_stay_finite, 3, 4)
{
    struct scene *scene = dark_scene((double[]){0, 0.3, 4}, (double[]){0, 0, 0});
    set_sky(scene, 1, 1, 1);
    for (int i = 0; i < 3; ++i) {
        struct scene_mesh mesh = mesh_icosphere(1.0, 3);
        uint32_t kept = 0;
        for (uint32_t t = 0; t < mesh.triangle_count; ++t) {
            if (t % 3 == 0)
                continue;
            memcpy(&mesh.indices[3 * (size_t)kept++], &mesh.indices[3 * (size_t)t],
                   3 * sizeof *mesh.indices);
        }
        mesh.triangle_count = kept;
        struct scene_material m = clear_glass(1.5f, (uint32_t)i);
        set_rgb(m.absorption, 0.1f, 0.2f, 0.0f);
        add_object(scene, mesh, m, 0.5 * i - 0.5, 0, 0);
    }
    const whit_renderer_params params = {.width = 40, .height = 40, .depth = 8};
    own_fixture f = fixture_open(scene, NULL, &params);
    assert_int_equal(f.renderer->frame.nested, 1);
    own_image image = render(&f);
    assert_range(&image, 0, 1.001);
}

/* ---- The camera inside ---- */

static void check_eye(struct scene *scene, const uint32_t *expected, uint32_t count)
{
    own_fixture f = fixture_open(scene, NULL, NULL);
    const struct gpu_frame *frame = &f.renderer->frame;
    const uint32_t words[] = {frame->eye_media0, frame->eye_media1, frame->eye_media2,
                              frame->eye_media3};
    for (uint32_t i = 0; i < MEDIA_MAX; ++i)
        assert_int_equal(words[i / 2] >> 16 * (i % 2) & 0xffff, i < count ? expected[i] + 1 : 0);
}

static struct scene_mesh ball(double radius)
{
    return mesh_balls((double[]){0, 0, 0, radius}, 1);
}

TEST_BY_TURNS(camera_knows_its_media, 0, 4)
{
    const double inside[3] = {0.1, 0.2, 0.1}, away[3] = {0, 0, -9};
    /* Outside; in a box; in two, of which the inner one is entered last; by priority. */
    struct scene *scene = dark_scene((double[]){0, 0, 5}, away);
    add_object(scene, mesh_box(2, 2, 2), clear_glass(1.5f, 0), 0, 0, 0);
    check_eye(scene, NULL, 0);
    for (uint32_t high = 0; high < 2; ++high) {
        scene = dark_scene(inside, away);
        uint32_t inner = add_object(scene, mesh_box(2, 2, 2), clear_glass(1.5f, 1), 0, 0, 0);
        uint32_t outer = add_object(scene, mesh_box(3, 3, 3), clear_glass(1.3f, 1 + high), 0, 0, 0);
        add_object(scene, mesh_box(1, 1, 1), clear_glass(1.3f, 1), 4, 0, 0);
        check_eye(scene, high ? (uint32_t[]){inner, outer} : (uint32_t[]){outer, inner}, 2);
    }
    /* The camera is in a sphere and in a thin box, which has no inside. */
    scene = dark_scene(inside, away);
    struct scene_material thin = clear_glass(1.5f, 0);
    thin.thin_walled = true;
    add_object(scene, mesh_box(4, 4, 4), thin, 0, 0, 0);
    uint32_t round = add_object(scene, ball(1.0), clear_glass(1.5f, 0), 0, 0, 0);
    check_eye(scene, &round, 1);
    /* Below a sheet without a border no majority of rays says that the camera is inside; nothing
       breaks. */
    scene = dark_scene(inside, away);
    add_object(scene, mesh_plane(8), clear_glass(1.33f, 0), 0, 1, 0);
    check_eye(scene, NULL, 0);
}

/* Seen from below water, the sky is within the critical angle; beyond it the surface reflects the
   dark ground below. One bounce. */
TEST_BY_TURNS(snells_window_is_where_it_should_be, 1, 4)
{
    struct scene *scene = dark_scene((double[]){0, -1, 0}, (double[]){0, 0, 0});
    scene->cameras[0].fov_y = 2.0f;
    set_sky(scene, 1, 1, 0);
    add_object(scene, mesh_box(60, 20, 60), clear_glass(1.33f, 0), 0, -10, 0);
    const whit_renderer_params params = {.width = 101, .height = 101, .depth = 1};
    own_image image = color_of(scene, NULL, &params);
    double critical = tan(asin(1.0 / (double)1.33f)), pixel = 2.0 * tan(1.0) / 101;
    int lit = 0, close = 0;
    for (uint32_t i = 0; i < 101 * 101; ++i) {
        double slope[2];
        pixel_slope(&image, i % 101, i / 101, 2.0, slope);
        double radius = hypot(slope[0], slope[1]);
        bool is_lit = image.pixels[4 * (size_t)i] > 0.0f;
        lit += is_lit;
        if (fabs(radius - critical) < pixel / 100)
            ++close; /* a hundredth of a pixel */
        else
            assert_true(is_lit == (radius < critical));
    }
    print_message("  %d pixels see the sky, %d are too close to tell\n", lit, close);
    assert_true(lit > 1000 && close < 4);
}

/* ---- Edges ---- */

/* How far a ray from `eye` along the unit `d` goes inside |x| + |y| + |z| <= 1, or |x|, |y| <= 1
   and -3 <= z <= 1. */
static double convex_chord(bool octahedron, const double eye[3], const double d[3])
{
    double in = 0, out = INFINITY;
    for (int side = 0; side < 27; ++side) {
        const int n[3] = {side % 3 - 1, side / 3 % 3 - 1, side / 9 - 1};
        if (n[0] * n[0] + n[1] * n[1] + n[2] * n[2] != (octahedron ? 3 : 1))
            continue;
        double toward = 0, beyond = !octahedron && n[2] < 0 ? -3 : -1;
        for (int k = 0; k < 3; ++k) {
            toward += n[k] * d[k];
            beyond += n[k] * eye[k];
        }
        if (toward < 0)
            in = fmax(in, -beyond / toward);
        else if (toward > 0)
            out = fmin(out, -beyond / toward);
        else if (beyond > 0)
            out = 0;
    }
    return fmax(out - in, 0);
}

static struct scene_mesh octahedron_mesh(void)
{
    struct scene_mesh mesh = mesh_zeroed(6, 8);
    for (uint32_t i = 0; i < 6; ++i)
        mesh.positions[3 * i + i / 2] = i % 2 ? -1.0f : 1.0f;
    for (uint32_t i = 0; i < 8; ++i) {
        uint32_t corners[3] = {i & 1, 2 + (i >> 1 & 1), 4 + (i >> 2)};
        bool turned = (i & 1) ^ (i >> 1 & 1) ^ (i >> 2);
        mesh.indices[3 * i] = corners[0];
        mesh.indices[3 * i + 1] = corners[turned ? 2 : 1];
        mesh.indices[3 * i + 2] = corners[turned ? 1 : 2];
    }
    return mesh;
}

/* Bodies with index 1 are placed so that whole rows of pixels look exactly at edges and vertices,
   where rays meet several triangles at once. Each body is entered and left once, so that light is
   lost only along the way inside. */
TEST_BY_TURNS(edges_are_crossed_once, 2, 4)
{
    enum { SIDE = 33 };
    const double far = 5, eyes[2][3] = {{far, 0, far}, {0, 0, far}};
    for (int way = 0; way < 4; ++way) {
        bool octahedron = way & 1;
        const double *eye = eyes[octahedron];
        double size = octahedron ? far : far * sqrt(2), worst = 0;
        struct scene *scene = dark_scene(eye, (double[]){0, 0, 0});
        struct scene_material m = clear_glass(1.0f, 1);
        scene->cameras[0].fov_y = (float)FOV;
        set_sky(scene, 1, 1, 1);
        if (way >= 2) /* of lower priority: other surfaces may now be at the same place */
            add_object(scene, mesh_box(0.2, 0.2, 0.2), clear_glass(1.0f, 0), 0, -1, 0);
        set_rgb(m.absorption, 1, 0.5f, 0);
        add_object(scene, octahedron ? octahedron_mesh() : mesh_box(2, 2, 4), m, 0, 0,
                   octahedron - 1);
        const whit_renderer_params params = {.width = SIDE, .height = SIDE, .depth = 6};
        own_image image = color_of(scene, NULL, &params);
        uint32_t through = 0;
        for (uint32_t i = 0; i < SIDE * SIDE; ++i) {
            double slope[2];
            pixel_slope(&image, i % SIDE, i / SIDE, FOV, slope);
            double length = sqrt(1 + slope[0] * slope[0] + slope[1] * slope[1]);
            /* Right is (z, 0, -x) of the way back to the eye. */
            const double d[3] = {(slope[0] * eye[2] - eye[0]) / size / length, slope[1] / length,
                                 (-slope[0] * eye[0] - eye[2]) / size / length};
            double way_inside = convex_chord(octahedron, eye, d);
            through += way_inside > 0;
            for (int k = 0; k < 3; ++k)
                worst = fmax(worst, fabs((double)image.pixels[4 * i + (uint32_t)k] -
                                         exp(-(double)m.absorption[k] * way_inside)));
        }
        print_message("  %s%s: %u of %d rays go through, light off by %.2g at most\n",
                      octahedron ? "octahedron" : "box", way >= 2 ? ", another body" : "", through,
                      SIDE * SIDE, worst);
        assert_true(through > SIDE * SIDE / 4 && through < SIDE * SIDE);
        /* gamma(7) of coordinates up to 4 at both ends of the way, at 60 degrees and less but for
           the outline, where the way is short */
        assert_true(worst < 1e-5);
    }
}

/* ---- Liquid in a glass ---- */

enum { LIQUID_SIDE = 24, LIQUID_PIXELS = LIQUID_SIDE * LIQUID_SIDE };

/* The liquid is wider than the inside of the glass by `overlap`. */
static struct image liquid_picture(double overlap, uint32_t glass_priority, double contact,
                                   double ior)
{
    const double glass[][2] = {{0, 0}, {1, 0}, {1, 2.4}, {0.85, 2.4}, {0.85, 0.3}, {0, 0.3}};
    const double liquid[][2] = {
        {0, 0.3 - overlap}, {0.85 + overlap, 0.3 - overlap}, {0.85 + overlap, 1.7}, {0, 1.7}};
    struct scene *scene = dark_scene((double[]){0, 2.6, 6}, (double[]){0, 1.1, 0});
    scene->cameras[0].fov_y = 0.55f;
    set_sky(scene, 0.2f, 0.5f, 0.1f);
    scene->contact = (float)contact;
    add_object(scene, lathe(glass, 6, 48), clear_glass(1.5f, glass_priority), 0, 0, 0);
    add_object(scene, lathe(liquid, 4, 48), clear_glass((float)ior, 0), 0, 0, 0);
    add_coordinate_wall(scene, -3, 4);
    const whit_renderer_params params = {.width = LIQUID_SIDE, .height = LIQUID_SIDE, .depth = 12};
    return color_of(scene, NULL, &params);
}

/* Pixels that differ by more than `tolerance` in some channel. */
static uint32_t count_over(const struct image *a, const struct image *b, double tolerance)
{
    uint32_t over = 0;
    for (size_t i = 0; i < LIQUID_PIXELS; ++i) {
        double worst = 0;
        for (size_t k = 4 * i; k < 4 * i + 3; ++k)
            worst = fmax(worst, fabs((double)a->pixels[k] - (double)b->pixels[k]));
        over += worst > tolerance;
    }
    return over;
}

/* Three ways to model a liquid in a glass give one picture. */
TEST_BY_TURNS(liquid_in_a_glass, 3, 4)
{
    enum { NONE = 0, SOME = LIQUID_PIXELS / 64, MANY = LIQUID_PIXELS / 8, ALL = LIQUID_PIXELS };
    static const struct {
        const char *name;
        double overlap;
        uint32_t glass_priority;
        double contact, ior, tolerance;
        uint32_t min, max; /* limits of the number of pixels that differ by more than `tolerance` */
    } ways[] = {
        /* The priority decides where the surface is, so that pictures are equal within rounding. */
        {"overlap of 0.05", 0.05, 1, 0, 1.33, 1e-3, NONE, NONE},
        {"touching, last entered", 0, 0, 0, 1.33, 1e-3, NONE, NONE},
        {"gap of 1e-5, contact 1e-4", -1e-5, 1, 1e-4, 1.33, 1e-3, NONE, NONE},
        /* A surface that is 1e-3, less than a hundredth of a pixel, elsewhere: edges may fall on
           another pixel. */
        {"overlap of 1e-3, last entered", 1e-3, 0, 0, 1.33, 1e-2, NONE, SOME},
        {"gap of 1e-3, contact 4e-3", -1e-3, 1, 4e-3, 1.33, 1e-2, NONE, SOME},
        /* A layer of air reflects all light at flat angles, nearly as if there were no liquid. */
        {"gap of 1e-5, no contact", -1e-5, 1, 0, 1.33, 1e-2, MANY + 1, ALL},
        {"no liquid", -0.2, 1, 0, 1.0, 1e-2, MANY + 1, ALL},
    };
    own_image touching = liquid_picture(0, 1, 0, 1.33);
    for (size_t i = 0; i < sizeof ways / sizeof *ways; ++i) {
        own_image other =
            liquid_picture(ways[i].overlap, ways[i].glass_priority, ways[i].contact, ways[i].ior);
        uint32_t over = count_over(&touching, &other, ways[i].tolerance);
        print_message("  %s: %u of %d pixels differ by more than %g\n", ways[i].name, over,
                      LIQUID_PIXELS, ways[i].tolerance);
        assert_in_range(over, ways[i].min, ways[i].max);
    }
}
