/* Linked into every test program that makes devices. The synchronization checks of the validation
   layers take an eighth to a third of such a test's time, so ctest entries take turns: each entry
   has its number in WHIT_TEST_TURN, and with each commit (WHIT_TEST_OFFSET) another quarter of them
   has the checks. Every eighth commit shifts the turns, so that cases that take turns by the same
   offset (cases.h) all get checked. Entries with the label long have no number, and always have the
   checks. */
#include <stdlib.h>
#include <string.h>

static unsigned long number_of(const char *name)
{
    const char *text = getenv(name);
    return text ? strtoul(text, NULL, 10) : 0;
}

__attribute__((constructor)) static void take_turn(void)
{
    const char *validation = getenv("WHIT_VALIDATION");
    unsigned long offset = number_of("WHIT_TEST_OFFSET");
    if (getenv("WHIT_TEST_TURN") && validation && strcmp(validation, "sync") == 0 &&
        (number_of("WHIT_TEST_TURN") + offset + offset / 8) % 4 != 0)
        unsetenv("WHIT_VALIDATION");
}
