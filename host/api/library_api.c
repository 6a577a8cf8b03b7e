#include <stdlib.h>

#include "base/clock.h"
#include "whit/whit.h"
#include "whit/whit_program.h"

double whit_clock_ms(void)
{
    return clock_ms();
}

double whit_clock_cpu_ms(void)
{
    return clock_cpu_ms();
}

const char *whit_version(void)
{
    return WHIT_VERSION;
}

void whit_memory_destroy(void *memory)
{
    free(memory);
}
