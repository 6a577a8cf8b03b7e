/* Decides which scenes get one tree in world space, where the user does not say. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "accel/extent.h"
#include "accel/flat.h"
#include "accel/flat_choice.h"
#include "base/array.h"
#include "scene/afford.h"

/* The largest allowed world coordinate of an object, in multiples of its longest side. Transformed
   vertices are then off by at most 2^-16 of that side: 1/60 of a pixel where the side fills 1000
   pixels. */
static const double FARTHEST = 256.0;

bool accel_flat_keeps_spheres(const struct affine *forward)
{
    const double *m = forward->m;
    return m[0] > 0.0 && m[5] == m[0] && m[10] == m[0] && m[1] == 0.0 && m[2] == 0.0 &&
           m[4] == 0.0 && m[6] == 0.0 && m[8] == 0.0 && m[9] == 0.0;
}

/* Whether transforming the instance's vertices to world space loses little precision. */
static bool is_placed_well(const struct scene_mesh *mesh, const struct affine *forward)
{
    struct bvh_box box;
    double farthest = 0.0, longest = 0.0;
    if (affine_is_identity(forward) || scene_mesh_primitives(mesh) == 0)
        return true;
    if (mesh->sphere_count && !accel_flat_keeps_spheres(forward))
        return false;
    memcpy(box.lo, mesh->lo, sizeof box.lo);
    memcpy(box.hi, mesh->hi, sizeof box.hi);
    struct accel_extent world = accel_transformed_box(forward->m, &box);
    for (int k = 0; k < 3; ++k) {
        farthest = fmax(farthest, fmax(fabs(world.lo[k]), fabs(world.hi[k])));
        longest = fmax(longest, world.hi[k] - world.lo[k]);
    }
    return farthest <= FARTHEST * longest && farthest <= FLAT_COORDINATE_MAX;
}

static bool is_one_ball(const struct scene_mesh *mesh)
{
    return mesh->sphere_count == 1 && mesh->triangle_count == 0;
}

/* Whether each mesh has only one instance, since the tree would contain a mesh once for each
   instance. A mesh of a single sphere may have more: its record takes no more memory than the
   instance did. */
static whit_result find_repeated(const struct scene *scene, bool *each_once)
{
    uint8_t *seen = array_alloc_zeroed(scene->mesh_count, 1);
    if (!seen)
        return log_failure(&scene->log, WHIT_ERROR_MEMORY, "%s: out of memory", scene->name);
    *each_once = true;
    for (uint32_t i = 0; *each_once && i < scene->instance_count; ++i)
        *each_once = seen[scene->instances[i].mesh]++ == 0 ||
                     is_one_ball(&scene->meshes[scene->instances[i].mesh]);
    free(seen);
    return WHIT_OK;
}

static bool has_room(const struct scene *scene)
{
    uint64_t vertices = 0, primitives = scene->triangle_total + scene->sphere_total;
    for (uint32_t i = 0; i < scene->mesh_count; ++i)
        vertices += accel_flat_vertices(&scene->meshes[i]);
    return primitives > 0 && primitives <= FLAT_TRIANGLES_MAX && vertices <= FLAT_VERTICES_MAX &&
           scene->instance_count < FLAT_INSTANCES_MAX &&
           primitives * FLAT_TRIANGLE_BYTES <= scene_room(scene);
}

whit_result accel_flat_suits(const struct scene *scene, const struct scene_pose *pose, bool *out)
{
    bool single_identity = scene->instance_count == 1 && affine_is_identity(&pose->instances[0]);
    bool suits = scene->channel_count == 0 && !single_identity && has_room(scene);
    for (uint32_t i = 0; suits && i < scene->instance_count; ++i)
        suits = is_placed_well(&scene->meshes[scene->instances[i].mesh], &pose->instances[i]);
    *out = suits;
    return suits ? find_repeated(scene, out) : WHIT_OK;
}
