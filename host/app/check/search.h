/* Which of some changes make a picture other than it was, by drawing it without them. */
#ifndef APP_CHECK_SEARCH_H
#define APP_CHECK_SEARCH_H

#include <stdbool.h>
#include <stdint.h>

#include "whit/whit_base.h"

enum search_end {
    SEARCH_FOUND,     /* each change of the cause is needed */
    SEARCH_ELSEWHERE, /* with all changes taken back the picture is not what it was */
    SEARCH_CUT,       /* there were too few pictures: some of the cause may not be needed */
};

struct search {
    uint32_t count;        /* changes */
    uint32_t pictures_max; /* 0: no limit */
    /* Draws with these changes taken back; *same: that gives the old picture. What cannot be drawn
       is not it. Errors end the search. */
    whit_result (*draw)(void *user, const bool *back, bool *same);
    void *user;
    /* Set by the search. */
    enum search_end end;
    uint32_t pictures;
    bool *cause; /* of each change; free() it */
    uint32_t cause_count;
};

/* Delta debugging: Zeller and Hildebrandt 2002, "Simplifying and isolating failure-inducing input",
   ddmin. One change that is the cause alone takes about twice the binary logarithm of `count`
   pictures. WHIT_ERROR_MEMORY, not logged; else what `draw` gives. */
WHIT_CHECK whit_result search_run(struct search *search);

#endif
