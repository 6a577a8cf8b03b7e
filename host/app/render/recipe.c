#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "app/render/recipe.h"
#include "app/settings_json.h"

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

static char *options_line(const struct settings *settings)
{
    json_t *options = document_object();
    struct settings told = *settings;
    told.paint = PAINT_COLOR; /* recipe_add_view adds the options of heat maps */
    settings_describe(&told, IN_RENDER, options);
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

static void add(struct recipe *recipe, const char *key, const char *value)
{
    recipe->texts[recipe->count++] = (whit_text){.key = key, .value = value};
}

/* Functions that a picture cannot carry, as they are too large, are left out with a warning: the
   picture is written all the same. */
static void add_functions(struct recipe *recipe, const whit_shader *shader, const char *output)
{
    const char *why;
    recipe->functions = shader ? whit_shader_pack(shader, &why) : NULL;
    if (recipe->functions)
        add(recipe, WHIT_SHADER_KEY, recipe->functions);
    else if (shader)
        cli_warning("%s: the functions are not kept in it: %s", output, why);
}

bool recipe_init(struct recipe *recipe, const struct settings *settings, const whit_scene *scene,
                 const whit_shader *shader, const whit_device_info *device, const whit_stats *stats,
                 const char *output)
{
    whit_scene_info info;
    *recipe = (struct recipe){.device = *device};
    whit_scene_get_info(scene, &info);
    snprintf(recipe->hash, sizeof recipe->hash, "%016" PRIx64, info.hash);
    recipe->command = command_line(settings, output);
    recipe->options = options_line(settings);
    recipe->counters = stats ? recipe_counters(stats) : NULL;
    /* Other programs print the texts of pictures unescaped. */
    recipe->scene = strdup(cli_shown(settings->scene));
    recipe->name = strdup(cli_shown(recipe->device.name));
    recipe->driver = strdup(cli_shown(recipe->device.driver));
    if (!recipe->command || !recipe->scene || !recipe->name || !recipe->driver) {
        cli_error("out of memory");
        recipe_finish(recipe);
        return false;
    }
    add(recipe, "Software", "whit " WHIT_VERSION);
    add(recipe, "whit:command", recipe->command);
    add(recipe, "whit:device", recipe->name);
    add(recipe, "whit:driver", recipe->driver);
    add(recipe, "whit:scene", recipe->scene);
    add(recipe, "whit:scene_hash", recipe->hash);
    add(recipe, "whit:options", recipe->options);
    if (stats)
        add(recipe, "whit:counters", recipe->counters);
    if (settings->shader[0])
        add_functions(recipe, shader, output);
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
    recipe->view = document_line(object);
    add(recipe, "whit:view", recipe->view);
}

void recipe_add_part(struct recipe *recipe, const struct part *part,
                     const struct settings *settings)
{
    if (!part_is_given(part))
        return;
    recipe->part = document_line(part_document(part, settings));
    add(recipe, PART_KEY, recipe->part);
}

void recipe_add_camera(struct recipe *recipe, json_t *camera)
{
    recipe->camera = document_line(camera);
    add(recipe, VIEW_CAMERA_KEY, recipe->camera);
}

const char *recipe_text(const whit_text *texts, uint32_t count, const char *key)
{
    for (uint32_t i = 0; i < count; ++i) {
        if (strcmp(texts[i].key, key) == 0)
            return texts[i].value;
    }
    return NULL;
}

void recipe_finish(struct recipe *recipe)
{
    free(recipe->part);
    free(recipe->camera);
    free(recipe->scene);
    free(recipe->name);
    free(recipe->driver);
    free(recipe->view);
    free(recipe->command);
    free(recipe->options);
    free(recipe->counters);
    whit_memory_destroy(recipe->functions);
    *recipe = (struct recipe){0};
}
