#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#include "app/arguments.h"
#include "app/check/describe.h"
#include "app/check/lanes.h"
#include "app/check/thumbnails.h"
#include "app/commands.h"
#include "app/document.h"
#include "base/array.h"
#include "base/file.h"
#include "base/lock.h"

/* Time to stop after a signal, before the run ends without its reports: a driver that compiles a
   kernel cannot be stopped. */
enum { GRACE_MS = 20000 };

/* ---- Options ---- */

static bool add_name(const char *value, struct check_names *names, char *why)
{
    if (!value[0] || names->count == CHECK_PATTERNS_MAX)
        return setting_refuse(why, " `%s`: names of up to %d cases are needed", value,
                              CHECK_PATTERNS_MAX);
    names->patterns[names->count++] = value;
    return true;
}

static bool read_name(const struct setting *setting, const char *value, void *record, char *why)
{
    return add_name(value, (struct check_names *)(void *)((char *)record + setting->offset), why);
}

static const struct setting_value values_on[] = {
    {"device", GOLDEN_OF_DEVICE, NULL}, {"reference", GOLDEN_OF_REFERENCE, NULL}, {0}};

static const struct setting options[] = {
    {"only", 0, "NAME", "those cases alone; * and ? stand for letters; may be given again",
     .kind = SETTING_OWN, .offset = offsetof(struct check, only), .read = read_name},
    {"list", 0, NULL, "print the names of the cases, and draw nothing",
     SETTING_AT_FLAG(struct check, list)},
    {"accept", 0, "NAME|all",
     "take what these cases show now into the golden; further\n"
     "names may follow behind SUITE",
     .kind = SETTING_OWN, .offset = offsetof(struct check, accept), .read = read_name},
    {"reason", 0, "TEXT", "with --accept: why pictures change; kept in the golden",
     SETTING_AT_NAME(struct check, reason)},
    {"accept-from", 0, "FOLDER|FILE",
     "the same with what a report of --json, or all in a folder,\n"
     "say that they show; nothing is drawn",
     SETTING_AT_NAME(struct check, accept_from)},
    {"on", 0, NULL,
     "what draws: Vulkan, or the reference in double on the CPU,\n"
     "which has goldens of its own, SUITE.reference.golden (device)",
     SETTING_AT_CHOICE(struct check, on), .values = values_on},
    {"json", 0, "FILE", "also write what came of each case as JSON",
     SETTING_AT_NAME(struct check, json), .written = true},
    {"junit", 0, "FILE", "the same as JUnit XML, which CI services show",
     SETTING_AT_NAME(struct check, junit), .written = true},
    {"report", 0, "FILE.html", "the same as one page with pictures, which opens offline",
     SETTING_AT_NAME(struct check, report), .written = true},
    {"thumbnails", 0, NULL,
     "with --accept: also keep small pictures beside the golden,\n"
     "for people: SUITE.thumbnails/NAME.png",
     SETTING_AT_FLAG(struct check, thumbnails)},
    {"prune", 0, NULL, "drop what the golden has of cases that the suite has not",
     SETTING_AT_FLAG(struct check, prune)},
    {"base", 0, "REVISION",
     "say of what differs why: draw it as that revision of git has\n"
     "it, and name the parts that give the old bytes when they are\n"
     "taken back",
     SETTING_AT_NAME(struct check, base)},
    {"power", 0, NULL,
     "print for each case the smallest change of a vertex, an ior, a\n"
     "light and a texel that it notices; nothing is compared",
     SETTING_AT_FLAG(struct check, power)},
    {"mutate", 0, "N",
     "put N faults into the suite's scenes, one after the other, and\n"
     "print how many were caught and their cause found",
     SETTING_AT_COUNT(struct check, mutate), .min = 1, .max = 100000},
    {"seed", 0, "N", "of --power and --mutate: another N draws other faults (0)",
     SETTING_AT_COUNT(struct check, seed), .max = UINT32_MAX},
    {"root", 0, "FOLDER", "what the suite's files lie below and are named from",
     "the suite's own folder", SETTING_AT_NAME(struct check, root)},
    {0},
};

bool check_names_match(const struct check_names *names, const char *name)
{
    for (uint32_t i = 0; i < names->count; ++i) {
        if (strcmp(names->patterns[i], "all") == 0 || suite_matches(names->patterns[i], name))
            return true;
    }
    return false;
}

static bool check_outputs(struct cli_reader *reader, const struct check *check)
{
    static const char *const hint = "for a pipe give /dev/stdout";
    const struct cli_file files[] = {{"the golden", check->golden_path, true},
                                     {"--accept-from", check->accept_from, false},
                                     {"--json", check->json, true},
                                     {"--junit", check->junit, true},
                                     {"--report", check->report, true}};
    return cli_check_apart(reader, files, sizeof files / sizeof *files) &&
           cli_check_output(reader, "--json", check->json, hint) &&
           cli_check_output(reader, "--junit", check->junit, hint) &&
           cli_check_output(reader, "--report", check->report, hint);
}

/* Refuses reports over files of the suite's cases; called when the suite was read. */
static bool check_inputs(struct cli_reader *reader, const struct check *check)
{
    bool reports = check->json || check->junit || check->report, apart = true;
    for (uint32_t i = 0; reports && apart && i < check->suite.count; ++i) {
        const struct settings *settings = check->suite.cases[i].settings;
        const char *environment = settings->environment, *shader = settings->shader;
        const struct cli_file files[] = {
            {"a scene of the suite", settings->scene, false},
            {"an environment of the suite", *environment ? environment : NULL, false},
            {"a shader of the suite", *shader ? shader : NULL, false},
            {"--json", check->json, true},
            {"--junit", check->junit, true},
            {"--report", check->report, true}};
        apart = cli_check_apart(reader, files, sizeof files / sizeof *files);
    }
    return apart;
}

/* Refuses to change a golden that cannot be written, or that another suite beside this one has
   too. */
static bool check_golden(struct cli_reader *reader, const struct check *check)
{
    if (!check->accept.count && !check->prune)
        return true;
    char *other = golden_other_suite(reader->positional);
    bool shared = other && file_exists(other);
    if (shared)
        cli_misuse(reader, "%s: %s has the same golden, %s: rename one of the suites",
                   reader->positional, other, check->golden_path);
    free(other);
    return !shared && cli_check_writable(reader, check->golden_path);
}

static bool is_folder(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && S_ISDIR(info.st_mode);
}

/* Refuses options that a run without verdicts would ignore. */
static bool check_alone(struct cli_reader *reader, const struct check *check)
{
    const char *report = check->json     ? "json"
                         : check->junit  ? "junit"
                         : check->report ? "report"
                                         : NULL;
    const char *mode = check->list     ? "list"
                       : check->power  ? "power"
                       : check->mutate ? "mutate"
                                       : NULL;
    if (mode && (check->accept.count || check->prune || report || (check->base && !check->list)))
        return cli_misuse(reader, "--%s compares nothing with a golden, and goes with --only alone",
                          mode);
    if (check->power + (check->mutate > 0) + check->list > 1)
        return cli_misuse(reader, "--list, --power and --mutate: one of them");
    if (check->seed && !check->power && !check->mutate)
        return cli_misuse(reader, "--seed is of the faults of --power and --mutate");
    if (check->accept_from && check->base)
        return cli_misuse(reader, "--accept-from draws nothing, and --base is for what is drawn");
    const char *other = check->base ? "base" : check->only.count ? "only" : report;
    return !check->prune || check->accept.count || !other ||
           cli_misuse(reader, "--prune alone draws nothing, and --%s is for what is drawn", other);
}

static bool check_request(struct cli_reader *reader, struct check *check)
{
    char why[SETTING_WHY_BYTES];
    if (!reader->positional)
        return cli_misuse(reader, "a suite is missing");
    if (check->accept_from && !check->accept.count)
        check->accept = (struct check_names){{"all"}, 1};
    if (check->root && !is_folder(check->root))
        return cli_misuse(reader, "--root %s: there is no such folder", check->root);
    if (reader->other_count && !check->accept.count)
        return cli_misuse(reader, "`%s` is one argument too many", reader->others[0]);
    for (uint32_t i = 0; i < reader->other_count; ++i) {
        if (!add_name(reader->others[i], &check->accept, why))
            return cli_misuse(reader, "--accept%s", why);
    }
    if (check->reason && !check->accept.count)
        return cli_misuse(reader, "--reason is why something is accepted, and --accept is missing");
    if (check->thumbnails && (!check->accept.count || check->accept_from))
        return cli_misuse(reader, "--thumbnails are of pictures that are drawn for --accept");
    if (!check_alone(reader, check))
        return false;
    if (check->on == GOLDEN_OF_REFERENCE &&
        (check->settings.device[0] || check->settings.validation))
        return cli_misuse(reader, "--on reference uses no device: --%s is of one",
                          check->settings.device[0] ? "device" : "validation");
    if (!check_outputs(reader, check) || !check_golden(reader, check))
        return false;
    if (check->reason && (!check->reason[strspn(check->reason, " \t\r\n")] ||
                          strlen(check->reason) > GOLDEN_REASON_MAX))
        return cli_misuse(reader, "--reason: 1 to %d bytes, not all blank, are needed",
                          GOLDEN_REASON_MAX);
    return true;
}

/* ---- Which cases ---- */

/* Checks that each pattern matches a case. */
static bool check_patterns(const struct check *check, const struct check_names *names,
                           const char *option)
{
    for (uint32_t i = 0; i < names->count; ++i) {
        const struct check_names one = {{names->patterns[i]}, 1};
        uint32_t at = 0;
        while (at < check->suite.count && !check_names_match(&one, check->suite.cases[at].name))
            ++at;
        if (at == check->suite.count)
            return CLI_FAIL(false, "%s `%s`: %s has no such case", option, names->patterns[i],
                            check->suite.path);
    }
    return true;
}

static bool is_named(const struct check *check, const char *name)
{
    return (!check->only.count || check_names_match(&check->only, name)) &&
           (!check->accept.count || check_names_match(&check->accept, name));
}

/* For suite_read: of cases that are not drawn, no file need be there, as another test may make
   it. */
static bool needs_files(const void *user, const char *name)
{
    const struct check *check = user;
    return !check->list && is_named(check, name);
}

static bool choose(struct check *check)
{
    uint32_t count = check->suite.count;
    check->wanted = array_alloc_zeroed(count, sizeof *check->wanted);
    check->results = array_alloc_zeroed(count, sizeof *check->results);
    if (!check->wanted || !check->results)
        return CLI_FAIL(false, "out of memory");
    for (uint32_t i = 0; i < count; ++i) {
        const char *name = check->suite.cases[i].name;
        check->results[i].item = &check->suite.cases[i];
        check->wanted[i] = is_named(check, name);
        check->wanted_count += check->wanted[i];
    }
    if (!check_patterns(check, &check->only, "--only") ||
        !check_patterns(check, &check->accept, "--accept"))
        return false;
    if (!check->wanted_count)
        cli_error("%s: no case is named by both --only and --accept", check->suite.path);
    return check->wanted_count > 0;
}

/* ---- Cases ---- */

static bool counts(const struct check_case *item)
{
    for (uint32_t i = 0; i < item->expectation_count; ++i) {
        if (expectation_counts(&item->expectations[i]))
            return true;
    }
    return false;
}

/* Appends expectations that do not hold to the result's text. */
static whit_result check_expectations(const struct drawing *drawing, struct check_result *result)
{
    const struct check_case *item = result->item;
    for (uint32_t i = 0; i < item->expectation_count; ++i) {
        char *is;
        whit_result held = expectation_check(&item->expectations[i], drawing, &is);
        if (held == WHIT_ERROR_FAILED)
            verdict_add(result, CHECK_UNMET,
                        string_format("line %u expects %s, it is %s", item->expectations[i].line,
                                      item->expectations[i].text, is));
        free(is);
        if (held != WHIT_OK && held != WHIT_ERROR_FAILED)
            return held;
    }
    return WHIT_OK;
}

/* With --base: says why a picture differs, in place of the differences from the golden. */
static whit_result explain(const struct check *check, struct studio *studio,
                           const struct drawing *drawing, struct check_result *result)
{
    whit_result explained = base_explain(&check->past, studio, result->item,
                                         golden_find(&check->old, result->item->name), drawing,
                                         &result->cause, &result->before);
    if (explained != WHIT_OK || !result->cause)
        return explained;
    verdict_set(result, CHECK_DIFFERS, string_format("differs: %s", result->cause));
    return WHIT_OK;
}

/* Says in the result's text where the picture has textures that could not be read. */
static void tell_missing(const struct drawing *drawing, struct check_result *result)
{
    whit_scene_info info;
    whit_scene_get_info(drawing->job.scene, &info);
    uint32_t missing = info.textures_missing;
    if (missing && result->text)
        verdict_set(result, result->verdict,
                    string_format("%s; %u texture%s cannot be read and %s magenta", result->text,
                                  missing, missing == 1 ? "" : "s", missing == 1 ? "is" : "are"));
}

static whit_result find_verdict(struct check *check, struct studio *studio,
                                const struct drawing *drawing, struct check_result *result)
{
    whit_result described = drawing_describe(drawing, result->item, &result->found);
    if (described != WHIT_OK)
        return described;
    const char *refused;
    if (!verdict_find(result, &check->old))
        return WHIT_ERROR_MEMORY;
    whit_result found = WHIT_OK;
    if (check->base && result->verdict == CHECK_DIFFERS)
        found = explain(check, studio, drawing, result);
    if (found == WHIT_OK)
        found = check_expectations(drawing, result);
    if (found == WHIT_OK)
        found = drawing_refuse(drawing, &refused);
    if (found == WHIT_OK && refused)
        verdict_add(result, CHECK_VACUOUS, string_format("refused as a golden: %s", refused));
    if (found == WHIT_OK)
        tell_missing(drawing, result);
    return found == WHIT_OK && !result->text ? WHIT_ERROR_MEMORY : found;
}

/* Makes small pictures for --report and --thumbnails; for a case that differs, also of the old
   picture and the difference. */
static whit_result make_pictures(const struct check *check, const struct drawing *drawing,
                                 struct check_result *result)
{
    if (!check->report && !check->thumbnails)
        return WHIT_OK;
    whit_result made = check_pictures_make(&result->pictures, drawing);
    if (made != WHIT_OK || !check->report || result->verdict < CHECK_DIFFERS)
        return made;
    return result->before ? check_pictures_compare(&result->pictures, drawing, result->before)
                          : check_compare_thumbnail(check, drawing, result);
}

/* Draws a case and finds its verdict. */
static whit_result draw_case(struct check *check, struct studio *studio, uint32_t index)
{
    struct check_result *result = &check->results[index];
    struct drawing drawing;
    double start_ms = whit_clock_ms();
    whit_result drawn = studio_draw(studio, index, counts(result->item), &drawing);
    if (drawn == WHIT_OK)
        drawn = find_verdict(check, studio, &drawing, result);
    if (drawn == WHIT_OK)
        drawn = make_pictures(check, &drawing, result);
    whit_image_destroy(result->before);
    result->before = NULL;
    drawing_finish(&drawing);
    result->time_ms = whit_clock_ms() - start_ms;
    result->error = drawn;
    if (trial_ends_all(drawn)) { /* the result may be incomplete */
        verdict_finish(result);
        result->error = drawn;
    }
    return drawn;
}

/* As draw_case, but an error becomes a verdict unless it keeps all other cases from being drawn
   too: where one picture has no room another one may have. */
static whit_result run_case(struct check *check, struct studio *studio, uint32_t index)
{
    struct check_result *result = &check->results[index];
    suite_errors_of(&check->suite, result->item);
    whit_result drawn = draw_case(check, studio, index);
    bool ends = trial_ends_all(drawn) && drawn != WHIT_ERROR_MEMORY;
    if (drawn != WHIT_OK && !ends) {
        const char *why = cli_said()[0] ? cli_said() : whit_result_name(drawn);
        verdict_set(result, CHECK_BROKEN, string_format("cannot be drawn: %s", why));
    }
    cli_errors_of(NULL);
    return ends ? drawn : WHIT_OK;
}

static void print_result(const struct check *check, const struct check_result *result)
{
    if (check->settings.quiet && (result->verdict == CHECK_OK || result->verdict == CHECK_SAME))
        return;
    fprintf(check_lines(check), "%s: %s\n", result->item->name, cli_shown(result->text));
    fflush(check_lines(check));
}

static const char *why_undrawn(whit_result result)
{
    return cli_cancel                       ? "the run was interrupted"
           : cli_time_over()                ? "the time limit passed"
           : result == WHIT_ERROR_NO_DEVICE ? "there is no device"
           : result == WHIT_ERROR_DEVICE    ? "the device was lost"
                                            : whit_result_name(result);
}

/* After a run that failed, marks the cases that were not drawn as CHECK_UNDRAWN. */
static void mark_undrawn(struct check *check, whit_result result)
{
    uint32_t drawn = 0;
    for (uint32_t i = 0; i < check->suite.count; ++i) {
        struct check_result *one = &check->results[i];
        drawn += one->verdict != CHECK_NOT_RUN;
        if (check->wanted[i] && one->verdict == CHECK_NOT_RUN)
            verdict_set(one, CHECK_UNDRAWN, string_format("not drawn: %s", why_undrawn(result)));
    }
    cli_set_kept(drawn, check->wanted_count, "cases were drawn");
}

static whit_result run_cases(struct check *check)
{
    struct studio studio;
    whit_result result = studio_open(&studio, (enum golden_kind)check->on, &check->settings,
                                     &check->suite, check->wanted, &cli_log);
    struct lanes *lanes = result == WHIT_OK ? lanes_begin(check, &studio, draw_case) : NULL;
    uint32_t i = 0;
    for (; result == WHIT_OK && i < check->suite.count; ++i) {
        if (!check->wanted[i])
            continue;
        if (!lanes_have(lanes, i))
            result = run_case(check, &studio, i);
        if (result == WHIT_OK)
            print_result(check, &check->results[i]);
    }
    lanes_end(lanes);
    for (; i < check->suite.count; ++i) { /* the cases drawn by lanes, behind the one at which this
                                             thread stopped */
        if (check->results[i].verdict != CHECK_NOT_RUN)
            print_result(check, &check->results[i]);
    }
    if (studio.job.device)
        whit_device_get_info(studio.job.device, &check->device);
    else if (check->on == GOLDEN_OF_REFERENCE)
        snprintf(check->device.name, sizeof check->device.name, "the reference in double");
    if (result == WHIT_OK && job_check_validation(&studio.job) != EXIT_FINE)
        result = WHIT_ERROR_FAILED;
    studio_close(&studio);
    return result;
}

/* ---- All of it ---- */

static void print_counts(const struct check *check)
{
    uint32_t counts[CHECK_VERDICTS] = {0}, drawn = 0;
    for (uint32_t i = 0; i < check->suite.count; ++i)
        ++counts[check->results[i].verdict];
    drawn = check->suite.count - counts[CHECK_NOT_RUN] - counts[CHECK_UNDRAWN];
    FILE *to = check_lines(check);
    fprintf(to, "%u case%s", drawn, drawn == 1 ? "" : "s");
    for (uint32_t verdict = CHECK_OK; verdict < CHECK_VERDICTS; ++verdict) {
        if (counts[verdict])
            fprintf(to, ", %u %s", counts[verdict], verdict_word((enum check_verdict)verdict));
    }
    fputc('\n', to);
}

static int sum_up(struct check *check)
{
    int status = EXIT_FINE;
    for (uint32_t i = 0; i < check->suite.count; ++i)
        status = verdict_exit(&check->results[i], status);
    if (status == EXIT_MISSING && !check->settings.quiet)
        cli_note("%s: `--accept all` takes what is new into it", check->golden_path);
    uint32_t gone = 0;
    for (uint32_t i = 0; i < check->golden.count; ++i)
        gone += suite_find(&check->suite, check->golden.cases[i].name) == NULL;
    if (gone && !check->settings.quiet)
        cli_note("%s has %u case%s that the suite has not: `--prune` drops %s", check->golden_path,
                 gone, gone == 1 ? "" : "s", gone == 1 ? "it" : "them");
    return status;
}

static int list(const struct check *check)
{
    for (uint32_t i = 0; i < check->suite.count; ++i) {
        if (check->wanted[i])
            puts(check->suite.cases[i].name);
    }
    return cli_finish_stdout(EXIT_FINE);
}

static bool take_reports(struct check *check)
{
    bool read = check_read_reports(check);
    for (uint32_t i = 0; read && i < check->suite.count; ++i) {
        if (check->results[i].verdict != CHECK_NOT_RUN)
            print_result(check, &check->results[i]);
    }
    return read;
}

/* Saves each report, even if another cannot be saved. Gives the first error. */
static whit_result save_reports(const struct check *check, int status)
{
    whit_result results[3] = {WHIT_OK, WHIT_OK, WHIT_OK};
    if (check->json)
        results[0] = document_save(check_document(check, status), check->json);
    if (check->junit)
        results[1] = document_save_written(check->junit, check_write_junit, check);
    if (check->report)
        results[2] = check_save_page(check, status);
    return results[0] != WHIT_OK ? results[0] : results[1] != WHIT_OK ? results[1] : results[2];
}

/* Draws the cases, or reads reports. *read: false, with a message, where a report or the suite of
   --base is damaged. */
static whit_result find_results(struct check *check, bool *read)
{
    *read = !check->accept_from || take_reports(check);
    if (check->accept_from)
        return WHIT_OK;
    whit_result result = check->base ? base_open(&check->past, check->suite.path, check->root,
                                                 check->base, (enum golden_kind)check->on)
                                     : WHIT_OK;
    *read = result == WHIT_OK || result == WHIT_ERROR_CANCELLED;
    if (result == WHIT_OK)
        result = run_cases(check);
    if (check->base)
        base_close(&check->past);
    return result;
}

static int judge(struct check *check)
{
    int accepted = check->accept.count ? check_accept(check) : EXIT_FINE;
    print_counts(check);
    return cli_finish_stdout(accepted == EXIT_FINE ? sum_up(check) : accepted);
}

/* Reports are also written where the run stopped early, with the results so far. */
static int end_run(struct check *check, whit_result result)
{
    if (result != WHIT_OK) {
        mark_undrawn(check, result);
        print_counts(check);
    }
    int status = result == WHIT_OK ? judge(check) : cli_exit_of(result);
    whit_result saved = save_reports(check, status);
    return saved == WHIT_OK || result != WHIT_OK ? status : cli_exit_of(saved);
}

static int work(struct check *check)
{
    bool read;
    if (check->list)
        return list(check);
    if (check->mutate || check->power)
        return strength_run(check);
    if (check->prune && !check->accept.count)
        return check_accept(check);
    whit_result result = find_results(check, &read);
    if (read)
        return end_run(check, result);
    return result == WHIT_OK ? EXIT_USAGE : cli_exit_of(result);
}

static void say_wrong(void *user, const char *text)
{
    (void)user;
    cli_error("%s", text);
}

/* Locks the golden, from before it is read until it is saved, so that of two processes that accept
   at once the second adds to what the first has saved. WHIT_ERROR_OUTPUT: that is not possible;
   WHIT_ERROR_CANCELLED and WHIT_ERROR_TIME_LIMIT: another process had the lock until then. */
static whit_result lock_golden(const struct check *check, struct lock *lock)
{
    enum { LOOK_AGAIN_MS = 20 };
    bool told = false;
    for (;;) {
        enum lock_end end = lock_take(&cli_log, check->golden_path, lock);
        whit_result wanted = end == LOCK_OTHERS ? job_still_wanted() : WHIT_OK;
        if (end != LOCK_OTHERS || wanted != WHIT_OK)
            return end == LOCK_FAILED ? WHIT_ERROR_OUTPUT : wanted;
        if (!told && !check->settings.quiet)
            cli_note("%s: another process is accepting into it; waiting", check->golden_path);
        told = true;
        nanosleep(&(struct timespec){.tv_nsec = LOOK_AGAIN_MS * 1000000L}, NULL);
    }
}

/* Reads the golden, under a lock where it will be changed, and does the work. */
static int work_on_golden(struct check *check)
{
    const enum golden_kind kind = (enum golden_kind)check->on;
    struct lock lock = {.path = NULL};
    whit_result locked = check->accept.count || check->prune ? lock_golden(check, &lock) : WHIT_OK;
    int status = EXIT_USAGE;
    if (locked != WHIT_OK)
        status = check->accept.count && locked != WHIT_ERROR_OUTPUT ? end_run(check, locked)
                                                                    : cli_exit_of(locked);
    else if (golden_read(&check->golden, check->golden_path, kind) &&
             golden_read(&check->old, check->golden_path, kind))
        status = work(check);
    lock_give_back(&lock);
    return status;
}

static int run(const struct cli_command *command, int argc, char **argv)
{
    struct cli_reader reader;
    struct check check = {.settings = settings_usual()};
    struct job common = {.start_ms = whit_clock_ms()};
    cli_reader_init(&reader, command, argc, argv);
    if (!cli_read(&reader, &check, &check.settings))
        return reader.status;
    if (reader.positional)
        check.golden_path = golden_path(reader.positional, (enum golden_kind)check.on);
    if (!check_request(&reader, &check)) {
        free(check.golden_path);
        return reader.status;
    }
    int status = EXIT_USAGE;
    common.settings = check.settings;
    if (suite_read(&check.suite, reader.positional, check.root, needs_files, say_wrong, &check) &&
        check_inputs(&reader, &check) && check.golden_path && choose(&check)) {
        if (check.json || check.junit || check.report)
            cli_keep_what_is_done(GRACE_MS);
        job_start(&common);
        status = work_on_golden(&check);
    }
    for (uint32_t i = 0; check.results && i < check.suite.count; ++i)
        verdict_finish(&check.results[i]);
    free(check.results);
    free(check.wanted);
    golden_finish(&check.golden);
    golden_finish(&check.old);
    suite_finish(&check.suite);
    free(check.golden_path);
    return status;
}

const struct cli_command command_check = {
    .name = "check",
    .arguments = "SUITE [options]",
    .summary = "Draws a suite of pictures and says which are other than its golden.",
    .details =
        "A line of SUITE is NAME SCENE OPTIONS, with options of `whit render`, or NAME expect A, "
        "B.\n"
        "SUITE.golden beside it has hashes of what was accepted. See docs/check.md.\n"
        "Exit codes: 0 all as it was, 1 something differs or is refused, 2 a bad suite, 3 no\n"
        "device, 4 no golden, 5 time limit, 130 interrupted.\n",
    .options = options,
    .settings = IN_CHECK,
    .others_max = CLI_OTHERS_MAX,
    .run = run,
};
