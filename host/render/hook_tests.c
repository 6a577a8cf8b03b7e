/* Tests of a user's file on the device: one dispatch for all of them and all seeds. */
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/clock.h"
#include "device/buffer.h"
#include "device/commands.h"
#include "render/renderer.h"
#include "render/tiles.h"
#include "render/variants.h"

_Static_assert(TEST_SEEDS == WHIT_TEST_SEEDS && TEST_SEEDS % RENDER_GROUP_SIZE == 0,
               "whole groups of all seeds");

/* An entry of check_rows in shaders/hook/check.glsl. */
struct check_row {
    uint32_t reached, failed;
};

static uint64_t count_rows(const struct shader_tests *tests)
{
    return (uint64_t)tests->test_count * shader_tests_words(tests) * TEST_SEEDS;
}

static whit_result dispatch(struct renderer *renderer, const struct pass *pass, uint32_t groups,
                            uint32_t tests)
{
    struct commands *commands = renderer->commands;
    const struct gpu_chunk chunk = {.sample_index = 0};
    whit_result result = commands_begin(commands);
    if (result != WHIT_OK)
        return result;
    commands_fill(commands, renderer->picture.buffers.status, 0, 4, 0);
    commands_barrier(commands);
    commands_bind(commands, pass->pipeline, pass->set);
    commands_push(commands, &chunk, sizeof chunk);
    commands_dispatch(commands, groups, 1, tests);
    commands_barrier(commands);
    result = commands_run(commands);
    return result == WHIT_OK ? status_check(&renderer->picture, false) : result;
}

/* `rows`: one for each seed, of the word that has the check's bit. */
static whit_check_result result_of(const struct check_row *rows, uint32_t bit)
{
    whit_check_result result = {.reached = false};
    for (uint32_t seed = TEST_SEEDS; seed-- > 0;) {
        result.reached = result.reached || (rows[seed].reached & bit);
        if (rows[seed].failed & bit) {
            result.failed++;
            result.first_seed = seed;
        }
    }
    return result;
}

static whit_result run(struct renderer *renderer, const struct pass *pass, struct buffer *found,
                       whit_check_result *results)
{
    const struct shader_tests *tests = &renderer->params.shader->tests;
    uint64_t row_count = count_rows(tests);
    uint32_t words = shader_tests_words(tests);
    struct check_row *rows = array_alloc(row_count, sizeof *rows);
    if (!rows)
        return render_no_memory(renderer, "tests of a shader");
    whit_result result =
        dispatch(renderer, pass, TEST_SEEDS / RENDER_GROUP_SIZE, tests->test_count);
    if (result == WHIT_OK)
        result = buffer_read(found, 0, rows, row_count * sizeof *rows);
    for (uint32_t t = 0; result == WHIT_OK && t < tests->test_count; ++t) {
        const struct shader_test *test = &tests->tests[t];
        for (uint32_t i = 0; i < test->check_count; ++i)
            results[test->first_check + i] =
                result_of(rows + ((size_t)t * words + i / 32) * TEST_SEEDS, 1u << i % 32);
    }
    free(rows);
    return result;
}

whit_result renderer_run_tests(struct renderer *renderer, whit_check_result *results,
                               double *compile_ms, double *run_ms)
{
    const whit_shader *shader = renderer->params.shader;
    struct buffer *found = NULL;
    struct pass pass = {0};
    double start_ms = clock_ms();
    if (!shader || !shader->codes[HOOK_KERNEL_TEST].words)
        return log_usage(&renderer->log,
                         "there are no tests of a shader, or they were not compiled");
    whit_result result =
        buffer_create(renderer->device, count_rows(&shader->tests) * sizeof(struct check_row),
                      BUFFER_STORAGE | BUFFER_HOST, "checks", &found);
    if (result == WHIT_OK)
        result = variant_create_tests(&renderer->picture, found, &pass);
    if (result == WHIT_OK) /* lavapipe compiles a kernel at its first dispatch */
        result = dispatch(renderer, &pass, 1, 1);
    double made_ms = clock_ms();
    if (result == WHIT_OK)
        result = run(renderer, &pass, found, results);
    *compile_ms = made_ms - start_ms;
    *run_ms = clock_ms() - made_ms;
    pass_finish(&pass);
    buffer_destroy(found);
    return result;
}
