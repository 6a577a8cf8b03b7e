/* An architectural interior. It is hard for tree builders: very large beside very small triangles,
   many of them long, thin or diagonal. */
#include <math.h>

#include "base/same.h"
#include "base/vec.h"
#include "scene/shaper.h"
#include "scene/shapes.h"

#define PITCH  4.0 /* of the bays */
#define NAVE   5.0 /* from the axis to the columns */
#define WALL   9.0 /* from the axis to the outer walls */
#define FLOOR2 6.8
#define EAVES  12.4

enum { BAYS_MAX = 64, LEVEL_MAX = 8, TILES_PER_BAY = 4 };

struct atrium {
    struct shaper shaper;
    uint32_t bays, level;
    double end; /* z of the end walls */
};

static const float stone[3] = {0.60f, 0.53f, 0.42f}, pale[3] = {0.74f, 0.69f, 0.59f},
                   wood[3] = {0.22f, 0.12f, 0.06f}, dark[3] = {0.18f, 0.16f, 0.15f};

static void paint(struct atrium *atrium, const float color[3])
{
    for (int i = 0; i < 3; ++i)
        atrium->shaper.color[i] = color[i];
}

/* An orthonormal frame, right-handed; `axes` are its x, y and z. */
struct frame {
    double origin[3], axes[3][3];
};

static struct frame frame_at(double x, double y, double z)
{
    return (struct frame){.origin = {x, y, z}, .axes = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
}

/* A frame whose z is the world's x (`sign` 1) or -x (`sign` -1). */
static struct frame frame_across(double x, double y, double z, double sign)
{
    return (struct frame){.origin = {x, y, z}, .axes = {{0, 0, -sign}, {0, 1, 0}, {sign, 0, 0}}};
}

static void turned(const struct frame *frame, const double v[3], double out[3])
{
    for (int i = 0; i < 3; ++i)
        out[i] = frame->axes[0][i] * v[0] + frame->axes[1][i] * v[1] + frame->axes[2][i] * v[2];
}

static uint32_t put(struct atrium *atrium, const struct frame *frame, const double p[3],
                    const double n[3])
{
    double position[3], normal[3];
    turned(frame, p, position);
    turned(frame, n, normal);
    for (int i = 0; i < 3; ++i)
        position[i] += frame->origin[i];
    return shaper_vertex(&atrium->shaper, position, normal, p[0], p[1]);
}

/* Four corners of a plane, counter-clockwise as seen from where `n` points. */
static void add_plane(struct atrium *atrium, const struct frame *frame, const double corners[4][3],
                      const double n[3])
{
    uint32_t a = put(atrium, frame, corners[0], n), b = put(atrium, frame, corners[1], n);
    uint32_t c = put(atrium, frame, corners[2], n), d = put(atrium, frame, corners[3], n);
    shaper_quad(&atrium->shaper, a, b, c, d);
}

static void add_block(struct atrium *atrium, const struct frame *frame, const double lo[3],
                      const double hi[3])
{
    for (int face = 0; face < 6; ++face) {
        int axis = face / 2, s = (axis + 1) % 3, t = (axis + 2) % 3;
        bool high = face % 2;
        double corners[4][3], normal[3] = {0, 0, 0};
        normal[axis] = high ? 1.0 : -1.0;
        for (int i = 0; i < 4; ++i) {
            bool right = i == 1 || i == 2;
            corners[i][axis] = high ? hi[axis] : lo[axis];
            corners[i][s] = right == high ? hi[s] : lo[s];
            corners[i][t] = i >= 2 ? hi[t] : lo[t];
        }
        add_plane(atrium, frame, (const double(*)[3])corners, normal);
    }
}

/* A surface of revolution about y. `profile`: radius (above 0) and height of each ring, bottom
   to top, scaled by `size` and `tall`. Bands between rings share no vertices, so that edges are
   crisp. */
static void add_lathe(struct atrium *atrium, const struct frame *frame, const double profile[][2],
                      uint32_t ring_count, uint32_t segments, double size, double tall)
{
    for (uint32_t ring = 0; ring + 1 < ring_count; ++ring) {
        const double *low = profile[ring], *high = profile[ring + 1];
        double rise = tall * (high[1] - low[1]), grow = size * (high[0] - low[0]);
        uint32_t first = atrium->shaper.vertex;
        for (uint32_t i = 0; i <= segments; ++i) {
            double c, s;
            shape_circle_point(i, segments, &c, &s);
            double normal[3] = {rise * c, -grow, -rise * s};
            put(atrium, frame, (double[]){size * low[0] * c, tall * low[1], -size * low[0] * s},
                normal);
            put(atrium, frame, (double[]){size * high[0] * c, tall * high[1], -size * high[0] * s},
                normal);
        }
        shaper_grid(&atrium->shaper, first, segments, 1);
    }
}

/* A tube around a part of a circle in the frame's xy plane, from angle 0 to `angle`. */
static void add_ring(struct atrium *atrium, const struct frame *frame, double radius, double tube,
                     double angle, uint32_t segments, uint32_t sides)
{
    uint32_t first = atrium->shaper.vertex;
    for (uint32_t i = 0; i <= segments; ++i) {
        double c = same_cos(angle * i / segments), s = same_sin(angle * i / segments);
        for (uint32_t j = 0; j <= sides; ++j) {
            double ct, st;
            shape_circle_point(j, sides, &ct, &st);
            double reach = radius + tube * ct;
            put(atrium, frame, (double[]){reach * c, reach * s, tube * st},
                (double[]){ct * c, ct * s, st});
        }
    }
    shaper_grid(&atrium->shaper, first, segments, sides);
}

/* A wall from y = 0 to `top` over an arch of `radius`; the frame's z is its front. */
static void add_arch(struct atrium *atrium, const struct frame *frame, double radius, double top,
                     double depth, uint32_t segments)
{
    double half = 0.5 * PITCH, z = 0.5 * depth;
    const double front[3] = {0, 0, 1}, back[3] = {0, 0, -1};
    for (int side = -1; side <= 1; side += 2) {
        double inner = side < 0 ? -half : radius, outer = side < 0 ? -radius : half;
        const double corners[4][3] = {
            {inner, 0, z}, {outer, 0, z}, {outer, top, z}, {inner, top, z}};
        const double behind[4][3] = {
            {outer, 0, -z}, {inner, 0, -z}, {inner, top, -z}, {outer, top, -z}};
        add_plane(atrium, frame, corners, front);
        add_plane(atrium, frame, behind, back);
    }
    for (uint32_t i = 0; i < segments; ++i) {
        double a = PI * i / segments, b = PI * (i + 1) / segments;
        double xa = radius * same_cos(a), ya = radius * same_sin(a);
        double xb = i + 1 < segments ? radius * same_cos(b) : -radius;
        double yb = i + 1 < segments ? radius * same_sin(b) : 0.0;
        const double corners[4][3] = {{xb, yb, z}, {xa, ya, z}, {xa, top, z}, {xb, top, z}};
        const double behind[4][3] = {{xa, ya, -z}, {xb, yb, -z}, {xb, top, -z}, {xa, top, -z}};
        add_plane(atrium, frame, corners, front);
        add_plane(atrium, frame, behind, back);
        const double na[3] = {-xa, -ya, 0}, nb[3] = {-xb, -yb, 0};
        uint32_t p = put(atrium, frame, (double[]){xa, ya, z}, na);
        uint32_t q = put(atrium, frame, (double[]){xb, yb, z}, nb);
        uint32_t r = put(atrium, frame, (double[]){xb, yb, -z}, nb);
        uint32_t s = put(atrium, frame, (double[]){xa, ya, -z}, na);
        shaper_quad(&atrium->shaper, p, q, r, s);
    }
    struct frame rim = *frame;
    for (int i = 0; i < 3; ++i)
        rim.origin[i] += z * frame->axes[2][i];
    add_ring(atrium, &rim, radius + 0.12, 0.09, PI, segments, 3 * atrium->level);
}

/* A square beam from p to q, which lie in a plane of constant z, or along z. */
static void add_beam(struct atrium *atrium, const double p[3], const double q[3], double thickness)
{
    double along[3] = {q[0] - p[0], q[1] - p[1], q[2] - p[2]}, h = 0.5 * thickness;
    double length = double3_length(along);
    struct frame frame = frame_at(p[0], p[1], p[2]);
    for (int i = 0; i < 3; ++i)
        frame.axes[0][i] = along[i] / length;
    if (along[2] != 0.0) { /* the frame's x is the world's z, its z the world's -x */
        frame.axes[2][0] = -1.0, frame.axes[2][2] = 0.0;
    } else {
        frame.axes[1][0] = -frame.axes[0][1];
        frame.axes[1][1] = frame.axes[0][0];
    }
    add_block(atrium, &frame, (double[]){0, -h, -h}, (double[]){length, h, h});
}

/* ---- Parts of the building ---- */

static const double column[][2] = {{0.62, 0.00}, {0.62, 0.05}, {0.55, 0.07}, {0.58, 0.09},
                                   {0.55, 0.11}, {0.42, 0.13}, {0.40, 0.30}, {0.38, 0.55},
                                   {0.35, 0.84}, {0.40, 0.86}, {0.37, 0.88}, {0.44, 0.93},
                                   {0.54, 0.97}, {0.54, 1.00}};
static const double baluster[][2] = {{0.09, 0.00}, {0.09, 0.08}, {0.05, 0.12}, {0.08, 0.25},
                                     {0.09, 0.40}, {0.04, 0.75}, {0.06, 0.85}, {0.08, 1.00}};
enum {
    COLUMN_RINGS = sizeof column / sizeof column[0],
    BALUSTER_RINGS = sizeof baluster / sizeof baluster[0],
};

static void add_column(struct atrium *atrium, double x, double y, double z, double height,
                       double size, uint32_t segments)
{
    struct frame frame = frame_at(x, y, z);
    double foot = 0.66 * size, head = 0.60 * size;
    add_block(atrium, &frame, (double[]){-foot, 0, -foot}, (double[]){foot, 0.15, foot});
    add_block(atrium, &frame, (double[]){-head, height - 0.12, -head},
              (double[]){head, height, head});
    frame.origin[1] += 0.15;
    add_lathe(atrium, &frame, column, COLUMN_RINGS, segments, size, height - 0.27);
}

static void add_colonnades(struct atrium *atrium)
{
    for (uint32_t i = 0; i <= atrium->bays; ++i) {
        double z = -atrium->end + PITCH * i;
        for (int side = -1; side <= 1; side += 2) {
            paint(atrium, pale);
            add_column(atrium, side * NAVE, 0.0, z, 4.0, 1.0, 12 * atrium->level);
            add_column(atrium, side * NAVE, FLOOR2, z, 2.8, 0.7, 8 * atrium->level);
            if (i == atrium->bays)
                continue;
            paint(atrium, stone);
            struct frame low = frame_across(side * NAVE, 4.0, z + 0.5 * PITCH, -side);
            struct frame high = frame_across(side * NAVE, FLOOR2 + 2.8, z + 0.5 * PITCH, -side);
            add_arch(atrium, &low, 1.45, FLOOR2 - 4.4, 0.9, 8 * atrium->level);
            add_arch(atrium, &high, 1.5, EAVES - FLOOR2 - 2.8, 0.7, 8 * atrium->level);
        }
    }
}

/* A balustrade along each gallery: 8 balusters per bay, 0.5 apart, under one rail. */
static void add_balustrades(struct atrium *atrium)
{
    paint(atrium, pale);
    for (int side = -1; side <= 1; side += 2) {
        double x = side * (NAVE - 0.5);
        for (uint32_t i = 0; i < 8 * atrium->bays; ++i) {
            struct frame frame = frame_at(x, FLOOR2, -atrium->end + 0.5 * (i + 0.5));
            add_lathe(atrium, &frame, baluster, BALUSTER_RINGS, 4 * atrium->level, 1.0, 0.9);
        }
        struct frame rail = frame_at(x, FLOOR2 + 0.9, 0.0);
        add_block(atrium, &rail, (double[]){-0.12, 0, -atrium->end},
                  (double[]){0.12, 0.12, atrium->end});
    }
}

/* Barrel vaults over the aisles, with faces towards the floor alone, and a rib at each column. */
static void add_vaults(struct atrium *atrium)
{
    const double radius = 0.5 * (WALL - NAVE) - 0.1;
    uint32_t segments = 8 * atrium->level;
    for (int side = -1; side <= 1; side += 2) {
        struct frame frame = frame_at(side * 0.5 * (NAVE + WALL), 4.4, 0.0);
        uint32_t first = atrium->shaper.vertex;
        paint(atrium, stone);
        for (uint32_t i = 0; i <= segments; ++i) {
            double c = same_cos(PI * i / segments), s = same_sin(PI * i / segments);
            for (int far = 0; far < 2; ++far)
                put(atrium, &frame,
                    (double[]){radius * c, radius * s, far ? -atrium->end : atrium->end},
                    (double[]){-c, -s, 0});
        }
        shaper_grid(&atrium->shaper, first, segments, 1);
        paint(atrium, pale);
        for (uint32_t i = 0; i <= atrium->bays; ++i) {
            frame.origin[2] = -atrium->end + PITCH * i;
            add_ring(atrium, &frame, radius, 0.14, PI, segments, 3 * atrium->level);
        }
    }
}

static void add_tile(struct atrium *atrium, double x, double z, double size, bool light)
{
    const double gap = 0.02;
    struct frame frame = frame_at(x, 0.0, z);
    paint(atrium, light ? pale : dark);
    add_block(atrium, &frame, (double[]){gap, -0.04, gap}, (double[]){size - gap, 0, size - gap});
}

static void add_floor(struct atrium *atrium)
{
    struct frame frame = frame_at(0, 0, 0);
    paint(atrium, dark);
    add_block(atrium, &frame, (double[]){-WALL, -0.3, -atrium->end},
              (double[]){WALL, -0.03, atrium->end});
    for (uint32_t j = 0; j < TILES_PER_BAY * atrium->bays; ++j) {
        for (uint32_t i = 0; i < 10; ++i)
            add_tile(atrium, i - NAVE, -atrium->end + j, 1.0, (i + j) % 2);
    }
    for (uint32_t j = 0; j < 2 * atrium->bays; ++j) {
        for (uint32_t i = 0; i < 4; ++i) {
            double x = i < 2 ? -WALL + 2.0 * i : NAVE + 2.0 * (i - 2);
            add_tile(atrium, x, -atrium->end + 2.0 * j, 2.0, (i + j) % 2);
        }
    }
}

static void add_walls(struct atrium *atrium)
{
    struct frame frame = frame_at(0, 0, 0);
    double end = atrium->end;
    for (int side = -1; side <= 1; side += 2) {
        double inner = side * WALL, outer = side * (WALL + 0.6), rim = side * (NAVE - 0.6);
        paint(atrium, stone);
        add_block(atrium, &frame, (double[]){fmin(inner, outer), -0.3, -end - 0.6},
                  (double[]){fmax(inner, outer), EAVES, end + 0.6});
        add_block(atrium, &frame, (double[]){-WALL, -0.3, fmin(side * end, side * (end + 0.6))},
                  (double[]){WALL, EAVES, fmax(side * end, side * (end + 0.6))});
        paint(atrium, pale); /* floor and roof of the gallery */
        add_block(atrium, &frame, (double[]){fmin(rim, inner), FLOOR2 - 0.4, -end},
                  (double[]){fmax(rim, inner), FLOOR2, end});
        add_block(atrium, &frame, (double[]){fmin(rim, outer), EAVES, -end - 0.6},
                  (double[]){fmax(rim, outer), EAVES + 0.35, end + 0.6});
        double lip = side * (NAVE - 0.75), sill = side * (NAVE - 0.45);
        add_block(atrium, &frame, (double[]){fmin(lip, rim), EAVES + 0.12, -end},
                  (double[]){fmax(lip, rim), EAVES + 0.3, end});
        add_block(atrium, &frame, (double[]){fmin(sill, rim), FLOOR2 - 0.6, -end},
                  (double[]){fmax(sill, rim), FLOOR2 - 0.4, end});
    }
}

/* Steps in front of the far wall, and rings on it around a walled-up round window. */
static void add_far_end(struct atrium *atrium)
{
    struct frame frame = frame_at(0, 0, -atrium->end);
    paint(atrium, pale);
    for (uint32_t i = 0; i < 8; ++i)
        add_block(atrium, &frame, (double[]){-3.6, 0.2 * i, 0},
                  (double[]){3.6, 0.2 * (i + 1), 3.8 - 0.35 * i});
    frame.origin[1] = 8.2;
    for (uint32_t i = 0; i < 4; ++i)
        add_ring(atrium, &frame, 0.6 + 0.6 * i, 0.12, 2.0 * PI, 24 * atrium->level,
                 3 * atrium->level);
    for (uint32_t i = 0; i < 12; ++i) {
        double c, s;
        shape_circle_point(i, 12, &c, &s);
        add_beam(atrium, (double[]){0.6 * c, 8.2 + 0.6 * s, -atrium->end},
                 (double[]){2.4 * c, 8.2 + 2.4 * s, -atrium->end}, 0.1);
    }
}

/* A hanging with folds in each arch of the gallery. */
static void add_hangings(struct atrium *atrium)
{
    static const float colors[3][3] = {
        {0.50f, 0.05f, 0.05f}, {0.08f, 0.22f, 0.09f}, {0.06f, 0.10f, 0.32f}};
    const uint32_t columns = 12 * atrium->level, rows = 2 * atrium->level;
    for (uint32_t n = 0; n < 2 * atrium->bays; ++n) {
        double side = n % 2 ? 1.0 : -1.0;
        struct frame frame =
            frame_across(side * (NAVE + 0.5), 0, -atrium->end + PITCH * (n / 2 + 0.5), -side);
        uint32_t first = atrium->shaper.vertex;
        paint(atrium, colors[n / 2 % 3]);
        for (uint32_t j = 0; j <= rows; ++j) {
            double down = (double)j / rows, width = 1.4 - 0.35 * same_sin(PI * down);
            for (uint32_t i = 0; i <= columns; ++i) {
                double across = 2.0 * i / columns - 1.0, phase = 3.0 * PI * across;
                double fold = 0.12 * same_sin(phase) * (0.4 + 0.6 * down);
                double slope = 0.12 * 3.0 * PI * same_cos(phase) * (0.4 + 0.6 * down) / width;
                put(atrium, &frame, (double[]){across * width, FLOOR2 + 4.2 - 3.2 * down, fold},
                    (double[]){-slope, 0, 1});
            }
        }
        for (uint32_t j = 0; j < rows; ++j) {
            for (uint32_t i = 0; i < columns; ++i) {
                uint32_t a = first + j * (columns + 1) + i, b = a + columns + 1;
                shaper_quad(&atrium->shaper, b, b + 1, a + 1, a);
            }
        }
    }
}

/* Trusses over the nave, joined by purlins, with the open sky between them. */
static void add_roof(struct atrium *atrium)
{
    const double eaves = EAVES + 0.5, ridge = 15.5, end = atrium->end;
    paint(atrium, wood);
    for (uint32_t i = 0; i <= atrium->bays; ++i) {
        double z = -end + PITCH * i;
        add_beam(atrium, (double[]){-NAVE, eaves, z}, (double[]){NAVE, eaves, z}, 0.24);
        add_beam(atrium, (double[]){-NAVE, eaves, z}, (double[]){0, ridge, z}, 0.2);
        add_beam(atrium, (double[]){0, ridge, z}, (double[]){NAVE, eaves, z}, 0.2);
        add_beam(atrium, (double[]){0, eaves, z}, (double[]){0, ridge, z}, 0.16);
        add_beam(atrium, (double[]){0, eaves, z}, (double[]){-0.5 * NAVE, 14.2, z}, 0.12);
        add_beam(atrium, (double[]){0, eaves, z}, (double[]){0.5 * NAVE, 14.2, z}, 0.12);
    }
    for (int i = -3; i <= 3; ++i) {
        double part = i / 3.0, y = ridge - (ridge - eaves) * fabs(part) + 0.16;
        add_beam(atrium, (double[]){part * NAVE, y, -end}, (double[]){part * NAVE, y, end}, 0.12);
    }
}

static void add_all(struct atrium *atrium)
{
    add_floor(atrium);
    add_walls(atrium);
    add_colonnades(atrium);
    add_vaults(atrium);
    add_balustrades(atrium);
    add_far_end(atrium);
    add_hangings(atrium);
    add_roof(atrium);
}

whit_result shape_atrium(uint32_t bays, uint32_t level, struct scene_mesh *out)
{
    if (!bays || bays > BAYS_MAX || !level || level > LEVEL_MAX)
        return WHIT_ERROR_USAGE;
    struct atrium atrium = {
        .shaper.measuring = true, .bays = bays, .level = level, .end = 0.5 * PITCH * bays};
    add_all(&atrium);
    uint64_t vertices = atrium.shaper.vertex, triangles = atrium.shaper.corner / 3;
    whit_result result = shaper_init(&atrium.shaper, out, vertices, triangles);
    if (result == WHIT_OK)
        result = shaper_add_colors(&atrium.shaper);
    if (result != WHIT_OK)
        return result;
    add_all(&atrium);
    return WHIT_OK;
}
