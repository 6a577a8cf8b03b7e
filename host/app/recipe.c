#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "app/commands.h"
#include "app/document.h"
#include "cost/words.h"

static void put_part(void *user, const char *part)
{
    fputs(part, user);
}

void recipe_put_word(FILE *to, const char *word)
{
    fputc(' ', to);
    words_quote(word, put_part, to);
}

/* The shortest decimal that reads back as `value`. */
static void put_digits(FILE *to, double value)
{
    char text[40];
    for (int digits = 6; digits <= 17; ++digits) {
        snprintf(text, sizeof text, "%.*g", digits, value);
        if (strtod(text, NULL) == value)
            break;
    }
    fputs(text, to);
}

static void put_number(FILE *to, double value)
{
    fputc(' ', to);
    put_digits(to, value);
}

/* `-o` names a file of the same kind, not this one: a copy under another name is the same. */
static void put_output(FILE *to, const char *output)
{
    const char *dot = strrchr(output, '.');
    fprintf(to, " -o whit%s", dot ? dot : "");
}

/* A picture of costs shows what trees and traversals are like: they are part of it. */
static void put_view(FILE *to, const struct job *job, const struct render_request *request)
{
    char build[JOB_BUILD_NAME];
    job_build_name(&job->build, build);
    fprintf(to, " --view %s --view-rays %s", view_name(&request->view),
            view_rays_name(&request->view));
    if (request->view.scale > 0.0) {
        fputs(" --view-scale", to);
        put_number(to, request->view.scale);
    }
    if (job->no_trees) {
        fputs(" --no-bvh", to);
    } else {
        fprintf(to, " --build %s", build);
    }
    if (job->leaf_limit)
        fprintf(to, " --leaf %u", job->leaf_limit);
    if (job->instance_build == WHIT_BUILD_MEDIAN)
        fputs(" --instance-build median", to);
    if (job->instance_refit)
        fputs(" --instance-update refit", to);
    fprintf(to, " --traversal %s", value_word(values_traversal, (int)job->traversal));
}

/* Only what is left out does. */
static bool changes_picture(const char *effects)
{
    return effects && strchr(effects, '-');
}

static char *command_line(const struct job *job, const struct render_request *request)
{
    char *text = NULL;
    size_t size;
    FILE *to = open_memstream(&text, &size);
    if (!to)
        return NULL;
    fputs("whit render", to);
    recipe_put_word(to, job->scene_path);
    put_output(to, request->output);
    fprintf(to, " --size %ux%u", request->picture.width, request->picture.height);
    if (request->picture.camera) {
        fputs(" --camera", to);
        recipe_put_word(to, request->picture.camera);
    }
    if (job->time_s != 0.0) {
        fputs(" --time", to);
        put_number(to, job->time_s);
    }
    if (request->picture.adaptive > 0.0) {
        fputs(" --aa adaptive:", to);
        put_digits(to, request->picture.adaptive);
    } else {
        fprintf(to, " --aa %u", request->picture.samples);
    }
    fprintf(to, " --depth %u", request->picture.depth);
    if (request->bailout != WHIT_BAILOUT_DEFAULT) {
        fputs(" --bailout", to);
        put_number(to, request->bailout);
    }
    if (request->shadows == WHIT_SHADOWS_NONE)
        fputs(" --no-shadows", to);
    if (request->shadows == WHIT_SHADOWS_OPAQUE)
        fputs(" --opaque-shadows", to);
    if (request->light_samples)
        fprintf(to, " --light-samples %u", request->light_samples);
    if (request->schlick)
        fputs(" --fresnel schlick", to);
    if (changes_picture(request->effects)) {
        fputs(" --effects", to);
        recipe_put_word(to, request->effects);
    }
    if (job->texture_limit)
        fprintf(to, " --texture-limit %u", job->texture_limit);
    for (uint32_t i = 0; i < job->allowed_count; ++i) {
        fputs(" --allow-path", to);
        recipe_put_word(to, job->allowed[i]);
    }
    if (job->instances)
        fprintf(to, " --instances %s", value_word(values_instances, (int)job->instances));
    if (job->numerics)
        fprintf(to, " --numerics %s", value_word(values_numerics, (int)job->numerics));
    if (request->view.given)
        put_view(to, job, request);
    bool lacks_memory = ferror(to) != 0;
    if (fclose(to) != 0 || lacks_memory) {
        free(text);
        return NULL;
    }
    return text;
}

static char *options_line(const struct job *job, const struct render_request *request)
{
    json_t *options = document_object();
    picture_describe(&request->picture, job, options);
    document_number(options, "bailout", request->bailout);
    document_flag(options, "shadows", request->shadows != WHIT_SHADOWS_NONE);
    if (request->shadows == WHIT_SHADOWS_OPAQUE)
        document_flag(options, "opaque_shadows", true);
    if (request->light_samples)
        document_count(options, "light_samples", request->light_samples);
    if (request->schlick)
        document_text(options, "fresnel", "schlick");
    if (changes_picture(request->effects))
        document_text(options, "effects", request->effects);
    if (job->texture_limit)
        document_count(options, "texture_limit", job->texture_limit);
    if (job->instances) /* in one tree triangles are others, by the last bit */
        document_text(options, "instances", value_word(values_instances, (int)job->instances));
    if (job->numerics)
        document_text(options, "numerics", value_word(values_numerics, (int)job->numerics));
    return document_line(options);
}

static char *counters_line(const whit_stats *stats)
{
    json_t *rays = document_object();
    document_count(rays, "primary", stats->rays_primary);
    document_count(rays, "shadow", stats->rays_shadow);
    document_count(rays, "reflected", stats->rays_reflected);
    document_count(rays, "refracted", stats->rays_refracted);
    document_count(rays, "cut_by_depth", stats->rays_cut_depth);
    document_count(rays, "cut_by_bailout", stats->rays_cut_bailout);
    json_t *counters = document_object();
    document_put(counters, "rays", rays);
    if (stats->bailout_bound >= 0.0)
        document_number(counters, "bailout_bound", stats->bailout_bound);
    return document_line(counters);
}

static void add(struct recipe *recipe, const char *key, const char *value)
{
    recipe->texts[recipe->count++] = (whit_text){.key = key, .value = value};
}

bool recipe_init(struct recipe *recipe, const struct job *job, const struct render_request *request,
                 const whit_device_info *device, const whit_stats *stats)
{
    *recipe = (struct recipe){0};
    whit_scene_info scene;
    whit_scene_get_info(job->scene, &scene);
    if (device)
        recipe->device = *device;
    else
        whit_device_get_info(job->device, &recipe->device);
    snprintf(recipe->hash, sizeof recipe->hash, "%016" PRIx64, scene.hash);
    recipe->command = command_line(job, request);
    recipe->options = options_line(job, request);
    recipe->counters = counters_line(stats);
    /* Other programs print what pictures hold, as it is. */
    recipe->scene = strdup(cli_shown(job->scene_path));
    recipe->name = strdup(cli_shown(recipe->device.name));
    recipe->driver = strdup(cli_shown(recipe->device.driver));
    if (!recipe->command || !recipe->options || !recipe->counters || !recipe->scene ||
        !recipe->name || !recipe->driver) {
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
    add(recipe, "whit:counters", recipe->counters);
    return true;
}

bool recipe_add_view(struct recipe *recipe, const struct cost_view *view,
                     const struct view_figures *figures)
{
    json_t *object = document_object();
    document_text(object, "view", view_name(view));
    document_text(object, "rays", view_rays_name(view));
    document_number(object, "scale", figures->scale);
    document_number(object, "mean", figures->mean);
    document_number(object, "most", figures->most);
    recipe->view = document_line(object);
    if (!recipe->view)
        cli_error("out of memory");
    add(recipe, "whit:view", recipe->view);
    return recipe->view != NULL;
}

void recipe_finish(struct recipe *recipe)
{
    free(recipe->scene);
    free(recipe->name);
    free(recipe->driver);
    free(recipe->view);
    free(recipe->command);
    free(recipe->options);
    free(recipe->counters);
    *recipe = (struct recipe){0};
}
