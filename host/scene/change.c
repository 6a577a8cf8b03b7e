#include "scene/change.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "base/vec.h"
#include "scene/fields.h"

/* A description names at most TOLD_MAX differences, and says how many more there are. */
enum { TOLD_MAX = 4 };

struct words {
    char *text;
    size_t bytes;
    uint32_t told, left_out;
};

#define put(words, ...) text_add((words)->text, (words)->bytes, __VA_ARGS__)

/* Begins one more difference; false where TOLD_MAX are described already. */
static bool begin(struct words *words)
{
    if (words->told == TOLD_MAX) {
        ++words->left_out;
        return false;
    }
    put(words, "%s", words->told++ ? ", " : "");
    return true;
}

/* ---- Records, field by field ---- */

static double number_of(const void *record, const struct scene_field *field, uint32_t i)
{
    const char *at = (const char *)record + field->offset;
    switch (field->form) {
    case SCENE_FLOATS:
        return (double)((const float *)(const void *)at)[i];
    case SCENE_DOUBLES:
        return ((const double *)(const void *)at)[i];
    case SCENE_WORDS:
    case SCENE_NAMED:
        return (double)((const int32_t *)(const void *)at)[i];
    case SCENE_FLAG:
        break;
    }
    return *(const bool *)at;
}

/* Writes the number rounded to 6 significant digits, or to as many more as are needed to read back
   the same number. */
static void put_number(struct words *words, const char *before, double number, bool is_float)
{
    char text[32];
    int digits = 6, most = is_float ? 9 : 17;
    do
        snprintf(text, sizeof text, "%.*g", digits, number);
    while ((is_float ? (double)strtof(text, NULL) : strtod(text, NULL)) != number &&
           ++digits <= most);
    put(words, "%s%s", before, text);
}

static void put_value(struct words *words, const void *record, const struct scene_field *field)
{
    double first = number_of(record, field, 0);
    if (field->form == SCENE_FLAG)
        put(words, "%s", first > 0.0 ? "on" : "off");
    else if (field->form == SCENE_NAMED)
        put(words, "%s", field->names[(uint32_t)first]);
    for (uint32_t i = 0; field->form < SCENE_FLAG && i < field->count; ++i)
        put_number(words, i ? " " : "", number_of(record, field, i), field->form == SCENE_FLOATS);
}

static bool same_field(const void *a, const void *b, const struct scene_field *field)
{
    static const size_t sizes[] = {sizeof(float), sizeof(double), sizeof(int32_t), sizeof(bool),
                                   sizeof(int32_t)};
    return memcmp((const char *)a + field->offset, (const char *)b + field->offset,
                  sizes[field->form] * field->count) == 0;
}

static void compare_fields(struct words *words, const void *a, const void *b,
                           const struct scene_field *field)
{
    for (; field->name; ++field) {
        if (same_field(a, b, field) || !begin(words))
            continue;
        put(words, "%s from ", field->name);
        put_value(words, a, field);
        put(words, " to ");
        put_value(words, b, field);
    }
}

/* Compares the names of the record that a reference points to on either side; "": none. */
static void compare_names(struct words *words, const char *what, const char *a, const char *b)
{
    if (strcmp(a, b) == 0 || !begin(words))
        return;
    put(words, "%s from ", what);
    put(words, a[0] ? "\"%s\" to " : "none%s to ", a);
    put(words, b[0] ? "\"%s\"" : "none%s", b);
}

static void compare_nodes(struct words *words, const struct scene_side *before, uint32_t a,
                          const struct scene_side *after, uint32_t b)
{
    compare_names(words, "node", scene_parts_name(before->parts, SCENE_NAMES_NODE, a),
                  scene_parts_name(after->parts, SCENE_NAMES_NODE, b));
}

static const char *const slot_names[] = {
    [SCENE_SLOT_DIFFUSE] = "texture of diffuse",
    [SCENE_SLOT_SPECULAR] = "texture of specular",
    [SCENE_SLOT_EMISSION] = "texture of emission",
    [SCENE_SLOT_NORMAL] = "normal map",
    [SCENE_SLOT_BUMP] = "bump map",
    [SCENE_SLOT_METAL_ROUGH] = "texture of metal and roughness",
    [SCENE_SLOT_OPACITY] = "texture of opacity",
    [SCENE_SLOT_TRANSMISSION] = "texture of transmission",
    [SCENE_SLOT_SPECULAR_LEVEL] = "texture of specular level",
};

static void compare_materials(struct words *words, const struct scene_side *before,
                              const struct scene_material *a, const struct scene_side *after,
                              const struct scene_material *b)
{
    compare_fields(words, a, b, scene_material_fields);
    for (int i = 0; i < SCENE_SLOT_COUNT; ++i) {
        compare_names(words, slot_names[i],
                      scene_parts_name(before->parts, WHIT_PART_TEXTURE, a->textures[i].texture),
                      scene_parts_name(after->parts, WHIT_PART_TEXTURE, b->textures[i].texture));
        compare_fields(words, &a->textures[i], &b->textures[i], scene_texture_use_fields);
    }
}

/* ---- Arrays ---- */

/* The elements of an array that differ between the two sides: their number, and the indices of the
   first and the last. */
struct others {
    uint32_t count, first, last;
    double by; /* the largest distance between an element's two values */
};

/* Compares `count` elements of `width` floats; distances are of the first `space` floats alone. */
static struct others find_others(const float *a, const float *b, uint32_t count, uint32_t width,
                                 uint32_t space)
{
    struct others others = {.first = SCENE_NONE};
    for (uint32_t i = 0; a && b && i < count; ++i) {
        const float *x = a + (size_t)i * width, *y = b + (size_t)i * width;
        if (memcmp(x, y, width * sizeof *x) == 0)
            continue;
        double square = 0.0;
        for (uint32_t k = 0; k < space; ++k)
            square += ((double)y[k] - (double)x[k]) * ((double)y[k] - (double)x[k]);
        others.by = fmax(others.by, sqrt(square));
        others.first = others.count++ ? others.first : i;
        others.last = i;
    }
    return others;
}

/* Describes differences, for example as "vertices 3 and 7 moved by up to 0.1". */
static void put_others(struct words *words, const struct others *others, const char *one,
                       const char *many, const char *how)
{
    if (!others->count || !begin(words))
        return;
    if (others->count == 1)
        put(words, "%s %u %s by %.2g", one, others->first, how, others->by);
    else if (others->count == 2)
        put(words, "%s %u and %u %s by up to %.2g", many, others->first, others->last, how,
            others->by);
    else
        put(words, "%u %s (%u to %u) %s by up to %.2g", others->count, many, others->first,
            others->last, how, others->by);
}

static void compare_counts(struct words *words, uint32_t a, uint32_t b, const char *what)
{
    if (a != b && begin(words))
        put(words, "%u %s in place of %u", b, what, a);
}

/* Compares one vertex attribute; either side may lack it (NULL). */
static void compare_attribute(struct words *words, const float *a, const float *b, uint32_t count,
                              uint32_t width, const char *what)
{
    struct others others = find_others(a, b, count, width, width);
    if (!a != !b && begin(words))
        put(words, "%s %s", what, b ? "that it had not" : "gone");
    if (others.count && begin(words))
        put(words, "%s of %u %s other by up to %.2g", what, others.count,
            others.count == 1 ? "vertex" : "vertices", others.by);
}

static void compare_indices(struct words *words, const struct scene_mesh *a,
                            const struct scene_mesh *b)
{
    uint32_t count = 0;
    for (size_t i = 0; i < a->triangle_count; ++i)
        count += memcmp(a->indices + 3 * i, b->indices + 3 * i, 3 * sizeof *a->indices) != 0;
    if (count && begin(words))
        put(words, "%u %s of other vertices", count, count == 1 ? "triangle" : "triangles");
}

/* Compares the materials of primitives: describes the first primitive whose material differs. */
static void compare_worn(struct words *words, const struct scene_side *before,
                         const struct scene_mesh *a, const struct scene_side *after,
                         const struct scene_mesh *b)
{
    uint32_t count = 0;
    const char *was = "", *is = "";
    for (uint32_t i = 0; i < scene_mesh_primitives(a); ++i) {
        const char *x = scene_parts_name(before->parts, WHIT_PART_MATERIAL, a->materials[i]);
        const char *y = scene_parts_name(after->parts, WHIT_PART_MATERIAL, b->materials[i]);
        if (strcmp(x, y) != 0 && !count++)
            was = x, is = y;
    }
    if (count && begin(words))
        put(words, "%u of %u primitives of material \"%s\" in place of \"%s\"", count,
            scene_mesh_primitives(a), is, was);
}

static void compare_meshes(struct words *words, const struct scene_side *before,
                           const struct scene_mesh *a, const struct scene_side *after,
                           const struct scene_mesh *b)
{
    compare_counts(words, a->vertex_count, b->vertex_count, "vertices");
    compare_counts(words, a->triangle_count, b->triangle_count, "triangles");
    compare_counts(words, a->sphere_count, b->sphere_count, "spheres");
    if (a->vertex_count == b->vertex_count) {
        uint32_t count = a->vertex_count;
        struct others moved = find_others(a->positions, b->positions, count, 3, 3);
        put_others(words, &moved, "vertex", "vertices", "moved");
        compare_attribute(words, a->normals, b->normals, count, 3, "normals");
        compare_attribute(words, a->uvs[0], b->uvs[0], count, 2, "texture coordinates");
        compare_attribute(words, a->uvs[1], b->uvs[1], count, 2, "second texture coordinates");
        compare_attribute(words, a->colors, b->colors, count, 4, "vertex colours");
        compare_attribute(words, a->tangents, b->tangents, count, 4, "tangents");
    }
    if (a->sphere_count == b->sphere_count) {
        struct others moved = find_others(a->spheres, b->spheres, a->sphere_count, 4, 4);
        put_others(words, &moved, "sphere", "spheres", "other");
    }
    if (a->triangle_count == b->triangle_count)
        compare_indices(words, a, b);
    if (scene_mesh_primitives(a) == scene_mesh_primitives(b))
        compare_worn(words, before, a, after, b);
}

static void compare_textures(struct words *words, const struct scene_texture *a,
                             const struct scene_texture *b)
{
    uint32_t count = 0, first = 0, last = 0;
    int by = 0;
    if (a->width != b->width || a->height != b->height) {
        if (begin(words))
            put(words, "%u x %u texels in place of %u x %u", b->width, b->height, a->width,
                a->height);
        return;
    }
    size_t texels = (size_t)a->width * a->height;
    for (size_t i = 0; i < texels; ++i) {
        const uint8_t *x = a->rgba + 4 * i, *y = b->rgba + 4 * i;
        if (memcmp(x, y, 4) == 0)
            continue;
        last = (uint32_t)(i / a->width);
        first = count++ ? first : last;
        for (int k = 0; k < 4; ++k)
            by = abs(x[k] - y[k]) > by ? abs(x[k] - y[k]) : by;
    }
    if (count && begin(words))
        put(words, "%u of %zu texels other by up to %d of 255, in rows %u to %u", count, texels, by,
            first, last);
}

static void compare_channels(struct words *words, const struct scene_channel *a,
                             const struct scene_channel *b)
{
    compare_fields(words, a, b, scene_channel_fields);
    compare_counts(words, a->key_count, b->key_count, "keys");
    if (a->key_count != b->key_count || a->interpolation != b->interpolation)
        return;
    uint32_t width = scene_channel_width(a);
    struct others times = find_others(a->times_s, b->times_s, a->key_count, 1, 1);
    struct others values = find_others(a->values, b->values, a->key_count, width, width);
    put_others(words, &times, "time of key", "times of keys", "other");
    put_others(words, &values, "value of key", "values of keys", "other");
}

static void compare_environments(struct words *words, const struct scene *a, const struct scene *b)
{
    const struct scene_environment *x = &a->environment, *y = &b->environment;
    compare_fields(words, a, b, scene_own_fields);
    compare_fields(words, x, y, scene_environment_fields);
    if (x->width != y->width || x->height != y->height)
        return;
    struct others others = find_others(x->rgb, y->rgb, x->width * x->height, 3, 3);
    if (others.count && begin(words))
        put(words, "%u pixels of the map other by up to %.2g", others.count, others.by);
}

/* ---- Objects ---- */

/* Describes parts that side `has` has and side `other` lacks. */
static void compare_lists(struct words *words, const struct scene_parts *has,
                          const struct scene_parts *other, const char *how)
{
    for (uint32_t i = 0; i < has->count; ++i) {
        const struct scene_part *part = &has->items[i];
        bool listed = part->kind != WHIT_PART_MATERIAL && part->kind != WHIT_PART_TEXTURE;
        if (listed && !scene_parts_find(other, part->kind, part->name) && begin(words))
            put(words, "%s \"%s\" is %s", scene_part_kind_name(part->kind), part->name, how);
    }
}

/* Describes how a node's local transform differs. */
static void compare_node(struct words *words, const char *name, const struct scene_node *a,
                         const struct scene_node *b)
{
    struct affine x = scene_node_matrix(a), y = scene_node_matrix(b);
    double from[3] = {x.m[3], x.m[7], x.m[11]}, to[3] = {y.m[3], y.m[7], y.m[11]};
    bool turned = false;
    for (int i = 0; i < 12; ++i)
        turned = turned || (i % 4 != 3 && x.m[i] != y.m[i]);
    double by = double3_distance(from, to);
    if ((!turned && !(by > 0.0)) || !begin(words))
        return;
    put(words, "node \"%s\"", name);
    if (by > 0.0)
        put(words, " moved by %.2g%s", by, turned ? " and" : "");
    if (turned)
        put(words, " turned or scaled");
}

static void compare_instances(struct words *words, const struct scene_side *before,
                              const struct scene_side *after)
{
    const struct scene *a = before->scene, *b = after->scene;
    uint32_t count = 0;
    compare_counts(words, a->instance_count, b->instance_count, "instances");
    for (uint32_t i = 0; a->instance_count == b->instance_count && i < a->instance_count; ++i) {
        const struct scene_instance *x = &a->instances[i], *y = &b->instances[i];
        count += strcmp(scene_parts_name(before->parts, WHIT_PART_MESH, x->mesh),
                        scene_parts_name(after->parts, WHIT_PART_MESH, y->mesh)) != 0 ||
                 strcmp(scene_parts_name(before->parts, SCENE_NAMES_NODE, x->node),
                        scene_parts_name(after->parts, SCENE_NAMES_NODE, y->node)) != 0;
    }
    if (count && begin(words))
        put(words, "%u of %u objects are others or stand in another order", count,
            a->instance_count);
}

static void compare_objects(struct words *words, const struct scene_side *before,
                            const struct scene_side *after)
{
    compare_lists(words, after->parts, before->parts, "new");
    compare_lists(words, before->parts, after->parts, "gone");
    for (uint32_t i = 0; i < before->scene->node_count; ++i) {
        const char *name = scene_parts_name(before->parts, SCENE_NAMES_NODE, i);
        uint32_t k = scene_parts_index(after->parts, SCENE_NAMES_NODE, name);
        if (k != SCENE_NONE)
            compare_node(words, name, &before->scene->nodes[i], &after->scene->nodes[k]);
    }
    compare_counts(words, before->scene->node_count, after->scene->node_count, "nodes");
    compare_instances(words, before, after);
}

/* ---- All kinds ---- */

static void compare(struct words *words, const struct scene_side *before,
                    const struct scene_part *was, const struct scene_side *after,
                    const struct scene_part *is)
{
    const struct scene *a = before->scene, *b = after->scene;
    uint32_t i = was->index, k = is->index;
    switch (was->kind) {
    case WHIT_PART_MESH:
        compare_meshes(words, before, &a->meshes[i], after, &b->meshes[k]);
        break;
    case WHIT_PART_MATERIAL:
        compare_materials(words, before, &a->materials[i], after, &b->materials[k]);
        break;
    case WHIT_PART_TEXTURE:
        compare_textures(words, &a->textures[i], &b->textures[k]);
        break;
    case WHIT_PART_LIGHT:
        compare_fields(words, &a->lights[i], &b->lights[k], scene_light_fields);
        compare_nodes(words, before, a->lights[i].node, after, b->lights[k].node);
        break;
    case WHIT_PART_CAMERA:
        compare_fields(words, &a->cameras[i], &b->cameras[k], scene_camera_fields);
        compare_nodes(words, before, a->cameras[i].node, after, b->cameras[k].node);
        break;
    case WHIT_PART_ANIMATION:
        compare_channels(words, &a->channels[i], &b->channels[k]);
        break;
    case WHIT_PART_ENVIRONMENT:
        compare_environments(words, a, b);
        break;
    case WHIT_PART_OBJECTS:
    case WHIT_PART_KINDS:
        compare_objects(words, before, after);
        break;
    }
}

void scene_change_write(const struct scene_side *before, const struct scene_side *after,
                        whit_part_kind kind, const char *name, char *text, size_t bytes)
{
    const struct scene_part *was = scene_parts_find(before->parts, kind, name);
    const struct scene_part *is = scene_parts_find(after->parts, kind, name);
    struct words words = {.text = text, .bytes = bytes};
    text[0] = 0;
    if (!was || !is || was->hash == is->hash)
        return;
    compare(&words, before, was, after, is);
    if (words.left_out)
        put(&words, " and %u more", words.left_out);
}
