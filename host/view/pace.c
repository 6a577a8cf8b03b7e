#include "view/pace.h"

#include <math.h>

static const uint32_t divisors[PACE_SIZES] = {1, 2, 3, 4, 6, 8};
enum { DIVISOR_UNKNOWN = 4 };
static const double LARGER_MARGIN = 0.95;
enum { CALM_PICTURES = 20, TIMES = PACE_TIMES + 1 };
/* The overhead of a small picture is at most this part of what its pixels take. */
static const double OVERHEAD_MAX = 0.5;

static int size_of(uint32_t divisor)
{
    int size = 0;
    while (size + 1 < PACE_SIZES && divisors[size] < divisor)
        ++size;
    return size;
}

/* The median of the kept times and the last one, `off`. */
static double median(const struct pace *pace, double off)
{
    double sorted[TIMES];
    for (int i = 0; i < TIMES; ++i) {
        double next = i < PACE_TIMES ? pace->off[i] : off;
        int at = i;
        for (; at > 0 && sorted[at - 1] > next; --at)
            sorted[at] = sorted[at - 1];
        sorted[at] = next;
    }
    return sorted[TIMES / 2];
}

/* Takes the time of a whole picture. Others are expected to take their parts of it. */
static void begin(struct pace *pace, double ms)
{
    *pace = (struct pace){.calm = CALM_PICTURES};
    for (int i = 0; i < PACE_TIMES; ++i)
        pace->off[i] = 1.0;
    for (int i = 0; i < PACE_SIZES; ++i)
        pace->ms[i] = ms / ((double)divisors[i] * divisors[i]);
}

void pace_note(struct pace *pace, uint32_t divisor, bool moving, double ms)
{
    int drawn = size_of(divisor);
    pace->calm = divisor > pace->divisor ? 0 : pace->calm + 1;
    pace->divisor = divisor;
    if (!moving || pace->ms[0] <= 0.0)
        begin(pace, ms * divisor * divisor);
    if (!pace->measured[drawn]) {
        double overhead_ms = fmin(fmax(ms - pace->ms[drawn], 0.0), OVERHEAD_MAX * pace->ms[drawn]);
        for (int i = 1; i < PACE_SIZES; ++i)
            pace->ms[i] += pace->measured[i] ? 0.0 : overhead_ms;
        pace->measured[drawn] = true;
    }
    double off = ms / pace->ms[drawn];
    /* The view has changed, or the load of the machine. By the median, two pictures that were held
       up do not make the next ones smaller. */
    double change = median(pace, off);
    for (int i = 0; i < PACE_SIZES; ++i)
        pace->ms[i] *= change;
    for (int i = 0; i < PACE_TIMES; ++i)
        pace->off[i] = (i + 1 < PACE_TIMES ? pace->off[i + 1] : off) / change;
}

static bool fits(const struct pace *pace, int size, double budget_ms)
{
    return pace->ms[size] <= (divisors[size] < pace->divisor ? LARGER_MARGIN : 1.0) * budget_ms;
}

uint32_t pace_divisor(struct pace *pace, double budget_ms)
{
    if (pace->ms[0] <= 0.0)
        return DIVISOR_UNKNOWN;
    int drawn = size_of(pace->divisor);
    if (pace->calm < CALM_PICTURES && drawn > 0 && !fits(pace, drawn - 1, budget_ms))
        pace->calm = 0;
    int size = pace->calm < CALM_PICTURES ? drawn : 0;
    while (size + 1 < PACE_SIZES && !fits(pace, size, budget_ms))
        ++size;
    return divisors[size];
}
