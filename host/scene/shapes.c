#include "scene/shapes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/same.h"
#include "base/vec.h"
#include "scene/shaper.h"

#define STEPS_MAX 8192u

whit_result shape_box(const double size[3], struct scene_mesh *out)
{
    struct shaper shaper;
    if (!shape_positive(size[0]) || !shape_positive(size[1]) || !shape_positive(size[2]))
        return WHIT_ERROR_USAGE;
    whit_result result = shaper_init(&shaper, out, 24, 12);
    if (result != WHIT_OK)
        return result;
    for (int face = 0; face < 6; ++face) {
        int axis = face / 2, s = (axis + 1) % 3, t = (axis + 2) % 3;
        double sign = face % 2 ? 1.0 : -1.0;
        uint32_t corner[4];
        for (int i = 0; i < 4; ++i) {
            /* The corners go around the face as seen from outside. */
            double a = i == 1 || i == 2 ? 1.0 : -1.0, b = i >= 2 ? 1.0 : -1.0;
            double position[3], normal[3] = {0, 0, 0};
            normal[axis] = sign;
            position[axis] = sign * 0.5 * size[axis];
            position[s] = a * sign * 0.5 * size[s];
            position[t] = b * 0.5 * size[t];
            /* Texture coordinates such that a picture on the face stands upright. */
            double along = axis == 0 ? -sign * b : axis == 1 ? b : a;
            double up = axis == 0 ? sign * a : axis == 1 ? -a : b;
            corner[i] = shaper_vertex(&shaper, position, normal, 0.5 + 0.5 * along, 0.5 - 0.5 * up);
        }
        shaper_quad(&shaper, corner[0], corner[1], corner[2], corner[3]);
    }
    return WHIT_OK;
}

whit_result shape_plane(double width, double depth, uint32_t steps, double uv_scale,
                        struct scene_mesh *out)
{
    struct shaper shaper;
    if (!shape_positive(width) || !shape_positive(depth) || !steps || steps > STEPS_MAX ||
        !isfinite(uv_scale) || fabs(uv_scale) > 1e6)
        return WHIT_ERROR_USAGE;
    uint64_t row = (uint64_t)steps + 1;
    whit_result result = shaper_init(&shaper, out, row * row, 2 * (uint64_t)steps * steps);
    if (result != WHIT_OK)
        return result;
    for (uint32_t j = 0; j <= steps; ++j) {
        for (uint32_t i = 0; i <= steps; ++i) {
            double u = (double)i / steps, v = (double)j / steps;
            shaper_vertex(&shaper, (double[]){(u - 0.5) * width, 0.0, (v - 0.5) * depth},
                          (double[]){0, 1, 0}, u * uv_scale, v * uv_scale);
        }
    }
    shaper_grid(&shaper, 0, steps, steps);
    return WHIT_OK;
}

/* Rings of `segments` + 1 vertices: the seam has two, for its two values of u. Each pole has a
   vertex per segment. */
whit_result shape_sphere(double radius, uint32_t segments, uint32_t rings, struct scene_mesh *out)
{
    struct shaper shaper;
    if (!shape_positive(radius) || segments < 3 || rings < 2 || segments > STEPS_MAX ||
        rings > STEPS_MAX)
        return WHIT_ERROR_USAGE;
    uint32_t row = segments + 1;
    whit_result result = shaper_init(&shaper, out, (uint64_t)row * (rings + 1),
                                     2 * (uint64_t)segments * (rings - 1));
    if (result != WHIT_OK)
        return result;
    for (uint32_t j = 0; j <= rings; ++j) {
        double sine = j == 0 || j == rings ? 0.0 : same_sin(PI * j / rings),
               height = same_cos(PI * j / rings);
        for (uint32_t i = 0; i <= segments; ++i) {
            double c, s;
            shape_circle_point(i, segments, &c, &s);
            double n[3] = {sine * c, height, -sine * s};
            bool pole = j == 0 || j == rings;
            shaper_vertex(&shaper, (double[]){radius * n[0], radius * n[1], radius * n[2]}, n,
                          (i + (pole ? 0.5 : 0.0)) / segments, (double)j / rings);
        }
    }
    for (uint32_t j = 0; j < rings; ++j) {
        for (uint32_t i = 0; i < segments; ++i) {
            uint32_t a = j * row + i, b = a + row;
            if (j + 1 < rings)
                shaper_triangle(&shaper, a, b, b + 1);
            if (j > 0)
                shaper_triangle(&shaper, a, b + 1, a + 1);
        }
    }
    return WHIT_OK;
}

struct icosphere {
    double (*points)[3];
    uint32_t (*faces)[3], (*next)[3];
    uint32_t point_count, face_count;
    uint64_t *keys; /* hash table of edges: (smaller index << 32 | larger index) + 1; 0: empty */
    uint32_t *middles;
    uint32_t table_size;
};

static void icosphere_finish(struct icosphere *ico)
{
    free(ico->points);
    free(ico->faces);
    free(ico->next);
    free(ico->keys);
    free(ico->middles);
}

static uint32_t icosphere_point(struct icosphere *ico, double x, double y, double z)
{
    double length = sqrt(x * x + y * y + z * z);
    double *p = ico->points[ico->point_count];
    p[0] = x / length, p[1] = y / length, p[2] = z / length;
    return ico->point_count++;
}

static uint32_t icosphere_middle(struct icosphere *ico, uint32_t a, uint32_t b)
{
    uint32_t low = a < b ? a : b, high = a < b ? b : a;
    uint64_t key = ((uint64_t)low << 32 | high) + 1;
    uint32_t slot = (uint32_t)((key * UINT64_C(0x9e3779b97f4a7c15)) >> 32) & (ico->table_size - 1);
    while (ico->keys[slot] && ico->keys[slot] != key)
        slot = (slot + 1) & (ico->table_size - 1);
    if (!ico->keys[slot]) {
        const double *p = ico->points[low], *q = ico->points[high];
        ico->keys[slot] = key;
        ico->middles[slot] = icosphere_point(ico, p[0] + q[0], p[1] + q[1], p[2] + q[2]);
    }
    return ico->middles[slot];
}

static whit_result icosphere_init(struct icosphere *ico, uint32_t level)
{
    static const uint8_t faces[20][3] = {
        {0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
        {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
        {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    const size_t face_max = (size_t)20 << (2 * level);
    *ico = (struct icosphere){.table_size = 64u << (2 * level)};
    ico->points = array_alloc(face_max / 2 + 2, sizeof *ico->points);
    ico->faces = array_alloc(face_max, sizeof *ico->faces);
    ico->next = array_alloc(face_max, sizeof *ico->next);
    ico->keys = array_alloc_zeroed(ico->table_size, sizeof *ico->keys);
    ico->middles = array_alloc(ico->table_size, sizeof *ico->middles);
    if (!ico->points || !ico->faces || !ico->next || !ico->keys || !ico->middles) {
        icosphere_finish(ico);
        return WHIT_ERROR_MEMORY;
    }
    double g = 0.5 * (1.0 + sqrt(5.0));
    for (int axis = 0; axis < 3; ++axis) {
        for (int i = 0; i < 4; ++i) {
            double one = i & 1 ? 1.0 : -1.0, golden = i & 2 ? -g : g;
            if (axis == 0)
                icosphere_point(ico, one, golden, 0.0);
            else if (axis == 1)
                icosphere_point(ico, 0.0, one, golden);
            else
                icosphere_point(ico, golden, 0.0, one);
        }
    }
    for (; ico->face_count < 20; ++ico->face_count) {
        for (int k = 0; k < 3; ++k)
            ico->faces[ico->face_count][k] = faces[ico->face_count][k];
    }
    return WHIT_OK;
}

static void icosphere_refine(struct icosphere *ico)
{
    for (uint32_t i = 0; i < ico->face_count; ++i) {
        const uint32_t *f = ico->faces[i];
        uint32_t ab = icosphere_middle(ico, f[0], f[1]), bc = icosphere_middle(ico, f[1], f[2]);
        uint32_t ca = icosphere_middle(ico, f[2], f[0]);
        const uint32_t parts[4][3] = {{f[0], ab, ca}, {f[1], bc, ab}, {f[2], ca, bc}, {ab, bc, ca}};
        memcpy(ico->next[4 * (size_t)i], parts, sizeof parts);
    }
    ico->face_count *= 4;
    uint32_t(*swap)[3] = ico->faces;
    ico->faces = ico->next;
    ico->next = swap;
}

whit_result shape_icosphere(double radius, uint32_t level, struct scene_mesh *out)
{
    struct icosphere ico;
    struct shaper shaper;
    if (!shape_positive(radius) || level > 8)
        return WHIT_ERROR_USAGE;
    whit_result result = icosphere_init(&ico, level);
    if (result != WHIT_OK)
        return result;
    for (uint32_t i = 0; i < level; ++i)
        icosphere_refine(&ico);
    result = shaper_init(&shaper, out, ico.point_count, ico.face_count);
    if (result != WHIT_OK)
        goto fail;
    for (uint32_t i = 0; i < ico.point_count; ++i) {
        const double *n = ico.points[i];
        shaper_vertex(&shaper, (double[]){radius * n[0], radius * n[1], radius * n[2]}, n,
                      0.5 + same_atan2(-n[2], n[0]) / (2.0 * PI),
                      same_acos(fmax(-1.0, fmin(1.0, n[1]))) / PI);
    }
    for (uint32_t i = 0; i < ico.face_count; ++i)
        shaper_triangle(&shaper, ico.faces[i][0], ico.faces[i][1], ico.faces[i][2]);
fail:
    icosphere_finish(&ico);
    return result;
}

/* A torus around the y axis; `tube` is the radius of its cross-section. */
whit_result shape_torus(double radius, double tube, uint32_t segments, uint32_t sides,
                        struct scene_mesh *out)
{
    struct shaper shaper;
    if (!shape_positive(radius) || !shape_positive(tube) || segments < 3 || sides < 3 ||
        segments > STEPS_MAX || sides > STEPS_MAX)
        return WHIT_ERROR_USAGE;
    whit_result result = shaper_init(&shaper, out, (sides + UINT64_C(1)) * (segments + 1),
                                     2 * (uint64_t)segments * sides);
    if (result != WHIT_OK)
        return result;
    for (uint32_t i = 0; i <= segments; ++i) {
        double c, s, ct, st;
        shape_circle_point(i, segments, &c, &s);
        for (uint32_t j = 0; j <= sides; ++j) {
            shape_circle_point(j, sides, &ct, &st);
            double n[3] = {ct * c, st, -ct * s}, reach = radius + tube * ct;
            shaper_vertex(&shaper, (double[]){reach * c, tube * st, -reach * s}, n,
                          (double)i / segments, 1.0 - (double)j / sides);
        }
    }
    shaper_grid(&shaper, 0, segments, sides);
    return WHIT_OK;
}

static void add_cap(struct shaper *shaper, double radius, double height, double up,
                    uint32_t segments)
{
    const double normal[3] = {0, up, 0};
    uint32_t centre = shaper_vertex(shaper, (double[]){0, height, 0}, normal, 0.5, 0.5);
    for (uint32_t i = 0; i <= segments; ++i) {
        double c, s;
        shape_circle_point(i, segments, &c, &s);
        shaper_vertex(shaper, (double[]){radius * c, height, -radius * s}, normal, 0.5 + 0.5 * c,
                      0.5 - 0.5 * up * s);
    }
    for (uint32_t i = 0; i < segments; ++i) {
        uint32_t a = centre + 1 + i;
        if (up > 0.0)
            shaper_triangle(shaper, centre, a, a + 1);
        else
            shaper_triangle(shaper, centre, a + 1, a);
    }
}

whit_result shape_cylinder(double radius, double radius_top, double height, uint32_t segments,
                           struct scene_mesh *out)
{
    struct shaper shaper;
    bool cone = radius_top == 0.0;
    if (!shape_positive(radius) || (!cone && !shape_positive(radius_top)) ||
        !shape_positive(height) || segments < 3 || segments > STEPS_MAX)
        return WHIT_ERROR_USAGE;
    uint64_t caps = cone ? 1 : 2, row = (uint64_t)segments + 1;
    whit_result result =
        shaper_init(&shaper, out, 2 * row + caps * (row + 1), (uint64_t)segments * (cone ? 2 : 4));
    if (result != WHIT_OK)
        return result;
    for (uint32_t i = 0; i <= segments; ++i) {
        double c, s;
        shape_circle_point(i, segments, &c, &s);
        double n[3] = {height * c, radius - radius_top, -height * s}, u = (double)i / segments;
        shaper_vertex(&shaper, (double[]){radius * c, -0.5 * height, -radius * s}, n, u, 1.0);
        shaper_vertex(&shaper, (double[]){radius_top * c, 0.5 * height, -radius_top * s}, n, u,
                      0.0);
    }
    for (uint32_t i = 0; i < segments; ++i) {
        uint32_t a = 2 * i;
        if (!cone)
            shaper_triangle(&shaper, a, a + 3, a + 1);
        shaper_triangle(&shaper, a, a + 2, a + 3);
    }
    add_cap(&shaper, radius, -0.5 * height, -1.0, segments);
    if (!cone)
        add_cap(&shaper, radius_top, 0.5 * height, 1.0, segments);
    return WHIT_OK;
}

static double lattice(uint32_t i, uint32_t j, uint32_t seed)
{
    uint32_t h = i * 0x8da6b343u ^ j * 0xd8163841u ^ seed * 0xcb1ab31fu;
    h = (h ^ (h >> 16)) * 0x7feb352du;
    h = (h ^ (h >> 15)) * 0x846ca68bu;
    h ^= h >> 16;
    return h / 4294967295.0;
}

/* Value noise in [0, 1], with a fifth-degree fade so that slopes have no creases. */
static double value_noise(double x, double y, uint32_t seed)
{
    double fx = floor(x), fy = floor(y), s = x - fx, t = y - fy;
    uint32_t i = (uint32_t)fx, j = (uint32_t)fy;
    s = s * s * s * (s * (s * 6.0 - 15.0) + 10.0);
    t = t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    double low = lattice(i, j, seed) * (1.0 - s) + lattice(i + 1, j, seed) * s;
    double high = lattice(i, j + 1, seed) * (1.0 - s) + lattice(i + 1, j + 1, seed) * s;
    return low * (1.0 - t) + high * t;
}

/* Six octaves of value noise, in [0, 1], over the unit square and a little around it. */
static double terrain_height(double u, double v, uint32_t seed)
{
    double sum = 0.0, weight = 0.5, total = 0.0, frequency = 4.0;
    for (uint32_t octave = 0; octave < 6; ++octave) {
        sum += weight * value_noise((u + 1.0) * frequency, (v + 1.0) * frequency, seed + octave);
        total += weight;
        weight *= 0.5;
        frequency *= 2.0;
    }
    return sum / total;
}

whit_result shape_terrain(double size, double height, uint32_t steps, uint32_t seed,
                          struct scene_mesh *out)
{
    struct shaper shaper;
    if (!shape_positive(size) || !shape_positive(height) || !steps || steps > 4096)
        return WHIT_ERROR_USAGE;
    uint64_t row = (uint64_t)steps + 1;
    whit_result result = shaper_init(&shaper, out, row * row, 2 * (uint64_t)steps * steps);
    if (result != WHIT_OK)
        return result;
    double h = 1.0 / steps;
    for (uint32_t j = 0; j <= steps; ++j) {
        for (uint32_t i = 0; i <= steps; ++i) {
            double u = (double)i / steps, v = (double)j / steps;
            double dx = terrain_height(u + h, v, seed) - terrain_height(u - h, v, seed);
            double dz = terrain_height(u, v + h, seed) - terrain_height(u, v - h, seed);
            double slope = height / (2.0 * h * size);
            shaper_vertex(
                &shaper,
                (double[]){(u - 0.5) * size, height * terrain_height(u, v, seed), (v - 0.5) * size},
                (double[]){-slope * dx, 1.0, -slope * dz}, u, v);
        }
    }
    shaper_grid(&shaper, 0, steps, steps);
    return WHIT_OK;
}

struct flake {
    double centre[3], radius;
    double u[3], w[3]; /* unit: w points away from the parent, u is orthogonal to w */
};

/* Nine of the twelve directions of a cuboctahedron: six around the parent's equator, three above;
   the three below would meet the grandparent. */
static struct flake flake_child(const struct flake *parent, uint32_t child)
{
    double polar = child < 6 ? PI / 2.0 : same_acos(sqrt(2.0 / 3.0));
    double azimuth = child < 6 ? child * PI / 3.0 : PI / 6.0 + (child - 6) * 2.0 * PI / 3.0;
    double v[3];
    double3_cross(parent->w, parent->u, v);
    struct flake out = {.radius = parent->radius / 3.0};
    double reach = parent->radius + out.radius;
    for (int i = 0; i < 3; ++i) {
        out.w[i] = same_sin(polar) * (same_cos(azimuth) * parent->u[i] + same_sin(azimuth) * v[i]) +
                   same_cos(polar) * parent->w[i];
        out.u[i] = -same_sin(azimuth) * parent->u[i] + same_cos(azimuth) * v[i];
        out.centre[i] = parent->centre[i] + reach * out.w[i];
    }
    return out;
}

whit_result shape_sphereflake(double radius, uint32_t level, double **spheres, uint32_t *count)
{
    *spheres = NULL;
    *count = 0;
    if (!shape_positive(radius) || level > 6)
        return WHIT_ERROR_USAGE;
    uint32_t total = 1;
    for (uint32_t i = 0, width = 1; i < level; ++i)
        total += width *= 9;
    struct flake *flakes = array_alloc(total, sizeof *flakes);
    double *out = array_alloc(total, 4 * sizeof *out);
    if (!flakes || !out) {
        free(flakes);
        free(out);
        return WHIT_ERROR_MEMORY;
    }
    flakes[0] = (struct flake){.radius = radius, .u = {1, 0, 0}, .w = {0, 1, 0}};
    for (uint32_t i = 1; i < total; ++i)
        flakes[i] = flake_child(&flakes[(i - 1) / 9], (i - 1) % 9);
    for (uint32_t i = 0; i < total; ++i) {
        memcpy(out + 4 * (size_t)i, flakes[i].centre, 3 * sizeof *out);
        out[4 * (size_t)i + 3] = flakes[i].radius;
    }
    free(flakes);
    *spheres = out;
    *count = total;
    return WHIT_OK;
}

whit_result shape_balls(const double *spheres, uint32_t count, struct scene_mesh *out)
{
    if (count == 0)
        return WHIT_ERROR_USAGE;
    struct scene_mesh mesh = {.sphere_count = count};
    mesh.spheres = array_alloc(count, 4 * sizeof *mesh.spheres);
    mesh.materials = array_alloc_zeroed(count, sizeof *mesh.materials);
    if (!mesh.spheres || !mesh.materials) {
        free(mesh.spheres);
        free(mesh.materials);
        return WHIT_ERROR_MEMORY;
    }
    for (size_t i = 0; i < 4 * (size_t)count; ++i)
        mesh.spheres[i] = (float)spheres[i];
    *out = mesh;
    return WHIT_OK;
}
