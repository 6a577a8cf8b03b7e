/* A run of `whit check` as JSON, which --accept-from reads. */
#include <stdlib.h>

#include "app/check/check.h"
#include "app/document.h"
#include "settings/quote.h"

enum { COMMAND_BYTES = 16384 };

static void put_rays(json_t *out, const uint64_t rays[WHIT_RAY_KINDS])
{
    for (int kind = 0; kind < WHIT_RAY_KINDS; ++kind)
        document_count(out, value_word(values_rays, kind), rays[kind]);
}

/* Describes a case of a golden; null where there is none. */
static json_t *picture_document(const struct golden_case *item)
{
    if (!item)
        return json_null();
    json_t *out = document_object();
    document_hash(out, "ids", item->ids);
    document_hash(out, "colors", item->colors);
    document_count(out, "width", item->width);
    document_count(out, "height", item->height);
    put_rays(document_child(out, "rays"), item->rays);
    document_numbers(out, "mean", item->mean, 3);
    document_text(out, "made_by", item->made_by);
    document_text(out, "reason", item->reason);
    return out;
}

/* The command that checks one case again, for pictures of the reference, which `whit render` cannot
   draw. NULL: out of memory. */
static char *check_command(const struct check *check, const struct check_case *item)
{
    char *text = NULL;
    size_t size;
    FILE *to = open_memstream(&text, &size);
    if (!to)
        return NULL;
    fputs("whit check ", to);
    quote_print(check->suite.path, to);
    if (check->root) {
        fputs(" --root ", to);
        quote_print(check->root, to);
    }
    fprintf(to, " --on %s --only %s", golden_kind_word((enum golden_kind)check->on), item->name);
    return fclose(to) == 0 ? text : NULL;
}

/* Adds the command that draws the picture again. */
static void put_command(json_t *object, const struct check *check, const struct check_case *item)
{
    bool device = check->on == GOLDEN_OF_DEVICE;
    char *text = device ? malloc(COMMAND_BYTES) : check_command(check, item);
    char output[CHECK_NAME_MAX + 8];
    snprintf(output, sizeof output, "%s.png", item->name);
    if (text && device)
        settings_write_render(item->settings, SETTINGS_LINE, output, text, COMMAND_BYTES);
    document_text(object, "command", text);
    free(text);
}

static void put_case(json_t *out, const struct check *check, uint32_t index)
{
    const struct check_result *result = &check->results[index];
    const struct golden_case *found = result->found.count ? result->found.cases : NULL;
    char *lines = found ? golden_case_text(&result->found, found->name) : NULL;
    document_text(out, "name", result->item->name);
    document_count(out, "line", result->item->line);
    document_text(out, "verdict", verdict_word(result->verdict));
    document_text(out, "text", result->text);
    json_t *expects = document_list(out, "expects");
    for (uint32_t i = 0; i < result->item->expectation_count; ++i)
        document_append_text(expects, result->item->expectations[i].text);
    document_text(out, "changed", result->changed);
    document_text(out, "cause", result->cause);
    document_ms(out, "time_ms", result->time_ms);
    put_command(out, check, result->item);
    document_put(out, "is", picture_document(found));
    document_put(out, "was", picture_document(golden_find(&check->old, result->item->name)));
    document_text(out, "golden", lines);
    free(lines);
}

json_t *check_document(const struct check *check, int status)
{
    json_t *root = document_root();
    document_text(root, "suite", check->suite.path);
    document_text(root, "on", golden_kind_word((enum golden_kind)check->on));
    document_text(root, "golden", check->golden_path);
    document_text(root, "golden_by", check->old.exists ? check->old.by : NULL);
    document_text(root, "device", check->device.name[0] ? check->device.name : NULL);
    document_text(root, "driver", check->device.driver[0] ? check->device.driver : NULL);
    document_count(root, "exit_code", (uint64_t)status);
    json_t *cases = document_list(root, "cases");
    for (uint32_t i = 0; i < check->suite.count; ++i) {
        if (check->results[i].verdict != CHECK_NOT_RUN)
            put_case(document_entry(cases), check, i);
    }
    return root;
}
