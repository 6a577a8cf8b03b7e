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
static const double EDGE = 0.5;
/* A floor may also lie up to this share of the extent above the end, as on a foundation. */
static const double LOW = 0.1;
/* A model thinner than this share of its other sides is a board, which may stand on an edge. */
static const double BOARD = 0.15;

/* A shape is the mirror image of itself along an axis, or clearly not, if no more than the first,
   or at least the second, of these shares of its surface is at other places in the mirror. */
static const double EVEN = 0.02, UNEVEN = 0.1;
/* Places along an axis that the surface is counted at. */
enum { PLACES = 16 };

/* The surface of a terrain covers its ground, even at the corners, but for this share; and only
   this share of it is above another part of it. */
static const double GAPS = 0.18, ABOVE = 0.25;
/* Half of it slopes by more than SLIGHT, and the lesser of the slopes along two axes is no less
   than this share of the other, unlike those of a curtain. */
static const double SLIGHT = 0.01, OTHER_SLOPE = 0.3;

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

static bool is_grounded(const struct shape *shape, int axis)
{
    return fabs(shape->lo[axis]) <= SLAB * (shape->hi[axis] - shape->lo[axis]);
}

static bool is_centred(const struct shape *shape, int axis)
{
    return fabs(shape->lo[axis] + shape->hi[axis]) <= SLAB * (shape->hi[axis] - shape->lo[axis]);
}

/* A wall cabinet is above 0 on the axis that is up, and centred on the one along the wall. */
static bool hangs(const struct shape *shape, int up, int along)
{
    return shape->lo[up] > SLAB * (shape->hi[up] - shape->lo[up]) && is_centred(shape, along);
}

static bool is_board(const struct shape *shape, int axis)
{
    double extent[3];
    for (int k = 0; k < 3; ++k)
        extent[k] = shape->hi[k] - shape->lo[k];
    return extent[axis] < BOARD * fmin(extent[(axis + 1) % 3], extent[(axis + 2) % 3]);
}

/* The area of a box along two axes. */
static double area_of(const struct shape *box, int u, int v)
{
    return fmax(box->hi[u] - box->lo[u], 0.0) * fmax(box->hi[v] - box->lo[v], 0.0);
}

/* The share of the surface that is at other places in a mirror across the axis. */
static double unevenness(const struct scene *scene, const struct shape *shape, int axis)
{
    double areas[PLACES + 1] = {0}, total = 0.0, differing = 0.0;
    for (uint32_t m = 0; m < scene->mesh_count; ++m)
        for (uint32_t t = 0; t < scene->meshes[m].triangle_count; ++t) {
            double p[3][3], edges[2][3];
            scene_mesh_corners(&scene->meshes[m], t, p);
            double3_sub(p[1], p[0], edges[0]);
            double3_sub(p[2], p[0], edges[1]);
            double area = double3_area(edges[0], edges[1]);
            for (int i = 0; i < 3; ++i) {
                double place = (p[i][axis] - shape->lo[axis]) / (shape->hi[axis] - shape->lo[axis]);
                int below = (int)fmin(fmax(place * PLACES, 0.0), PLACES - 1);
                areas[below] += area * (below + 1 - place * PLACES);
                areas[below + 1] += area * (place * PLACES - below);
            }
            total += 3.0 * area;
        }
    for (int i = 0; i <= PLACES; ++i)
        differing += 0.5 * fabs(areas[i] - areas[PLACES - i]);
    return total > 0.0 ? differing / total : 0.0;
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

/* Whether the surface is a terrain whose heights are along the axis `up`. What stands with its
   ground at 0 on the axis `other`, and on no third one, is a rough wall. A board that is centred
   along the third axis may be a relief. */
static bool is_terrain(const struct scene *scene, const struct shape *shape, int up, int other)
{
    int u = (up + 1) % 3, v = (up + 2) % 3;
    double facing = 0.0, area = 0.0, sloping = 0.0, slopes[3] = {0};
    for (uint32_t m = 0; m < scene->mesh_count; ++m)
        for (uint32_t t = 0; t < scene->meshes[m].triangle_count; ++t) {
            double p[3][3], edges[2][3], n[3];
            scene_mesh_corners(&scene->meshes[m], t, p);
            double3_sub(p[1], p[0], edges[0]);
            double3_sub(p[2], p[0], edges[1]);
            double3_cross(edges[0], edges[1], n);
            double covered = 0.5 * fabs(n[up]);
            facing += 0.5 * n[up];
            area += covered;
            sloping += fmax(fabs(n[u]), fabs(n[v])) > SLIGHT * fabs(n[up]) ? covered : 0.0;
            slopes[u] += fabs(n[u]);
            slopes[v] += fabs(n[v]);
        }
    int third = 3 - up - other;
    bool wall = is_grounded(shape, other) && !is_grounded(shape, third);
    bool relief = is_board(shape, up) && is_centred(shape, third);
    return !wall && !relief && area > 0.0 && fabs(facing) >= (1.0 - GAPS) * area_of(shape, u, v) &&
           area <= (1.0 + ABOVE) * fabs(facing) && sloping >= 0.5 * area &&
           fmin(slopes[u], slopes[v]) >= OTHER_SLOPE * fmax(slopes[u], slopes[v]);
}

/* Whether the shape shows that one axis is up and not another one: it stands on its lower end, with
   the ground at 0 as modelling programs put it, and not on that of the other. */
static bool stands_along(const struct scene *scene, const struct shape *shape, int up, int other)
{
    if (is_board(shape, up) || !is_grounded(shape, up) || is_grounded(shape, other))
        return false;
    struct ending a = look_below(scene, shape, up), b = look_below(scene, shape, other);
    if ((a.flat >= STANDS && b.flat < HARDLY) || (a.low >= FLOOR && b.low < HARDLY) ||
        (a.feet >= FLOOR && !a.rim && b.feet < EDGE))
        return true;
    /* Things are more often the same on both sides than above and below. */
    bool hung = b.flat >= STANDS && hangs(shape, other, 3 - up - other);
    return !a.rim && !hung && unevenness(scene, shape, up) >= UNEVEN &&
           (a.flat >= FLOOR || unevenness(scene, shape, other) <= EVEN);
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
        return (y.flat >= STANDS && z.flat < HARDLY) || stands_along(scene, &shape, 1, 2) ||
                       is_terrain(scene, &shape, 1, 2)
                   ? WHIT_UP_Y
                   : WHIT_UP_Z;
    /* A floor with something in its middle; a picture in a frame would fill most of the floor. */
    if (z.flat >= FLOOR && z.rest > 0.0 && z.rest < FLOOR && y.flat < HARDLY)
        return WHIT_UP_Z;
    return stands_along(scene, &shape, 2, 1) || is_terrain(scene, &shape, 2, 1) ? WHIT_UP_Z
                                                                                : WHIT_UP_Y;
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
    for (uint32_t i = 0; i < node; ++i) { /* an OFF comes with nodes */
        struct scene_node *root = &scene->nodes[i];
        if (root->parent != SCENE_NONE)
            continue;
        if (!root->has_matrix)
            root->matrix = affine_from_trs(root->translation, root->rotation, root->scale);
        root->matrix = affine_multiply(&scene->nodes[node].matrix, &root->matrix);
        root->has_matrix = true;
    }
    for (uint32_t i = 0; i < scene->instance_count; ++i)
        if (scene->instances[i].node == SCENE_NONE)
            scene->instances[i].node = node;
    scene_note(scene, SCENE_NOTE_INFO, "the file does not say which axis is up: by its shape z is");
    return WHIT_OK;
}
