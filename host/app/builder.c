/* Names of tree builders: binned[:K], median, sweep, spatial[:ALPHA[,BUDGET]], each
   with `+opt`. */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "app/job.h"

enum { TEXT_MAX = 100 };

static bool refuse(struct cli_reader *reader, const char *text)
{
    char list[80];
    return cli_misuse(reader, "--%s `%s`: one of %s is needed, with +opt behind it or not",
                      reader->option->name, text,
                      value_list(values_build, ", ", list, sizeof list));
}

/* A number that ends at the end of the text, or at a comma when `*rest` is wanted. */
static bool read_number(const char *text, double least, double most, double *out, const char **rest)
{
    char *end;
    *out = strtod(text, &end);
    if (end == text || isspace((unsigned char)text[0]) || !(*out >= least && *out <= most))
        return false;
    if (*end == ',' && rest)
        *rest = end + 1;
    else if (*end)
        return false;
    return true;
}

static bool read_bins(struct cli_reader *reader, const char *text, const char *bins,
                      struct job_build *out)
{
    char *end;
    unsigned long count = strtoul(bins, &end, 10);
    if (!isdigit((unsigned char)bins[0]) || *end || count < 2 || count > 256)
        return cli_misuse(reader, "--%s `%s`: a whole number of bins from 2 to 256 is needed",
                          reader->option->name, text);
    out->bins = (uint32_t)count;
    return true;
}

static bool read_spatial(struct cli_reader *reader, const char *text, const char *numbers,
                         struct job_build *out)
{
    const char *rest = NULL;
    double alpha, budget;
    if (!read_number(numbers, 1e-12, 1.0, &alpha, &rest))
        return cli_misuse(reader,
                          "--%s `%s`: spatial:ALPHA[,BUDGET] needs an overlap from 1e-12 to 1",
                          reader->option->name, text);
    out->alpha = (float)alpha;
    if (!rest)
        return true;
    if (!read_number(rest, 0.0, 16.0, &budget, NULL))
        return cli_misuse(reader,
                          "--%s `%s`: spatial:ALPHA,BUDGET needs a share of triangles from 0 to 16",
                          reader->option->name, text);
    out->budget = budget > 0.0 ? (float)budget : -1.0f;
    return true;
}

static bool read_numbers(struct cli_reader *reader, const char *text, const char *numbers,
                         struct job_build *out)
{
    if (out->build == WHIT_BUILD_BINNED)
        return read_bins(reader, text, numbers, out);
    if (out->build == WHIT_BUILD_SPATIAL)
        return read_spatial(reader, text, numbers, out);
    return cli_misuse(reader, "--%s `%s`: only binned and spatial take numbers",
                      reader->option->name, text);
}

bool job_read_build(struct cli_reader *reader, const char *text, struct job_build *out)
{
    static const char suffix[] = "+opt";
    char word[TEXT_MAX];
    size_t length = strlen(text);
    *out = (struct job_build){0};
    if (length >= sizeof word)
        return refuse(reader, text);
    memcpy(word, text, length + 1);
    if (length >= sizeof suffix && strcmp(word + length + 1 - sizeof suffix, suffix) == 0) {
        out->optimize = true;
        word[length + 1 - sizeof suffix] = 0;
    }
    char *numbers = strchr(word, ':');
    if (numbers)
        *numbers++ = 0;
    uint32_t found = value_find(values_build, word);
    if (found == WHIT_NONE)
        return refuse(reader, text);
    out->build = (whit_build)values_build[found].value;
    return !numbers || read_numbers(reader, text, numbers, out);
}

void job_build_name(const struct job_build *build, char name[JOB_BUILD_NAME])
{
    const char *word =
        build->build == WHIT_BUILD_NONE ? "none" : value_word(values_build, (int)build->build);
    char numbers[64] = "";
    if (build->bins)
        snprintf(numbers, sizeof numbers, ":%u", build->bins);
    else if (build->alpha != 0.0f && build->budget != 0.0f)
        snprintf(numbers, sizeof numbers, ":%g,%g", (double)build->alpha,
                 build->budget < 0.0f ? 0.0 : (double)build->budget);
    else if (build->alpha != 0.0f)
        snprintf(numbers, sizeof numbers, ":%g", (double)build->alpha);
    snprintf(name, JOB_BUILD_NAME, "%s%s%s", word, numbers, build->optimize ? "+opt" : "");
}
