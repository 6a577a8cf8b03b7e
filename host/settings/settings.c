#include "settings/settings.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/hash.h"
#include "settings/quote.h"

/* ---- The table ---- */

const struct setting *settings_row(const char *name)
{
    for (const struct setting *row = settings_table; row->name; ++row) {
        if (strcmp(row->name, name) == 0)
            return row;
    }
    abort();
}

static uint64_t bit_of(const struct setting *row)
{
    return UINT64_C(1) << (row - settings_table);
}

bool settings_given(const struct settings *settings, const char *name)
{
    return settings->given & bit_of(settings_row(name));
}

struct settings settings_usual(void)
{
    return (struct settings){.load = {.up = WHIT_UP_AUTO, .texture_limit = 4096},
                             .trees = {.leaf_limit = 4},
                             .picture = whit_renderer_defaults(),
                             .exposure_auto = true,
                             .fps = 24.0,
                             .fps_goal = 30.0,
                             .refines = true};
}

bool settings_read(const struct setting *row, const char *text, struct settings *settings,
                   char why[SETTING_WHY_BYTES])
{
    bool read = setting_read(row, text, settings, why);
    if (read)
        settings->given |= bit_of(row);
    return read;
}

/* ---- Options that do not go together ---- */

/* Whether an option was given that changes colours, such as --aa: --budget-ms and --max-error
   choose these themselves. */
static bool light_is_given(const struct settings *settings)
{
    for (const struct setting *row = settings_table; row->name; ++row) {
        if (row->change == SETTING_LIGHT && row->need < SETTING_NEEDS_TREES &&
            settings->given & bit_of(row))
            return true;
    }
    return false;
}

static bool check_shader(const struct settings *settings, char *why)
{
    if (settings->shader[0])
        return true;
    if (settings->aov[0])
        return setting_refuse(why, "--aov: without --shader there are no functions");
    if (settings->sliders[0])
        return setting_refuse(why, "--set: without --shader there are no sliders");
    if (settings->trust)
        return setting_refuse(why, "--trust: there is no --shader to be trusted");
    return true;
}

static bool check_choice(const struct settings *settings, char *why)
{
    bool budget = settings->budget_ms > 0.0, error = settings->max_error > 0.0;
    const char *name = budget ? "--budget-ms" : "--max-error";
    if ((budget || error) && settings_compiles(settings))
        return setting_refuse(why, "%s is measured against the reference, which has no --%s", name,
                              settings->shader[0] ? "shader" : "stages");
    if (budget && error)
        return setting_refuse(why, "--budget-ms and --max-error: one of them");
    if ((budget || error) && light_is_given(settings))
        return setting_refuse(why, "%s chooses --aa, --depth and the like by itself", name);
    if ((budget || error) && settings->paint != PAINT_COLOR)
        return setting_refuse(why, "%s is for one picture of colours", name);
    return true;
}

bool settings_check(struct settings *settings, char why[SETTING_WHY_BYTES])
{
    bool rays = settings_given(settings, "view-rays"),
         scale = settings_given(settings, "view-scale");
    if (settings_given(settings, "time") && settings_given(settings, "frame"))
        return setting_refuse(why, "--time and --frame are two ways to say the same");
    if (settings->trees.build == WHIT_BUILD_NONE && settings_given(settings, "leaf"))
        return setting_refuse(why, "--build none and --leaf: without trees there are no leaves");
    if (settings->paint == PAINT_COLOR && (rays || scale))
        return setting_refuse(why,
                              "--view-%s: there is nothing to count without --view depth, visits, "
                              "boxes, tris or stack",
                              rays ? "rays" : "scale");
    if (settings_given(settings, "frame"))
        settings->picture.time_s = (double)settings->frame / settings->fps;
    return check_shader(settings, why) && check_choice(settings, why);
}

/* ---- For libwhit ---- */

void settings_expose(struct settings *settings, const whit_scene_info *scene)
{
    settings->scene_exposure_ev = scene->exposure_ev;
    if (!settings->exposure_auto)
        return;
    settings->picture.exposure_ev = scene->exposure_ev;
    settings->picture.soft_highlights = scene->exposure_ev != 0.0;
}

whit_renderer_params settings_picture(const struct settings *settings)
{
    whit_renderer_params params = settings->picture;
    params.camera = camera_of_text(settings->camera);
    params.sliders = settings->sliders;
    params.count = params.count || settings->paint != PAINT_COLOR;
    if (settings->paint != PAINT_COLOR) /* costs need a fixed number of samples */
        params.sampling.kind = WHIT_SAMPLING_FIXED;
    return params;
}

whit_device_params settings_device(const struct settings *settings)
{
    return (whit_device_params){.selector = settings->device[0] ? settings->device : NULL,
                                .validation = settings->validation};
}

whit_overlay settings_overlay(const struct settings *settings)
{
    return (whit_overlay){.grid = settings->grid,
                          .edges_of_instances = settings->edges == EDGES_OBJECTS,
                          .edges_of_primitives = settings->edges == EDGES_TRIANGLES};
}

whit_load_params settings_load(const struct settings *settings,
                               const char *folders[SETTING_FOLDERS_MAX])
{
    whit_load_params params = settings->load;
    params.clip = settings->clip[0] ? settings->clip : NULL;
    params.environment = settings->environment[0] ? settings->environment : NULL;
    params.allowed_folders = folders;
    while (params.allowed_count < SETTING_FOLDERS_MAX &&
           settings->allowed[params.allowed_count][0]) {
        folders[params.allowed_count] = settings->allowed[params.allowed_count];
        ++params.allowed_count;
    }
    return params;
}

/* ---- Comparing ---- */

typedef bool row_filter(const struct setting *row);

static bool same_rows(const struct settings *a, const struct settings *b, row_filter *wanted)
{
    for (const struct setting *row = settings_table; row->name; ++row) {
        if (wanted(row) && !setting_same(row, a, b))
            return false;
    }
    return true;
}

static void copy_rows(struct settings *to, const struct settings *from, row_filter *wanted)
{
    for (const struct setting *row = settings_table; row->name; ++row) {
        if (wanted(row))
            setting_copy(row, from, to);
    }
}

static bool is_of_scene(const struct setting *row)
{
    return row->need == SETTING_NEEDS_SCENE;
}

static bool is_of_trees(const struct setting *row)
{
    return row->need == SETTING_NEEDS_TREES;
}

static bool is_of_kernel(const struct setting *row)
{
    return row->need == SETTING_NEEDS_KERNEL || row->need == SETTING_NEEDS_TREES;
}

static bool is_of_camera(const struct setting *row)
{
    return row->change == SETTING_PLACE;
}

static bool is_light(const struct setting *row)
{
    return row->change == SETTING_LIGHT && row->need < SETTING_NEEDS_TREES;
}

static bool is_of_picture(const struct setting *row)
{
    return row->change != SETTING_RUN && row->commands & IN_RENDER;
}

/* Whether the row changes what is seen: pictures, or heat maps and overlays over them. */
static bool is_seen(const struct setting *row)
{
    return is_of_picture(row) || row->change == SETTING_PAINT;
}

static bool decides_pixels(const struct setting *row)
{
    return is_of_picture(row) && row->change != SETTING_COST;
}

bool settings_same_scene(const struct settings *a, const struct settings *b)
{
    return strcmp(a->scene, b->scene) == 0 && a->reload == b->reload &&
           same_rows(a, b, is_of_scene);
}

void settings_set_scene(struct settings *settings, const struct settings *from)
{
    memcpy(settings->scene, from->scene, sizeof settings->scene);
    settings->reload = from->reload;
    copy_rows(settings, from, is_of_scene);
}

bool settings_same_trees(const struct settings *a, const struct settings *b)
{
    return settings_same_scene(a, b) && same_rows(a, b, is_of_trees);
}

bool settings_same_shader(const struct settings *a, const struct settings *b)
{
    return strcmp(a->shader, b->shader) == 0 && strcmp(a->stages, b->stages) == 0 &&
           a->trust == b->trust && a->shader_reload == b->shader_reload;
}

bool settings_compiles(const struct settings *settings)
{
    return settings->shader[0] || settings->stages[0];
}

/* Beside the rows of the table, kernels depend on whether costs are counted, whether there are
   bounces, and whether samples are adaptive. */
bool settings_same_kernel(const struct settings *a, const struct settings *b)
{
    const whit_renderer_params p = settings_picture(a), q = settings_picture(b);
    return settings_same_scene(a, b) && same_rows(a, b, is_of_kernel) &&
           settings_same_shader(a, b) && p.count == q.count && (p.depth == 0) == (q.depth == 0) &&
           p.sampling.kind == q.sampling.kind;
}

bool settings_same_camera(const struct settings *a, const struct settings *b)
{
    return same_rows(a, b, is_of_camera);
}

bool settings_same_place(const struct settings *a, const struct settings *b)
{
    return settings_same_scene(a, b) && settings_same_camera(a, b);
}

void settings_set_camera(struct settings *settings, const struct settings *from)
{
    copy_rows(settings, from, is_of_camera);
}

bool settings_same_light(const struct settings *a, const struct settings *b)
{
    return same_rows(a, b, is_light) && settings_same_shader(a, b);
}

void settings_set_light(struct settings *settings, const struct settings *from)
{
    copy_rows(settings, from, is_light);
}

bool settings_same_pixels(const struct settings *a, const struct settings *b)
{
    return settings_same_scene(a, b) && same_rows(a, b, decides_pixels) &&
           settings_same_shader(a, b) && a->paint == PAINT_COLOR;
}

bool settings_same(const struct settings *a, const struct settings *b)
{
    return settings_same_scene(a, b) && same_rows(a, b, is_seen) && settings_same_shader(a, b);
}

static uint64_t hash_rows(uint64_t hash, const struct settings *settings, row_filter *wanted)
{
    char text[SETTING_VALUE_BYTES];
    for (const struct setting *row = settings_table; row->name; ++row) {
        uint32_t entries = row->kind == SETTING_FOLDERS ? SETTING_FOLDERS_MAX : 1;
        for (uint32_t i = 0; wanted(row) && i < entries; ++i) {
            if (!setting_write(row, settings, i, text))
                continue;
            hash = hash_bytes(hash, row->name, strlen(row->name));
            hash = hash_bytes(hash, text, strlen(text));
        }
    }
    return hash;
}

uint64_t settings_hash_scene(const struct settings *settings)
{
    uint64_t hash = hash_bytes(HASH_START, settings->scene, strlen(settings->scene));
    return hash_rows(hash_bytes(hash, &settings->reload, sizeof settings->reload), settings,
                     is_of_scene);
}

uint64_t settings_hash_kernel(const struct settings *settings)
{
    const whit_renderer_params picture = settings_picture(settings);
    const uint32_t own[] = {picture.count, picture.depth == 0, picture.sampling.kind,
                            settings->shader_reload};
    return hash_rows(hash_bytes(settings_hash_scene(settings), own, sizeof own), settings,
                     is_of_kernel);
}

/* ---- Writing ---- */

/* Whether a setting is written. Settings of trees and traversal are in a recipe only for pictures
   of costs, whose pixels they decide. */
static bool is_written(const struct setting *row, const struct settings *settings,
                       enum settings_words which)
{
    bool costs = settings->paint != PAINT_COLOR;
    if (row->change == SETTING_RUN || (row->trusted && which == SETTINGS_STATE))
        return false;
    if (which == SETTINGS_RECIPE && row->change == SETTING_COST)
        return costs && row->need != SETTING_NEEDS_VIEW && !row->of_machine;
    return !row->tells || row->tells(settings, which == SETTINGS_RECIPE);
}

/* Whether a row is written; gives the text of its value. */
static bool settings_word(const struct setting *row, const struct settings *settings,
                          enum settings_words which, uint32_t index, char text[SETTING_VALUE_BYTES])
{
    const struct settings usual = settings_usual();
    bool always = which == SETTINGS_RECIPE && row->always;
    return is_written(row, settings, which) && (always || !setting_same(row, settings, &usual)) &&
           setting_write(row, settings, index, text);
}

struct words {
    char *text;
    size_t bytes, used;
};

static void put(void *user, const char *part)
{
    struct words *words = user;
    for (size_t i = 0; part[i]; ++i, ++words->used) {
        if (words->used + 1 < words->bytes)
            words->text[words->used] = part[i];
    }
}

static void put_option(struct words *words, const struct setting *row, const char *text)
{
    put(words, "--");
    put(words, row->name);
    if (setting_has_argument(row)) {
        put(words, " ");
        quote_word(text, put, words);
    }
}

/* Writes all rows that one of `commands` takes. */
static void put_all(struct words *words, const struct settings *settings, enum settings_words which,
                    const char *separator, uint32_t commands)
{
    char text[SETTING_VALUE_BYTES];
    for (const struct setting *row = settings_table; row->name; ++row) {
        bool wanted = row->commands & commands;
        for (uint32_t i = 0; wanted && settings_word(row, settings, which, i, text); ++i) {
            if (words->used > 0)
                put(words, separator);
            put_option(words, row, text);
            if (row->kind != SETTING_FOLDERS)
                break;
        }
    }
}

static size_t finish(struct words *words)
{
    words->text[words->used < words->bytes ? words->used : words->bytes - 1] = '\0';
    return words->used;
}

size_t settings_write(const struct settings *settings, enum settings_words which,
                      const char *separator, char *text, size_t text_bytes)
{
    struct words words = {.text = text, .bytes = text_bytes};
    put_all(&words, settings, which, separator, UINT32_MAX);
    return finish(&words);
}

size_t settings_write_render(const struct settings *settings, enum settings_words which,
                             const char *output, char *text, size_t text_bytes)
{
    struct words words = {.text = text, .bytes = text_bytes};
    put(&words, "whit render ");
    quote_word(settings->scene, put, &words);
    put_all(&words, settings, which, " ", IN_RENDER);
    put(&words, " -o ");
    quote_word(output, put, &words);
    return finish(&words);
}
