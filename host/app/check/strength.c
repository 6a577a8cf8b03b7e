#include "app/check/strength.h"

#include "app/check/faults.h"
#include "app/check/mutate.h"
#include "app/job.h"

static whit_result try_case(struct check *check, struct studio *studio, uint32_t index,
                            struct mutate *mutate, uint32_t faults)
{
    const struct check_case *item = &check->suite.cases[index];
    struct drawing drawing;
    suite_errors_of(&check->suite, item);
    whit_result result = studio_draw(studio, index, false, &drawing);
    const struct fault_case faulted = {item->name, studio_input(studio, item, &drawing), &drawing};
    if (result == WHIT_OK)
        result = check->power ? power_case(&mutate->random, &faulted)
                              : mutate_case(mutate, &faulted, faults);
    drawing_finish(&drawing);
    cli_errors_of(NULL);
    return result;
}

int strength_run(struct check *check)
{
    struct studio studio;
    struct mutate mutate = {.random = check->seed};
    uint32_t count = 0, at = 0;
    for (uint32_t i = 0; i < check->suite.count; ++i)
        count += check->wanted[i];
    whit_result result = studio_open(&studio, (enum golden_kind)check->on, &check->settings,
                                     &check->suite, check->wanted, &cli_log);
    for (uint32_t i = 0; result == WHIT_OK && i < check->suite.count; ++i) {
        if (!check->wanted[i])
            continue;
        uint32_t before = (uint32_t)((uint64_t)check->mutate * at / count);
        uint32_t behind = (uint32_t)((uint64_t)check->mutate * ++at / count);
        result = try_case(check, &studio, i, &mutate, behind - before);
    }
    studio_close(&studio);
    if (result != WHIT_OK)
        return cli_exit_of(result);
    return cli_finish_stdout(check->power ? EXIT_FINE : mutate_sum_up(&mutate));
}
