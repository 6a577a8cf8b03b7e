/* Hashes of a scene and of single records: over everything that a picture depends on, without names
   and notes. */
#include "base/hash.h"
#include "scene/hash.h"

struct hash {
    uint64_t value;
};

static void hash_add(struct hash *hash, const void *data, size_t size_bytes)
{
    hash->value = hash_bytes(hash->value, data, size_bytes);
}

#define HASH_FIELD(hash, field) hash_add((hash), &(field), sizeof(field))
#define HASH_ARRAY(hash, array, count)                                                             \
    hash_add((hash), (array), (array) ? (size_t)(count) * sizeof *(array) : 0)

static void hash_mesh(struct hash *hash, const struct scene_mesh *m)
{
    HASH_ARRAY(hash, m->positions, 3 * (size_t)m->vertex_count);
    HASH_ARRAY(hash, m->normals, 3 * (size_t)m->vertex_count);
    HASH_ARRAY(hash, m->uvs[0], 2 * (size_t)m->vertex_count);
    HASH_ARRAY(hash, m->uvs[1], 2 * (size_t)m->vertex_count);
    HASH_ARRAY(hash, m->colors, 4 * (size_t)m->vertex_count);
    HASH_ARRAY(hash, m->tangents, 4 * (size_t)m->vertex_count);
    HASH_ARRAY(hash, m->indices, 3 * (size_t)m->triangle_count);
    HASH_ARRAY(hash, m->spheres, 4 * (size_t)m->sphere_count);
    HASH_ARRAY(hash, m->materials, scene_mesh_primitives(m));
}

/* Hashes field by field, since padding and names must not count. */
static void hash_material(struct hash *hash, const struct scene_material *m)
{
    /* Both flags in one word: scenes without one-sided materials keep the hash that recipes in
       older pictures name. */
    const uint32_t sides = (uint32_t)m->two_sided | (uint32_t)m->one_sided << 1;
    const uint32_t flags[] = {
        (uint32_t)m->model, (uint32_t)m->illum, m->fresnel, m->thin_walled, sides,
        m->shadow_catcher,  (uint32_t)m->alpha};
    const float values[] = {m->shininess,      m->ior,     m->metallic,     m->roughness,
                            m->specular_level, m->opacity, m->alpha_cutoff, m->normal_scale};
    HASH_FIELD(hash, flags);
    HASH_FIELD(hash, values);
    HASH_FIELD(hash, m->ambient);
    HASH_FIELD(hash, m->priority);
    HASH_FIELD(hash, m->diffuse);
    HASH_FIELD(hash, m->specular);
    HASH_FIELD(hash, m->emission);
    HASH_FIELD(hash, m->reflection);
    HASH_FIELD(hash, m->transmission);
    HASH_FIELD(hash, m->absorption);
    for (int i = 0; i < SCENE_SLOT_COUNT; ++i) {
        const struct scene_texture_use *use = &m->textures[i];
        const uint32_t words[] = {use->texture, use->uv_set, (uint32_t)use->wrap_u,
                                  (uint32_t)use->wrap_v, use->nearest};
        HASH_FIELD(hash, words);
        HASH_FIELD(hash, use->transform);
    }
}

static void hash_node(struct hash *hash, const struct scene_node *n)
{
    const uint32_t words[] = {n->parent, n->has_matrix};
    HASH_FIELD(hash, words);
    HASH_FIELD(hash, n->matrix);
    HASH_FIELD(hash, n->translation);
    HASH_FIELD(hash, n->rotation);
    HASH_FIELD(hash, n->scale);
}

static void hash_instance(struct hash *hash, const struct scene_instance *instance)
{
    const uint32_t words[] = {instance->mesh, instance->node, instance->has_local};
    HASH_FIELD(hash, words);
    if (instance->has_local)
        HASH_FIELD(hash, instance->local);
}

static void hash_channel(struct hash *hash, const struct scene_channel *c)
{
    const uint32_t words[] = {c->node, (uint32_t)c->path, (uint32_t)c->interpolation, c->key_count};
    HASH_FIELD(hash, words);
    HASH_ARRAY(hash, c->times_s, c->key_count);
    HASH_ARRAY(hash, c->values, (size_t)c->key_count * scene_channel_width(c));
}

/* Only spots have cones, as 1 - cosine. Other lights are hashed with the cosines that they had in
   earlier versions (0 where a format states no cones), so that goldens of that time still fit. */
static void hash_light(struct hash *hash, const struct scene_light *l)
{
    const uint32_t words[] = {(uint32_t)l->kind, l->node, l->falloff, l->two_sided};
    float cones[2] = {l->versine_inner, l->versine_outer};
    for (int i = 0; i < 2 && l->kind != WHIT_LIGHT_SPOT && l->versine_outer > 0.0f; ++i)
        cones[i] = 1.0f - cones[i];
    const float values[] = {l->range, cones[0], cones[1]};
    HASH_FIELD(hash, words);
    HASH_FIELD(hash, values);
    HASH_FIELD(hash, l->position);
    HASH_FIELD(hash, l->direction);
    HASH_FIELD(hash, l->color);
    if (scene_light_is_flat(l)) {
        HASH_FIELD(hash, l->edge_u);
        HASH_FIELD(hash, l->edge_v);
    }
}

static void hash_camera(struct hash *hash, const struct scene_camera *c)
{
    const uint32_t words[] = {(uint32_t)c->kind, c->node};
    const float values[] = {c->fov_y, c->height, c->aspect, c->lens_radius, c->focus_distance};
    HASH_FIELD(hash, words);
    HASH_FIELD(hash, values);
    HASH_FIELD(hash, c->eye);
    HASH_FIELD(hash, c->target);
    HASH_FIELD(hash, c->up);
}

static void hash_environment(struct hash *hash, const struct scene_environment *sky)
{
    const uint32_t words[] = {(uint32_t)sky->kind, sky->width, sky->height};
    HASH_FIELD(hash, words);
    HASH_FIELD(hash, sky->zenith);
    HASH_FIELD(hash, sky->horizon);
    HASH_FIELD(hash, sky->ground);
    HASH_FIELD(hash, sky->scale);
    HASH_ARRAY(hash, sky->rgb, (size_t)sky->width * sky->height * 3);
}

static void hash_texture(struct hash *hash, const struct scene_texture *t)
{
    const uint32_t size[] = {t->width, t->height};
    HASH_FIELD(hash, size);
    HASH_ARRAY(hash, t->rgba, (size_t)t->width * t->height * 4);
}

static void hash_objects(struct hash *hash, const struct scene *scene)
{
    for (uint32_t i = 0; i < scene->node_count; ++i)
        hash_node(hash, &scene->nodes[i]);
    for (uint32_t i = 0; i < scene->instance_count; ++i)
        hash_instance(hash, &scene->instances[i]);
}

uint64_t freeze_hash_objects(const struct scene *scene)
{
    struct hash hash = {HASH_START};
    hash_objects(&hash, scene);
    return hash.value;
}

uint64_t freeze_hash_record(enum whit_part_kind kind, const void *record)
{
    struct hash hash = {HASH_START};
    switch (kind) {
    case WHIT_PART_MESH:
        hash_mesh(&hash, record);
        break;
    case WHIT_PART_MATERIAL:
        hash_material(&hash, record);
        break;
    case WHIT_PART_TEXTURE:
        hash_texture(&hash, record);
        break;
    case WHIT_PART_LIGHT:
        hash_light(&hash, record);
        break;
    case WHIT_PART_CAMERA:
        hash_camera(&hash, record);
        break;
    case WHIT_PART_ANIMATION:
        hash_channel(&hash, record);
        break;
    case WHIT_PART_ENVIRONMENT:
        hash_environment(&hash, record);
        break;
    case WHIT_PART_OBJECTS:
    case WHIT_PART_KINDS:
        break;
    }
    return hash.value;
}

uint64_t freeze_hash(const struct scene *scene)
{
    struct hash hash = {HASH_START};
    for (uint32_t i = 0; i < scene->mesh_count; ++i)
        hash_mesh(&hash, &scene->meshes[i]);
    hash_objects(&hash, scene);
    for (uint32_t i = 0; i < scene->material_count; ++i)
        hash_material(&hash, &scene->materials[i]);
    for (uint32_t i = 0; i < scene->texture_count; ++i)
        hash_texture(&hash, &scene->textures[i]);
    for (uint32_t i = 0; i < scene->light_count; ++i)
        hash_light(&hash, &scene->lights[i]);
    for (uint32_t i = 0; i < scene->camera_count; ++i)
        hash_camera(&hash, &scene->cameras[i]);
    for (uint32_t i = 0; i < scene->channel_count; ++i)
        hash_channel(&hash, &scene->channels[i]);
    hash_environment(&hash, &scene->environment);
    HASH_FIELD(&hash, scene->ambient);
    HASH_FIELD(&hash, scene->contact);
    return hash.value;
}
