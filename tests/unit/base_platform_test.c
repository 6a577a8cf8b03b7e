#include "base/platform.h"
#include "unit.h"

TEST(peak_memory_covers_what_was_used)
{
    uint64_t before = platform_peak_memory_bytes();
    assert_true(before > 0);
    size_t bytes = (size_t)before + (32u << 20);
    own_memory char *memory = malloc(bytes);
    assert_non_null(memory);
    memset(memory, 1, bytes);
    assert_true(platform_peak_memory_bytes() >= bytes);
}
