/* Linked into every unit test: the list of its checks, and its main(). With WHIT_TEST_ONLY=NAME
   only checks of this name run; * and ? in it stand for any characters. A name that no check has is
   no failure: look at what was run. */
#include "unit.h"

#include "../cases.h"

enum { CHECKS_MAX = 64 };

static struct CMUnitTest checks[CHECKS_MAX]; /* cmocka leaves out those without a name. */
static size_t check_count;
static int (*at_end)(int failed);

__attribute__((constructor)) static void run_only(void)
{
    const char *name = getenv("WHIT_TEST_ONLY");
    if (name && *name)
        cmocka_set_test_filter(name);
}

void unit_add(const char *name, CMUnitTestFunction check, CMFixtureFunction begin,
              CMFixtureFunction end)
{
    if (check_count == CHECKS_MAX)
        abort();
    checks[check_count++] = (struct CMUnitTest){name, check, begin, end, NULL};
}

bool unit_turn(size_t index, size_t every)
{
    return getenv("WHIT_TEST_ONLY") || cases_turn(index, every);
}

int unit_run(CMFixtureFunction begin, CMFixtureFunction end)
{
    int failed = cmocka_run_group_tests(checks, begin, end);
    return at_end ? at_end(failed) : failed;
}

void unit_at_end(int (*end)(int failed))
{
    at_end = end;
}

__attribute__((weak)) int main(void)
{
    return unit_run(NULL, NULL);
}
