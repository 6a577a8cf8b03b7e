#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/platform.h"

static void peak_memory_covers_what_was_used(void **state)
{
    (void)state;
    uint64_t before = platform_peak_memory_bytes();
    assert_true(before > 0);
    size_t bytes = (size_t)before + (32u << 20);
    char *memory = malloc(bytes);
    assert_non_null(memory);
    memset(memory, 1, bytes);
    assert_true(platform_peak_memory_bytes() >= bytes);
    free(memory);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(peak_memory_covers_what_was_used),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
