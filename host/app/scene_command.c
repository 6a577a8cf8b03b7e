#include <stdlib.h>
#include <string.h>

#include "app/commands.h"
#include "app/document.h"
#include "app/receipt.h"

enum scene_id {
    ID_JSON = JOB_ID_END,
    ID_TRIANGLES,
    ID_ALL,
    ID_EFFECTS,
    ID_SIZE,
    ID_CAMERA,
    ID_AA,
    ID_DEPTH,
};

enum { DEPTH_MOST = 32, DEPTH_DEFAULT = 8 };

/* Items of a section that are listed without --all. */
enum { ITEMS_SHOWN = 12 };

static const struct cli_option options[] = {
    {ID_JSON, "json", NULL, "everything as JSON"},
    {ID_ALL, "all", NULL, "list every item, not only the first of each kind"},
    {ID_TRIANGLES, "triangles", "FILE",
     "write every world-space triangle: little-endian records\n"
     "float v[9]; uint32 instance; uint32 primitive"},
    {ID_EFFECTS, "effects", NULL,
     "what each effect costs, measured on the device: times\n"
     "with and without it in turns, and what the picture\n"
     "would lose; --size, --camera, --aa and --depth are those\n"
     "of `whit render`"},
    {ID_SIZE, "size", "WxH", "pixels, for --effects (320x240)"},
    {ID_CAMERA, "camera", "NAME|N|numbers", "for --effects (the scene's first)"},
    {ID_AA, "aa", "1|4|16|64|adaptive:X", "for --effects (1)"},
    {ID_DEPTH, "depth", "N", "for --effects (8)"},
    JOB_OPTION_DEVICE,
    {JOB_TIME, "time", "T", "time of the triangles, or of the picture, in seconds (0)"},
    {JOB_FRAME, "frame", "N", "instead of --time: frame N of the animation"},
    {JOB_FPS, "fps", "F", "frames in a second, for --frame (24)"},
    JOB_OPTION_TEXTURES,
    {JOB_TIME_LIMIT, "time-limit", "S", "give up after S seconds, with exit code 5"},
    {'q', "quiet", NULL, "print nothing but errors; useful with --triangles"},
    {0, NULL, NULL, NULL},
};

/* ---- Triangles ---- */

enum { TRIANGLE_BATCH = 4096 };
_Static_assert(sizeof(whit_triangle) == 44, "records of --triangles have no padding");

struct triangle_writer {
    whit_file *file;
    whit_triangle batch[TRIANGLE_BATCH];
    uint32_t used;
    whit_result result;
};

static bool write_batch(struct triangle_writer *writer)
{
    writer->result =
        whit_file_append(writer->file, writer->batch, writer->used * sizeof writer->batch[0]);
    writer->used = 0;
    return writer->result == WHIT_OK;
}

static bool write_triangle(void *user, const whit_triangle *triangle)
{
    struct triangle_writer *writer = user;
    writer->batch[writer->used++] = *triangle;
    if (cli_cancel)
        return false;
    return writer->used < TRIANGLE_BATCH || write_batch(writer);
}

static whit_result write_triangles(const struct job *job, const char *path)
{
    struct triangle_writer *writer = calloc(1, sizeof *writer);
    if (!writer) {
        cli_error("out of memory");
        return WHIT_ERROR_MEMORY;
    }
    whit_result result = whit_file_begin(path, &cli_log, &writer->file);
    if (result != WHIT_OK)
        goto done;
    result = whit_scene_triangles(job->scene, job->time_s, write_triangle, writer);
    if (result == WHIT_ERROR_CANCELLED && writer->result != WHIT_OK)
        result = writer->result;
    if (result == WHIT_OK && !write_batch(writer))
        result = writer->result;
    if (result == WHIT_OK)
        result = whit_file_commit(writer->file);
    else
        whit_file_abandon(writer->file);
done:
    free(writer);
    return result;
}

/* ---- JSON ---- */

static json_t *mesh_document(const whit_scene *scene, uint32_t index)
{
    whit_mesh_info mesh;
    whit_scene_get_mesh(scene, index, &mesh);
    json_t *object = document_object();
    document_text(object, "name", mesh.name);
    document_count(object, "vertices", mesh.vertex_count);
    document_count(object, "triangles", mesh.triangle_count);
    document_count(object, "spheres", mesh.sphere_count);
    document_count(object, "groups", mesh.group_count);
    document_flag(object, "normals", mesh.has_normals);
    document_flag(object, "uvs", mesh.has_uvs);
    document_flag(object, "colors", mesh.has_colors);
    return object;
}

static json_t *instance_document(const whit_scene *scene, uint32_t index)
{
    whit_instance_info instance;
    whit_scene_get_instance(scene, index, &instance);
    json_t *object = document_object();
    document_text(object, "name", instance.name);
    document_count(object, "mesh", instance.mesh);
    document_numbers(object, "object_to_world", instance.object_to_world, 12);
    return object;
}

static json_t *material_document(const whit_scene *scene, uint32_t index)
{
    whit_material_info material;
    whit_scene_get_material(scene, index, &material);
    json_t *object = document_object();
    document_text(object, "name", material.name);
    document_text(object, "file", material.file);
    document_count(object, "line", material.line);
    document_text(object, "model", material.model);
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
    return object;
}

static json_t *light_document(const whit_scene *scene, uint32_t index)
{
    whit_light_info light;
    whit_scene_get_light(scene, index, &light);
    json_t *object = document_object();
    document_text(object, "name", light.name);
    document_text(object, "kind", light.kind);
    document_numbers(object, "position", light.position, 3);
    document_numbers(object, "direction", light.direction, 3);
    document_floats(object, "color", light.color, 3);
    document_flag(object, "made_by_whit", light.made_by_whit);
    return object;
}

static json_t *camera_document(const whit_scene *scene, uint32_t index)
{
    whit_camera_info camera;
    whit_scene_get_camera(scene, index, &camera);
    json_t *object = document_object();
    document_text(object, "name", camera.name);
    document_text(object, "kind", camera.kind);
    document_numbers(object, "eye", camera.eye, 3);
    document_numbers(object, "target", camera.target, 3);
    document_numbers(object, "up", camera.up, 3);
    document_number(object, "fov_y_degrees", camera.fov_y_degrees);
    document_number(object, "height", camera.height);
    document_number(object, "lens", camera.lens_radius);
    document_number(object, "focus", camera.focus_distance);
    document_flag(object, "made_by_whit", camera.made_by_whit);
    return object;
}

static json_t *effect_document(const whit_scene *scene, uint32_t index)
{
    whit_effect_info effect;
    whit_scene_get_effect(scene, index, &effect);
    json_t *object = document_object();
    document_text(object, "name", effect.name);
    document_flag(object, "called", effect.called);
    document_text(object, "reason", effect.reason);
    return object;
}

static json_t *note_document(const whit_scene *scene, uint32_t index)
{
    whit_note_info note;
    whit_scene_get_note(scene, index, &note);
    json_t *object = document_object();
    document_text(object, "level", note.warning ? "warning" : "info");
    document_text(object, "text", note.text);
    return object;
}

static void put_list(json_t *root, const char *key, const whit_scene *scene, uint32_t count,
                     json_t *(*describe)(const whit_scene *scene, uint32_t index))
{
    json_t *list = document_array();
    for (uint32_t i = 0; i < count; ++i)
        document_append(list, describe(scene, i));
    document_put(root, key, list);
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

static int print_json(const struct job *job, const whit_scene_info *info)
{
    json_t *root = document_object();
    document_text(root, "whit", WHIT_VERSION);
    document_text(root, "file", job->scene_path);
    document_hash(root, "hash", info->hash);
    document_count(root, "file_bytes", info->file_bytes);
    document_count(root, "triangles", info->triangle_count);
    document_count(root, "spheres", info->sphere_count);
    document_count(root, "mesh_triangles", info->mesh_triangle_count);
    document_count(root, "nodes", info->node_count);
    document_count(root, "textures", info->texture_count);
    document_count(root, "channels", info->channel_count);
    document_number(root, "time_end_s", info->time_end_s);
    document_put(root, "bounds", bounds_document(info));
    json_t *environment = document_object();
    document_text(environment, "kind", info->environment);
    document_flag(environment, "made_by_whit", info->environment_made_by_whit);
    document_put(root, "environment", environment);
    put_list(root, "meshes", job->scene, info->mesh_count, mesh_document);
    put_list(root, "instances", job->scene, info->instance_count, instance_document);
    put_list(root, "materials", job->scene, info->material_count, material_document);
    put_list(root, "lights", job->scene, info->light_count, light_document);
    put_list(root, "cameras", job->scene, info->camera_count, camera_document);
    put_list(root, "effects", job->scene, info->effect_count, effect_document);
    put_list(root, "notes", job->scene, info->note_count, note_document);
    return cli_print_json(root);
}

/* ---- Text ---- */

/* Names come from files: what would steer the terminal is replaced. */
static void print_clean(const char *text)
{
    for (; *text; ++text)
        putchar((unsigned char)*text < 0x20 || *text == 0x7f ? '?' : *text);
}

static void print_name(uint32_t index, const char *name)
{
    printf("  %4u  ", index);
    print_clean(name[0] ? name : "(no name)");
    for (size_t i = strlen(name[0] ? name : "(no name)"); i < 24; ++i)
        putchar(' ');
    fputs("  ", stdout);
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
    bool metal_rough = strcmp(material.model, "metal-rough") == 0;
    print_name(index, material.name);
    fputs(material.model, stdout);
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
    if (material.file) {
        fputs("  (", stdout);
        print_clean(material.file);
        printf(material.line ? ":%u)" : ")", material.line);
    }
    putchar('\n');
}

static void print_light(const whit_scene *scene, uint32_t index)
{
    whit_light_info light;
    whit_scene_get_light(scene, index, &light);
    print_name(index, light.name);
    fputs(light.kind, stdout);
    if (strcmp(light.kind, "directional") != 0)
        printf(" at %.6g %.6g %.6g", light.position[0], light.position[1], light.position[2]);
    if (strcmp(light.kind, "point") != 0)
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
    printf("%s from %.6g %.6g %.6g to %.6g %.6g %.6g", camera.kind, camera.eye[0], camera.eye[1],
           camera.eye[2], camera.target[0], camera.target[1], camera.target[2]);
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
    print_clean(note.text);
    putchar('\n');
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
        printf("  %-20s %-7s ", effect.name, effect.called ? "yes" : "-");
        print_clean(effect.reason);
        putchar('\n');
    }
}

static void print_count(const char *before, uint32_t count, const char *one, const char *many)
{
    printf("%s%u %s", before, count, count == 1 ? one : many);
}

static void print_summary(const struct job *job, const whit_scene_info *info)
{
    print_clean(job->scene_path);
    printf("\n  triangles    %llu (%llu in the meshes)\n", (unsigned long long)info->triangle_count,
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
    if (info->channel_count)
        printf("  animation    %u channels, to %.4g s\n", info->channel_count, info->time_end_s);
    printf("  environment  %s%s\n", info->environment,
           info->environment_made_by_whit ? "  (made by whit)" : "");
    printf("  files        %.1f kB, hash %016llx\n", (double)info->file_bytes * 1e-3,
           (unsigned long long)info->hash);
}

static int print_text(const struct job *job, const whit_scene_info *info, bool all)
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

/* ---- The command ---- */

struct scene_request {
    const char *triangles; /* NULL: none */
    bool json, all, effects;
    struct picture picture; /* of --effects */
    bool for_effects;       /* an option that needs --effects was given */
};

static int work(struct job *job, const struct scene_request *request)
{
    whit_scene_info info;
    whit_result result = job_load(job);
    if (result == WHIT_OK && request->triangles)
        result = write_triangles(job, request->triangles);
    if (result != WHIT_OK)
        return cli_exit_of(result);
    if (request->effects)
        return receipt_run(job, &request->picture, request->json);
    whit_scene_get_info(job->scene, &info);
    if (request->json)
        return print_json(job, &info);
    return job->quiet ? EXIT_FINE : print_text(job, &info, request->all);
}

static void read_option(struct job *job, struct cli_reader *reader, int id,
                        struct scene_request *request)
{
    struct picture *picture = &request->picture;
    request->for_effects |= id >= ID_SIZE && id <= ID_DEPTH;
    switch (id) {
    case ID_JSON:
        request->json = true;
        break;
    case ID_ALL:
        request->all = true;
        break;
    case ID_TRIANGLES:
        request->triangles = reader->value;
        break;
    case ID_EFFECTS:
        request->effects = true;
        break;
    case ID_SIZE:
        cli_size(reader, &picture->width, &picture->height);
        break;
    case ID_CAMERA:
        picture->camera = reader->value;
        break;
    case ID_AA:
        picture_read_aa(reader, picture);
        break;
    case ID_DEPTH:
        cli_unsigned(reader, 0, DEPTH_MOST, &picture->depth);
        break;
    default:
        job_option(job, reader, id);
        break;
    }
}

static int run(const struct cli_command *command, int argc, char **argv)
{
    struct cli_reader reader;
    struct job job;
    struct scene_request request = {
        .picture = {.width = 320, .height = 240, .samples = 1, .depth = DEPTH_DEFAULT}};
    job_init(&job);
    cli_reader_init(&reader, command, argc, argv);
    for (int id; (id = cli_next(&reader)) != 0;)
        read_option(&job, &reader, id, &request);
    if (!job_options_done(&job, &reader) ||
        !cli_no_dash(&reader, "--triangles", request.triangles, "for a pipe give /dev/stdout"))
        return reader.status;
    if (request.for_effects && !request.effects) {
        cli_misuse(&reader, "--size, --camera, --aa and --depth are for the pictures of --effects");
        return reader.status;
    }
    if (request.triangles && !cli_can_write(request.triangles))
        return EXIT_USAGE;
    int status = work(&job, &request);
    job_finish(&job);
    return status;
}

const struct cli_command command_scene = {
    .name = "scene",
    .arguments = "SCENE [options]",
    .summary = "Lists what is in a scene, what is wrong with it, and the effects it calls for.",
    .options = options,
    .run = run,
};
