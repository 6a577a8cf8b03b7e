#include "app/merge/merge.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/render/recipe.h"
#include "base/text.h"

/* ---- Recipes ---- */

static const char *text_of(const struct merge_part *part, const char *key)
{
    return text_value(part->texts, part->text_count, key);
}

static whit_result read_part(struct merge_part *part, const char *path,
                             const whit_load_params *load)
{
    part->path = path;
    whit_result result = part_load_texts(path, load, &part->texts, &part->text_count);
    if (result != WHIT_OK)
        return result;
    const char *line = text_of(part, PART_KEY);
    if (line && part_of_line(line, &part->place))
        return WHIT_OK;
    return CLI_FAIL(
        WHIT_ERROR_INPUT, "%s: %s", path,
        line ? "what it says of its part is damaged"
             : "no part of a picture: `whit render --tile` and `--samples-part` make these");
}

whit_result merge_read(struct merge *merge, const char *const *paths, uint32_t count,
                       const whit_load_params *load)
{
    whit_result result = WHIT_OK;
    *merge = (struct merge){.load = load, .parts = calloc(count, sizeof *merge->parts)};
    if (!merge->parts)
        return cli_no_memory();
    for (; result == WHIT_OK && merge->count < count; ++merge->count) {
        result = read_part(&merge->parts[merge->count], paths[merge->count], load);
        if (result == WHIT_OK)
            result = job_still_wanted();
    }
    return result;
}

void merge_finish(struct merge *merge)
{
    for (uint32_t i = 0; i < merge->count; ++i)
        whit_memory_destroy(merge->parts[i].texts);
    free(merge->parts);
    *merge = (struct merge){0};
}

/* ---- Checks ---- */

static bool same_text(const struct merge_part *a, const struct merge_part *b, const char *key)
{
    const char *one = text_of(a, key), *other = text_of(b, key);
    return one && other ? strcmp(one, other) == 0 : one == other;
}

static whit_result check_same(const struct merge_part *a, const struct merge_part *b)
{
    static const struct {
        const char *key, *what;
    } keys[] = {{"Software", "versions of whit"},
                {"whit:scene_hash", "scenes"},
                {"whit:options", "settings"},
                {WHIT_SHADER_KEY, "functions"}};
    const struct part_place *x = &a->place, *y = &b->place;
    const char *what = NULL;
    for (size_t i = 0; !what && i < sizeof keys / sizeof *keys; ++i)
        what = same_text(a, b, keys[i].key) ? NULL : keys[i].what;
    if (x->part.tiles != y->part.tiles || x->part.sets != y->part.sets)
        what = "numbers of parts";
    if (x->width != y->width || x->height != y->height || x->samples != y->samples)
        what = "sizes or samples";
    if (!what)
        return WHIT_OK;
    return CLI_FAIL(WHIT_ERROR_INPUT, "%s and %s are of different %s: not parts of one picture",
                    a->path, b->path, what);
}

static int compare_parts(const void *a, const void *b)
{
    const struct part *x = &((const struct merge_part *)a)->place.part,
                      *y = &((const struct merge_part *)b)->place.part;
    return x->tile != y->tile ? (x->tile < y->tile ? -1 : 1)
                              : (int)(x->set > y->set) - (int)(x->set < y->set);
}

/* Checks that no part of the picture is missing: `parts` are sorted, so each has to be the next
   one. */
static whit_result check_whole(struct merge *merge, uint32_t sets)
{
    enum { SHOWN = 8 };
    uint32_t missing = 0;
    char list[SHOWN * 64 + 64] = "", name[64];
    const struct part *given = &merge->parts[0].place.part;
    for (uint32_t i = 0, at = 0; i < merge->tiles * sets; ++i) {
        struct part wanted = *given;
        wanted.tile = given->tiles ? i / sets + 1 : 0;
        wanted.set = given->sets ? i % sets + 1 : 0;
        const struct part *here = at < merge->count ? &merge->parts[at].place.part : NULL;
        if (here && here->tile == wanted.tile && here->set == wanted.set)
            ++at;
        else if (missing++ < SHOWN)
            text_add(list, sizeof list, "%s%s", missing > 1 ? "; " : "", part_name(&wanted, name));
    }
    if (!missing)
        return WHIT_OK;
    if (missing > SHOWN)
        text_add(list, sizeof list, "; and %u more", missing - SHOWN);
    return CLI_FAIL(WHIT_ERROR_INPUT, "%u of %u parts are missing: %s", missing,
                    merge->tiles * sets, list);
}

/* Adds a part's counters. The error bound of the picture is the largest of its tiles; that of a
   tile is the mean of the bounds of its parts, as its pixels are means of theirs. */
static void add_counters(struct merge *merge, const struct merge_part *part, double *bounds)
{
    const char *line = text_of(part, "whit:counters");
    json_t *object = json_loads(line ? line : "", 0, NULL), *rays = json_object_get(object, "rays");
    whit_stats *stats = &merge->stats;
    stats->rays_primary += document_read_count(rays, "primary");
    stats->rays_shadow += document_read_count(rays, "shadow");
    stats->rays_reflected += document_read_count(rays, "reflected");
    stats->rays_refracted += document_read_count(rays, "refracted");
    stats->rays_straight += document_read_count(rays, "straight");
    stats->rays_by_functions += document_read_count(rays, "by_functions");
    stats->rays_cut_depth += document_read_count(rays, "cut_by_depth");
    stats->rays_cut_bailout += document_read_count(rays, "cut_by_bailout");
    double bound = document_read_number(object, "bailout_bound", -1.0);
    *bounds = bound >= 0.0 && *bounds >= 0.0 ? *bounds + bound / merge->sets : -1.0;
    json_decref(object);
}

static void sum_up(struct merge *merge, uint32_t sets)
{
    double largest = 0.0;
    for (uint32_t tile = 0; tile < merge->tiles; ++tile) {
        double bound = 0.0;
        for (uint32_t set = 0; set < sets; ++set)
            add_counters(merge, &merge->parts[tile * sets + set], &bound);
        largest = bound >= 0.0 && largest >= 0.0 ? fmax(largest, bound) : -1.0;
    }
    merge->stats.bailout_bound = largest;
}

/* Warns where parts were drawn on different devices, though the bytes may be the same. */
static void warn_of_devices(const struct merge *merge)
{
    for (uint32_t i = 1; i < merge->count; ++i) {
        const struct merge_part *a = &merge->parts[0], *b = &merge->parts[i];
        if (same_text(a, b, "whit:device") && same_text(a, b, "whit:driver"))
            continue;
        cli_warning("%s and %s were drawn on different devices: there may be a seam", a->path,
                    b->path);
        return;
    }
}

static whit_result load_part(const struct merge *merge, const struct merge_part *part,
                             whit_image **out)
{
    whit_image_info info;
    uint32_t first, rows;
    whit_result result = whit_image_load(part->path, merge->load, &cli_log, out);
    if (result != WHIT_OK)
        return result;
    whit_image_get_info(*out, &info);
    part_rows(&part->place.part, part->place.height, &first, &rows);
    bool fits = info.width == part->place.width && info.height == rows;
    if (fits && (info.integers || info.channels >= 3))
        return job_still_wanted();
    if (fits)
        cli_error("%s: colours have 3 channels, not %u", part->path, info.channels);
    else
        cli_error("%s: %u x %u pixels, where its part has %u x %u", part->path, info.width,
                  info.height, part->place.width, rows);
    whit_image_destroy(*out);
    *out = NULL;
    return WHIT_ERROR_INPUT;
}

static whit_result find_kind(struct merge *merge)
{
    whit_image *image = NULL;
    whit_image_info info = {0};
    whit_result result = load_part(merge, &merge->parts[0], &image);
    if (result == WHIT_OK)
        whit_image_get_info(image, &info);
    whit_image_destroy(image);
    merge->ids = info.integers;
    return result;
}

whit_result merge_check(struct merge *merge)
{
    const struct part *given = &merge->parts[0].place.part;
    whit_result result = WHIT_OK;
    for (uint32_t i = 1; result == WHIT_OK && i < merge->count; ++i)
        result = check_same(&merge->parts[0], &merge->parts[i]);
    if (result != WHIT_OK)
        return result;
    qsort(merge->parts, merge->count, sizeof *merge->parts, compare_parts);
    for (uint32_t i = 1; i < merge->count; ++i) {
        char name[64];
        const struct merge_part *a = &merge->parts[i - 1], *b = &merge->parts[i];
        if (compare_parts(a, b) != 0)
            continue;
        return CLI_FAIL(WHIT_ERROR_INPUT, "%s and %s are both %s", a->path, b->path,
                        part_name(&b->place.part, name));
    }
    merge->tiles = given->tiles ? given->tiles : 1;
    merge->sets = given->sets ? given->sets : 1;
    result = find_kind(merge);
    uint32_t sets = merge->ids ? 1 : merge->sets;
    if (result == WHIT_OK)
        result = check_whole(merge, sets);
    if (result != WHIT_OK)
        return result;
    sum_up(merge, sets);
    warn_of_devices(merge);
    return WHIT_OK;
}

/* ---- Pixels ---- */

static whit_result add_up(const struct merge_part *part, whit_image *image, const whit_image *other)
{
    whit_image_info a, b;
    whit_image_get_info(image, &a);
    whit_image_get_info(other, &b);
    if (a.channels != b.channels || a.integers || b.integers)
        return CLI_FAIL(WHIT_ERROR_INPUT, "%s: other channels than the parts before it",
                        part->path);
    float *sums = whit_image_edit(image);
    const float *more = whit_image_floats(other);
    for (size_t i = 0; i < (size_t)a.width * a.height; ++i) {
        for (size_t c = 0; c < 3; ++c)
            sums[i * a.channels + c] += more[i * a.channels + c];
    }
    return WHIT_OK;
}

/* Sums `count` parts in pairs and pairs of pairs, in the order in which resolve.comp adds
   samples. */
static whit_result sum_parts(const struct merge *merge, const struct merge_part *parts,
                             uint32_t count, whit_image **out)
{
    whit_image *other = NULL;
    if (count == 1)
        return load_part(merge, parts, out);
    whit_result result = sum_parts(merge, parts, count / 2, out);
    if (result == WHIT_OK)
        result = sum_parts(merge, parts + count / 2, count / 2, &other);
    if (result == WHIT_OK)
        result = add_up(parts + count / 2, *out, other);
    whit_image_destroy(other);
    return result;
}

static whit_result merge_tile(const struct merge *merge, uint32_t tile, whit_image **out)
{
    uint32_t sets = merge->ids ? 1 : merge->sets;
    const struct merge_part *parts = &merge->parts[tile * sets];
    *out = NULL;
    whit_result result = sum_parts(merge, parts, sets, out);
    whit_image_info info;
    if (result != WHIT_OK)
        return result;
    whit_image_get_info(*out, &info);
    if (info.integers != merge->ids)
        return CLI_FAIL(WHIT_ERROR_INPUT, "%s: %s, where parts before it hold %s", parts->path,
                        info.integers ? "hit identities" : "colours",
                        merge->ids ? "hit identities" : "colours");
    if (!info.integers && parts->place.part.sets)
        part_scale(1.0f / (float)parts->place.samples, *out);
    return WHIT_OK;
}

/* ---- The picture ---- */

/* Writes the recipe that a single run would have written into `texts`, which has room for that of
   the first part; gives the number of its texts. */
static uint32_t fill_texts(const struct merge *merge, const char *counters, whit_text *texts)
{
    const struct merge_part *first = &merge->parts[0];
    uint32_t count = 0;
    for (uint32_t i = 0; i < first->text_count; ++i) {
        whit_text text = first->texts[i];
        if (strcmp(text.key, "whit:counters") == 0)
            text.value = counters;
        if (strcmp(text.key, PART_KEY) != 0)
            texts[count++] = text;
    }
    return count;
}

static whit_result write_tiles(const struct merge *merge, const char *output,
                               const whit_text *texts, uint32_t text_count,
                               struct cli_progress *progress)
{
    whit_image_strips *strips = NULL;
    whit_result result = WHIT_OK;
    for (uint32_t tile = 0; result == WHIT_OK && tile < merge->tiles; ++tile) {
        whit_image *image;
        result = merge_tile(merge, tile, &image);
        if (result == WHIT_OK && !strips)
            result = whit_image_strips_begin(output, image, merge->parts[0].place.height, texts,
                                             text_count, &cli_log, &strips);
        if (result == WHIT_OK)
            result = whit_image_strips_add(strips, image);
        whit_image_destroy(image);
        cli_progress_update(progress, (tile + 1.0) / merge->tiles);
    }
    if (result != WHIT_OK) {
        whit_image_strips_abandon(strips);
        return result;
    }
    cli_set_saving();
    return whit_image_strips_commit(strips);
}

whit_result merge_write(const struct merge *merge, const char *output,
                        struct cli_progress *progress)
{
    whit_text *texts = calloc(merge->parts[0].text_count + 1, sizeof *texts);
    if (!texts)
        return cli_no_memory();
    char *counters = recipe_counters(&merge->stats);
    uint32_t text_count = fill_texts(merge, counters, texts);
    whit_result result = write_tiles(merge, output, texts, text_count, progress);
    free(texts);
    free(counters);
    return result;
}
