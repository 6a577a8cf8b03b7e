/* No surface adds light, and only light of rays that were cut is lost; those rays are counted. */
#include "media_fixture.h"
#include "render_scenes.h"
#include "unit.h"

/* ---- White furnace ---- */

static struct scene *furnace(struct scene_mesh mesh, struct scene_material m)
{
    struct scene *scene = dark_scene((double[]){0.3, 0.5, 4}, (double[]){0, 0, 0});
    set_sky(scene, 1, 1, 1);
    add_object(scene, mesh, m, 0, 0, 0);
    return scene;
}

/* Under a white sky a pixel is white but for the rays that were cut. */
static void check_furnace(const char *name, struct scene *scene)
{
    const whit_renderer_params params = {.width = 32, .height = 32, .depth = 5};
    own_fixture f = fixture_open(scene, NULL, &params);
    own_picture picture = render_picture(&f);
    const whit_stats *stats = &picture.stats;
    double highest = 0, worst = 0, cut = 0;
    for (size_t i = 0; i < 32 * 32; ++i) {
        float cuts[2];
        pixel_cut(&f, i, cuts);
        double value = (double)picture.color.pixels[4 * i], lost = (double)cuts[0];
        assert_true(cuts[1] == 0);
        highest = fmax(highest, value);
        worst = fmax(worst, fabs(value + lost - 1));
        cut = fmax(cut, lost);
    }
    print_message("  %s: 1 %+.2g at most, with what was cut 1 within %.2g; cut: up to %.2g\n", name,
                  highest - 1, worst, cut);
    assert_true(highest <= 1 + 1e-4 && worst <= 1e-4); /* NUMERICS O13 */
    assert_true(fabs(stats->weight_cut_depth - cut) < 1e-6 && stats->weight_cut_bailout == 0);
    assert_true(stats->rays_cut_bailout == 0 && (stats->rays_cut_depth > 0) == (cut > 0));
}

TEST(white_furnace)
{
    check_furnace("cube", furnace(mesh_box(1, 1, 1), clear_glass(1.5f, 0)));
    check_furnace("smooth mesh", furnace(mesh_icosphere(1, 3), clear_glass(1.5f, 0)));
    check_furnace("smooth ring", furnace(mesh_torus(0.7, 0.3, 24, 12), clear_glass(2.42f, 0)));
    check_furnace("ball", furnace(mesh_balls((double[]){0, 0, 0, 1}, 1), clear_glass(1.33f, 0)));
    struct scene_material thin = clear_glass(1.5f, 0);
    thin.thin_walled = true;
    check_furnace("thin cube", furnace(mesh_box(1, 1, 1), thin));
    check_furnace("mirror ring", furnace(mesh_torus(0.7, 0.3, 24, 12), mirror(1, 1, 1)));
}

TEST_BY_TURNS(white_furnace_of_nested_media, 0, 2)
{
    struct scene *scene = furnace(mesh_box(1.6, 1.6, 1.6), clear_glass(1.33f, 0));
    add_object(scene, mesh_icosphere(0.6, 3), clear_glass(1.5f, 1), 0.3, 0, 0);
    add_object(scene, mesh_torus(0.5, 0.2, 24, 12), clear_glass(1.0f, 2), -0.2, 0.1, 0.2);
    add_object(scene, mesh_box(1, 0.5, 0.5), clear_glass(1.2f, 0), 0.3, -0.25, 0.8);
    check_furnace("nested", scene);
}

/* ---- Facing mirrors ---- */

/* Mirrors that reflect everything and glow a little: each bounce adds the same amount of light, and
   the bounces end at the depth. */
TEST_BY_TURNS(facing_mirrors_end, 1, 2)
{
    const uint32_t depths[] = {0, 1, 2, 3, 8, 64, 255};
    struct image before = {0};
    for (size_t d = 0; d < sizeof depths / sizeof *depths; ++d) {
        struct scene *scene = dark_scene((double[]){0, 0, 0}, (double[]){0, 0, -1});
        struct scene_material shining = mirror(1, 1, 1);
        set_rgb(shining.emission, 0.01f, 0.01f, 0.01f);
        for (int i = 0; i < 2; ++i)
            add_object(scene, mesh_box(6, 6, 1), shining, 0, 0, i ? 2.5 : -2.5);
        scene_put_lamp(scene, 0, 50, 0, 1); /* else the mirrors would be lights */
        const whit_renderer_params params = {.width = 15, .height = 15, .depth = depths[d]};
        own_fixture f = fixture_open(scene, NULL, &params);
        struct image image = render(&f);
        assert_near(middle(&image)[0], 0.01 * (depths[d] + 1), 1e-5);
        float cuts[2];
        pixel_cut(&f, 15 * 7 + 7, cuts);
        assert_near(cuts[0], 1, 1e-6);
        for (size_t i = 0; i < 15 * 15 * 4; ++i) {
            assert_true(isfinite(image.pixels[i]));
            assert_true(!before.pixels || image.pixels[i] >= before.pixels[i]);
        }
        image_finish(&before);
        before = image;
    }
    image_finish(&before);
}

/* ---- Rays that are too weak ---- */

static struct scene *weak_scene(int which)
{
    if (which == 0)
        return glass_scene();
    struct scene *scene = furnace(mesh_box(1.2, 1.2, 1.2), clear_glass(1.5f, 0));
    add_object(scene, mesh_box(0.5, 0.5, 0.5), clear_glass(1.1f, 0), 0.1, 0, 0);
    struct scene_material shiny = matte(0.5f, 0.5f, 0.5f);
    set_rgb(shiny.specular, 0.5f, 0.5f, 0.5f);
    set_rgb(shiny.reflection, 0.3f, 0.3f, 0.3f);
    add_object(scene, mesh_plane(6), shiny, 0, -0.8, 0);
    scene_put_lamp(scene, 2, 3, 2, 8);
    return scene;
}

static double largest_difference(const struct image *a, const struct image *b)
{
    double worst = 0;
    for (size_t k = 0; k < (size_t)a->width * a->height * 4; ++k)
        worst = fmax(worst, fabs((double)a->pixels[k] - (double)b->pixels[k]));
    return worst;
}

/* A black surface with a highlight of (n . h)^4000 asks for the light where that is above 2^-24 of
   it, or, with no bailout, above the least float: h is off the normal by 5 degrees, or by 12. */
TEST(highlights_that_nobody_sees_take_no_shadow_rays)
{
    uint64_t rays[2];
    struct image images[2];
    for (int i = 0; i < 2; ++i) {
        struct scene *scene = dark_scene((double[]){0, 4, 0.001}, (double[]){0, 0, 0});
        struct scene_material shiny = matte(0, 0, 0);
        set_rgb(shiny.specular, 1, 1, 1);
        shiny.shininess = 4000;
        add_object(scene, mesh_plane(20), shiny, 0, 0, 0);
        scene_put_lamp(scene, 0, 4, 0.001, 1);
        const whit_renderer_params params = {
            .width = 64, .height = 64, .bailout = i ? 0.0 : WHIT_BAILOUT_DEFAULT};
        own_picture picture = picture_of(scene, NULL, &params);
        rays[i] = picture.stats.rays_shadow;
        images[i] = picture.color;
        picture.color = (struct image){0};
    }
    double worst = largest_difference(&images[0], &images[1]);
    print_message("  %llu shadow rays of %llu, off by %.3g\n", (unsigned long long)rays[0],
                  (unsigned long long)rays[1], worst);
    assert_true(rays[0] > 0 && rays[0] * 2 < rays[1]);
    assert_true(worst > 0 && worst <= 0x1p-24);
    image_finish(&images[0]);
    image_finish(&images[1]);
}

/* No pixel is off by more than the bound in the statistics, and the bound is less than
   100 times the largest error. */
TEST(bailout_keeps_its_bound)
{
    const double bailouts[] = {0.0, 1.0 / 16, 1.0 / 64, 1.0 / 256};
    for (int which = 0; which < 2; ++which) {
        own_image full = {0};
        for (int i = 0; i < 4; ++i) {
            const whit_renderer_params params = {.width = 40,
                                                 .height = 40,
                                                 .depth = 6,
                                                 .bailout = bailouts[i],
                                                 .camera = which ? (whit_camera){.name = NULL}
                                                                 : glass_camera};
            own_picture picture = picture_of(weak_scene(which), NULL, &params);
            const whit_stats *stats = &picture.stats;
            if (i == 0) {
                assert_true(stats->rays_cut_bailout == 0 && stats->bailout_bound == 0);
                full = picture.color;
                picture.color = (struct image){0};
            } else {
                double worst = largest_difference(&picture.color, &full);
                print_message("  bailout 1/%g cuts %llu rays: off by %.3g, the bound is %.3g\n",
                              1 / bailouts[i], (unsigned long long)stats->rays_cut_bailout, worst,
                              stats->bailout_bound);
                assert_true(stats->rays_cut_bailout > 0 && worst > 0);
                assert_true(worst <= stats->bailout_bound + 1e-6);
                assert_true(stats->bailout_bound < 100 * worst);
            }
        }
    }
}
