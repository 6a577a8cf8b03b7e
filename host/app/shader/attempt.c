#include "app/shader/attempt.h"

#include <stdlib.h>
#include <string.h>

/* Size in pixels of the picture in which expectations are checked. */
enum { WIDTH = 160, HEIGHT = 120 };

/* ---- On the device ---- */

static whit_result begin_scene(struct job *job, const char *scene)
{
    if (!scene)
        return whit_scene_small(&cli_log_errors, &job->scene);
    if (strlen(scene) >= sizeof job->settings.scene)
        return CLI_FAIL(WHIT_ERROR_USAGE, "%s: the path is too long", scene);
    strcpy(job->settings.scene, scene);
    return job_load(job);
}

static whit_renderer_params params_of(const struct job *job)
{
    whit_renderer_params params = job_picture(job);
    params.width = WIDTH;
    params.height = HEIGHT;
    return params;
}

/* Lists every kernel that a picture may have, as for a picture of many rays, which uses more
   kernels. */
static whit_result list_kernels(const struct job *job, struct attempt *attempt)
{
    whit_renderer_params params = params_of(job);
    params.classes = WHIT_CLASSES_MANY;
    whit_result result = whit_kernels_list(job->device, job->accel, &params, true, attempt->kernels,
                                           &attempt->kernel_count);
    params.shader = NULL;
    params.sliders = NULL;
    if (result == WHIT_OK)
        result = whit_kernels_list(job->device, job->accel, &params, false, attempt->base,
                                   &attempt->base_count);
    return result;
}

static whit_result run_tests(struct job *job, whit_renderer *renderer, struct attempt *attempt)
{
    attempt->checks = calloc(attempt->info.check_count, sizeof *attempt->checks);
    double start_ms = whit_clock_ms();
    if (!attempt->checks)
        return WHIT_ERROR_MEMORY;
    whit_result result = whit_shader_compile_tests(job->compiler, job->shader);
    attempt->compile_ms = whit_clock_ms() - start_ms;
    if (result == WHIT_OK)
        result = whit_renderer_run_tests(renderer, attempt->checks, &attempt->driver_ms,
                                         &attempt->run_ms);
    if (result != WHIT_OK) {
        free(attempt->checks);
        attempt->checks = NULL;
    }
    return result;
}

static whit_result try_pictures(struct job *job, struct attempt *attempt)
{
    whit_renderer *renderer = NULL;
    const whit_renderer_params params = params_of(job);
    whit_result result = whit_renderer_create(job->device, job->accel, &params, &renderer);
    if (result == WHIT_OK && attempt->info.test_count)
        result = run_tests(job, renderer, attempt);
    if (result == WHIT_OK && attempt->info.expectation_count)
        result = whit_renderer_render(renderer);
    if (result == WHIT_OK && attempt->info.expectation_count)
        result = whit_renderer_check_expectations(renderer, &attempt->held);
    whit_renderer_destroy(renderer);
    return result;
}

whit_result attempt_make(struct job *job, const char *scene, struct attempt *attempt)
{
    const whit_shader_info *info = &attempt->info;
    whit_shader_get_info(job->shader, &attempt->info);
    bool needs = info->test_count || info->expectation_count;
    job_start(job);
    if (!needs && !job_any_device()) {
        cli_note("there is no usable device: kernels are not tried");
        return WHIT_OK;
    }
    whit_result result = begin_scene(job, scene);
    if (result == WHIT_OK)
        result = job_build(job);
    if (result == WHIT_OK)
        result = job_open_device(job);
    if (result == WHIT_OK && info->kernel_count)
        result = list_kernels(job, attempt);
    if (result == WHIT_OK && needs)
        result = try_pictures(job, attempt);
    return result;
}

void attempt_finish(struct attempt *attempt)
{
    free(attempt->checks);
    *attempt = (struct attempt){0};
}

/* ---- What came of it ---- */

/* The SPIR-V instructions of whit's own kernel of the same name; 0: there is no such kernel. */
static uint32_t base_instructions(const struct attempt *attempt, const whit_kernel *kernel)
{
    for (uint32_t i = 0; i < attempt->base_count; ++i) {
        if (strcmp(attempt->base[i].name, kernel->name) == 0 &&
            attempt->base[i].deferred == kernel->deferred)
            return attempt->base[i].instructions;
    }
    return 0;
}

static void print_kernels(const struct attempt *attempt)
{
    if (attempt->kernel_count)
        printf("  kernel              SPIR-V  whit's own      made in\n");
    for (uint32_t i = 0; i < attempt->kernel_count; ++i) {
        const whit_kernel *kernel = &attempt->kernels[i];
        uint32_t base = base_instructions(attempt, kernel);
        char own[16] = "-";
        if (base)
            snprintf(own, sizeof own, "%u", base);
        printf("  %-13s %12u %11s %9.1f ms\n", kernel->name, kernel->instructions, own,
               kernel->create_ms);
    }
}

static uint32_t count_wrong(const struct attempt *attempt, const whit_shader_test *test)
{
    uint32_t wrong = 0;
    for (uint32_t i = test->first_check; i < test->first_check + test->check_count; ++i)
        wrong += attempt->checks[i].failed || !attempt->checks[i].reached;
    return wrong;
}

static void say_wrong(const struct attempt *attempt, const whit_shader_test *test)
{
    for (uint32_t i = test->first_check; i < test->first_check + test->check_count; ++i) {
        const whit_shader_check *check = &attempt->info.checks[i];
        const whit_check_result *result = &attempt->checks[i];
        if (result->failed)
            cli_error("%s:%u: check(%s) fails for %u of %d seeds of %s, the smallest is %u",
                      cli_shown(check->file), check->line, cli_shown(check->text), result->failed,
                      WHIT_TEST_SEEDS, test->name, result->first_seed);
        else if (!result->reached)
            cli_error("%s:%u: check(%s) is not reached by any seed of %s", cli_shown(check->file),
                      check->line, cli_shown(check->text), test->name);
    }
}

void attempt_say(const struct attempt *attempt)
{
    for (uint32_t i = 0; attempt->checks && i < attempt->info.test_count; ++i)
        say_wrong(attempt, &attempt->info.tests[i]);
}

void attempt_print(const struct attempt *attempt)
{
    const whit_shader_info *info = &attempt->info;
    print_kernels(attempt);
    for (uint32_t i = 0; attempt->checks && i < info->test_count; ++i) {
        const whit_shader_test *test = &info->tests[i];
        uint32_t wrong = count_wrong(attempt, test);
        printf("  test %s: %s, %u check%s of %d seeds", test->name, wrong ? "FAILED" : "passed",
               test->check_count, test->check_count == 1 ? "" : "s", WHIT_TEST_SEEDS);
        if (wrong)
            printf(", %u failed", wrong);
        putchar('\n');
    }
    if (attempt->checks)
        printf("  tests: compiled in %.0f ms, made by the driver in %.0f ms, run in %.1f ms\n",
               attempt->compile_ms, attempt->driver_ms, attempt->run_ms);
    for (uint32_t i = 0; attempt->held && i < info->expectation_count; ++i)
        printf("  expected: %s == base\n", info->expectations[i].word);
}

static void put_check(json_t *object, const whit_shader_check *check,
                      const whit_check_result *result)
{
    document_text(object, "text", check->text);
    document_text(object, "file", check->file);
    document_count(object, "line", check->line);
    document_flag(object, "reached", result->reached);
    document_count(object, "failed", result->failed);
    document_count(object, "first_seed", result->first_seed);
}

static json_t *describe_tests(const struct attempt *attempt)
{
    const whit_shader_info *info = &attempt->info;
    json_t *list = document_array();
    for (uint32_t i = 0; attempt->checks && i < info->test_count; ++i) {
        const whit_shader_test *test = &info->tests[i];
        json_t *object = document_entry(list);
        document_text(object, "name", test->name);
        document_text(object, "file", test->file);
        document_count(object, "line", test->line);
        document_count(object, "seeds", WHIT_TEST_SEEDS);
        json_t *checks = document_list(object, "checks");
        for (uint32_t c = test->first_check; c < test->first_check + test->check_count; ++c)
            put_check(document_entry(checks), &info->checks[c], &attempt->checks[c]);
    }
    return list;
}

static json_t *describe_kernels(const struct attempt *attempt)
{
    json_t *list = document_array();
    for (uint32_t i = 0; i < attempt->kernel_count; ++i) {
        const whit_kernel *kernel = &attempt->kernels[i];
        json_t *object = document_entry(list);
        document_text(object, "name", kernel->name);
        document_count(object, "instructions", kernel->instructions);
        document_count(object, "base_instructions", base_instructions(attempt, kernel));
        document_ms(object, "create_ms", kernel->create_ms);
    }
    return list;
}

void attempt_describe(const struct attempt *attempt, json_t *object)
{
    const whit_shader_info *info = &attempt->info;
    document_put(object, "variants", describe_kernels(attempt));
    document_put(object, "tests", describe_tests(attempt));
    json_t *expected = document_list(object, "expected");
    for (uint32_t i = 0; i < info->expectation_count; ++i) {
        json_t *one = document_entry(expected);
        document_text(one, "name", info->expectations[i].word);
        document_text(one, "file", info->expectations[i].file);
        document_count(one, "line", info->expectations[i].line);
    }
    document_flag(object, "held", attempt->held || !info->expectation_count);
    json_t *times = document_child(object, "test_times");
    document_ms(times, "compile_ms", attempt->compile_ms);
    document_ms(times, "driver_ms", attempt->driver_ms);
    document_ms(times, "run_ms", attempt->run_ms);
}

int attempt_status(const struct attempt *attempt)
{
    const whit_shader_info *info = &attempt->info;
    bool fine = attempt->held || !info->expectation_count;
    for (uint32_t i = 0; attempt->checks && i < info->check_count; ++i)
        fine = fine && attempt->checks[i].reached && !attempt->checks[i].failed;
    return fine ? EXIT_FINE : EXIT_DIFFERS;
}
