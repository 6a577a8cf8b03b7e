#include "app/scene/listing.h"

#include <string.h>

/* Most items of a section that are listed without --all. */
enum { ITEMS_SHOWN = 12 };

static void print_name(uint32_t index, const char *name)
{
    printf("  %4u  %-24s  ", index, name[0] ? cli_shown(name) : "(no name)");
}

static void print_mesh(const whit_scene *scene, uint32_t index)
{
    whit_mesh_info mesh;
    whit_scene_get_mesh(scene, index, &mesh);
    print_name(index, mesh.name);
    if (mesh.sphere_count)
        printf("%u sphere%s\n", mesh.sphere_count, mesh.sphere_count == 1 ? "" : "s");
    else
        printf("%u triangles, %u vertices%s%s%s\n", mesh.triangle_count, mesh.vertex_count,
               mesh.has_normals ? ", normals" : "", mesh.has_uvs ? ", uvs" : "",
               mesh.has_colors ? ", colours" : "");
}

static void print_instance(const whit_scene *scene, uint32_t index)
{
    whit_instance_info instance;
    whit_scene_get_instance(scene, index, &instance);
    const double *m = instance.object_to_world;
    print_name(index, instance.name);
    printf("mesh %u at %.6g %.6g %.6g\n", instance.mesh, m[3], m[7], m[11]);
}

static bool is_black(const float color[3])
{
    return color[0] == 0.0f && color[1] == 0.0f && color[2] == 0.0f;
}

static void print_color(const char *what, const float color[3])
{
    if (!is_black(color))
        printf(", %s %.3g %.3g %.3g", what, (double)color[0], (double)color[1], (double)color[2]);
}

static void print_material(const whit_scene *scene, uint32_t index)
{
    whit_material_info material;
    whit_scene_get_material(scene, index, &material);
    bool metal_rough = material.model == WHIT_MODEL_METAL_ROUGH;
    print_name(index, material.name);
    fputs(whit_material_model_name(material.model), stdout);
    if (material.illum >= 0)
        printf(", illum %d", material.illum);
    print_color(metal_rough ? "base" : "diffuse", material.diffuse);
    if (metal_rough)
        printf(", metallic %.3g, roughness %.3g", (double)material.metallic,
               (double)material.roughness);
    else
        print_color("specular", material.specular);
    print_color("mirror", material.reflection);
    print_color("glass", material.transmission);
    if (!is_black(material.transmission))
        printf(", ior %.4g", (double)material.ior);
    print_color("emits", material.emission);
    if (material.opacity < 1.0f)
        printf(", opacity %.3g", (double)material.opacity);
    if (material.texture_count)
        printf(", %u texture%s", material.texture_count, material.texture_count > 1 ? "s" : "");
    if (material.file)
        printf("  (%s", cli_shown(material.file));
    if (material.file)
        printf(material.line ? ":%u)" : ")", material.line);
    putchar('\n');
}

static void print_light(const whit_scene *scene, uint32_t index)
{
    whit_light_info light;
    whit_scene_get_light(scene, index, &light);
    print_name(index, light.name);
    fputs(whit_light_kind_name(light.kind), stdout);
    if (light.kind != WHIT_LIGHT_DIRECTIONAL)
        printf(" at %.6g %.6g %.6g", light.position[0], light.position[1], light.position[2]);
    if (light.kind != WHIT_LIGHT_POINT)
        printf(" towards %.3g %.3g %.3g", light.direction[0], light.direction[1],
               light.direction[2]);
    print_color("colour", light.color);
    puts(light.made_by_whit ? "  (made by whit)" : "");
}

static void print_camera(const whit_scene *scene, uint32_t index)
{
    whit_camera_info camera;
    whit_scene_get_camera(scene, index, &camera);
    print_name(index, camera.name);
    printf("%s from %.6g %.6g %.6g to %.6g %.6g %.6g", whit_camera_kind_name(camera.kind),
           camera.eye[0], camera.eye[1], camera.eye[2], camera.target[0], camera.target[1],
           camera.target[2]);
    if (camera.height > 0.0)
        printf(", height %.6g", camera.height);
    else if (camera.fov_y_degrees > 0.0)
        printf(", %.4g degrees", camera.fov_y_degrees);
    if (camera.lens_radius > 0.0)
        printf(", lens %.6g", camera.lens_radius);
    if (camera.lens_radius > 0.0 && camera.focus_distance > 0.0)
        printf(", focus %.6g", camera.focus_distance);
    puts(camera.made_by_whit ? "  (made by whit)" : "");
}

static void print_note(const whit_scene *scene, uint32_t index)
{
    whit_note_info note;
    whit_scene_get_note(scene, index, &note);
    fputs(note.warning ? "  warning  " : "  info     ", stdout);
    puts(cli_shown(note.text));
}

static void print_list(const char *title, const whit_scene *scene, uint32_t count, bool all,
                       void (*print)(const whit_scene *scene, uint32_t index))
{
    uint32_t shown = all || count <= ITEMS_SHOWN + 1 ? count : ITEMS_SHOWN;
    if (count == 0)
        return;
    printf("\n%s (%u)\n", title, count);
    for (uint32_t i = 0; i < shown; ++i)
        print(scene, i);
    if (shown < count)
        printf("  ... and %u more; --all lists them\n", count - shown);
}

static void print_effects(const whit_scene *scene, uint32_t count)
{
    printf("\neffects\n  %-20s %-7s %s\n", "effect", "called", "why");
    for (uint32_t i = 0; i < count; ++i) {
        whit_effect_info effect;
        whit_scene_get_effect(scene, i, &effect);
        printf("  %-20s %-7s %s\n", effect.name, effect.called ? "yes" : "-",
               cli_shown(effect.reason));
    }
}

static void print_count(const char *before, uint32_t count, const char *one, const char *many)
{
    printf("%s%u %s", before, count, count == 1 ? one : many);
}

static void print_summary(const struct job *job, const whit_scene_info *info)
{
    printf("%s\n", cli_shown(job->settings.scene));
    printf("  triangles    %llu (%llu in the meshes)\n", (unsigned long long)info->triangle_count,
           (unsigned long long)info->mesh_triangle_count);
    if (info->sphere_count)
        printf("  spheres      %llu\n", (unsigned long long)info->sphere_count);
    print_count("  contents     ", info->mesh_count, "mesh", "meshes");
    print_count(", ", info->instance_count, "instance", "instances");
    print_count(", ", info->node_count, "node", "nodes");
    print_count(", ", info->material_count, "material", "materials");
    print_count(", ", info->texture_count, "texture", "textures");
    putchar('\n');
    if (info->lo[0] <= info->hi[0])
        printf("  bounds       %.6g %.6g %.6g  to  %.6g %.6g %.6g\n", info->lo[0], info->lo[1],
               info->lo[2], info->hi[0], info->hi[1], info->hi[2]);
    else
        puts("  bounds       empty");
    if (info->channel_count && info->time_begin_s < 0.0)
        printf("  animation    %u channels, %.4g to %.4g s\n", info->channel_count,
               info->time_begin_s, info->time_end_s);
    else if (info->channel_count)
        printf("  animation    %u channels, to %.4g s\n", info->channel_count, info->time_end_s);
    if (info->one_tree)
        puts("  trees        one, in world space (--instances)");
    printf("  environment  %s%s\n", whit_environment_kind_name(info->environment),
           info->environment_made_by_whit ? "  (made by whit)" : "");
    printf("  files        %.1f kB, hash %016llx\n", (double)info->file_bytes * 1e-3,
           (unsigned long long)info->hash);
}

int listing_print_text(const struct job *job, const whit_scene_info *info, bool all)
{
    const whit_scene *scene = job->scene;
    print_summary(job, info);
    print_list("problems and additions", scene, info->note_count, all, print_note);
    print_list("cameras", scene, info->camera_count, all, print_camera);
    print_list("lights", scene, info->light_count, all, print_light);
    print_list("materials", scene, info->material_count, all, print_material);
    print_list("meshes", scene, info->mesh_count, all, print_mesh);
    print_list("instances", scene, info->instance_count, all, print_instance);
    print_effects(scene, info->effect_count);
    return cli_finish_stdout(EXIT_FINE);
}
