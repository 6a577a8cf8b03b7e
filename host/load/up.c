#include "load/up.h"

#include <math.h>
#include <string.h>

#include "base/file.h"
#include "base/vec.h"

/* A model stands on an axis' lower end if surface within SLAB of its extent from that end covers at
   least the share STANDS of its ground area, and does not if it covers less than HARDLY. */
static const double SLAB = 0.02, STANDS = 0.15, HARDLY = 0.02;
/* Surfaces that cover at least this share of the ground are a floor. */
static const double FLOOR = 0.5;
/* Feet carry a model if the box around them covers at least FLOOR of the ground, and they are no
   rim, such as that of a mask. A side on which it hardly stands, such as the back of a car, covers
   less than this share. */
static const double EDGE = 0.4;
/* A floor may also lie up to this share of the extent above the end, as on a foundation. */
static const double LOW = 0.1;
/* A model thinner than this share of its other sides is a board, which may stand on an edge. */
static const double BOARD = 0.15;

/* Rotation matrices that turn each axis to +y; exact, since they only swap and negate
   coordinates. */
static const double turns[][9] = {
    [WHIT_UP_X] = {0, -1, 0, 1, 0, 0, 0, 0, 1},
    [WHIT_UP_Y] = {1, 0, 0, 0, 1, 0, 0, 0, 1},
    [WHIT_UP_Z] = {1, 0, 0, 0, 0, 1, 0, -1, 0},
    [WHIT_UP_MINUS_X] = {0, 1, 0, -1, 0, 0, 0, 0, 1},
    [WHIT_UP_MINUS_Y] = {1, 0, 0, 0, -1, 0, 0, 0, -1},
    [WHIT_UP_MINUS_Z] = {1, 0, 0, 0, 0, -1, 0, 1, 0},
};

uint32_t up_add_node(struct scene *scene, whit_up up)
{
    struct scene_node node;
    scene_node_init(&node, "up", SCENE_NONE);
    node.has_matrix = true;
    node.matrix = affine_identity();
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            node.matrix.m[4 * row + column] = turns[up][3 * row + column];
    return scene_add_node(scene, node);
}

struct shape {
    double lo[3], hi[3];
};

static struct shape measure(const struct scene *scene)
{
    struct shape shape;
    double3_no_box(shape.lo, shape.hi);
    for (uint32_t m = 0; m < scene->mesh_count; ++m)
        for (size_t i = 0; i < 3 * (size_t)scene->meshes[m].vertex_count; ++i) {
            double value = (double)scene->meshes[m].positions[i];
            shape.lo[i % 3] = fmin(shape.lo[i % 3], value);
            shape.hi[i % 3] = fmax(shape.hi[i % 3], value);
        }
    return shape;
}

/* The area of a box along two axes. */
static double area_of(const struct shape *box, int u, int v)
{
    return fmax(box->hi[u] - box->lo[u], 0.0) * fmax(box->hi[v] - box->lo[v], 0.0);
}

/* The triangles at the lower end of an axis, as shares of the area of the box's face at that end
   (the ground). */
struct ending {
    double flat; /* covered by triangles within SLAB of the end */
    double low;  /* covered by flat triangles within LOW of the end, each side of a solid counted */
    double rest; /* covered by the box around all triangles not in `flat`; 0: there are none */
    double feet; /* covered by the box around all corners within SLAB of the end */
    bool rim;    /* some of these corners are in the middle of each side of the ground */
};

/* A bit for the side of the ground in whose middle third a corner is, in the outer third across; 0
   for other places. */
static unsigned side_of(const struct shape *ground, const double corner[3], int u, int v)
{
    const int axes[2] = {u, v};
    int third[2];
    for (int i = 0; i < 2; ++i) {
        double lo = ground->lo[axes[i]], hi = ground->hi[axes[i]], at = corner[axes[i]];
        third[i] = (3.0 * (at - lo) > hi - lo) - (3.0 * (hi - at) > hi - lo);
    }
    if ((third[0] == 0) == (third[1] == 0))
        return 0;
    return third[0] == 0 ? 1u << (third[1] > 0) : 4u << (third[0] > 0);
}

static struct ending look_below(const struct scene *scene, const struct shape *shape, int axis)
{
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    double ground = area_of(shape, u, v), area = 0.0, low = 0.0;
    struct shape rest, feet;
    double extent = shape->hi[axis] - shape->lo[axis];
    unsigned sides = 0;
    double3_no_box(rest.lo, rest.hi);
    double3_no_box(feet.lo, feet.hi);
    double top = shape->lo[axis] + SLAB * extent, low_top = shape->lo[axis] + LOW * extent;
    for (uint32_t m = 0; m < scene->mesh_count; ++m)
        for (uint32_t t = 0; t < scene->meshes[m].triangle_count; ++t) {
            double p[3][3];
            scene_mesh_corners(&scene->meshes[m], t, p);
            double highest = fmax(fmax(p[0][axis], p[1][axis]), p[2][axis]);
            double lowest = fmin(fmin(p[0][axis], p[1][axis]), p[2][axis]);
            double covered = 0.5 * fabs((p[1][u] - p[0][u]) * (p[2][v] - p[0][v]) -
                                        (p[2][u] - p[0][u]) * (p[1][v] - p[0][v]));
            if (highest <= low_top && highest - lowest <= SLAB * extent)
                low += covered;
            if (highest <= top)
                area += covered;
            for (int i = 0; i < 3; ++i) {
                if (highest > top)
                    double3_grow_box(rest.lo, rest.hi, p[i]);
                if (p[i][axis] > top)
                    continue;
                double3_grow_box(feet.lo, feet.hi, p[i]);
                sides |= side_of(shape, p[i], u, v);
            }
        }
    return ground > 0.0 ? (struct ending){.flat = area / ground,
                                          .low = low / ground,
                                          .rest = area_of(&rest, u, v) / ground,
                                          .feet = area_of(&feet, u, v) / ground,
                                          .rim = sides == 15}
                        : (struct ending){0};
}

whit_up up_guess(const struct scene *scene, bool z_usual)
{
    const struct shape shape = measure(scene);
    double extent[3];
    for (int k = 0; k < 3; ++k)
        extent[k] = shape.hi[k] - shape.lo[k];
    if (!(extent[0] >= 0.0) || !isfinite(extent[0] + extent[1] + extent[2]))
        return WHIT_UP_Y;
    struct ending y = look_below(scene, &shape, 1), z = look_below(scene, &shape, 2);
    if (z_usual)
        return y.flat >= STANDS && z.flat < HARDLY ? WHIT_UP_Y : WHIT_UP_Z;
    /* A floor with something in its middle; a picture in a frame would fill most of the floor. */
    if (z.flat >= FLOOR && z.rest > 0.0 && z.rest < FLOOR && y.flat < HARDLY)
        return WHIT_UP_Z;
    bool board = extent[2] < BOARD * fmin(extent[0], extent[1]);
    /* Programs with z upwards put the ground at z = 0. */
    bool grounded = fabs(shape.lo[2]) <= SLAB * extent[2] && fabs(shape.lo[1]) > SLAB * extent[1];
    bool stands = (z.flat >= STANDS && y.flat < HARDLY) || (z.low >= FLOOR && y.low < HARDLY) ||
                  (z.feet >= FLOOR && !z.rim && y.feet < EDGE);
    return !board && grounded && stands ? WHIT_UP_Z : WHIT_UP_Y;
}

whit_result up_turn_by_shape(struct scene *scene, const char *path)
{
    char extension[8];
    path_extension(path, extension, sizeof extension);
    whit_up up = up_guess(scene, strcmp(extension, "stl") == 0);
    if (up == WHIT_UP_Y)
        return WHIT_OK;
    uint32_t node = up_add_node(scene, up);
    if (node == SCENE_NONE)
        return WHIT_ERROR_MEMORY;
    for (uint32_t i = 0; i < scene->instance_count; ++i)
        if (scene->instances[i].node == SCENE_NONE)
            scene->instances[i].node = node;
    scene_note(scene, SCENE_NOTE_INFO, "the file does not say which axis is up: by its shape z is");
    return WHIT_OK;
}
