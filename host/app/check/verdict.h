/* The verdict on a case: its kind, the text that is printed, and the exit code. */
#ifndef APP_CHECK_VERDICT_H
#define APP_CHECK_VERDICT_H

#include "app/check/golden.h"
#include "app/check/pictures.h"
#include "app/check/suite.h"

enum check_verdict {
    CHECK_NOT_RUN,
    CHECK_OK,
    CHECK_SAME,     /* something that it was made of is other, the picture is not */
    CHECK_ACCEPTED, /* it was other, or new, and the golden has it now */
    CHECK_NEW,      /* the golden does not have it */
    CHECK_DIFFERS,
    CHECK_UNMET,   /* an expectation fails */
    CHECK_VACUOUS, /* a picture that could not fail */
    CHECK_BROKEN,  /* it cannot be drawn */
    CHECK_UNDRAWN, /* it was to be drawn, and the run ended before */
    CHECK_VERDICTS
};
/* "ok", "differs": also of reports. */
const char *verdict_word(enum check_verdict verdict);

struct check_result {
    const struct check_case *item;
    enum check_verdict verdict;
    char *text;          /* behind "NAME: " in what is printed; NULL where it was not run */
    char *cause;         /* how and why it differs from what --base has; NULL: not known */
    whit_image *before;  /* its colours there; NULL: not known, or not wanted any more */
    char *changed;       /* parts and options that are other, as text; NULL: none */
    whit_result error;   /* CHECK_BROKEN */
    struct golden found; /* with this case alone, unless it could not be drawn */
    struct check_pictures pictures; /* where a report or thumbnails are asked for */
    double time_ms;
};

/* Compares what was found with the golden: CHECK_OK, _SAME, _DIFFERS or _NEW, with the text. False:
   out of memory. */
bool verdict_find(struct check_result *result, const struct golden *golden);
/* Takes over `text`. */
void verdict_set(struct check_result *result, enum check_verdict verdict, char *text);
/* The same, with the text behind that of verdicts that are no better, which it had. */
void verdict_add(struct check_result *result, enum check_verdict verdict, char *text);
/* What the case makes of an exit code: the worst of all counts (docs/check.md). */
int verdict_exit(const struct check_result *result, int worst);
void verdict_finish(struct check_result *result);

#endif
