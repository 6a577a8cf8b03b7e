#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "app/render/recipe.h"
#include "app/settings_json.h"
#include "base/array.h"
#include "base/path.h"

enum { COMMAND_BYTES = 16384 };

/* The recipe's command has `-o whit.EXT` with the ending of the file, not its name, so that the
   same picture under another name has the same bytes. */
static char *command_line(const struct settings *settings, const char *output)
{
    const char *dot = strrchr(output, '.');
    char name[64], *text = malloc(COMMAND_BYTES);
    snprintf(name, sizeof name, "whit%s", dot ? dot : "");
    if (text)
        settings_write_render(settings, SETTINGS_RECIPE, name, text, COMMAND_BYTES);
    return text;
}

/* Without `has_camera` the options say of no camera, not even that it is the scene's first. */
static char *options_line(const struct settings *settings, bool has_camera)
{
    json_t *options = document_object();
    struct settings told = *settings;
    told.paint = PAINT_COLOR; /* recipe_add_view adds the options of heat maps */
    settings_describe(&told, IN_RENDER, options);
    if (!has_camera)
        json_object_del(options, "camera");
    return document_line(options);
}

json_t *recipe_rays(const whit_stats *stats)
{
    json_t *rays = document_object();
    document_count(rays, "primary", stats->rays_primary);
    document_count(rays, "shadow", stats->rays_shadow);
    document_count(rays, "reflected", stats->rays_reflected);
    document_count(rays, "refracted", stats->rays_refracted);
    if (stats->rays_straight)
        document_count(rays, "straight", stats->rays_straight);
    if (stats->rays_by_functions)
        document_count(rays, "by_functions", stats->rays_by_functions);
    document_count(rays, "cut_by_depth", stats->rays_cut_depth);
    document_count(rays, "cut_by_bailout", stats->rays_cut_bailout);
    return rays;
}

char *recipe_counters(const whit_stats *stats)
{
    json_t *counters = document_object();
    document_put(counters, "rays", recipe_rays(stats));
    if (stats->bailout_bound >= 0.0)
        document_number(counters, "bailout_bound", stats->bailout_bound);
    return document_line(counters);
}

/* Takes over `value`. */
static void add(struct recipe *recipe, const char *key, char *value)
{
    recipe->texts[recipe->count++] = (whit_text){.key = key, .value = value};
}

/* Functions that a picture cannot carry, as they are too large, are left out with a warning: the
   picture is written all the same. */
static void add_functions(struct recipe *recipe, const whit_shader *shader, const char *output)
{
    const char *why;
    char *functions = shader ? whit_shader_pack(shader, &why) : NULL;
    if (functions)
        add(recipe, WHIT_SHADER_KEY, string_copy(functions));
    else if (shader)
        cli_warning("%s: the functions are not kept in it: %s", output, why);
    whit_memory_destroy(functions);
}

/* The settings as a recipe says them: a picture that is repeated gives its functions, but has them
   from a file. */
static struct settings said_settings(const struct settings *settings)
{
    struct settings said = *settings;
    bool picture = path_is(said.shader, "png") || path_is(said.shader, "exr");
    if (said.shader_said[0] && picture)
        memcpy(said.shader, said.shader_said, sizeof said.shader);
    return said;
}

bool recipe_init(struct recipe *recipe, const struct settings *settings, const whit_scene *scene,
                 const whit_shader *shader, const whit_device_info *device, const whit_stats *stats,
                 const char *output, json_t *camera)
{
    const struct settings said = said_settings(settings);
    whit_scene_info info;
    *recipe = (struct recipe){.count = 0};
    whit_scene_get_info(scene, &info);
    add(recipe, "Software", string_copy("whit " WHIT_VERSION));
    if (camera)
        add(recipe, VIEW_CAMERA_KEY, document_line(camera));
    else
        add(recipe, "whit:command", command_line(&said, output));
    /* Other programs print the texts of pictures unescaped. */
    add(recipe, "whit:device", string_copy(cli_shown(device->name)));
    add(recipe, "whit:driver", string_copy(cli_shown(device->driver)));
    add(recipe, "whit:scene", string_copy(cli_shown(settings->scene)));
    add(recipe, "whit:scene_hash", string_format("%016" PRIx64, info.hash));
    add(recipe, "whit:options", options_line(&said, !camera));
    if (stats)
        add(recipe, "whit:counters", recipe_counters(stats));
    if (settings->shader[0])
        add_functions(recipe, shader, output);
    for (uint32_t i = 0; i < recipe->count; ++i) {
        if (recipe->texts[i].value)
            continue;
        cli_error("out of memory");
        recipe_finish(recipe);
        return false;
    }
    return true;
}

void recipe_add_view(struct recipe *recipe, const struct settings *settings,
                     const struct view_figures *figures)
{
    json_t *object = document_object();
    document_text(object, "view", value_word(values_view, (int)settings->paint));
    document_text(object, "rays", value_word(values_rays, (int)settings->paint_rays));
    document_number(object, "scale", figures->scale);
    document_number(object, "mean", figures->mean);
    document_number(object, "max", figures->max);
    add(recipe, "whit:view", document_line(object));
}

void recipe_add_part(struct recipe *recipe, const struct part *part,
                     const struct settings *settings)
{
    if (part_is_given(part))
        add(recipe, PART_KEY, document_line(part_document(part, settings)));
}

void recipe_finish(struct recipe *recipe)
{
    for (uint32_t i = 0; i < recipe->count; ++i)
        free((char *)recipe->texts[i].value);
    *recipe = (struct recipe){.count = 0};
}
