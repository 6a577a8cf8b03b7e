/* --accept and --prune: both write the golden of a suite. */
#include <string.h>

#include "app/check/thumbnails.h"
#include "app/document.h"
#include "base/array.h"

static bool can_accept(const struct check_result *result)
{
    return result->verdict == CHECK_OK || result->verdict == CHECK_SAME ||
           result->verdict == CHECK_DIFFERS || result->verdict == CHECK_NEW;
}

/* Checks that --reason is given where a case that the golden has is to be replaced: the golden
   keeps the reason. */
static bool check_reason(const struct check *check)
{
    uint32_t other = 0;
    for (uint32_t i = 0; i < check->suite.count; ++i)
        other += check->results[i].verdict == CHECK_DIFFERS;
    if (!other || check->reason)
        return true;
    return CLI_FAIL(false,
                    "%u case%s other than the golden: say why they are to be so: --reason TEXT",
                    other, other == 1 ? " is" : "s are");
}

static bool put_parts(struct golden *golden, const struct golden *found)
{
    for (uint32_t i = 0; i < found->part_count; ++i) {
        if (!golden_put_part(golden, found->parts[i].key, found->parts[i].hash))
            return false;
    }
    return true;
}

/* A case whose picture did not change keeps the reason for which it was accepted. */
static bool put_case(struct check *check, const struct check_result *result)
{
    struct golden_case item = result->found.cases[0];
    const struct golden_case *old = golden_find(&check->old, item.name);
    char shown[4 * GOLDEN_REASON_MAX + 1];
    bool is_new = result->verdict == CHECK_DIFFERS || result->verdict == CHECK_NEW;
    item.reason = old ? old->reason : NULL;
    if (is_new)
        item.reason = check->reason ? whit_text_show(check->reason, shown, sizeof shown) : NULL;
    return golden_put(&check->golden, &item) && put_parts(&check->golden, &result->found);
}

/* Marks a case of the saved golden as accepted, and saves its thumbnail. A thumbnail of a former
   picture is removed. False: the new one could not be saved. */
static bool note_accepted(struct check *check, struct check_result *result)
{
    bool other = result->verdict == CHECK_DIFFERS || result->verdict == CHECK_NEW;
    if (other)
        check_drop_thumbnail(check, result->item->name);
    if (other || result->verdict == CHECK_SAME)
        verdict_set(result, CHECK_ACCEPTED, string_format("accepted: %s", result->text));
    return !check->thumbnails || check_save_thumbnail(check, result) == WHIT_OK;
}

/* Removes the cases that the suite does not have. */
static void drop_cases(struct golden *golden, const struct suite *suite)
{
    for (uint32_t i = golden->count; i-- > 0;) {
        if (!suite_find(suite, golden->cases[i].name))
            golden_remove(golden, i);
    }
}

/* Says which cases the saved golden no longer has, and removes their thumbnails. */
static void say_dropped(const struct check *check)
{
    for (uint32_t i = 0; i < check->old.count; ++i) {
        const char *name = check->old.cases[i].name;
        if (golden_find(&check->golden, name))
            continue;
        fprintf(check_lines(check), "%s: dropped\n", name);
        check_drop_thumbnail(check, name);
    }
}

/* Gives the exit code. */
static int save_golden(struct check *check)
{
    golden_sort(&check->golden);
    if (check->prune)
        drop_cases(&check->golden, &check->suite);
    if (!check->old.exists && !check->golden.count)
        return EXIT_FINE; /* nothing was accepted, so there is no golden to begin */
    whit_result result = document_save_text(golden_text(&check->golden), check->golden_path);
    if (result != WHIT_OK)
        return cli_exit_of(result);
    say_dropped(check);
    if (!check->old.exists && !check->settings.quiet)
        cli_note("%s is new: with `*.golden merge=union` in .gitattributes git merges what two "
                 "people accept at one place",
                 check->golden_path);
    return cli_finish_stdout(EXIT_FINE);
}

int check_accept(struct check *check)
{
    if (!check_reason(check))
        return EXIT_USAGE;
    for (uint32_t i = 0; i < check->suite.count; ++i) {
        struct check_result *result = &check->results[i];
        if (can_accept(result) && !put_case(check, result))
            return cli_exit_of(cli_no_memory());
    }
    int saved = save_golden(check), noted = saved;
    for (uint32_t i = 0; saved == EXIT_FINE && i < check->suite.count; ++i) {
        struct check_result *result = &check->results[i];
        if (can_accept(result) && !note_accepted(check, result))
            noted = EXIT_USAGE;
    }
    return noted;
}
