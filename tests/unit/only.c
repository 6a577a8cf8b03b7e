/* Linked into every unit test: with WHIT_TEST_ONLY=NAME it runs the checks of that name alone, in
   which * and ? stand for others. None of that name is no failure: see what was run. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

__attribute__((constructor)) static void run_only(void)
{
    const char *name = getenv("WHIT_TEST_ONLY");
    if (name && *name)
        cmocka_set_test_filter(name);
}
