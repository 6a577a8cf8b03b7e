#include <math.h>

#include "base/same.h"
#include "base/vec.h"
#include "scene/shaper.h"
#include "scene/shapes.h"

enum { STRANDS_MAX = 4000000 };

/* M. O'Neill, PCG: A Family of Simple Fast Space-Efficient Statistically Good Algorithms for Random
   Number Generation, 2014: RXS-M-XS 32. */
static double random_next(uint32_t *state)
{
    *state = *state * 747796405u + 2891336453u;
    uint32_t word = ((*state >> ((*state >> 28) + 4)) ^ *state) * 277803737u;
    return ((word >> 22) ^ word) / 4294967296.0;
}

/* A direction from the whole sphere, evenly. */
static void random_direction(uint32_t *state, double out[3])
{
    double height = 2.0 * random_next(state) - 1.0, turn = 2.0 * PI * random_next(state);
    double reach = sqrt(1.0 - height * height);
    out[0] = reach * same_cos(turn), out[1] = height, out[2] = reach * same_sin(turn);
}

static void add_face(struct shaper *shaper, const double *a, const double *b, const double *c)
{
    double ab[3], ac[3], normal[3];
    double3_sub(b, a, ab);
    double3_sub(c, a, ac);
    double3_cross(ab, ac, normal);
    uint32_t first = shaper_vertex(shaper, a, normal, 0.0, 0.0);
    shaper_vertex(shaper, b, normal, 1.0, 0.0);
    shaper_vertex(shaper, c, normal, 0.5, 1.0);
    shaper_triangle(shaper, first, first + 1, first + 2);
}

/* A tetrahedron: a base of three corners around `dir`, and a tip. */
static void add_needle(struct shaper *shaper, const double middle[3], const double dir[3],
                       double length, double width)
{
    double side[3], up[3], corners[4][3];
    const double axis[3] = {fabs(dir[0]) < 0.6, fabs(dir[0]) >= 0.6, 0.0};
    double3_cross(dir, axis, side);
    double3_unit(side);
    double3_cross(dir, side, up);
    for (int i = 0; i < 3; ++i) {
        corners[3][i] = middle[i] + 0.5 * length * dir[i];
        for (int k = 0; k < 3; ++k) {
            double angle = 2.0 * PI * k / 3.0;
            corners[k][i] =
                middle[i] - 0.5 * length * dir[i] +
                width / sqrt(3.0) * (same_cos(angle) * side[i] + same_sin(angle) * up[i]);
        }
    }
    add_face(shaper, corners[0], corners[2], corners[1]);
    for (int k = 0; k < 3; ++k)
        add_face(shaper, corners[k], corners[(k + 1) % 3], corners[3]);
}

whit_result shape_strands(double size, double length, double width, uint32_t count, uint32_t seed,
                          struct scene_mesh *out)
{
    struct shaper shaper;
    if (!shape_positive(size) || !shape_positive(length) || !shape_positive(width) ||
        !(width <= length) || !count || count > STRANDS_MAX)
        return WHIT_ERROR_USAGE;
    whit_result result = shaper_init(&shaper, out, 12 * (uint64_t)count, 4 * (uint64_t)count);
    if (result != WHIT_OK)
        return result;
    uint32_t state = seed;
    for (uint32_t n = 0; n < count; ++n) {
        double middle[3], dir[3];
        for (int i = 0; i < 3; ++i)
            middle[i] = (random_next(&state) - 0.5) * size;
        random_direction(&state, dir);
        add_needle(&shaper, middle, dir, length, width);
    }
    return WHIT_OK;
}
