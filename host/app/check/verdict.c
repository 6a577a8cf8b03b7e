#include "app/check/verdict.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "settings/values.h"

/* Most parts that a line names; the rest is only counted. */
enum { PARTS_NAMED = 4 };

const char *verdict_word(enum check_verdict verdict)
{
    static const char *const words[CHECK_VERDICTS] = {
        [CHECK_NOT_RUN] = "not run",   [CHECK_OK] = "ok",           [CHECK_SAME] = "same",
        [CHECK_ACCEPTED] = "accepted", [CHECK_DIFFERS] = "differs", [CHECK_UNMET] = "unmet",
        [CHECK_VACUOUS] = "refused",   [CHECK_NEW] = "new",         [CHECK_BROKEN] = "broken",
        [CHECK_UNDRAWN] = "undrawn",
    };
    return words[verdict];
}

void verdict_set(struct check_result *result, enum check_verdict verdict, char *text)
{
    free(result->text);
    result->verdict = verdict;
    result->text = text;
}

void verdict_add(struct check_result *result, enum check_verdict verdict, char *text)
{
    bool said = result->verdict >= CHECK_NEW;
    char *both = said && result->text && text ? string_format("%s; %s", result->text, text) : NULL;
    if (said)
        free(text);
    verdict_set(result, verdict > result->verdict || !said ? verdict : result->verdict,
                said ? both : text);
}

void verdict_finish(struct check_result *result)
{
    free(result->text);
    free(result->cause);
    whit_image_destroy(result->before);
    free(result->changed);
    golden_finish(&result->found);
    check_pictures_finish(&result->pictures);
    *result = (struct check_result){.item = result->item};
}

/* ---- What it is made of ---- */

/* `shader`: file of the case's functions, which the message names in place of their key, since a
   key names the scene; "": there is none. */
static void put_part(FILE *to, uint32_t *count, const char *key, const char *shader,
                     const char *what)
{
    static const char functions[] = "functions of ";
    char shown[SETTING_VALUE_BYTES];
    if (++*count > PARTS_NAMED)
        return;
    fputs(*count > 1 ? ", " : "", to);
    if (shader[0] && strncmp(key, functions, strlen(functions)) == 0)
        fprintf(to, "%s%s%s", functions, whit_text_show(shader, shown, sizeof shown), what);
    else
        fprintf(to, "%s%s", key, what);
}

/* Whether the old case has a part with that key, whatever its content. */
static bool knows_key(const struct golden *golden, const struct golden_case *old, const char *key)
{
    for (uint32_t i = 0; i < golden->part_count; ++i) {
        const struct golden_part *part = &golden->parts[i];
        if (strcmp(part->key, key) == 0 && golden_case_has_part(old, part->hash))
            return true;
    }
    return false;
}

/* Writes the parts of a scene that changed, are new or are gone, and returns how many. */
static uint32_t put_changed_parts(FILE *to, const struct golden *golden,
                                  const struct golden_case *old, const struct golden *found,
                                  const char *shader)
{
    const struct golden_case *now = &found->cases[0];
    uint32_t count = 0;
    for (uint32_t i = 0; i < found->part_count; ++i) {
        const struct golden_part *part = &found->parts[i];
        if (!golden_case_has_part(old, part->hash))
            put_part(to, &count, part->key, shader,
                     knows_key(golden, old, part->key) ? "" : " (new)");
    }
    for (uint32_t i = 0; i < old->part_count; ++i) {
        const char *key = golden_part_key(golden, old->parts[i]);
        if (!golden_case_has_part(now, old->parts[i]) && key && !knows_key(found, now, key))
            put_part(to, &count, key, "", " (gone)");
    }
    if (count > PARTS_NAMED)
        fprintf(to, " and %u more", count - PARTS_NAMED);
    return count;
}

/* Describes the parts and options that changed; *text NULL: none did. False: out of memory. */
static bool find_changed(const struct golden *golden, const struct golden_case *old,
                         const struct golden *found, const char *shader, char **text)
{
    const struct golden_case *now = &found->cases[0];
    size_t size;
    *text = NULL;
    FILE *to = open_memstream(text, &size);
    if (!to)
        return false;
    bool options = strcmp(old->made_by, now->made_by) != 0;
    uint32_t count = put_changed_parts(to, golden, old, found, shader);
    if (options)
        fprintf(to, "%s`%s`, was `%s`", count ? ", " : "", now->made_by, old->made_by);
    if (fclose(to) != 0)
        return false;
    if (!options && !count) {
        free(*text);
        *text = NULL;
    }
    return true;
}

/* ---- How pictures differ ---- */

static void put_rays(FILE *to, const struct golden_case *old, const struct golden_case *now)
{
    const char *before = "; rays: ";
    for (int kind = 0; kind < WHIT_RAY_KINDS; ++kind) {
        if (old->rays[kind] == now->rays[kind])
            continue;
        fprintf(to, "%s%" PRIu64 " %s, were %" PRIu64, before, now->rays[kind],
                value_word(values_rays, kind), old->rays[kind]);
        before = ", ";
    }
}

static void put_mean(FILE *to, const struct golden_case *old, const struct golden_case *now)
{
    char was[80], is[80];
    snprintf(was, sizeof was, "%.5g %.5g %.5g", old->mean[0], old->mean[1], old->mean[2]);
    snprintf(is, sizeof is, "%.5g %.5g %.5g", now->mean[0], now->mean[1], now->mean[2]);
    if (strcmp(was, is) != 0)
        fprintf(to, "; mean colour %s, was %s", is, was);
}

static bool differs(const struct golden_case *old, const struct golden_case *now)
{
    return old->ids != now->ids || old->colors != now->colors || old->width != now->width ||
           old->height != now->height;
}

static void put_difference(FILE *to, const struct golden_case *old, const struct golden_case *now)
{
    bool ids = old->ids != now->ids, colors = old->colors != now->colors;
    if (old->width != now->width || old->height != now->height)
        fprintf(to, "%u x %u pixels, were %u x %u", now->width, now->height, old->width,
                old->height);
    else
        fputs(ids && colors ? "colours other, and what pixels hit"
              : ids         ? "what pixels hit is other, with the same colours"
                            : "colours other, of the same hits",
              to);
    put_rays(to, old, now);
    put_mean(to, old, now);
}

/* ---- The verdict ---- */

static char *text_of(enum check_verdict verdict, const struct golden_case *old,
                     const struct golden_case *now, const char *changed)
{
    static const char *const beginnings[] = {[CHECK_OK] = "ok",
                                             [CHECK_SAME] = "input changed, picture same",
                                             [CHECK_NEW] = "no golden",
                                             [CHECK_DIFFERS] = "differs: "};
    char *text = NULL;
    size_t size;
    FILE *to = open_memstream(&text, &size);
    if (!to)
        return NULL;
    fputs(beginnings[verdict], to);
    if (verdict == CHECK_DIFFERS)
        put_difference(to, old, now);
    else if (old)
        put_rays(to, old, now);
    if (changed)
        fprintf(to, "%s%s", verdict == CHECK_DIFFERS ? "; input changed: " : ": ", changed);
    return fclose(to) == 0 ? text : NULL;
}

bool verdict_find(struct check_result *result, const struct golden *golden)
{
    const struct golden_case *now = &result->found.cases[0];
    const struct golden_case *old = golden_find(golden, now->name);
    if (old && !find_changed(golden, old, &result->found, result->item->settings->shader,
                             &result->changed))
        return false;
    enum check_verdict verdict = !old                ? CHECK_NEW
                                 : differs(old, now) ? CHECK_DIFFERS
                                 : result->changed   ? CHECK_SAME
                                                     : CHECK_OK;
    verdict_set(result, verdict, text_of(verdict, old, now, result->changed));
    return result->text != NULL;
}

/* Exit codes in order: wrong input is worse than a difference, and a difference is worse than a
   missing golden. */
int verdict_exit(const struct check_result *result, int worst)
{
    static const int rank[] = {
        [EXIT_FINE] = 0, [EXIT_MISSING] = 1, [EXIT_DIFFERS] = 2, [EXIT_USAGE] = 3};
    int code = EXIT_FINE;
    if (result->verdict == CHECK_NEW)
        code = EXIT_MISSING;
    else if (result->verdict == CHECK_BROKEN)
        code = result->error == WHIT_ERROR_FAILED || result->error == WHIT_ERROR_STATUS
                   ? EXIT_DIFFERS
                   : EXIT_USAGE;
    else if (result->verdict >= CHECK_DIFFERS)
        code = EXIT_DIFFERS;
    return rank[code] > rank[worst] ? code : worst;
}
