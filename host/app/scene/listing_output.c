#include "app/document.h"
#include "app/scene/listing.h"

static void put_mesh(json_t *object, const whit_scene *scene, uint32_t index)
{
    whit_mesh_info mesh;
    whit_scene_get_mesh(scene, index, &mesh);
    document_text(object, "name", mesh.name);
    document_count(object, "vertices", mesh.vertex_count);
    document_count(object, "triangles", mesh.triangle_count);
    document_count(object, "spheres", mesh.sphere_count);
    document_count(object, "groups", mesh.group_count);
    document_flag(object, "normals", mesh.has_normals);
    document_flag(object, "uvs", mesh.has_uvs);
    document_flag(object, "colors", mesh.has_colors);
}

static void put_instance(json_t *object, const whit_scene *scene, uint32_t index)
{
    whit_instance_info instance;
    whit_scene_get_instance(scene, index, &instance);
    document_text(object, "name", instance.name);
    document_count(object, "mesh", instance.mesh);
    document_numbers(object, "object_to_world", instance.object_to_world, 12);
}

static void put_material(json_t *object, const whit_scene *scene, uint32_t index)
{
    whit_material_info material;
    whit_scene_get_material(scene, index, &material);
    document_text(object, "name", material.name);
    document_text(object, "file", material.file);
    document_count(object, "line", material.line);
    document_text(object, "model", whit_material_model_name(material.model));
    if (material.illum >= 0)
        document_count(object, "illum", (uint64_t)material.illum);
    else
        document_put(object, "illum", json_null());
    document_floats(object, "diffuse", material.diffuse, 3);
    document_floats(object, "specular", material.specular, 3);
    document_floats(object, "emission", material.emission, 3);
    document_floats(object, "reflection", material.reflection, 3);
    document_floats(object, "transmission", material.transmission, 3);
    document_float(object, "shininess", material.shininess);
    document_float(object, "ior", material.ior);
    document_float(object, "opacity", material.opacity);
    document_float(object, "metallic", material.metallic);
    document_float(object, "roughness", material.roughness);
    document_count(object, "textures", material.texture_count);
}

static void put_light(json_t *object, const whit_scene *scene, uint32_t index)
{
    whit_light_info light;
    whit_scene_get_light(scene, index, &light);
    document_text(object, "name", light.name);
    document_text(object, "kind", whit_light_kind_name(light.kind));
    document_numbers(object, "position", light.position, 3);
    document_numbers(object, "direction", light.direction, 3);
    document_floats(object, "color", light.color, 3);
    document_flag(object, "made_by_whit", light.made_by_whit);
}

static void put_camera(json_t *object, const whit_scene *scene, uint32_t index)
{
    whit_camera_info camera;
    whit_scene_get_camera(scene, index, &camera);
    document_text(object, "name", camera.name);
    document_text(object, "kind", whit_camera_kind_name(camera.kind));
    document_numbers(object, "eye", camera.eye, 3);
    document_numbers(object, "target", camera.target, 3);
    document_numbers(object, "up", camera.up, 3);
    document_number(object, "fov_y_degrees", camera.fov_y_degrees);
    document_number(object, "height", camera.height);
    document_number(object, "lens", camera.lens_radius);
    document_number(object, "focus", camera.focus_distance);
    document_flag(object, "made_by_whit", camera.made_by_whit);
}

static void put_effect(json_t *object, const whit_scene *scene, uint32_t index)
{
    whit_effect_info effect;
    whit_scene_get_effect(scene, index, &effect);
    document_text(object, "name", effect.name);
    document_flag(object, "called", effect.called);
    document_text(object, "reason", effect.reason);
}

static void put_note(json_t *object, const whit_scene *scene, uint32_t index)
{
    whit_note_info note;
    whit_scene_get_note(scene, index, &note);
    document_text(object, "level", note.warning ? "warning" : "info");
    document_text(object, "text", note.text);
}

static void put_list(json_t *root, const char *key, const whit_scene *scene, uint32_t count,
                     void (*put)(json_t *object, const whit_scene *scene, uint32_t index))
{
    json_t *list = document_list(root, key);
    for (uint32_t i = 0; i < count; ++i)
        put(document_entry(list), scene, i);
}

static json_t *bounds_document(const whit_scene_info *info)
{
    if (info->lo[0] > info->hi[0])
        return json_null();
    json_t *bounds = document_object();
    document_numbers(bounds, "lo", info->lo, 3);
    document_numbers(bounds, "hi", info->hi, 3);
    return bounds;
}

int listing_print_json(const struct job *job, const whit_scene_info *info)
{
    json_t *root = document_root();
    document_text(root, "file", job->settings.scene);
    document_hash(root, "hash", info->hash);
    document_count(root, "file_bytes", info->file_bytes);
    document_count(root, "triangles", info->triangle_count);
    document_count(root, "spheres", info->sphere_count);
    document_count(root, "mesh_triangles", info->mesh_triangle_count);
    document_count(root, "nodes", info->node_count);
    document_count(root, "textures", info->texture_count);
    document_count(root, "channels", info->channel_count);
    document_number(root, "time_begin_s", info->time_begin_s);
    document_number(root, "time_end_s", info->time_end_s);
    document_flag(root, "one_tree", info->one_tree);
    document_put(root, "bounds", bounds_document(info));
    json_t *environment = document_child(root, "environment");
    document_text(environment, "kind", whit_environment_kind_name(info->environment));
    document_flag(environment, "made_by_whit", info->environment_made_by_whit);
    put_list(root, "meshes", job->scene, info->mesh_count, put_mesh);
    put_list(root, "instances", job->scene, info->instance_count, put_instance);
    put_list(root, "materials", job->scene, info->material_count, put_material);
    put_list(root, "lights", job->scene, info->light_count, put_light);
    put_list(root, "cameras", job->scene, info->camera_count, put_camera);
    put_list(root, "effects", job->scene, info->effect_count, put_effect);
    put_list(root, "notes", job->scene, info->note_count, put_note);
    return cli_print_json(root);
}
