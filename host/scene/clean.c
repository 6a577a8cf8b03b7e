#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/text.h"
#include "base/vec.h"
#include "scene/freeze.h"

#define LARGEST_COORDINATE 1e18f
#define LARGEST_UV         1e9f
/* Largest angle in radians between a vertex normal and its face's normal that counts as rounding:
   files with four decimals are that far off. */
#define NORMAL_SLACK       1e-4

struct cleaned {
    uint32_t out_of_range, not_finite, zero_area;
    uint32_t spheres;
};

static bool usable_vertex(const float *p)
{
    return fabsf(p[0]) <= LARGEST_COORDINATE && fabsf(p[1]) <= LARGEST_COORDINATE &&
           fabsf(p[2]) <= LARGEST_COORDINATE;
}

/* Whether a sum of doubles is 0, computed without rounding: `parts` do not overlap (Shewchuk 1997,
   Grow-Expansion). */
static bool sum_is_zero(const double *terms, int count)
{
    double parts[6];
    bool zero = true;
    for (int i = 0; i < count; ++i) {
        double sum = terms[i];
        for (int k = 0; k < i; ++k) {
            double both = sum + parts[k], rest = both - sum;
            parts[k] = (sum - (both - rest)) + (parts[k] - rest);
            sum = both;
        }
        parts[i] = sum;
    }
    for (int i = 0; i < count; ++i)
        zero = zero && parts[i] == 0.0;
    return zero;
}

/* Whether the triangle has an area in the plane of axes u and v. Products of two floats are exact
   in double. */
static bool has_area_along(const float *a, const float *b, const float *c, int u, int v)
{
    double ax = (double)a[u], ay = (double)a[v], bx = (double)b[u], by = (double)b[v];
    double cx = (double)c[u], cy = (double)c[v];
    double left = (bx - ax) * (cy - ay), right = (by - ay) * (cx - ax);
    if (fabs(left - right) > 0x1p-50 * (fabs(left) + fabs(right)))
        return true;
    const double terms[6] = {ax * by, -ay * bx, bx * cy, -by * cx, cx * ay, -cy * ax};
    return !sum_is_zero(terms, 6);
}

static bool has_area(const float *a, const float *b, const float *c)
{
    return has_area_along(a, b, c, 1, 2) || has_area_along(a, b, c, 2, 0) ||
           has_area_along(a, b, c, 0, 1);
}

static bool keep_triangle(const struct scene_mesh *mesh, uint32_t triangle, struct cleaned *count)
{
    const uint32_t *index = mesh->indices + 3 * (size_t)triangle;
    const float *p[3];
    for (int i = 0; i < 3; ++i) {
        if (index[i] >= mesh->vertex_count) {
            ++count->out_of_range;
            return false;
        }
        p[i] = mesh->positions + 3 * (size_t)index[i];
    }
    if (!usable_vertex(p[0]) || !usable_vertex(p[1]) || !usable_vertex(p[2])) {
        ++count->not_finite;
        return false;
    }
    if (!has_area(p[0], p[1], p[2])) {
        ++count->zero_area;
        return false;
    }
    return true;
}

/* Groups are ranges of triangles: both ends move down by the triangles dropped before them. */
static void shrink_groups(struct scene_mesh *mesh, const uint32_t *kept_before)
{
    for (uint32_t i = 0; i < mesh->group_count; ++i) {
        struct scene_group *group = &mesh->groups[i];
        uint32_t end = group->first_triangle + group->triangle_count;
        group->first_triangle = kept_before[group->first_triangle];
        group->triangle_count = kept_before[end] - group->first_triangle;
    }
}

static whit_result drop_triangles(struct scene_mesh *mesh, struct cleaned *count)
{
    uint32_t *kept_before = array_alloc((size_t)mesh->triangle_count + 1, sizeof *kept_before);
    if (!kept_before)
        return WHIT_ERROR_MEMORY;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < mesh->triangle_count; ++i) {
        kept_before[i] = kept;
        if (!keep_triangle(mesh, i, count))
            continue;
        if (kept != i) {
            memmove(mesh->indices + 3 * (size_t)kept, mesh->indices + 3 * (size_t)i,
                    3 * sizeof *mesh->indices);
            mesh->materials[kept] = mesh->materials[i];
        }
        ++kept;
    }
    kept_before[mesh->triangle_count] = kept;
    shrink_groups(mesh, kept_before);
    mesh->triangle_count = kept;
    free(kept_before);
    return WHIT_OK;
}

static bool usable_sphere(const float *sphere)
{
    return usable_vertex(sphere) && sphere[3] > 0.0f && sphere[3] <= LARGEST_COORDINATE;
}

static void drop_spheres(struct scene_mesh *mesh, struct cleaned *count)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < mesh->sphere_count; ++i) {
        if (!usable_sphere(mesh->spheres + 4 * (size_t)i)) {
            ++count->spheres;
            continue;
        }
        memmove(mesh->spheres + 4 * (size_t)kept, mesh->spheres + 4 * (size_t)i,
                4 * sizeof *mesh->spheres);
        mesh->materials[kept++] = mesh->materials[i];
    }
    mesh->sphere_count = kept;
}

/* Zeroes vertices that are not finite or beyond 1e18: only dropped triangles used them, and later
   stages may go over all vertices. */
static void zero_unusable_vertices(struct scene_mesh *mesh)
{
    for (uint32_t i = 0; i < mesh->vertex_count; ++i) {
        float *p = mesh->positions + 3 * (size_t)i;
        if (!usable_vertex(p))
            p[0] = p[1] = p[2] = 0.0f;
    }
}

static void set_bounds(struct scene_mesh *mesh)
{
    for (int k = 0; k < 3; ++k) {
        mesh->lo[k] = INFINITY;
        mesh->hi[k] = -INFINITY;
    }
    for (size_t i = 0; i < 3 * (size_t)mesh->triangle_count; ++i) {
        const float *p = mesh->positions + 3 * (size_t)mesh->indices[i];
        for (int k = 0; k < 3; ++k) {
            mesh->lo[k] = fminf(mesh->lo[k], p[k]);
            mesh->hi[k] = fmaxf(mesh->hi[k], p[k]);
        }
    }
    for (uint32_t i = 0; i < mesh->sphere_count; ++i) {
        const float *sphere = mesh->spheres + 4 * (size_t)i;
        for (int k = 0; k < 3; ++k) {
            mesh->lo[k] = fminf(mesh->lo[k], nextafterf(sphere[k] - sphere[3], -INFINITY));
            mesh->hi[k] = fmaxf(mesh->hi[k], nextafterf(sphere[k] + sphere[3], INFINITY));
        }
    }
}

/* The face's normal; its length is twice the triangle's area. */
static void face_normal(const struct scene_mesh *mesh, uint32_t triangle, double n[3])
{
    double p[3][3], e1[3], e2[3];
    scene_mesh_corners(mesh, triangle, p);
    double3_sub(p[1], p[0], e1);
    double3_sub(p[2], p[0], e2);
    double3_cross(e1, e2, n);
}

/* Area-weighted face normals summed into the vertices marked bad. */
static void average_faces(const struct scene_mesh *mesh, const bool *bad, double *sums)
{
    for (uint32_t t = 0; t < mesh->triangle_count; ++t) {
        const uint32_t *index = mesh->indices + 3 * (size_t)t;
        if (!bad[index[0]] && !bad[index[1]] && !bad[index[2]])
            continue;
        double n[3];
        face_normal(mesh, t, n);
        for (int corner = 0; corner < 3; ++corner) {
            for (int k = 0; bad[index[corner]] && k < 3; ++k)
                sums[3 * (size_t)index[corner] + (size_t)k] += n[k];
        }
    }
}

static void mend_normal(float *normal, const double sum[3])
{
    double length = double3_length(sum);
    bool usable = length > 0.0 && isfinite(length);
    for (int k = 0; k < 3; ++k)
        normal[k] = usable ? (float)(sum[k] / length) : k == 2 ? 1.0f : 0.0f;
}

/* Makes the normal unit, since interpolation would weigh a longer one more. False when its length
   is 0 or not finite. */
static bool normalize(float *normal)
{
    double n[3] = {(double)normal[0], (double)normal[1], (double)normal[2]};
    double length = double3_length(n);
    if (!(length > 0.0) || !isfinite(length))
        return false;
    if (fabs(length - 1.0) > 1e-4) {
        for (int k = 0; k < 3; ++k)
            normal[k] = (float)(n[k] / length);
    }
    return true;
}

static whit_result mend_normals(struct scene_mesh *mesh, uint32_t *count)
{
    if (!mesh->normals)
        return WHIT_OK;
    whit_result result = WHIT_ERROR_MEMORY;
    double *sums = NULL;
    bool *bad = array_alloc_zeroed(mesh->vertex_count, sizeof *bad);
    if (!bad)
        goto fail;
    for (uint32_t i = 0; i < mesh->vertex_count; ++i) {
        bad[i] = !normalize(mesh->normals + 3 * (size_t)i);
        *count += bad[i];
    }
    if (*count) {
        sums = array_alloc_zeroed((size_t)mesh->vertex_count, 3 * sizeof *sums);
        if (!sums)
            goto fail;
        average_faces(mesh, bad, sums);
        for (uint32_t i = 0; i < mesh->vertex_count; ++i) {
            if (bad[i])
                mend_normal(mesh->normals + 3 * (size_t)i, sums + 3 * (size_t)i);
        }
    }
    result = WHIT_OK;
fail:
    free(bad);
    free(sums);
    return result;
}

static uint32_t mend_uvs(struct scene_mesh *mesh)
{
    uint32_t count = 0;
    for (int set = 0; set < 2; ++set) {
        for (uint32_t i = 0; mesh->uvs[set] && i < mesh->vertex_count; ++i) {
            float *uv = mesh->uvs[set] + 2 * (size_t)i;
            if (fabsf(uv[0]) <= LARGEST_UV && fabsf(uv[1]) <= LARGEST_UV)
                continue;
            uv[0] = uv[1] = 0.0f;
            ++count;
        }
    }
    return count;
}

static uint32_t mend_colors(struct scene_mesh *mesh)
{
    uint32_t count = 0;
    for (size_t i = 0; mesh->colors && i < 4 * (size_t)mesh->vertex_count; ++i) {
        if (isfinite(mesh->colors[i]) && mesh->colors[i] >= 0.0f)
            continue;
        mesh->colors[i] = isfinite(mesh->colors[i]) ? 0.0f : 1.0f;
        ++count;
    }
    return count;
}

static uint32_t mend_tangents(struct scene_mesh *mesh)
{
    uint32_t count = 0;
    for (uint32_t i = 0; mesh->tangents && i < mesh->vertex_count; ++i) {
        float *t = mesh->tangents + 4 * (size_t)i;
        t[3] = t[3] < 0.0f ? -1.0f : 1.0f;
        if (normalize(t))
            continue;
        t[0] = 1.0f, t[1] = t[2] = 0.0f;
        ++count;
    }
    return count;
}

/* Whether unit `normal` is parallel to the face's normal, in either direction. */
static bool says_the_face(const float *normal, const double face[3])
{
    const double n[3] = {(double)normal[0], (double)normal[1], (double)normal[2]};
    return double3_area(n, face) <= NORMAL_SLACK * double3_length(face);
}

/* Frees the vertex normals where all of them equal the normals of their faces, so that no kernel
   has to interpolate them. */
static void drop_flat_normals(struct scene_mesh *mesh)
{
    for (uint32_t t = 0; mesh->normals && t < mesh->triangle_count; ++t) {
        const uint32_t *index = mesh->indices + 3 * (size_t)t;
        double face[3];
        face_normal(mesh, t, face);
        for (int corner = 0; corner < 3; ++corner) {
            if (!says_the_face(mesh->normals + 3 * (size_t)index[corner], face))
                return;
        }
    }
    free(mesh->normals);
    mesh->normals = NULL;
}

static void report(struct scene *scene, const struct scene_mesh *mesh, uint32_t count,
                   const char *what)
{
    if (count)
        scene_note(scene, SCENE_NOTE_WARNING, "mesh `%s`: %u %s", text_token(mesh->name).text,
                   count, what);
}

static void report_dropped(struct scene *scene, const struct scene_mesh *mesh,
                           const struct cleaned *count)
{
    if (count->out_of_range || count->not_finite || count->zero_area)
        scene_note(
            scene, SCENE_NOTE_WARNING,
            "mesh `%s`: dropped %u triangles (%u with indices out of range, %u with vertices "
            "not finite or beyond 1e18, %u without area)",
            text_token(mesh->name).text, count->out_of_range + count->not_finite + count->zero_area,
            count->out_of_range, count->not_finite, count->zero_area);
    report(scene, mesh, count->spheres,
           "spheres dropped: centre or radius not finite or beyond 1e18, or no radius over 0");
}

whit_result freeze_clean_mesh(struct scene *scene, uint32_t index)
{
    struct scene_mesh *mesh = &scene->meshes[index];
    struct cleaned dropped = {0};
    uint32_t normals = 0;
    whit_result result = drop_triangles(mesh, &dropped);
    if (result != WHIT_OK)
        return result;
    drop_spheres(mesh, &dropped);
    zero_unusable_vertices(mesh);
    set_bounds(mesh);
    result = mend_normals(mesh, &normals);
    if (result != WHIT_OK)
        return result;
    drop_flat_normals(mesh);
    report_dropped(scene, mesh, &dropped);
    report(scene, mesh, normals, "normals without length or not finite, made from the faces");
    report(scene, mesh, mend_uvs(mesh), "texture coordinates not finite or beyond 1e9, set to 0");
    report(scene, mesh, mend_colors(mesh), "vertex colour components negative or not finite");
    report(scene, mesh, mend_tangents(mesh), "tangents without length or not finite");
    return WHIT_OK;
}
