/* Finds which of several changes alter a picture, by drawing it with some of them taken back. */
#ifndef APP_CHECK_SEARCH_H
#define APP_CHECK_SEARCH_H

#include <stdbool.h>
#include <stdint.h>

#include "whit/whit_base.h"

enum search_end {
    SEARCH_FOUND,     /* all changes of the cause are needed */
    SEARCH_ELSEWHERE, /* the old picture does not come back even with all changes taken back */
    SEARCH_CUT,       /* the limit of pictures was reached: some changes of the cause may not be
                         needed */
};

struct search {
    uint32_t count;        /* number of changes */
    uint32_t pictures_max; /* 0: no limit */
    /* Draws with the changes in `back` taken back; *same: this gives the old picture. Input that
       cannot be drawn is not the same. Errors end the search. */
    whit_result (*draw)(void *user, const bool *back, bool *same);
    void *user;
    /* Set by the search. */
    enum search_end end;
    uint32_t pictures;
    bool *cause; /* per change: it belongs to the cause; free() it */
    uint32_t cause_count;
};

/* Delta debugging: Zeller and Hildebrandt 2002, "Simplifying and isolating failure-inducing input",
   ddmin. If a single change is the cause, it takes about 2 log2(`count`) pictures.
   WHIT_ERROR_MEMORY, not logged; else what `draw` gives. */
WHIT_CHECK whit_result search_run(struct search *search);

#endif
