/* Pictures by the reference in double. */
#ifndef TESTS_REFERENCE_FIXTURE_H
#define TESTS_REFERENCE_FIXTURE_H

#include "render_fixture.h"

#include "reference/reference.h"

/* Renders colours and ids with the reference. */
static inline struct picture reference_picture(struct accel *accel,
                                               const struct reference_params *params)
{
    struct reference *reference = NULL;
    struct picture picture = {0};
    assert_int_equal(reference_create(&fixture_log, accel, params, &reference), WHIT_OK);
    assert_int_equal(reference_render(reference, &picture.color, &picture.ids, &picture.stats),
                     WHIT_OK);
    for (size_t i = 0; i < (size_t)picture.color.width * picture.color.height * 4; ++i)
        assert_true(isfinite(picture.color.pixels[i]));
    reference_destroy(reference);
    return picture;
}

/* The difference of two pictures: pixels further than 1e-3 apart in some channel, and the largest
   of all. */
struct difference {
    uint32_t over, pixels;
    double largest;
};

static inline struct difference difference_of(const struct image *a, const struct image *b)
{
    struct difference d = {.pixels = a->width * a->height};
    for (size_t i = 0; i < d.pixels; ++i) {
        double max = 0.0;
        for (size_t c = 4 * i; c < 4 * i + 3; ++c)
            max = fmax(max, fabs((double)a->pixels[c] - (double)b->pixels[c]));
        d.over += max > 1e-3;
        d.largest = fmax(d.largest, max);
    }
    return d;
}

/* Draws a scene, which it destroys, by the device and by the reference with whole stops. At most
   0.2 % of the pixels may differ, for edges. */
static inline void assert_agrees(const char *name, struct scene *scene,
                                 const whit_accel_params *trees, whit_renderer_params picture)
{
    const struct reference_params params = {.picture = picture, .whole_stops = true};
    own_fixture f = fixture_open(scene, trees, &picture);
    own_image device = render(&f);
    own_picture reference = reference_picture(f.accel, &params);
    struct difference d = difference_of(&device, &reference.color);
    print_message("  %s: %u of %u pixels over 1e-3, largest %.2g\n", name, d.over, d.pixels,
                  d.largest);
    assert_true(d.over * 500 <= d.pixels);
}

/* The ray tree of one sample. */
struct rays {
    struct reference_ray *all; /* free() */
    uint32_t count;
};

static inline struct rays reference_rays(const struct reference *reference, uint32_t x, uint32_t y,
                                         uint32_t sample)
{
    struct rays rays = {0};
    assert_int_equal(reference_ray_tree(reference, x, y, sample, &rays.all, &rays.count), WHIT_OK);
    return rays;
}

#endif
