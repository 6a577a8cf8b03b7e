/* The judge of runs: how a program ended, what it said, and what became of its outputs. */
#define _GNU_SOURCE
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <jansson.h>

#include "judge.h"

/* An interrupted program ends within that time, by its timer if not by itself. */
enum { GRACE_MS = 200 };

static bool is_output(const struct sweep *sweep, const char *name)
{
    for (uint32_t i = 0; i < sweep->output_count; ++i)
        if (strcmp(sweep->outputs[i], name) == 0)
            return true;
    return false;
}

/* The name of a file that should not be there; removes it. */
static bool find_stray(const struct sweep *sweep, char *name, size_t name_bytes)
{
    bool found = false;
    DIR *folder = opendir(".");
    for (struct dirent *entry; folder && (entry = readdir(folder));) {
        if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0 ||
            is_output(sweep, entry->d_name))
            continue;
        snprintf(name, name_bytes, "%s", entry->d_name);
        unlink(entry->d_name);
        found = true;
    }
    if (folder)
        closedir(folder);
    return found;
}

static uint32_t count_of(const char *text, const char *part)
{
    uint32_t count = 0;
    for (const char *at = text; (at = strstr(at, part)); ++at)
        ++count;
    return count;
}

/* The message has what the fault or the sweep wants it to say. */
static bool says_why(const struct sweep *sweep, const char *errors)
{
    const char *say = sweep->fault->say;
    return (!say && !sweep->say) || (say && strcasestr(errors, say)) ||
           (sweep->say && strcasestr(errors, sweep->say));
}

/* Names the fault in how the program ended; NULL: there is none. */
static const char *judge_end(const struct sweep *sweep, int status, const char *errors)
{
    static char text[128];
    const struct fault *fault = sweep->fault;
    bool fine = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    text[0] = '\0';
    if (WIFSIGNALED(status) && WTERMSIG(status) == deadly(fault) && !errors[0])
        return NULL;
    if (WIFSIGNALED(status))
        snprintf(text, sizeof text, "it died of signal %d", WTERMSIG(status));
    else if (!fine && WEXITSTATUS(status) != fault->expect)
        snprintf(text, sizeof text, "exit code %d", WEXITSTATUS(status));
    if (text[0])
        return text;
    uint32_t interrupts = count_of(errors, "whit: interrupted, ");
    uint32_t reasons = count_of(errors, "whit: error: ") + interrupts;
    bool second = fault->then == SIGINT; /* says nothing, or what the first one had said */
    bool right = fine ? reasons == 0 : reasons == 1 || (second && reasons == 0);
    if (!right || (!fine && is_interrupt(fault) && interrupts != reasons) ||
        (!fine && !says_why(sweep, errors)))
        snprintf(text, sizeof text, "%u errors, exit code %d", reasons, WEXITSTATUS(status));
    return text[0] ? text : NULL;
}

const char *judge_run(const struct sweep *sweep, int status, const char *errors)
{
    static char text[512];
    char stray[256];
    struct fault_shared *shared = sweep->shared;
    uint32_t submits = atomic_load(&shared->submits_later);
    bool is_signal = is_interrupt(sweep->fault) && atomic_load(&shared->fired) > 0;
    const char *end = judge_end(sweep, status, errors);
    if (find_stray(sweep, stray, sizeof stray))
        snprintf(text, sizeof text, "the file %s is left", stray);
    else if (end)
        return end;
    else if (shared->live != 0 && !sweep->may_leak && !(shared->live < 0 && sweep->fault->at_once))
        snprintf(text, sizeof text, "%lld blocks were not given back", (long long)shared->live);
    else if (is_signal && (shared->timer_ms == 0 || shared->timer_ms > GRACE_MS) && !sweep->reports)
        snprintf(text, sizeof text, "it has %u ms to end by itself", shared->timer_ms);
    else if (submits > sweep->max_submits)
        snprintf(text, sizeof text, "it went on for %u submissions", submits);
    else
        return NULL;
    return text;
}

static bool same(const struct content *a, const struct content *b)
{
    return a->data && b->data && a->bytes == b->bytes && memcmp(a->data, b->data, a->bytes) == 0;
}

/* The states of a viewer, which are JSON one behind the other, up to where they no longer are. */
static json_t *read_states(const struct content *printed)
{
    json_t *states = json_array(), *state;
    json_error_t end = {.position = 0};
    for (size_t at = 0; at < printed->bytes; at += (size_t)end.position) {
        state = json_loadb(printed->data + at, printed->bytes - at, JSON_DISABLE_EOF_CHECK, &end);
        if (!state)
            break;
        json_array_append_new(states, state);
    }
    return states;
}

static bool same_field(const json_t *a, const json_t *b, const char *name)
{
    return json_equal(json_object_get(a, name), json_object_get(b, name));
}

static bool same_picture(const json_t *a, const json_t *b)
{
    a = json_object_get(a, "frame");
    b = json_object_get(b, "frame");
    return same_field(a, b, "ids") && same_field(a, b, "pixels");
}

/* Something is said in the window that is not said without a fault. */
static bool is_said(const json_t *whole, const json_t *now, const char *name)
{
    return json_string_length(json_object_get(now, name)) > 0 && !same_field(whole, now, name);
}

/* Each state has the picture that it has without a fault, or the window says why not. */
static const char *judge_states(const struct sweep *sweep, const struct content *printed,
                                bool *said)
{
    json_t *whole = read_states(&sweep->printed), *now = read_states(printed);
    size_t count = json_array_size(whole);
    const char *defect = NULL;
    if (count == 0 || json_array_size(now) != count)
        defect = "a state is missing";
    for (size_t i = 0; i < count && !defect; ++i) {
        const json_t *a = json_array_get(whole, i), *b = json_array_get(now, i);
        bool shown = same_picture(a, b);
        if (!shown && !is_said(a, b, "error") && !is_said(a, b, "toast"))
            defect = "it shows something else and does not say why";
        *said |= !shown;
    }
    json_decref(whole);
    json_decref(now);
    return defect;
}

/* Whether it is a report, which says of itself whether it is complete. */
static bool read_report(const struct content *output, bool *complete)
{
    json_t *report = output->data ? json_loadb(output->data, output->bytes, 0, NULL) : NULL;
    const json_t *says = json_object_get(report, "complete");
    bool is_report = json_is_boolean(says);
    *complete = json_is_true(says);
    json_decref(report);
    return is_report;
}

static bool is_of_number(char letter)
{
    return letter && strchr("0123456789.-+e", letter);
}

/* Whether two texts are the same but for their numbers, which may be times. */
static bool same_words(const struct content *a, const struct content *b)
{
    const char *left = a->data, *right = b->data;
    while (left && right && (left[0] || right[0])) {
        while (is_of_number(left[0]))
            ++left;
        while (is_of_number(right[0]))
            ++right;
        if (left[0] != right[0])
            return false;
        left += left[0] != '\0';
        right += right[0] != '\0';
    }
    return left && right;
}

/* Whether an output is the one of a run without a fault; for reports, whether it is a complete one,
   or (*part) a part of one. */
static bool is_whole(const struct sweep *sweep, uint32_t output, const struct content *now,
                     bool *part)
{
    bool complete = false;
    *part = false;
    if (sweep->figures)
        return same_words(now, &sweep->whole[output]);
    if (!sweep->reports)
        return same(now, &sweep->whole[output]);
    *part = read_report(now, &complete) && !complete;
    return complete;
}

/* Checks the number of outputs that the program says it wrote. Returns its false statement; NULL:
   there is none. A program that ends at once may have put a frame in its place that it has not
   counted. */
static const char *judge_words(const struct sweep *sweep, const char *errors, uint32_t new_count)
{
    unsigned done, count;
    const char *at = strstr(errors, " of ");
    if (strstr(errors, "nothing was written") && new_count > 0)
        return "it says that nothing was written";
    while (at && at > errors && at[-1] >= '0' && at[-1] <= '9')
        --at;
    if (!at || sscanf(at, "%u of %u", &done, &count) != 2)
        return NULL;
    if (strstr(errors, "settings were measured") && (done == 0 || new_count == 0))
        return "it says that settings were measured";
    if (strstr(errors, "frames were written") && done != new_count &&
        !(sweep->fault->at_once && done + 1 == new_count))
        return "it does not say how many frames were written";
    return NULL;
}

const char *judge_outputs(struct sweep *sweep, bool fine, const char *errors)
{
    static char text[512];
    struct content old = {(char *)(uintptr_t)OLD_TEXT, sizeof OLD_TEXT - 1};
    uint32_t new_count = 0;
    bool kept = false;
    text[0] = '\0';
    for (uint32_t i = 0; i < sweep->output_count; ++i) {
        struct content now = sweep_read(sweep->outputs[i]);
        bool part, whole = is_whole(sweep, i, &now, &part);
        if (!whole && (fine || (!part && !same(&now, &old))))
            snprintf(text, sizeof text, "%s is neither the old one nor whole", sweep->outputs[i]);
        new_count += whole || part;
        kept = kept || part;
        free(now.data);
    }
    const char *words = judge_words(sweep, errors, new_count);
    if (words)
        snprintf(text, sizeof text, "%s, and %u outputs are new", words, new_count);
    struct content printed = sweep_read("../stdout");
    sweep->kept += kept;
    if (kept && !(printed.data && strstr(printed.data, "not complete")))
        snprintf(text, sizeof text, "it prints the report of a part as if it were whole");
    if (kept && sweep->shared->timer_ms <= GRACE_MS)
        snprintf(text, sizeof text, "it has %u ms to save a report", sweep->shared->timer_ms);
    if (fine && sweep->same_stdout && !same(&printed, &sweep->printed))
        snprintf(text, sizeof text, "it printed something else");
    bool said = false;
    const char *states = fine && sweep->pictures ? judge_states(sweep, &printed, &said) : NULL;
    if (states)
        snprintf(text, sizeof text, "%s: %.400s", states, printed.data);
    sweep->said += said;
    free(printed.data);
    return text[0] ? text : NULL;
}
