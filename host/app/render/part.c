#include "app/render/part.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "app/arguments.h"
#include "app/render/recipe.h"
#include "app/render/render_command.h"
#include "base/array.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/path.h"
#include "base/text.h"
#include "whit/whit_program.h"

/* ---- Options ---- */

bool part_is_given(const struct part *part)
{
    return part->tiles || part->sets;
}

static bool read_share(const char *value, uint32_t *index, uint32_t *count, char *why)
{
    const char *text = text_number(value, UINT16_MAX, index);
    text = text && *text == '/' ? text_number(text + 1, UINT16_MAX, count) : NULL;
    if (text && !*text && *index >= 1 && *index <= *count)
        return true;
    *count = 0;
    return setting_refuse(why, " `%s`: I/N is needed, part I of N, such as 2/4", value);
}

bool part_read_tile(const struct setting *setting, const char *value, void *request,
                    char why[SETTING_WHY_BYTES])
{
    struct part *part = &((struct render_request *)request)->part;
    (void)setting;
    if (value[0] && value[strspn(value, "0123456789")] == '\0')
        return setting_refuse(why,
                              " `%s`: I/N is needed, such as 2/4; the size of tiles is "
                              "`--tile-size` now",
                              value);
    return read_share(value, &part->tile, &part->tiles, why);
}

bool part_read_samples(const struct setting *setting, const char *value, void *request,
                       char why[SETTING_WHY_BYTES])
{
    struct part *part = &((struct render_request *)request)->part;
    (void)setting;
    return read_share(value, &part->set, &part->sets, why);
}

static bool is_power_of_2(uint32_t n)
{
    return n && (n & (n - 1)) == 0;
}

/* Kernels add samples in pairs. The sum over parts has the same bits as that of one run only where
   each part is an aligned block of the sequence whose size is a power of 2. */
static bool check_samples(struct cli_reader *reader, const struct settings *settings,
                          const struct render_request *request)
{
    const struct part *part = &request->part;
    uint32_t samples = settings->picture.sampling.count ? settings->picture.sampling.count : 1;
    if (!is_power_of_2(part->sets) || !(part->sets & 0x55555555u) || samples % part->sets ||
        !is_power_of_2(samples))
        return cli_misuse(reader,
                          "--samples-part %u/%u: N has to be a power of 4, such as 4 or 16, that "
                          "divides the samples of --aa, a power of 2; these are %u",
                          part->set, part->sets, samples);
    if (path_is(request->output, "png"))
        return cli_misuse(reader, "%s: sums of samples need .exr or .pfm", request->output);
    if (settings->aov[0])
        return cli_misuse(reader, "--samples-part and --aov: sums are kept of colours alone");
    if (request->ids && part->set > 1)
        return cli_misuse(reader,
                          "--ids: hit identities are those of the first sample, which "
                          "--samples-part 1/%u has",
                          part->sets);
    return true;
}

/* The most tiles that a picture of `height` rows can be cut into. */
static uint32_t tiles_max(uint32_t height)
{
    return (height + WHIT_STRIP_ROWS - 1) / WHIT_STRIP_ROWS;
}

bool part_check(struct cli_reader *reader, const struct job *job,
                const struct render_request *request)
{
    const struct part *part = &request->part;
    const struct settings *settings = &job->settings;
    if (!part_is_given(part))
        return true;
    const char *option = part->tiles ? "tile" : "samples-part";
    const char *other = render_asks(settings, request, "--aa adaptive", "--thumbnail");
    if (other)
        return cli_misuse(reader, "--%s and %s: only the whole picture can tell", option, other);
    uint32_t max = tiles_max(settings->picture.height);
    if (part->tiles > max)
        return cli_misuse(reader, "--tile %u/%u: a picture of %u rows has no more than %u tiles",
                          part->tile, part->tiles, settings->picture.height, max);
    return !part->sets || !request->output || check_samples(reader, settings, request);
}

bool part_check_shader(const struct job *job, const struct render_request *request)
{
    const whit_shader_info info = job_shader_info(job->shader);
    if (!part_is_given(&request->part))
        return true;
    const char *what = NULL;
    if (info.aov_count && path_is(request->output, "exr") && !job->settings.aov[0])
        what = "its `//@ aov` images are kept beside the colours of whole pictures alone; .pfm and "
               ".png are without them, and --aov NAME is one of them";
    if (request->part.sets && (info.hooks >> WHIT_HOOK_POST & 1))
        what = "what its `post` makes of a part of the samples is no part of what it makes of all";
    if (what)
        cli_error("%s: with --%s: %s", job->settings.shader,
                  request->part.sets ? "samples-part" : "tile", what);
    return !what;
}

/* ---- Place ---- */

void part_rows(const struct part *part, uint32_t height, uint32_t *first, uint32_t *count)
{
    uint64_t strips = tiles_max(height), tiles = part->tiles ? part->tiles : 1;
    uint32_t before = part->tiles ? part->tile - 1 : 0;
    uint64_t end = strips * (before + 1) / tiles * WHIT_STRIP_ROWS;
    *first = (uint32_t)(strips * before / tiles * WHIT_STRIP_ROWS);
    *count = (uint32_t)(end < height ? end : height) - *first;
}

void part_take(const struct part *part, whit_renderer_params *params)
{
    if (part->tiles)
        part_rows(part, params->height, &params->first_row, &params->row_count);
    if (part->sets) {
        uint32_t samples = params->sampling.count ? params->sampling.count : 1;
        params->sampling.count = samples / part->sets;
        params->sampling.first = params->sampling.count * (part->set - 1);
    }
}

const char *part_name(const struct part *part, char text[64])
{
    text[0] = '\0';
    if (part->tiles)
        text_add(text, 64, "tile %u/%u", part->tile, part->tiles);
    if (part->sets)
        text_add(text, 64, "%ssamples %u/%u", text[0] ? ", " : "", part->set, part->sets);
    return text;
}

void part_scale(float factor, whit_image *image)
{
    whit_image_info info;
    whit_image_get_info(image, &info);
    float *floats = whit_image_edit(image);
    for (size_t i = 0; i < (size_t)info.width * info.height; ++i) {
        for (size_t c = 0; c < 3; ++c)
            floats[i * info.channels + c] *= factor;
    }
}

/* ---- Recipes ---- */

json_t *part_document(const struct part *part, const struct settings *settings)
{
    uint32_t samples = settings->picture.sampling.count, first, rows;
    part_rows(part, settings->picture.height, &first, &rows);
    json_t *object = document_object();
    document_count(object, "tile", part->tile);
    document_count(object, "tiles", part->tiles);
    document_count(object, "samples_part", part->set);
    document_count(object, "samples_parts", part->sets);
    document_count(object, "first_row", first);
    document_count(object, "rows", rows);
    document_count(object, "width", settings->picture.width);
    document_count(object, "height", settings->picture.height);
    document_count(object, "samples", samples ? samples : 1);
    return object;
}

static uint32_t get_count(const json_t *object, const char *key)
{
    const json_t *value = json_object_get(object, key);
    json_int_t number = json_is_integer(value) ? json_integer_value(value) : -1;
    return number >= 0 && number <= UINT16_MAX ? (uint32_t)number : UINT32_MAX;
}

static bool is_share(uint32_t index, uint32_t count)
{
    return count <= UINT16_MAX && (count ? index >= 1 && index <= count : index == 0);
}

bool part_of_line(const char *line, struct part_place *place)
{
    json_t *object = json_loads(line, 0, NULL);
    struct part *part = &place->part;
    *place = (struct part_place){.part = {.tile = get_count(object, "tile"),
                                          .tiles = get_count(object, "tiles"),
                                          .set = get_count(object, "samples_part"),
                                          .sets = get_count(object, "samples_parts")},
                                 .width = get_count(object, "width"),
                                 .height = get_count(object, "height"),
                                 .samples = get_count(object, "samples")};
    json_decref(object);
    return is_share(part->tile, part->tiles) && is_share(part->set, part->sets) &&
           place->width - 1 < UINT16_MAX && place->height - 1 < UINT16_MAX &&
           part->tiles <= tiles_max(place->height) && is_power_of_2(part->sets ? part->sets : 1) &&
           place->samples - 1 < WHIT_SAMPLES_MAX &&
           (!part->sets || (place->samples % part->sets == 0 && is_power_of_2(place->samples)));
}

static char *beside(const char *path)
{
    char *name = string_format("%s.part", path);
    if (!name)
        cli_error("out of memory");
    return name;
}

static whit_result hash_file(const char *path, char hash[17])
{
    uint8_t *data;
    size_t bytes;
    whit_result result = file_read(&cli_log, NULL, path, 0, &data, &bytes);
    if (result != WHIT_OK)
        return result;
    snprintf(hash, 17, "%016" PRIx64, hash_bytes(HASH_START, data, bytes));
    free(data);
    return WHIT_OK;
}

#define HASH_KEY "file_hash"

whit_result part_save_beside(const char *path, const struct recipe *recipe)
{
    char hash[17], *name = beside(path);
    whit_result result = name ? hash_file(path, hash) : WHIT_ERROR_MEMORY;
    if (result == WHIT_OK) {
        json_t *object = document_object();
        for (uint32_t i = 0; i < recipe->count; ++i)
            document_text(object, recipe->texts[i].key, recipe->texts[i].value);
        document_text(object, HASH_KEY, hash);
        result = document_save(object, name);
    }
    free(name);
    return result;
}

/* Gives all strings of the object as a list of texts, in one block. */
static whit_text *texts_of_object(json_t *object, uint32_t *count)
{
    const char *key;
    json_t *value;
    size_t bytes = 0, n = json_object_size(object), i = 0;
    json_object_foreach(object, key, value) bytes += strlen(key) + json_string_length(value) + 2;
    whit_text *texts = malloc(n * sizeof *texts + bytes + 1);
    char *at = texts ? (char *)(texts + n) : NULL;
    if (!texts)
        cli_error("out of memory");
    else
        json_object_foreach(object, key, value)
        {
            const char *text = json_is_string(value) ? json_string_value(value) : "";
            texts[i] = (whit_text){.key = at, .value = at + strlen(key) + 1};
            at += sprintf(at, "%s", key) + 1;
            at += sprintf(at, "%s", text) + 1;
            ++i;
        }
    *count = (uint32_t)n;
    return texts;
}

static whit_result load_beside(const char *path, whit_text **texts, uint32_t *count)
{
    enum { RECIPE_BYTES_MAX = 64 << 20 };
    char hash[17], *name = beside(path);
    uint8_t *data = NULL;
    size_t bytes = 0;
    whit_result result =
        name ? file_read(&cli_log, NULL, name, RECIPE_BYTES_MAX, &data, &bytes) : WHIT_ERROR_MEMORY;
    json_t *object = result == WHIT_OK ? json_loadb((const char *)data, bytes, 0, NULL) : NULL;
    const char *kept = json_string_value(json_object_get(object, HASH_KEY));
    if (result == WHIT_OK)
        result = hash_file(path, hash);
    if (result == WHIT_OK && (!kept || strcmp(kept, hash) != 0)) {
        cli_error("%s: not the recipe of %s as it is", name, path);
        result = WHIT_ERROR_INPUT;
    }
    if (result == WHIT_OK && !(*texts = texts_of_object(object, count)))
        result = WHIT_ERROR_MEMORY;
    json_decref(object);
    free(data);
    free(name);
    return result;
}

whit_result part_load_texts(const char *path, const whit_load_params *params, whit_text **texts,
                            uint32_t *count)
{
    *texts = NULL;
    return path_is(path, "pfm") ? load_beside(path, texts, count)
                                : whit_image_load_texts(path, params, &cli_log, texts, count);
}
