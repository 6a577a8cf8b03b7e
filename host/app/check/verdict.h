/* The verdict on a case: its kind, the text that is printed, and the exit code. */
#ifndef APP_CHECK_VERDICT_H
#define APP_CHECK_VERDICT_H

#include "app/check/golden.h"
#include "app/check/pictures.h"
#include "app/check/suite.h"

enum check_verdict {
    CHECK_NOT_RUN,
    CHECK_OK,
    CHECK_SAME,     /* its input changed, the picture did not */
    CHECK_ACCEPTED, /* it differed or was new, and was accepted into the golden */
    CHECK_NEW,      /* the golden does not have it */
    CHECK_DIFFERS,
    CHECK_UNMET,   /* an expectation fails */
    CHECK_VACUOUS, /* a picture that could not fail */
    CHECK_BROKEN,  /* it cannot be drawn */
    CHECK_UNDRAWN, /* the run ended before it was drawn */
    CHECK_VERDICTS
};
/* "ok", "differs"; reports use these words too. */
const char *verdict_word(enum check_verdict verdict);

struct check_result {
    const struct check_case *item;
    enum check_verdict verdict;
    char *text;          /* printed behind "NAME: "; NULL where the case was not run */
    char *cause;         /* how and why it differs from the revision of --base; NULL: not known */
    whit_image *before;  /* its colours at that revision; NULL: not known, or freed */
    char *changed;       /* parts and options that changed, as text; NULL: none */
    whit_result error;   /* for CHECK_BROKEN */
    struct golden found; /* has only this case; empty where it could not be drawn */
    struct check_pictures pictures; /* made where a report or thumbnails are asked for */
    double time_ms;
};

/* Compares `found` with the golden and sets verdict (CHECK_OK, _SAME, _DIFFERS or _NEW) and text.
   False: out of memory. */
bool verdict_find(struct check_result *result, const struct golden *golden);
/* Sets verdict and text; takes over `text`. */
void verdict_set(struct check_result *result, enum check_verdict verdict, char *text);
/* Adds a verdict; the worse of the two counts. `text` is appended to the text of a verdict from
   CHECK_NEW on, and replaces that of a better one. Without memory for either there is no text. */
void verdict_add(struct check_result *result, enum check_verdict verdict, char *text);
/* The worse of the exit code `worst` and the case's own (docs/check.md). */
int verdict_exit(const struct check_result *result, int worst);
/* Only `item` stays. */
void verdict_finish(struct check_result *result);

#endif
