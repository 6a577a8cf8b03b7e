/* The node tree of a glTF, with its meshes, cameras and lights. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/file.h"
#include "base/same.h"
#include "load/gltf_accessor.h"
#include "load/gltf_json.h"
#include "load/gltf_nodes.h"
#include "scene/afford.h"

/* --- which nodes are drawn ------------------------------------------------------------------ */

static bool find_parents(struct gltf *gltf)
{
    for (uint32_t i = 0; i < gltf->node_count; i++) {
        struct gltf_place at;
        json_t *node, *children, *child;
        size_t k;
        if (!gltf_item(gltf, "nodes", i, &at, &node) ||
            !gltf_array(gltf, node, &at, "children", &children))
            return false;
        json_array_foreach(children, k, child)
        {
            struct gltf_place place = gltf_place("nodes[%u].children[%zu]", i, k);
            uint32_t index;
            if (!gltf_index_value(gltf, child, &place, gltf->node_count, &index))
                return false;
            if (gltf->parents[index] != SCENE_NONE)
                return gltf_fail(gltf, &place, "node %u is already a child of node %u", index,
                                 gltf->parents[index]);
            gltf->parents[index] = i;
        }
    }
    return true;
}

static void add_drawn(struct gltf *gltf, uint32_t node)
{
    gltf->order[gltf->order_count++] = node;
}

/* Appends to order[] all nodes below those in it. Each node has at most one parent, so none comes
   twice. */
static void add_descendants(struct gltf *gltf)
{
    for (uint32_t i = 0; i < gltf->order_count; i++) {
        const json_t *node = json_array_get(json_object_get(gltf->root, "nodes"), gltf->order[i]);
        json_t *child;
        size_t k;
        json_array_foreach(json_object_get(node, "children"), k, child)
        {
            add_drawn(gltf, (uint32_t)json_number_value(child));
        }
    }
}

static bool check_loops(const struct gltf *gltf)
{
    /* Each node has at most one parent, so following parents ends at a root or runs into a loop. */
    uint8_t *done = array_alloc_zeroed(gltf->node_count, 1);
    uint32_t looping = SCENE_NONE;
    for (uint32_t i = 0; done && i < gltf->node_count && looping == SCENE_NONE; i++) {
        uint32_t at = i;
        for (; at != SCENE_NONE && done[at] == 0; at = gltf->parents[at])
            done[at] = 1;
        if (at != SCENE_NONE && done[at] == 1)
            looping = at;
        for (at = i; at != SCENE_NONE && done[at] == 1 && looping == SCENE_NONE;
             at = gltf->parents[at])
            done[at] = 2;
    }
    free(done);
    struct gltf_place place = gltf_place("nodes[%u]", looping);
    return looping == SCENE_NONE || gltf_fail(gltf, &place, "is its own ancestor");
}

/* The nodes of the default scene; without scenes, all roots. */
static bool find_roots(struct gltf *gltf)
{
    uint32_t scene_count = gltf_count(gltf, "scenes"), index = 0;
    struct gltf_place at = gltf_place("glTF");
    json_t *scene, *roots, *root;
    size_t i;
    if (scene_count == 0) {
        for (uint32_t n = 0; n < gltf->node_count; n++)
            if (gltf->parents[n] == SCENE_NONE)
                add_drawn(gltf, n);
        return true;
    }
    if (!gltf_index(gltf, gltf->root, &at, "scene", scene_count, &index))
        return false;
    if (!gltf_item(gltf, "scenes", index == SCENE_NONE ? 0 : index, &at, &scene) ||
        !gltf_array(gltf, scene, &at, "nodes", &roots))
        return false;
    json_array_foreach(roots, i, root)
    {
        struct gltf_place place = gltf_place("%.60s.nodes[%zu]", at.text, i);
        uint32_t node;
        if (!gltf_index_value(gltf, root, &place, gltf->node_count, &node))
            return false;
        if (gltf->parents[node] != SCENE_NONE)
            return gltf_fail(gltf, &place, "node %u is not a root, or is named twice", node);
        /* In this loop a node that is its own parent has been listed as a root already. */
        gltf->parents[node] = node;
        add_drawn(gltf, node);
    }
    for (uint32_t k = 0; k < gltf->order_count; k++)
        gltf->parents[gltf->order[k]] = SCENE_NONE;
    return true;
}

bool gltf_node_mesh(const struct gltf *gltf, uint32_t node, uint32_t *mesh, uint32_t *skin)
{
    struct gltf_place at;
    json_t *object;
    return gltf_item(gltf, "nodes", node, &at, &object) &&
           gltf_index(gltf, object, &at, "mesh", gltf->mesh_count, mesh) &&
           gltf_index(gltf, object, &at, "skin", gltf_count(gltf, "skins"), skin);
}

whit_result gltf_plan_nodes(struct gltf *gltf)
{
    if (!find_parents(gltf) || !check_loops(gltf) || !find_roots(gltf))
        return WHIT_ERROR_INPUT;
    add_descendants(gltf);
    for (uint32_t i = 0; i < gltf->order_count; i++) {
        uint32_t mesh, skin;
        if (!gltf_node_mesh(gltf, gltf->order[i], &mesh, &skin))
            return WHIT_ERROR_INPUT;
        if (mesh != SCENE_NONE && skin == SCENE_NONE)
            gltf->mesh_used[mesh] = true;
    }
    return WHIT_OK;
}

/* --- instances ------------------------------------------------------------------------------ */

static whit_result add_instance(struct gltf *gltf, const char *name, uint32_t mesh, uint32_t node,
                                const struct affine *local)
{
    struct scene_instance instance = {.name = string_copy(name),
                                      .mesh = mesh,
                                      .node = node,
                                      .has_local = local != NULL,
                                      .local = local ? *local : affine_identity()};
    if (!instance.name)
        return WHIT_ERROR_MEMORY;
    return scene_add_instance(gltf->scene, instance) == SCENE_NONE ? WHIT_ERROR_MEMORY : WHIT_OK;
}

struct instancing {
    float *translations, *rotations, *scales;
    uint32_t count;
};

static bool read_instancing(const struct gltf *gltf, const json_t *extension,
                            const struct gltf_place *at, struct instancing *out)
{
    struct {
        const char *name;
        uint32_t components;
        float **values;
    } const wanted[] = {{"TRANSLATION", 3, &out->translations},
                        {"ROTATION", 4, &out->rotations},
                        {"SCALE", 3, &out->scales}};
    json_t *attributes;
    if (!gltf_object(gltf, extension, at, "attributes", &attributes))
        return false;
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++) {
        uint32_t index, count;
        if (!gltf_index(gltf, attributes, at, wanted[i].name, gltf_count(gltf, "accessors"),
                        &index))
            return false;
        if (index == SCENE_NONE)
            continue;
        if (!gltf_read_floats(gltf, index, wanted[i].components, wanted[i].values, &count))
            return false;
        if (out->count && out->count != count)
            return gltf_fail(gltf, at, "its instancing attributes differ in length");
        out->count = count;
    }
    return out->count || gltf_fail(gltf, at, "its instancing has no attributes");
}

static void widen(const float *from, uint32_t index, uint32_t components, double *to)
{
    for (uint32_t i = 0; from && i < components; i++)
        to[i] = (double)from[(size_t)index * components + i];
}

static whit_result add_instances(struct gltf *gltf, const json_t *extension,
                                 const struct gltf_place *at, const char *name, uint32_t mesh,
                                 uint32_t node)
{
    struct instancing set = {0};
    whit_result result = read_instancing(gltf, extension, at, &set) ? WHIT_OK : WHIT_ERROR_INPUT;
    if (result == WHIT_OK &&
        !scene_afford(gltf->scene,
                      scene_instance_cost(set.count) + (uint64_t)set.count * strlen(name),
                      "%s of %u instances", at->text, set.count))
        result = WHIT_ERROR_INPUT;
    for (uint32_t i = 0; i < set.count && result == WHIT_OK; i++) {
        double translation[3] = {0, 0, 0}, rotation[4] = {0, 0, 0, 1}, scale[3] = {1, 1, 1};
        widen(set.translations, i, 3, translation);
        widen(set.rotations, i, 4, rotation);
        widen(set.scales, i, 3, scale);
        struct affine local = affine_from_trs(translation, rotation, scale);
        result = add_instance(gltf, name, mesh, node, &local);
    }
    free(set.translations);
    free(set.rotations);
    free(set.scales);
    return result;
}

/* glTF ignores the transform of a node with a skin: the joints have placed its mesh. */
static whit_result add_mesh(struct gltf *gltf, const json_t *object, const struct gltf_place *at,
                            const char *name, uint32_t index)
{
    uint32_t mesh, node = gltf->nodes[index], skinned = gltf->skinned[index];
    json_t *instancing;
    if (skinned != SCENE_NONE)
        return add_instance(gltf, name, skinned, gltf->request->parent, NULL);
    if (!gltf_index(gltf, object, at, "mesh", gltf->mesh_count, &mesh) ||
        !gltf_extension(gltf, object, at, "EXT_mesh_gpu_instancing", &instancing))
        return WHIT_ERROR_INPUT;
    if (mesh == SCENE_NONE || gltf->meshes[mesh] == SCENE_NONE)
        return WHIT_OK;
    if (instancing)
        return add_instances(gltf, instancing, at, name, gltf->meshes[mesh], node);
    return add_instance(gltf, name, gltf->meshes[mesh], node, NULL);
}

/* --- cameras -------------------------------------------------------------------------------- */

static bool read_lens(const struct gltf *gltf, const json_t *object, const struct gltf_place *at,
                      struct scene_camera *out)
{
    json_t *lens;
    const char *type;
    double yfov = 0, aspect = 0, xmag = 0, ymag = 0;
    if (!gltf_string(gltf, object, at, "type", &type))
        return false;
    bool perspective = type && strcmp(type, "perspective") == 0;
    if (!perspective && (!type || strcmp(type, "orthographic") != 0))
        return gltf_fail(gltf, at, "its type is neither perspective nor orthographic");
    if (!gltf_object(gltf, object, at, type, &lens) ||
        !gltf_number(gltf, lens, at, "yfov", &yfov) ||
        !gltf_number(gltf, lens, at, "aspectRatio", &aspect) ||
        !gltf_number(gltf, lens, at, "xmag", &xmag) || !gltf_number(gltf, lens, at, "ymag", &ymag))
        return false;
    if (perspective && !(yfov > 0 && yfov < same_acos(-1.0)))
        return gltf_fail(gltf, at, "yfov should be between 0 and pi and is %g", yfov);
    if (!perspective && !(fabs(xmag) > 0 && fabs(ymag) > 0))
        return gltf_fail(gltf, at, "xmag and ymag should not be 0");
    out->kind = perspective ? WHIT_CAMERA_PERSPECTIVE : WHIT_CAMERA_ORTHOGRAPHIC;
    out->fov_y = (float)yfov;
    out->height = (float)(2 * fabs(ymag));
    out->aspect = (float)(perspective ? fmax(aspect, 0) : fabs(xmag / ymag));
    return true;
}

static whit_result add_camera(struct gltf *gltf, const json_t *node, const struct gltf_place *at,
                              const char *node_name, uint32_t scene_node)
{
    struct gltf_place place;
    json_t *object;
    const char *name;
    uint32_t index;
    if (!gltf_index(gltf, node, at, "camera", gltf_count(gltf, "cameras"), &index))
        return WHIT_ERROR_INPUT;
    if (index == SCENE_NONE || !gltf->request->with_cameras)
        return WHIT_OK;
    struct scene_camera camera = {
        .node = scene_node, .target = {0, 0, -1}, .up = {0, 1, 0}, .target_is_direction = true};
    if (!gltf_item(gltf, "cameras", index, &place, &object) ||
        !gltf_string(gltf, object, &place, "name", &name) ||
        !read_lens(gltf, object, &place, &camera))
        return WHIT_ERROR_INPUT;
    camera.name = string_copy(name && *name ? name : node_name);
    if (!camera.name)
        return WHIT_ERROR_MEMORY;
    return scene_add_camera(gltf->scene, camera) == SCENE_NONE ? WHIT_ERROR_MEMORY : WHIT_OK;
}

/* --- lights --------------------------------------------------------------------------------- */

static bool read_spot(const struct gltf *gltf, const json_t *object, const struct gltf_place *at,
                      struct scene_light *out)
{
    json_t *spot;
    double quarter = same_atan2(1.0, 1.0), inner = 0, outer = quarter;
    if (!gltf_object(gltf, object, at, "spot", &spot) ||
        !gltf_number(gltf, spot, at, "innerConeAngle", &inner) ||
        !gltf_number(gltf, spot, at, "outerConeAngle", &outer))
        return false;
    /* Equal angles make a hard edge. glTF does not allow them, but exporters write them. */
    if (!(inner >= 0 && inner <= outer && outer <= 2 * quarter + 1e-6)) {
        scene_note(gltf->scene, SCENE_NOTE_WARNING,
                   "%s: %s: its cone angles %g and %g are cut to 0 <= inner <= outer <= pi/2",
                   path_name(gltf->request->path), at->text, inner, outer);
        outer = fmin(fmax(outer, 0), 2 * quarter);
        inner = fmin(fmax(inner, 0), outer);
    }
    scene_light_cones(out, inner, outer);
    return true;
}

/* Photometric values (candela, lux) are taken as radiometric ones, divided by pi: glTF's diffuse
   surfaces reflect albedo / pi of the irradiance, whit's reflect albedo of it. */
static bool read_light(const struct gltf *gltf, const json_t *object, const struct gltf_place *at,
                       struct scene_light *out)
{
    const char *type;
    double color[3] = {1, 1, 1}, intensity = 1, range = 0;
    if (!gltf_string(gltf, object, at, "type", &type) ||
        !gltf_numbers(gltf, object, at, "color", 3, color) ||
        !gltf_number(gltf, object, at, "intensity", &intensity) ||
        !gltf_number(gltf, object, at, "range", &range))
        return false;
    for (int i = 0; i < 3; i++)
        out->color[i] = (float)(color[i] * intensity / same_acos(-1.0));
    out->range = (float)fmax(range, 0);
    out->falloff = true;
    if (type && strcmp(type, "directional") == 0) {
        out->kind = WHIT_LIGHT_DIRECTIONAL;
        out->falloff = false;
        out->range = 0;
        return true;
    }
    if (type && strcmp(type, "point") == 0) {
        out->kind = WHIT_LIGHT_POINT;
        return true;
    }
    if (!type || strcmp(type, "spot") != 0)
        return gltf_fail(gltf, at, "its type is not directional, point or spot");
    out->kind = WHIT_LIGHT_SPOT;
    return read_spot(gltf, object, at, out);
}

static whit_result add_light(struct gltf *gltf, const json_t *node, const struct gltf_place *at,
                             const char *node_name, uint32_t scene_node)
{
    const char *extension = "KHR_lights_punctual", *name;
    struct gltf_place file = gltf_place("glTF");
    json_t *reference, *all, *lights = NULL;
    uint32_t index;
    if (!gltf_extension(gltf, node, at, extension, &reference) || !reference)
        return reference ? WHIT_ERROR_INPUT : WHIT_OK;
    if (!gltf_extension(gltf, gltf->root, &file, extension, &all) ||
        !gltf_array(gltf, all, &file, "lights", &lights) ||
        !gltf_index(gltf, reference, at, "light", (uint32_t)json_array_size(lights), &index))
        return WHIT_ERROR_INPUT;
    if (index == SCENE_NONE || !gltf->request->with_lights)
        return WHIT_OK;
    struct gltf_place place = gltf_place("lights[%u]", index);
    struct scene_light light = {.node = scene_node, .direction = {0, 0, -1}};
    const json_t *object = json_array_get(lights, index);
    if (!json_is_object(object)) {
        gltf_fail(gltf, &place, "should be an object");
        return WHIT_ERROR_INPUT;
    }
    if (!gltf_string(gltf, object, &place, "name", &name) ||
        !read_light(gltf, object, &place, &light))
        return WHIT_ERROR_INPUT;
    light.name = scene_text(gltf->scene, name && *name ? name : node_name);
    light.origin.file = scene_text(gltf->scene, gltf->request->path);
    return scene_add_light(gltf->scene, light) == SCENE_NONE ? WHIT_ERROR_MEMORY : WHIT_OK;
}

/* --- nodes ---------------------------------------------------------------------------------- */

static bool read_transform(const struct gltf *gltf, const json_t *object,
                           const struct gltf_place *at, struct scene_node *out)
{
    double columns[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    out->has_matrix = json_object_get(object, "matrix") != NULL;
    if (!gltf_numbers(gltf, object, at, "matrix", 16, columns) ||
        !gltf_numbers(gltf, object, at, "translation", 3, out->translation) ||
        !gltf_numbers(gltf, object, at, "rotation", 4, out->rotation) ||
        !gltf_numbers(gltf, object, at, "scale", 3, out->scale))
        return false;
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 4; column++)
            out->matrix.m[4 * row + column] = columns[4 * column + row];
    return true;
}

/* Adds a node without what hangs on it; `at`: its place, which names it where the file does not. */
static whit_result place_node(struct gltf *gltf, uint32_t index, const json_t *object,
                              const struct gltf_place *at, const char *name)
{
    uint32_t parent = gltf->parents[index];
    struct scene_node node;
    scene_node_init(&node, name,
                    parent == SCENE_NONE ? gltf->request->parent : gltf->nodes[parent]);
    if (!node.name || !read_transform(gltf, object, at, &node)) {
        whit_result result = node.name ? WHIT_ERROR_INPUT : WHIT_ERROR_MEMORY;
        free(node.name);
        return result;
    }
    struct affine local = node.has_matrix
                              ? node.matrix
                              : affine_from_trs(node.translation, node.rotation, node.scale);
    gltf->worlds[index] =
        parent == SCENE_NONE ? local : affine_multiply(&gltf->worlds[parent], &local);
    gltf->nodes[index] = scene_add_node(gltf->scene, node);
    return gltf->nodes[index] == SCENE_NONE ? WHIT_ERROR_MEMORY : WHIT_OK;
}

static whit_result fill_node(struct gltf *gltf, uint32_t index, const json_t *object,
                             const struct gltf_place *at, const char *name)
{
    whit_result result = add_mesh(gltf, object, at, name, index);
    if (result == WHIT_OK)
        result = add_camera(gltf, object, at, name, gltf->nodes[index]);
    if (result == WHIT_OK)
        result = add_light(gltf, object, at, name, gltf->nodes[index]);
    return result;
}

static whit_result for_all(struct gltf *gltf,
                           whit_result (*step)(struct gltf *, uint32_t, const json_t *,
                                               const struct gltf_place *, const char *))
{
    whit_result result = WHIT_OK;
    for (uint32_t i = 0; i < gltf->order_count && result == WHIT_OK; i++) {
        struct gltf_place at;
        json_t *object;
        const char *name;
        if (!gltf_item(gltf, "nodes", gltf->order[i], &at, &object) ||
            !gltf_string(gltf, object, &at, "name", &name))
            return WHIT_ERROR_INPUT;
        result = step(gltf, gltf->order[i], object, &at, name && *name ? name : at.text);
    }
    return result;
}

whit_result gltf_place_nodes(struct gltf *gltf)
{
    return for_all(gltf, place_node);
}

whit_result gltf_fill_nodes(struct gltf *gltf)
{
    return for_all(gltf, fill_node);
}
