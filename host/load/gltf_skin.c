#include "load/gltf_skin.h"

#include <stdlib.h>

#include "base/array.h"
#include "base/file.h"
#include "scene/afford.h"

/* --- joints --------------------------------------------------------------------------------- */

/* The joint's move: from the mesh's space to the joint's, by a column-major 4x4 matrix whose last
   row is 0 0 0 1 (NULL: the spaces are the same), and on with the joint. */
static struct affine move_of(const struct affine *world, const float *matrix)
{
    struct affine bind = affine_identity();
    for (int i = 0; matrix && i < 12; i++)
        bind.m[i] = (double)matrix[4 * (i % 4) + i / 4];
    return affine_multiply(world, &bind);
}

static bool read_moves(const struct gltf *gltf, const struct gltf_place *at, const json_t *joints,
                       const float *matrices, struct gltf_skin *out)
{
    uint64_t bytes = out->joint_count * sizeof *out->moves;
    if (!scene_afford(gltf->scene, bytes, "%s of %u joints", at->text, out->joint_count))
        return false;
    out->moves = array_alloc(out->joint_count, sizeof *out->moves);
    if (!out->moves)
        return gltf_fail(gltf, at, "out of memory");
    for (uint32_t i = 0; i < out->joint_count; i++) {
        struct gltf_place place = gltf_place("%.60s.joints[%u]", at->text, i);
        uint32_t node;
        if (!gltf_index_value(gltf, json_array_get(joints, i), &place, gltf->node_count, &node))
            return false;
        if (gltf->nodes[node] == SCENE_NONE)
            return gltf_fail(gltf, &place, "node %u is not in the scene that is drawn", node);
        out->moves[i] = move_of(&gltf->worlds[node], matrices ? matrices + (size_t)16 * i : NULL);
    }
    return true;
}

bool gltf_skin_read(const struct gltf *gltf, uint32_t index, struct gltf_skin *out)
{
    struct gltf_place at;
    json_t *object, *joints;
    float *matrices = NULL;
    uint32_t accessor, count = 0;
    *out = (struct gltf_skin){0};
    if (!gltf_item(gltf, "skins", index, &at, &object) ||
        !gltf_array(gltf, object, &at, "joints", &joints) ||
        !gltf_index(gltf, object, &at, "inverseBindMatrices", gltf_count(gltf, "accessors"),
                    &accessor) ||
        (accessor != SCENE_NONE && !gltf_read_floats(gltf, accessor, 16, &matrices, &count)))
        return false;
    out->joint_count = (uint32_t)json_array_size(joints);
    bool enough = out->joint_count && (!matrices || count >= out->joint_count);
    if (!enough)
        gltf_fail(gltf, &at, "has %u joints and %u inverseBindMatrices", out->joint_count, count);
    bool good = enough && read_moves(gltf, &at, joints, matrices, out);
    free(matrices);
    return good;
}

void gltf_skin_finish(const struct gltf *gltf, struct gltf_skin *skin)
{
    if (skin->moves)
        scene_give_back(gltf->scene, skin->joint_count * sizeof *skin->moves);
    free(skin->moves);
}

/* --- vertices ------------------------------------------------------------------------------- */

/* Reads four numbers for each vertex; *out stays NULL where the primitive has no such attribute. */
static bool read_attribute(const struct gltf *gltf, const struct gltf_primitive *primitive,
                           const char *name, bool whole, float **out)
{
    const struct gltf_place *at = &primitive->at;
    struct gltf_accessor accessor;
    uint32_t index, count;
    if (!gltf_index(gltf, primitive->attributes, at, name, gltf_count(gltf, "accessors"), &index))
        return false;
    if (index == SCENE_NONE)
        return true;
    if (!gltf_accessor(gltf, index, &accessor))
        return false;
    if (whole ? !gltf_is_whole(&accessor) || accessor.normalized
              : !gltf_is_whole(&accessor) && accessor.component != GLTF_FLOAT)
        return gltf_fail(gltf, at, "%s has components of a wrong type", name);
    if (accessor.count != primitive->vertex_count)
        return gltf_fail(gltf, at, "%s has %u elements where there are %u vertices", name,
                         accessor.count, primitive->vertex_count);
    return gltf_read_floats(gltf, index, 4, out, &count);
}

/* Sets *out to the mean of the moves of a vertex's four joints by their weights, whose sum need not
   be 1. A vertex without weights follows the first joint. */
static bool blend(const struct gltf *gltf, const struct gltf_place *at,
                  const struct gltf_skin *skin, const float *joints, const float *weights,
                  struct affine *out)
{
    double sum = 0;
    *out = (struct affine){0};
    for (int i = 0; i < 4; i++) {
        if (weights[i] == 0)
            continue;
        if (!(joints[i] < (float)skin->joint_count))
            return gltf_fail(gltf, at, "a vertex has joint %.0f, the skin has %u",
                             (double)joints[i], skin->joint_count);
        for (int k = 0; k < 12; k++)
            out->m[k] += (double)weights[i] * skin->moves[(uint32_t)joints[i]].m[k];
        sum += (double)weights[i];
    }
    for (int k = 0; k < 12; k++)
        out->m[k] = sum == 0 ? skin->moves[0].m[k] : out->m[k] / sum;
    return true;
}

/* `normal`: or NULL. A normal is moved by the inverse, transposed. */
static void move(const struct affine *map, float *position, float *normal)
{
    double from[3] = {(double)position[0], (double)position[1], (double)position[2]}, to[3];
    struct affine inverse = affine_identity();
    affine_point(map, from, to);
    affine_invert(map, &inverse);
    for (int i = 0; i < 3; i++) {
        position[i] = (float)to[i];
        from[i] = normal ? (double)normal[i] : 0;
    }
    for (int i = 0; normal && i < 3; i++)
        normal[i] = (float)(inverse.m[i] * from[0] + inverse.m[4 + i] * from[1] +
                            inverse.m[8 + i] * from[2]);
}

static void note_unread(const struct gltf *gltf, const struct gltf_primitive *primitive,
                        bool packed)
{
    if (packed || json_object_get(primitive->attributes, "JOINTS_1"))
        scene_note(gltf->scene, SCENE_NOTE_WARNING, "%s: %s: %s", path_name(gltf->request->path),
                   primitive->at.text,
                   packed ? "joints packed by Draco are not read, it is drawn in the bind pose"
                          : "only the first four joints of a vertex move it");
}

bool gltf_skin_apply(const struct gltf *gltf, const struct gltf_skin *skin,
                     const struct gltf_primitive *primitive, struct part *part)
{
    float *positions = part->arrays[PART_POSITIONS], *normals = part->arrays[PART_NORMALS];
    float *joints = NULL, *weights = NULL;
    bool packed =
        json_object_get(json_object_get(primitive->draco, "attributes"), "JOINTS_0") != NULL;
    note_unread(gltf, primitive, packed);
    bool good = packed || (read_attribute(gltf, primitive, "JOINTS_0", true, &joints) &&
                           read_attribute(gltf, primitive, "WEIGHTS_0", false, &weights));
    if (good && !joints != !weights)
        good = gltf_fail(gltf, &primitive->at, "has only one of JOINTS_0 and WEIGHTS_0");
    for (size_t i = 0; good && joints && i < part->vertex_count; i++) {
        struct affine map;
        good = blend(gltf, &primitive->at, skin, joints + 4 * i, weights + 4 * i, &map);
        if (good)
            move(&map, positions + 3 * i, normals ? normals + 3 * i : NULL);
    }
    free(joints);
    free(weights);
    return good;
}
