/* Linked into a whit of its own (--wrap): of the kind that SMALL_STACKS names, stacks hold one
   entry. They are as deep as a scene needs, so that nothing else makes them overflow. */
#include <stdlib.h>
#include <string.h>

#include "../wrapped.h"
#include "accel/accel.h"

static bool is_small(const char *which)
{
    const char *value = getenv("SMALL_STACKS");
    return value && strcmp(value, which) == 0;
}

WRAPPED(uint32_t, accel_stack_size, const struct accel *accel)
{
    uint32_t size = __real_accel_stack_size(accel);
    return is_small("nodes") ? 1 : size;
}

WRAPPED(uint32_t, accel_packet_stack_size, const struct accel *accel)
{
    uint32_t size = __real_accel_packet_stack_size(accel);
    return is_small("packets") ? 1 : size;
}
