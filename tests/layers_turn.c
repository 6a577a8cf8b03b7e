/* Linked into every test program that makes devices. The synchronization checks of the validation
   layers take an eighth to a third of such a test: of the entries that have WHIT_TEST_TURN, their
   number, a quarter has them with each commit, by WHIT_TEST_OFFSET. Every eighth commit shifts the
   turns, so that cases that take turns by the same offset (cases.h) all get there. Entries with the
   label long have no such number, and always have the layers. */
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
