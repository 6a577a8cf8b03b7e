#include "render/portable.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "abi/portable.h"
#include "base/hash.h"
#include "base/store.h"
#include "device/buffer.h"
#include "device/commands.h"
#include "device/pipeline.h"
#include "kernels.h"

_Static_assert((int)REWRITE_WHY_BYTES == (int)PORTABLE_WHY_BYTES, "the same room");

enum { GROUP = 64, GROUPS_MAX = 65535, VALUES = 12, CASES = VALUES * VALUES };

whit_result portable_rewrite(const void *user, const uint32_t *words, size_t word_count,
                             uint32_t **out, size_t *out_words, char why[REWRITE_WHY_BYTES])
{
    return shader_make_portable(user, words, word_count, out, out_words, why);
}

uint32_t portable_number(const struct portable_params *params)
{
    return (uint32_t)params->own_division | (uint32_t)params->asks_nearest << 1 |
           (uint32_t)params->asks_special << 2 | (uint32_t)params->asks_denormals << 3 |
           (uint32_t)params->own_comparison << 4;
}

/* Runs one function of kernel/portable.comp on a device. */
struct run {
    struct device *device;
    struct buffer *in, *out;
    struct pipeline *pipeline;
    struct binding_set *set;
    struct commands *commands;
};

static void run_finish(struct run *run)
{
    commands_destroy(run->commands);
    binding_set_destroy(run->set);
    pipeline_destroy(run->pipeline);
    buffer_destroy(run->out);
    buffer_destroy(run->in);
}

/* Declares the same float controls as kernels of pictures. Call run_finish also after an error. */
static whit_result run_init(struct run *run, struct device *device,
                            const struct portable_params *asks, uint32_t function)
{
    static const enum binding_kind bindings[] = {BINDING_STORAGE, BINDING_STORAGE};
    const uint32_t spec[] = {1, function, 1};
    const struct pipeline_params params = {
        .spirv = portable_kernel.words,
        .spirv_bytes = portable_kernel.bytes,
        .rewrite = portable_rewrite,
        .rewrite_user = asks,
        .rewrite_as = portable_number(asks),
        .spec = spec,
        .spec_count = 3,
        .bindings = bindings,
        .binding_count = 2,
        .name = "floats of the device",
    };
    *run = (struct run){.device = device};
    whit_result result =
        buffer_create(device, CASES * 2 * sizeof(uint32_t), BUFFER_STORAGE, "cases", &run->in);
    if (result == WHIT_OK)
        result = buffer_create(device, CASES * sizeof(uint32_t), BUFFER_STORAGE | BUFFER_ZEROED,
                               "answers", &run->out);
    if (result == WHIT_OK)
        result = pipeline_create(device, &params, &run->pipeline);
    if (result == WHIT_OK)
        result =
            binding_set_create(run->pipeline, (struct buffer *[]){run->in, run->out}, 2, &run->set);
    if (result == WHIT_OK)
        result = commands_create(device, "floats of the device", &run->commands);
    return result;
}

static whit_result run_dispatch(struct run *run, const void *cases, uint32_t bytes, uint32_t groups)
{
    whit_result result = buffer_write(run->in, 0, cases, bytes);
    if (result == WHIT_OK)
        result = commands_begin(run->commands);
    if (result != WHIT_OK)
        return result;
    commands_bind(run->commands, run->pipeline, run->set);
    commands_dispatch(run->commands, groups, 1, 1);
    return commands_run(run->commands);
}

/* Runs compare() of kernel/portable.comp over all of its cases. */
static whit_result compare_division(struct device *device, const struct portable_params *asks,
                                    bool *same)
{
    struct run run;
    uint32_t others = 0;
    whit_result result = run_init(&run, device, asks, PORTABLE_COMPARED);
    for (uint32_t first = 0; result == WHIT_OK && first < COMPARED_ALL;
         first += GROUPS_MAX * GROUP) {
        const uint32_t from[2] = {first, 0};
        result = run_dispatch(&run, from, sizeof from, GROUPS_MAX);
    }
    if (result == WHIT_OK)
        result = buffer_read(run.out, 0, &others, sizeof others);
    *same = others == 0;
    run_finish(&run);
    return result;
}

static float as_float(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static bool is_denormal(uint32_t bits)
{
    return (bits & 0x7f800000) == 0 && (bits & 0x7fffffff) != 0;
}

/* The answer that kernel/portable.comp must give: this processor's result, which is IEEE's. */
static uint32_t right_answer(uint32_t function, float x, float y)
{
    float right = function == PORTABLE_SUM       ? x + y
                  : function == PORTABLE_PRODUCT ? x * y
                                                 : fabsf(x);
    uint32_t bits;
    if (function == PORTABLE_RELATIONS)
        return (uint32_t)(x < y) | (uint32_t)(x <= y) << 1 | (uint32_t)(x == y) << 2 |
               (uint32_t)(x != y) << 3 | (uint32_t)(x > y) << 4 | (uint32_t)(x >= y) << 5 |
               (uint32_t) !(y < x) << 6;
    memcpy(&bits, &right, sizeof bits);
    return bits;
}

/* Tests sums, products, relations or absolute values of a few floats. */
static whit_result compare_plain(struct device *device, const struct portable_params *asks,
                                 uint32_t function, whit_device_floats *out)
{
    static const uint32_t values[VALUES] = {1,          0x80000003, 0x00400000, 0x007fffff,
                                            0x00800000, 0x80800001, 0x3f800000, 0x3f000000,
                                            0xbf7fffff, 0x33800000, 0x33800001, 0x4b7fffff};
    uint32_t cases[CASES][2], answers[CASES];
    struct run run;
    for (uint32_t i = 0; i < CASES; ++i) {
        cases[i][0] = values[i / VALUES];
        cases[i][1] = values[i % VALUES];
    }
    whit_result result = run_init(&run, device, asks, function);
    if (result == WHIT_OK)
        result = run_dispatch(&run, cases, sizeof cases, (CASES + GROUP - 1) / GROUP);
    if (result == WHIT_OK)
        result = buffer_read(run.out, 0, answers, sizeof answers);
    for (uint32_t i = 0; result == WHIT_OK && i < CASES; ++i) {
        float x = as_float(cases[i][0]), y = as_float(cases[i][1]);
        uint32_t bits = right_answer(function, x, y);
        bool rounds = function == PORTABLE_SUM || function == PORTABLE_PRODUCT;
        bool small = is_denormal(cases[i][0]) || is_denormal(cases[i][1]) || is_denormal(bits);
        bool *fine = !rounds ? &out->own_comparison
                     : small ? &out->keeps_denormals
                             : &out->rounds_nearest;
        *fine = *fine && answers[i] == bits;
    }
    run_finish(&run);
    return result;
}

static struct portable_params asks_of(const struct device *device)
{
    const struct device_limits *limits = device_get_limits(device);
    return (struct portable_params){.own_division = true,
                                    .own_comparison = true,
                                    .asks_nearest = limits->asked_nearest,
                                    .asks_special = limits->asked_special,
                                    .asks_denormals = limits->asked_denormals};
}

static whit_result find_out(struct device *device, whit_device_floats *out)
{
    const struct portable_params asks = asks_of(device);
    static const uint32_t plain[] = {PORTABLE_SUM, PORTABLE_PRODUCT, PORTABLE_RELATIONS,
                                     PORTABLE_ABS};
    *out = (whit_device_floats){false, true, true, true};
    whit_result result = compare_division(device, &asks, &out->own_division);
    for (size_t i = 0; result == WHIT_OK && i < sizeof plain / sizeof *plain; ++i)
        result = compare_plain(device, &asks, plain[i], out);
    return result;
}

whit_result portable_find(const whit_log *log, struct device *device, whit_device_floats *out)
{
    uint8_t *kept = NULL;
    size_t bytes = 0;
    char what[32], *name;
    whit_result result = WHIT_OK;
    const char *driver = device_get_info(device)->driver;
    /* The key has the driver's name and version, since not every driver changes its UUID with
       them. */
    uint64_t hash = hash_bytes(HASH_START, driver, strlen(driver));
    snprintf(what, sizeof what, "floats-%016llx", (unsigned long long)hash);
    name = device_kept_name(device, what);
    if (name && store_read(log, name, &kept, &bytes) && bytes == 4) {
        *out = (whit_device_floats){kept[0] == 1, kept[1] == 1, kept[2] == 1, kept[3] == 1};
    } else {
        result = find_out(device, out);
        const uint8_t found[] = {out->own_division, out->keeps_denormals, out->rounds_nearest,
                                 out->own_comparison};
        if (result == WHIT_OK && name)
            store_write(log, name, found, sizeof found);
    }
    free(kept);
    free(name);
    return result;
}

static bool is_off(const char *variable)
{
    const char *value = getenv(variable);
    return value && strcmp(value, "0") == 0;
}

whit_result portable_choose(const whit_log *log, struct device *device, struct portable_params *out)
{
    whit_device_floats found = {true, true, true, true};
    *out = (struct portable_params){.own_division = true, .own_comparison = true};
    whit_result result = device ? portable_find(log, device, &found) : WHIT_OK;
    if (result != WHIT_OK)
        return result;
    if (device)
        *out = asks_of(device);
    out->own_division = found.own_division && !is_off("WHIT_OWN_DIVISION");
    out->own_comparison = found.own_comparison && !is_off("WHIT_OWN_COMPARISON");
    if (found.keeps_denormals && found.rounds_nearest)
        return WHIT_OK;
    return log_failure(log, WHIT_ERROR_DEVICE, "%s %s, so that no picture of it is portable",
                       device_get_info(device)->name,
                       found.rounds_nearest ? "takes floats below 2^-126 for 0"
                                            : "does not round sums and products to nearest");
}
