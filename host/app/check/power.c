#include <math.h>

#include "app/check/faults.h"
#include "app/check/strength.h"

/* The smallest change that is tried, relative to the strongest. */
static const double SMALLEST = 1e-9;

/* Halves the strength, on a logarithmic scale, between one that is seen and one that is not, until
   they are a factor of 2 apart. This assumes that larger changes are seen too, which need not be
   so. */
static whit_result find_smallest(const struct fault_case *item, whit_fault fault, double *smallest)
{
    double unseen = SMALLEST * fault.amount, seen = fault.amount;
    whit_result result = WHIT_OK;
    while (result == WHIT_OK && seen > 2.0 * unseen) {
        enum fault_end end;
        fault.amount = sqrt(seen * unseen);
        result = fault_draw(item, &fault, 1, &end, NULL);
        if (end == FAULT_SEEN)
            seen = fault.amount;
        else
            unseen = fault.amount;
    }
    *smallest = seen;
    return result;
}

whit_result power_case(uint64_t *random, const struct fault_case *item)
{
    static const whit_fault_kind kinds[] = {WHIT_FAULT_VERTEX, WHIT_FAULT_IOR, WHIT_FAULT_LIGHT,
                                            WHIT_FAULT_TEXELS};
    whit_result result = WHIT_OK;
    printf("%s:", item->name);
    for (size_t i = 0; result == WHIT_OK && i < sizeof kinds / sizeof *kinds; ++i) {
        whit_fault fault;
        bool found;
        double smallest = 0.0;
        result = fault_find(item, kinds[i], random, &fault, &found);
        if (result == WHIT_OK && found)
            result = find_smallest(item, fault, &smallest);
        /* A texel changes by whole steps of 1/255. */
        if (kinds[i] == WHIT_FAULT_TEXELS)
            smallest = fmax(smallest, 1.0 / 255.0);
        printf("%s %s ", i ? "," : "", whit_fault_kind_name(kinds[i]));
        if (found)
            printf("%.1e", smallest);
        else
            putchar('-');
    }
    putchar('\n');
    fflush(stdout);
    return result;
}
