/* The entry of a golden file: hashes of what was drawn, its mean, and the parts it was made of. */
#include <math.h>
#include <string.h>

#include "app/check/describe.h"
#include "base/hash.h"

enum { KEY_BYTES = 2048 };

uint64_t drawing_hash_floats(const whit_image *image)
{
    whit_image_info info;
    whit_image_get_info(image, &info);
    size_t count = (size_t)info.width * info.height * info.channels;
    const float *floats = whit_image_floats(image);
    uint64_t hash = hash_bytes(HASH_START, &info.channels, sizeof info.channels);
    float row[1024];
    for (size_t at = 0; at < count; at += sizeof row / sizeof *row) {
        size_t some = count - at < sizeof row / sizeof *row ? count - at : sizeof row / sizeof *row;
        for (size_t i = 0; i < some; ++i)
            row[i] = isnan(floats[at + i]) ? NAN : floats[at + i];
        hash = hash_bytes(hash, row, some * sizeof *row);
    }
    return hash;
}

uint64_t drawing_hash_ids(const whit_image *image)
{
    whit_image_info info;
    whit_image_get_info(image, &info);
    size_t count = (size_t)info.width * info.height * info.channels;
    return hash_bytes(HASH_START, whit_image_words(image), count * sizeof(uint32_t));
}

/* Gives red, green and blue; a single channel is repeated three times. */
static void get_color(const float *pixel, uint32_t channels, double rgb[3])
{
    for (int k = 0; k < 3; ++k)
        rgb[k] = (double)pixel[channels < 3 ? 0 : k];
}

void drawing_color_at(const struct drawing *drawing, size_t pixel, double rgb[3])
{
    whit_image_info info;
    whit_image_get_info(drawing->color, &info);
    get_color(whit_image_floats(drawing->color) + pixel * info.channels, info.channels, rgb);
}

size_t drawing_find_color(const struct drawing *drawing, enum color_of which, double rgb[3])
{
    whit_image_info info;
    whit_image_get_info(drawing->color, &info);
    const float *at = whit_image_floats(drawing->color);
    size_t used = 0;
    rgb[0] = rgb[1] = rgb[2] = 0.0;
    for (size_t i = 0; i < (size_t)info.width * info.height; ++i, at += info.channels) {
        double color[3];
        get_color(at, info.channels, color);
        if (!isfinite(color[0]) || !isfinite(color[1]) || !isfinite(color[2]))
            continue;
        for (int k = 0; k < 3; ++k)
            rgb[k] = which == COLOR_MEAN  ? rgb[k] + color[k]
                     : used == 0          ? color[k]
                     : which == COLOR_MIN ? fmin(rgb[k], color[k])
                                          : fmax(rgb[k], color[k]);
        ++used;
    }
    for (int k = 0; k < 3 && which == COLOR_MEAN && used; ++k)
        rgb[k] /= (double)used;
    return used;
}

size_t drawing_count_hits(const struct drawing *drawing)
{
    whit_image_info info;
    whit_image_get_info(drawing->ids, &info);
    const uint32_t *ids = whit_image_words(drawing->ids);
    size_t hits = 0;
    for (size_t i = 0; i < (size_t)info.width * info.height; ++i)
        hits += ids[2 * i] != WHIT_NONE;
    return hits;
}

whit_result drawing_probe(const struct drawing *drawing, uint32_t x, uint32_t y,
                          whit_probe_ray *ray)
{
    whit_probe_report *report = NULL;
    whit_probe_ray *rays = NULL;
    uint32_t count = 0;
    whit_result result = drawing->reference
                             ? whit_reference_rays(drawing->reference, x, y, 0, &rays, &count)
                             : whit_probe(drawing->renderer, x, y, 1, &report);
    *ray =
        (whit_probe_ray){.device = {(double)INFINITY, WHIT_NONE, WHIT_NONE}, .material = WHIT_NONE};
    if (rays && count) /* there are none where memory ran out */
        *ray = rays[0];
    else if (report && report->ray_count)
        *ray = report->rays[0];
    whit_memory_destroy(rays);
    whit_probe_report_destroy(report);
    return result;
}

/* ---- Parts ---- */

/* Adds a part of the picture's input: `kind` as "mesh", a `name` that is the same in every run, and
   a hash of its content. */
static bool put_part(struct golden *found, const struct check_case *item, const char *kind,
                     const char *name, uint64_t content)
{
    char text[KEY_BYTES], key[KEY_BYTES];
    snprintf(text, sizeof text, "%s%s%s of %s", kind, name[0] ? " " : "", name, item->loaded);
    whit_text_show(text, key, sizeof key);
    uint32_t hash = golden_part_hash(key, content);
    return golden_put_part(found, key, hash) && golden_case_add_part(&found->cases[0], hash);
}

static bool put_scene_parts(struct golden *found, const struct check_case *item,
                            const whit_scene *scene)
{
    whit_part *parts;
    uint32_t count;
    bool put = whit_scene_parts(scene, &parts, &count) == WHIT_OK;
    for (uint32_t i = 0; put && i < count; ++i)
        put =
            put_part(found, item, whit_part_kind_name(parts[i].kind), parts[i].name, parts[i].hash);
    whit_memory_destroy(parts);
    return put;
}

static bool put_shader_part(struct golden *found, const struct check_case *item,
                            const whit_shader *shader)
{
    whit_shader_info info;
    if (!shader)
        return true;
    whit_shader_get_info(shader, &info);
    return put_part(found, item, "functions", "", info.hash);
}

/* ---- All of it ---- */

static bool fill(const struct drawing *drawing, const struct check_case *item, struct golden *found)
{
    const whit_stats *stats = &drawing->stats;
    const uint64_t rays[WHIT_RAY_KINDS] = {stats->rays_primary, stats->rays_shadow,
                                           stats->rays_reflected, stats->rays_refracted};
    whit_image_info info;
    whit_image_get_info(drawing->ids, &info);
    struct golden_case one = {.name = item->name,
                              .ids = drawing->ids_hash,
                              .colors = drawing->color_hash,
                              .width = info.width,
                              .height = info.height,
                              .made_by = item->made_by};
    memcpy(one.rays, rays, sizeof rays);
    drawing_find_color(drawing, COLOR_MEAN, one.mean);
    return golden_put(found, &one) && put_scene_parts(found, item, drawing->job.scene) &&
           put_shader_part(found, item, drawing->job.shader);
}

whit_result drawing_describe(const struct drawing *drawing, const struct check_case *item,
                             struct golden *found)
{
    *found = (struct golden){.exists = true};
    if (!fill(drawing, item, found)) {
        golden_finish(found);
        return cli_no_memory();
    }
    golden_sort(found);
    return WHIT_OK;
}
