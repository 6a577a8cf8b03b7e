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
