/* Reads and writes the names of tree builders: binned[:K], median, sweep, spatial[:ALPHA[,BUDGET]],
   each optionally with `+opt`; and none. */
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "settings/settings.h"

enum { TEXT_MAX = 100 };

static bool refuse(const char *text, char *why)
{
    char list[80];
    return setting_refuse(why, " `%s`: one of %s is needed, with +opt behind it or not", text,
                          value_list(values_build, ", ", list, sizeof list));
}

/* Reads a number that ends at the end of the text, or, where `rest` is not NULL, at a comma. */
static bool read_number(const char *text, double min, double max, double *out, const char **rest)
{
    char *end;
    *out = strtod(text, &end);
    if (end == text || isspace((unsigned char)text[0]) || !(*out >= min && *out <= max))
        return false;
    if (*end == ',' && rest)
        *rest = end + 1;
    else if (*end)
        return false;
    return true;
}

static bool read_bins(const char *text, const char *bins, whit_accel_params *out, char *why)
{
    const char *rest = text_number(bins, 256, &out->bins);
    return (rest && !*rest && out->bins >= 2) ||
           setting_refuse(why, " `%s`: a whole number of bins from 2 to 256 is needed", text);
}

static bool read_spatial(const char *text, const char *numbers, whit_accel_params *out, char *why)
{
    const char *rest = NULL;
    double alpha, budget;
    if (!read_number(numbers, 1e-12, 1.0, &alpha, &rest))
        return setting_refuse(why, " `%s`: spatial:ALPHA[,BUDGET] needs an overlap from 1e-12 to 1",
                              text);
    out->spatial_alpha = (float)alpha;
    if (!rest)
        return true;
    if (!read_number(rest, 0.0, 16.0, &budget, NULL))
        return setting_refuse(
            why, " `%s`: spatial:ALPHA,BUDGET needs a share of triangles from 0 to 16", text);
    out->spatial_budget = budget > 0.0 ? (float)budget : -1.0f;
    return true;
}

static bool read_numbers(const char *text, const char *numbers, whit_accel_params *out, char *why)
{
    if (out->build == WHIT_BUILD_BINNED)
        return read_bins(text, numbers, out, why);
    if (out->build == WHIT_BUILD_SPATIAL)
        return read_spatial(text, numbers, out, why);
    return setting_refuse(why, " `%s`: only binned and spatial take numbers", text);
}

bool builder_read(const char *text, whit_accel_params *trees, char why[SETTING_WHY_BYTES])
{
    static const char suffix[] = "+opt";
    char word[TEXT_MAX];
    size_t length = strlen(text);
    whit_accel_params out = *trees;
    out.optimize = false;
    out.bins = 0;
    out.spatial_alpha = out.spatial_budget = 0.0f;
    if (length >= sizeof word)
        return refuse(text, why);
    memcpy(word, text, length + 1);
    if (length >= sizeof suffix && strcmp(word + length + 1 - sizeof suffix, suffix) == 0) {
        out.optimize = true;
        word[length + 1 - sizeof suffix] = 0;
    }
    char *numbers = strchr(word, ':');
    if (numbers)
        *numbers++ = 0;
    if (strcmp(word, "sweep-naive") == 0)
        return setting_refuse(why, " `%s` is gone: `--build sweep` builds the same tree", text);
    uint32_t found = value_find(values_build, word);
    if (found == WHIT_NONE)
        return refuse(text, why);
    out.build = (whit_build)values_build[found].value;
    if (out.build == WHIT_BUILD_NONE && out.optimize)
        return setting_refuse(why, " `%s`: without trees there is nothing to improve", text);
    if (numbers && !read_numbers(text, numbers, &out, why))
        return false;
    *trees = out;
    return true;
}

void builder_write(const whit_accel_params *trees, char *text, size_t text_bytes)
{
    const char *word = value_word(values_build, (int)trees->build);
    char alpha[32], budget[32], numbers[80] = "";
    setting_write_float(trees->spatial_alpha, alpha, sizeof alpha);
    setting_write_float(trees->spatial_budget < 0.0f ? 0.0f : trees->spatial_budget, budget,
                        sizeof budget);
    if (trees->bins)
        snprintf(numbers, sizeof numbers, ":%u", trees->bins);
    else if (trees->spatial_alpha != 0.0f && trees->spatial_budget != 0.0f)
        snprintf(numbers, sizeof numbers, ":%s,%s", alpha, budget);
    else if (trees->spatial_alpha != 0.0f)
        snprintf(numbers, sizeof numbers, ":%s", alpha);
    snprintf(text, text_bytes, "%s%s%s", word, numbers, trees->optimize ? "+opt" : "");
}
