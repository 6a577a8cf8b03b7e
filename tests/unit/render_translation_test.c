/* A second device translates some of the kernels that the driver's cache lacks. The linker puts the
   function below in place of commands_wait, so that no clock says which kernels are missing and
   which device takes them. */
#include <semaphore.h>
#include <time.h>

#include "../wrapped.h"
#include "base/threads.h"
#include "device/commands.h"
#include "picture_fixture.h"
#include "render_scenes.h"
#include "unit.h"

/* `begins`: the next kernel that the first device looks for is missing. `first`: the commands of
   the first device, until the second one has translated a kernel, of which `translated` tells. */
static struct {
    bool begins;
    _Atomic(const struct commands *) first;
    sem_t translated;
} missing;

WRAPPED(whit_result, commands_wait, struct commands *commands, double timeout_ms)
{
    if (missing.begins && timeout_ms >= 0.0) {
        missing.begins = false;
        missing.first = commands;
        return WHIT_ERROR_TIME_LIMIT;
    }
    if (commands == missing.first) {
        struct timespec latest = {.tv_sec = time(NULL) + 60};
        assert_int_equal(sem_timedwait(&missing.translated, &latest), 0);
        missing.first = NULL;
    }
    whit_result result = __real_commands_wait(commands, timeout_ms);
    if (missing.first && commands != missing.first)
        assert_int_equal(sem_post(&missing.translated), 0);
    return result;
}

static uint32_t kernels_beside(const struct renderer *renderer)
{
    whit_stats stats;
    renderer_get_stats(renderer, &stats);
    return stats.kernels_beside;
}

/* Not under the validation layers, which let only one device compile at a time. */
TEST(the_second_device_translates_missing_kernels)
{
    unsetenv("WHIT_VALIDATION");
    const whit_renderer_params params = {.width = 50, .height = 30, .depth = 4};
    own_fixture f = fixture_open(terrain_scene(), NULL, &params);
    if (threads_available() < 2)
        skip();
    assert_int_equal(sem_init(&missing.translated, 0, 0), 0);
    own_image first = render(&f);
    missing.begins = true;
    fixture_renew(&f, &params);
    own_image second = render(&f);
    assert_false(missing.begins);
    assert_true(kernels_beside(f.renderer) > 0);
    assert_same_image("with a second device", &first, &second);
}
