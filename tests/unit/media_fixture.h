/* Glass, walls whose colour shows where they are hit, and optics in double, for refraction
   tests. */
#ifndef TESTS_MEDIA_FIXTURE_H
#define TESTS_MEDIA_FIXTURE_H

#include "device/buffer.h"
#include "picture_fixture.h"
#include "render/renderer.h"

/* Clear glass without a highlight: all light is reflected or transmitted, by Fresnel. */
static inline struct scene_material clear_glass(float ior, uint32_t priority)
{
    struct scene_material m = matte(0, 0, 0);
    set_rgb(m.transmission, 1, 1, 1);
    m.fresnel = true;
    m.ior = ior;
    m.priority = priority;
    return m;
}

/* A surface of revolution about y of a closed profile of radii and heights; points on the axis have
   radius 0. For a surface that faces outwards the profile goes up outside and down at the axis. */
static inline struct scene_mesh lathe(const double (*profile)[2], uint32_t count, uint32_t segments)
{
    struct scene_mesh mesh = mesh_zeroed(count * segments, 2 * (count - 1) * segments);
    uint32_t used = 0;
    for (uint32_t s = 0; s < segments; ++s) {
        for (uint32_t i = 0; i < count; ++i) {
            double angle = 2.0 * acos(-1.0) * s / segments;
            float *p = &mesh.positions[3 * (size_t)(s * count + i)];
            p[0] = (float)(profile[i][0] * cos(angle));
            p[1] = (float)profile[i][1];
            p[2] = (float)(-profile[i][0] * sin(angle));
        }
        for (uint32_t i = 0; i + 1 < count; ++i) {
            uint32_t next = (s + 1) % segments;
            uint32_t quad[4] = {s * count + i, next * count + i, next * count + i + 1,
                                s * count + i + 1};
            uint32_t *t = &mesh.indices[3 * (size_t)used];
            if (profile[i][0] > 0) {
                memcpy(t, (uint32_t[]){quad[0], quad[1], quad[2]}, 3 * sizeof *t);
                ++used, t += 3;
            }
            if (profile[i + 1][0] > 0) {
                memcpy(t, (uint32_t[]){quad[0], quad[2], quad[3]}, 3 * sizeof *t);
                ++used;
            }
        }
    }
    mesh.triangle_count = used;
    return mesh;
}

/* Adds a wall that faces +z and emits the coordinates of the hit: red and green go from 0 to 1 for
   x and y from -side to side, blue is 1. */
static inline void add_coordinate_wall(struct scene *scene, double z, double side)
{
    struct scene_mesh mesh = mesh_zeroed(4, 2);
    static const uint32_t indices[6] = {0, 1, 2, 0, 2, 3};
    memcpy(mesh.indices, indices, sizeof indices);
    mesh.colors = array_alloc_zeroed(4, 4 * sizeof *mesh.colors);
    assert_non_null(mesh.colors);
    for (size_t i = 0; i < 4; ++i) {
        double right = i == 1 || i == 2, top = i >= 2;
        mesh.positions[3 * i] = (float)(side * (2.0 * right - 1.0));
        mesh.positions[3 * i + 1] = (float)(side * (2.0 * top - 1.0));
        set_rgb(&mesh.colors[4 * i], (float)right, (float)top, 1.0f);
        mesh.colors[4 * i + 3] = 1.0f;
    }
    add_object(scene, mesh, unlit(1, 1, 1), 0, 0, z);
}

/* The coordinate (`axis` 0: x, 1: y) at which a coordinate wall was hit, by its colour. */
static inline double wall_coordinate(const float *color, int axis, double side)
{
    return side * (2.0 * (double)color[axis] / (double)color[2] - 1.0);
}

/* x and y of a pixel's camera ray with z = -1, for a camera that looks along -z. */
static inline void pixel_slope(const struct image *image, uint32_t x, uint32_t y, double fov_y,
                               double slope[2])
{
    double up = tan(fov_y / 2), right = up * image->width / image->height;
    slope[0] = right * ((x + 0.5) / image->width * 2.0 - 1.0);
    slope[1] = -up * ((y + 0.5) / image->height * 2.0 - 1.0);
}

/* Share of unpolarised light that is reflected, between indices n1 and n2. */
static inline double fresnel(double cos1, double n1, double n2)
{
    double sin2 = n1 / n2 * sqrt(1.0 - cos1 * cos1);
    if (sin2 >= 1.0)
        return 1.0;
    double cos2 = sqrt(1.0 - sin2 * sin2);
    double s = (n1 * cos1 - n2 * cos2) / (n1 * cos1 + n2 * cos2);
    double p = (n1 * cos2 - n2 * cos1) / (n1 * cos2 + n2 * cos1);
    return 0.5 * (s * s + p * p);
}

/* Reads a pixel's weights of rays that were not traced: by depth and by bail-out. */
static inline void pixel_cut(const struct fixture *f, size_t pixel, float cut[2])
{
    assert_int_equal(buffer_read(f->renderer->picture.buffers.queues.cut_sums,
                                 pixel * 2 * sizeof *cut, cut, 2 * sizeof *cut),
                     WHIT_OK);
}

#endif
