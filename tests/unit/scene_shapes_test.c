/* Shapes made by formula: exact counts, closed surfaces, outward faces, normals that agree. */
#include "base/vec.h"
#include "scene/shapes.h"
#include "unit.h"

struct edge {
    float a[3], b[3];
    int direction;
};

static int compare_edges(const void *x, const void *y)
{
    return memcmp(x, y, 6 * sizeof(float));
}

/* Every edge, by the bits of its ends, is walked once each way. */
static void assert_closed(const struct scene_mesh *mesh)
{
    size_t count = 3 * (size_t)mesh->triangle_count;
    own_memory struct edge *edges = calloc(count, sizeof *edges);
    assert_non_null(edges);
    for (size_t i = 0; i < count; ++i) {
        size_t next = i % 3 == 2 ? i - 2 : i + 1;
        const float *p = mesh->positions + 3 * (size_t)mesh->indices[i];
        const float *q = mesh->positions + 3 * (size_t)mesh->indices[next];
        bool forward = memcmp(p, q, 3 * sizeof *p) < 0;
        memcpy(edges[i].a, forward ? p : q, 3 * sizeof *p);
        memcpy(edges[i].b, forward ? q : p, 3 * sizeof *p);
        edges[i].direction = forward ? 1 : -1;
    }
    qsort(edges, count, sizeof *edges, compare_edges);
    for (size_t i = 0; i < count; i += 2) {
        assert_int_equal(compare_edges(&edges[i], &edges[i + 1]), 0);
        assert_int_equal(edges[i].direction + edges[i + 1].direction, 0);
        if (i + 2 < count)
            assert_int_not_equal(compare_edges(&edges[i], &edges[i + 2]), 0);
    }
}

static double volume(const struct scene_mesh *mesh)
{
    double sum = 0.0;
    for (uint32_t t = 0; t < mesh->triangle_count; ++t) {
        double p[3][3], across[3];
        scene_mesh_corners(mesh, t, p);
        double3_cross(p[1], p[2], across);
        sum += double3_dot(p[0], across);
    }
    return sum / 6.0;
}

/* Faces that turn away from their own vertex normals would shade inside out. */
static void assert_normals_agree(const struct scene_mesh *mesh)
{
    for (uint32_t t = 0; t < mesh->triangle_count; ++t) {
        const uint32_t *index = mesh->indices + 3 * (size_t)t;
        double p[3][3], edges[2][3], n[3], sum = 0.0;
        scene_mesh_corners(mesh, t, p);
        for (int i = 0; i < 3; ++i) {
            edges[0][i] = p[1][i] - p[0][i];
            edges[1][i] = p[2][i] - p[0][i];
        }
        double3_cross(edges[0], edges[1], n);
        for (size_t i = 0; i < 9; ++i)
            sum += n[i % 3] * (double)mesh->normals[3 * (size_t)index[i / 3] + i % 3];
        assert_true(sum > 0.0);
    }
    for (uint32_t i = 0; i < mesh->vertex_count; ++i) {
        const float *n = mesh->normals + 3 * (size_t)i;
        assert_true(fabs(double3_length((double[]){(double)n[0], (double)n[1], (double)n[2]}) -
                         1.0) < 1e-6);
    }
}

static void assert_indices(const struct scene_mesh *mesh)
{
    for (size_t i = 0; i < 3 * (size_t)mesh->triangle_count; ++i)
        assert_true(mesh->indices[i] < mesh->vertex_count);
}

static void check_closed(struct scene_mesh *mesh, uint32_t triangles, double min, double max)
{
    assert_int_equal(mesh->triangle_count, triangles);
    assert_indices(mesh);
    assert_closed(mesh);
    assert_normals_agree(mesh);
    assert_true(volume(mesh) > min && volume(mesh) <= max);
    scene_mesh_finish(mesh);
}

static void check_open(struct scene_mesh *mesh, uint32_t triangles)
{
    assert_int_equal(mesh->triangle_count, triangles);
    assert_indices(mesh);
    assert_normals_agree(mesh);
    scene_mesh_finish(mesh);
}

TEST(box)
{
    struct scene_mesh mesh;
    assert_int_equal(shape_box((double[]){1, 2, 4}, &mesh), WHIT_OK);
    check_closed(&mesh, 12, 7.999999, 8.000001);
}

/* Pictures stand upright on a box's walls: v falls with y, and u runs to the right of who looks. */
TEST(box_pictures_stand_upright)
{
    struct scene_mesh mesh;
    assert_int_equal(shape_box((double[]){2, 2, 2}, &mesh), WHIT_OK);
    for (uint32_t i = 0; i < mesh.vertex_count; ++i) {
        const float *p = mesh.positions + 3 * (size_t)i, *n = mesh.normals + 3 * (size_t)i;
        const float *uv = mesh.uvs[0] + 2 * (size_t)i;
        if (n[1] != 0.0f)
            continue;
        float right = n[2] * p[0] - n[0] * p[2]; /* (up x normal) . p */
        assert_true(uv[1] == 0.5f - 0.5f * p[1]);
        assert_true(uv[0] == 0.5f + 0.5f * right);
    }
    scene_mesh_finish(&mesh);
}

TEST(spheres)
{
    struct scene_mesh mesh;
    double full = 4.0 / 3.0 * PI * 8.0;
    assert_int_equal(shape_sphere(2.0, 3, 2, &mesh), WHIT_OK);
    check_closed(&mesh, 6, 0.1 * full, full);
    assert_int_equal(shape_sphere(2.0, 64, 32, &mesh), WHIT_OK);
    check_closed(&mesh, 2 * 64 * 31, 0.99 * full, full);
    for (uint32_t level = 0; level <= 4; ++level) {
        assert_int_equal(shape_icosphere(2.0, level, &mesh), WHIT_OK);
        assert_int_equal(mesh.vertex_count, (10u << (2 * level)) + 2);
        check_closed(&mesh, 20u << (2 * level), level < 4 ? 0.5 * full : 0.99 * full, full);
    }
}

TEST(rings_and_rods)
{
    struct scene_mesh mesh;
    assert_int_equal(shape_torus(3.0, 1.0, 64, 32, &mesh), WHIT_OK);
    /* On the outside v grows downwards, as in pictures; it is 1 and 0 at half height. */
    for (uint32_t i = 0; i < mesh.vertex_count; ++i) {
        const float *p = mesh.positions + 3 * (size_t)i, *uv = mesh.uvs[0] + 2 * (size_t)i;
        if (p[0] * p[0] + p[2] * p[2] > 9.1f)
            assert_true(p[1] > 0.01f ? uv[1] > 0.5f : p[1] > -0.01f || uv[1] < 0.5f);
    }
    check_closed(&mesh, 4096, 0.98 * 6.0 * PI * PI, 6.0 * PI * PI);
    assert_int_equal(shape_cylinder(1.0, 1.0, 2.0, 64, &mesh), WHIT_OK);
    check_closed(&mesh, 256, 0.99 * 2.0 * PI, 2.0 * PI);
    assert_int_equal(shape_cylinder(1.0, 0.0, 3.0, 64, &mesh), WHIT_OK);
    check_closed(&mesh, 128, 0.99 * PI, PI);
    assert_int_equal(shape_cylinder(1.0, 2.0, 3.0, 64, &mesh), WHIT_OK);
    check_closed(&mesh, 256, 0.99 * 7.0 * PI, 7.0 * PI);
}

TEST(open_shapes)
{
    struct scene_mesh mesh;
    assert_int_equal(shape_plane(2.0, 4.0, 5, 3.0, &mesh), WHIT_OK);
    check_open(&mesh, 50);
    assert_int_equal(shape_terrain(10.0, 2.0, 32, 7, &mesh), WHIT_OK);
    for (uint32_t i = 0; i < mesh.vertex_count; ++i) {
        float y = mesh.positions[3 * (size_t)i + 1];
        assert_true(y >= 0.0f && y <= 2.0f);
    }
    check_open(&mesh, 2048);
}

/* The same seed gives the same, another one does not. */
static void check_seeds(const struct scene_mesh *a, const struct scene_mesh *b,
                        const struct scene_mesh *other)
{
    size_t bytes = 3 * sizeof(float) * a->vertex_count;
    assert_memory_equal(a->positions, b->positions, bytes);
    assert_int_not_equal(memcmp(a->positions, other->positions, bytes), 0);
}

TEST(terrain_follows_its_seed)
{
    struct scene_mesh meshes[3];
    for (uint32_t i = 0; i < 3; ++i)
        assert_int_equal(shape_terrain(1.0, 1.0, 8, 1 + i / 2, &meshes[i]), WHIT_OK);
    check_seeds(&meshes[0], &meshes[1], &meshes[2]);
    for (int i = 0; i < 3; ++i)
        scene_mesh_finish(&meshes[i]);
}

TEST(strands_are_closed_needles)
{
    struct scene_mesh meshes[3];
    double one = sqrt(3.0) / 12.0 * 0.1 * 0.1 * 2.0;
    for (uint32_t i = 0; i < 3; ++i)
        assert_int_equal(shape_strands(3.0, 2.0, 0.1, 200, 1 + i / 2, &meshes[i]), WHIT_OK);
    check_seeds(&meshes[0], &meshes[1], &meshes[2]);
    for (int i = 0; i < 3; ++i)
        check_closed(&meshes[i], 800, 199.99 * one, 200.01 * one);
}

/* The sum over bays and ends is linear: a hall of 5 bays has what 3 have, and twice two of them. */
TEST(atrium)
{
    struct scene_mesh mesh;
    uint32_t counts[3];
    for (uint32_t i = 0; i < 3; ++i) {
        assert_int_equal(shape_atrium(1 + 2 * i, 1 + i, &mesh), WHIT_OK);
        check_open(&mesh, mesh.triangle_count);
    }
    for (uint32_t i = 0; i < 3; ++i) {
        assert_int_equal(shape_atrium(1 + 2 * i, 1, &mesh), WHIT_OK);
        counts[i] = mesh.triangle_count;
        for (uint32_t k = 0; k < mesh.vertex_count; ++k) {
            const float *p = mesh.positions + 3 * (size_t)k;
            assert_true(fabsf(p[0]) < 10.0f && p[1] > -1.0f && p[1] < 16.0f);
            assert_true(fabs((double)p[2]) <= 2.0 * (1 + 2 * i) + 0.7);
            assert_true(mesh.colors[4 * (size_t)k + 3] == 1.0f);
        }
        scene_mesh_finish(&mesh);
    }
    assert_int_equal(counts[2] - counts[1], counts[1] - counts[0]);
    assert_true(counts[0] > 0 && counts[1] > counts[0]);
    assert_int_equal(shape_atrium(9, 2, &mesh), WHIT_OK); /* that of scenes/atrium.json */
    check_open(&mesh, 64616);
}

TEST(sphereflake)
{
    own_memory double *spheres = NULL;
    uint32_t count;
    assert_int_equal(shape_sphereflake(1.0, 2, &spheres, &count), WHIT_OK);
    assert_int_equal(count, 1 + 9 + 81);
    for (uint32_t i = 1; i < count; ++i) {
        const double *s = spheres + 4 * (size_t)i, *parent = spheres + 4 * (size_t)((i - 1) / 9);
        assert_true(fabs(s[3] - parent[3] / 3.0) < 1e-12);
        assert_true(fabs(double3_distance(s, parent) - (s[3] + parent[3])) < 1e-12);
    }
    /* Touching at most: no two spheres reach into each other. */
    for (uint32_t i = 0; i < count; ++i) {
        for (uint32_t k = i + 1; k < count; ++k) {
            const double *a = spheres + 4 * (size_t)i, *b = spheres + 4 * (size_t)k;
            assert_true(double3_distance(a, b) > a[3] + b[3] - 1e-12);
        }
    }
}

TEST(senseless_parameters_are_refused)
{
    struct scene_mesh mesh;
    double *spheres;
    uint32_t count;
    assert_int_equal(shape_box((double[]){1, 0, 1}, &mesh), WHIT_ERROR_USAGE);
    assert_int_equal(shape_box((double[]){1, (double)NAN, 1}, &mesh), WHIT_ERROR_USAGE);
    assert_int_equal(shape_sphere(1.0, 2, 8, &mesh), WHIT_ERROR_USAGE);
    assert_int_equal(shape_sphere(1.0, 8, 1, &mesh), WHIT_ERROR_USAGE);
    assert_int_equal(shape_sphere(-1.0, 8, 8, &mesh), WHIT_ERROR_USAGE);
    assert_int_equal(shape_icosphere(1.0, 9, &mesh), WHIT_ERROR_USAGE);
    assert_int_equal(shape_torus(1.0, 0.0, 8, 8, &mesh), WHIT_ERROR_USAGE);
    assert_int_equal(shape_cylinder(1.0, -1.0, 1.0, 8, &mesh), WHIT_ERROR_USAGE);
    assert_int_equal(shape_plane(1.0, 1.0, 0, 1.0, &mesh), WHIT_ERROR_USAGE);
    assert_int_equal(shape_terrain(1.0, 1.0, 5000, 1, &mesh), WHIT_ERROR_USAGE);
    assert_int_equal(shape_strands(1.0, 1.0, 2.0, 9, 1, &mesh), WHIT_ERROR_USAGE);
    assert_int_equal(shape_strands(1.0, 1.0, 0.1, 0, 1, &mesh), WHIT_ERROR_USAGE);
    assert_int_equal(shape_strands(0.0, 1.0, 0.1, 9, 1, &mesh), WHIT_ERROR_USAGE);
    assert_int_equal(shape_atrium(0, 1, &mesh), WHIT_ERROR_USAGE);
    assert_int_equal(shape_atrium(1, 9, &mesh), WHIT_ERROR_USAGE);
    assert_int_equal(shape_sphereflake(1.0, 7, &spheres, &count), WHIT_ERROR_USAGE);
}
