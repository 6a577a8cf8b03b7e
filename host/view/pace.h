#ifndef WHIT_VIEW_PACE_H
#define WHIT_VIEW_PACE_H
#include <stdbool.h>
#include <stdint.h>

enum { PACE_SIZES = 6, PACE_TIMES = 4 };

/* How long pictures of one sample take at each size, and so how small they have to be to follow
   the camera. Times are divided by the number of pixels of the window, which may be resized. All
   0: nothing was drawn yet. */
struct pace {
    double ms[PACE_SIZES];     /* expected time; 0: not known */
    bool measured[PACE_SIZES]; /* a picture of this size was drawn since the last rest */
    double off[PACE_TIMES];    /* the last pictures' times as parts of what was expected, the
                                  oldest first */
    uint32_t divisor;          /* by which the sides of the last picture were divided; 0: none
                                  since the last rest */
    uint32_t calm;             /* pictures since they last became smaller, or since the next larger
                                  size was last expected to take too long */
};

/* Notes a picture whose sides are those of the window divided by `divisor`. One at rest, not
   `moving`, is the base of what is expected anew. */
void pace_note(struct pace *pace, uint32_t divisor, bool moving, double ms);

/* The divisor of the largest picture that takes at most budget_ms. After pictures became smaller, a
   larger one comes when it was expected to fit, with a margin, for a while on end, so that sizes do
   not flicker. */
uint32_t pace_divisor(struct pace *pace, double budget_ms);

#endif
