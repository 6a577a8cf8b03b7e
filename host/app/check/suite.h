/* A suite: pictures with names, and what is expected of them (docs/check.md). */
#ifndef APP_CHECK_SUITE_H
#define APP_CHECK_SUITE_H

#include "app/check/expect.h"
#include "app/cli.h"
#include "base/roots.h"

enum { CHECK_NAME_MAX = 64, CHECK_CASES_MAX = 4096 };

/* One picture. The suite owns all of it. */
struct check_case {
    char *name;
    uint32_t line;
    struct settings *settings; /* file names in them are relative to the working folder; NULL: the
                                  options are wrong, and so is the suite */
    char *made_by; /* scene and options as the suite names them: `room.json --depth 4` */
    char *loaded;  /* the same, with only the options that affect how the scene is loaded */
    struct check_expectation *expectations;
    uint32_t expectation_count, expectation_capacity;
};

/* Whether the files that a case of this name has must exist. */
typedef bool suite_needs(const void *user, const char *name);

struct suite {
    const char *path;
    struct roots roots;       /* where its files may lie */
    struct check_case *cases; /* in the order of the file */
    uint32_t count, capacity;
    uint32_t wrong;           /* number of wrong lines */
    uint32_t told;            /* the last line that `say` was called for */
    size_t expectation_bytes; /* of the expectations of all cases */
    suite_needs *needs;
    /* Gets "FILE:LINE: reason" for each wrong line. */
    void (*say)(void *user, const char *text);
    void *user;
};

/* Reads all lines. `root`: the folder that files lie below and are named from; NULL: the suite's
   own. On the disk it only checks that files exist, of the cases that `needs` is true for; NULL: of
   all. False, with messages, where a line is wrong or the file cannot be read. Call
   suite_finish() in any case. */
bool suite_read(struct suite *suite, const char *path, const char *root, suite_needs *needs,
                void (*say)(void *user, const char *text), void *user);
void suite_finish(struct suite *suite);
/* The case of that name; NULL: there is none. */
struct check_case *suite_find(const struct suite *suite, const char *name);
/* Errors from this call on begin with the suite's path, the line and the name of the case, until
   cli_errors_of(NULL). One thread may call it. */
void suite_errors_of(const struct suite *suite, const struct check_case *item);
/* Whether a name is `pattern`, in which * stands for any letters and ? for one. */
bool suite_matches(const char *pattern, const char *name);

/* case_options.c: reads the words behind a case's name, which are a scene and options of
   `whit render`. `where`: "FILE:LINE". False, with the reason in `said`. */
bool case_options_read(struct check_case *item, const struct suite *suite, const char *where,
                       int argc, char **argv, char *said, size_t said_bytes);

#endif
