#include "view/pace.h"

#include <math.h>

static const uint32_t divisors[PACE_SIZES] = {1, 2, 3, 4, 6, 8};
enum { DIVISOR_UNKNOWN = 4 };
static const double LARGER_MARGIN = 0.8;
enum { CALM_PICTURES = 20 };
/* The overhead of a small picture is at most this part of what its pixels take. */
static const double OVERHEAD_MAX = 0.5;

static int size_of(uint32_t divisor)
{
    int size = 0;
    while (size + 1 < PACE_SIZES && divisors[size] < divisor)
        ++size;
    return size;
}

static double median(double a, double b, double c)
{
    return fmax(fmin(a, b), fmin(fmax(a, b), c));
}

/* Takes the time of a whole picture. Others are expected to take their parts of it. */
static void begin(struct pace *pace, double ms)
{
    *pace = (struct pace){.off = {1.0, 1.0}, .calm = CALM_PICTURES};
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
    /* The view has changed, or the load of the machine. By the median, one picture that was held up
       does not make the next ones smaller. */
    double change = median(pace->off[0], pace->off[1], off);
    for (int i = 0; i < PACE_SIZES; ++i)
        pace->ms[i] *= change;
    pace->off[0] = pace->off[1] / change;
    pace->off[1] = off / change;
}

uint32_t pace_divisor(const struct pace *pace, double budget_ms)
{
    if (pace->ms[0] <= 0.0)
        return DIVISOR_UNKNOWN;
    int size = pace->calm < CALM_PICTURES ? size_of(pace->divisor) : 0;
    while (size + 1 < PACE_SIZES &&
           pace->ms[size] > (divisors[size] < pace->divisor ? LARGER_MARGIN : 1.0) * budget_ms)
        ++size;
    return divisors[size];
}
