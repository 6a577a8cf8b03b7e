/* One run of `whit check`. */
#ifndef APP_CHECK_CHECK_H
#define APP_CHECK_CHECK_H

#include <stdio.h>
#include <string.h>

#include "app/arguments.h"
#include "app/check/base.h"
#include "app/check/verdict.h"

enum { CHECK_PATTERNS_MAX = CLI_OTHERS_MAX };

/* Names of cases, or patterns of them. */
struct check_names {
    const char *patterns[CHECK_PATTERNS_MAX];
    uint32_t count;
};

struct check {
    struct settings settings; /* of the command line, for all cases */
    const char *root, *reason, *base, *accept_from;
    const char *json, *junit, *report; /* or NULL */
    struct check_names accept, only;
    bool list, prune, thumbnails, power;
    uint32_t on;     /* enum golden_kind: device or reference */
    uint32_t mutate; /* number of faults to put into the suite's scenes; 0: none */
    uint32_t seed;   /* seed of these faults */

    struct suite suite;
    char *golden_path;
    struct golden old, golden; /* the golden as it was read; as it will be saved */
    bool *wanted;              /* per case of the suite: it is to be drawn */
    uint32_t wanted_count;
    struct check_result *results;
    struct base past;        /* with --base */
    whit_device_info device; /* known once something was drawn */
};

/* Whether one of the patterns is `name`; "all" stands for every name. */
bool check_names_match(const struct check_names *names, const char *name);

/* The stream on which lines for people are printed: standard output, or standard error if a report
   is written to standard output. */
static inline FILE *check_lines(const struct check *check)
{
    bool piped =
        cli_is_piped(check->json) || cli_is_piped(check->junit) || cli_is_piped(check->report);
    return piped ? stderr : stdout;
}

/* accept_from.c: fills the results of the cases in `wanted` from the reports of
   --accept-from. False, with an error, where a report is damaged or does not fit the suite. */
bool check_read_reports(struct check *check);

/* accept.c: puts the results of the cases that --accept names into the golden, drops with --prune
   the cases that the suite does not have, and saves it. Prints which cannot be accepted. Gives the
   exit code. */
int check_accept(struct check *check);

/* strength.c: --power and --mutate, in place of a check: draws the wanted cases, and prints which
   faults they notice. Gives the exit code. */
int strength_run(struct check *check);

/* report.c, junit.c, page.c: reports on all cases that were run. */
struct json_t;
struct json_t *check_document(const struct check *check, int status);
void check_write_junit(FILE *to, const void *check); /* for document_save_written */
WHIT_CHECK whit_result check_save_page(const struct check *check, int status);
extern const char check_page_html[]; /* page_head.html and page.html, ended by 0 */

#endif
