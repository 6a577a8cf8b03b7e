/* Kernels with their constants filled in. No device is needed. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "abi/bindings.h"
#include "abi/spec.h"
#include "device/device.h"
#include "device/specialize.h"
#include "kernels.h"

enum { HEADER_WORDS = 5, OP_SPEC_FIRST = 48, OP_SPEC_LAST = 52, OP_DECORATE = 71 };
enum { OP_FUNCTION = 54, OP_CALL = 57 };
enum { DECORATION_NO_CONTRACTION = 42 };

struct tally {
    uint32_t instructions, spec_constants, float_operations, exact, functions, calls;
    uint32_t inexact; /* float operations that are not marked */
};

/* OpFAdd 129, OpFSub 131, OpFMul 133, OpFDiv 136. */
static bool is_float_operation(uint32_t opcode)
{
    return opcode == 129 || opcode == 131 || opcode == 133 || opcode == 136;
}

/* Decorations come before functions, so one way through sees them first. */
static struct tally tally_of(const uint32_t *words, size_t count)
{
    struct tally tally = {0};
    size_t at = HEADER_WORDS;
    bool *marked = calloc(words[3], sizeof *marked); /* the bound of ids */
    assert_non_null(marked);
    while (at < count) {
        uint32_t opcode = words[at] & 0xffff, length = words[at] >> 16;
        assert_true(length > 0 && length <= count - at);
        ++tally.instructions;
        tally.spec_constants += opcode >= OP_SPEC_FIRST && opcode <= OP_SPEC_LAST;
        tally.float_operations += is_float_operation(opcode);
        tally.functions += opcode == OP_FUNCTION;
        tally.calls += opcode == OP_CALL;
        if (opcode == OP_DECORATE && words[at + 2] == DECORATION_NO_CONTRACTION) {
            ++tally.exact;
            marked[words[at + 1]] = true;
        }
        tally.inexact += is_float_operation(opcode) && !marked[words[at + 2]];
        at += length;
    }
    free(marked);
    return tally;
}

typedef bool fill_in(const uint32_t *words, size_t word_count, const uint32_t *spec,
                     uint32_t spec_count, uint32_t **out, size_t *out_words);

static fill_in *const ways[] = {spirv_specialize, spirv_evaluate};
enum { WAYS = 2 };

static uint32_t *filled_in(fill_in *way, enum kernel kernel, const struct gpu_spec *spec,
                           size_t *count)
{
    uint32_t *words = NULL;
    assert_true(way(kernels[kernel].words, kernels[kernel].bytes / 4, (const uint32_t *)spec,
                    GPU_SPEC_COUNT, &words, count));
    return words;
}

static struct tally specialized(fill_in *way, enum kernel kernel, const struct gpu_spec *spec)
{
    size_t count = 0;
    uint32_t *words = filled_in(way, kernel, spec, &count);
    struct tally tally = tally_of(words, count);
    free(words);
    return tally;
}

static void constants_are_gone_and_floats_stay_exact(void **state)
{
    (void)state;
    const struct gpu_spec all = GPU_SPEC_DEFAULTS;
    for (int i = 0; i < WAYS * KERNEL_COUNT; ++i) {
        enum kernel kernel = (enum kernel)(i / WAYS);
        struct tally before = tally_of(kernels[kernel].words, kernels[kernel].bytes / 4);
        struct tally after = specialized(ways[i % WAYS], kernel, &all);
        assert_true((before.spec_constants > 0) == (kernel != KERNEL_PRESENT));
        assert_int_equal(after.spec_constants, 0);
        assert_true(after.float_operations > 0);
        assert_true(after.exact >= after.float_operations);
        assert_int_equal(after.inexact, 0);
    }
}

/* One function, with the operations of all that it calls, as exact, and no binding that the other
   way leaves out. */
static void evaluated_kernels_call_nothing(void **state)
{
    (void)state;
    const struct gpu_spec all = GPU_SPEC_DEFAULTS;
    struct gpu_spec less = all;
    less.SPEC_REFRACTION = less.SPEC_FILTERS = less.SPEC_LISTED = 0;
    for (int i = 0; i < 2 * KERNEL_COUNT; ++i) {
        enum kernel kernel = (enum kernel)(i / 2);
        struct spirv_info with, without;
        size_t count = 0, flat_count = 0;
        uint32_t *words = filled_in(spirv_specialize, kernel, i % 2 ? &less : &all, &count);
        uint32_t *flat = filled_in(spirv_evaluate, kernel, i % 2 ? &less : &all, &flat_count);
        struct tally before = tally_of(words, count), after = tally_of(flat, flat_count);
        assert_true(spirv_inspect(words, count, &with));
        assert_true(spirv_inspect(flat, flat_count, &without));
        print_message("  %s: %u functions, %u float operations; flat: %u of %u not exact\n",
                      kernels[kernel].name, before.functions, before.float_operations,
                      after.inexact, after.float_operations);
        assert_true(before.functions > 1 && before.calls > 0);
        assert_int_equal(after.functions, 1);
        assert_int_equal(after.calls, 0);
        assert_true(after.float_operations >= before.float_operations);
        assert_int_equal(after.inexact, 0);
        assert_true(without.bindings == with.bindings);
        free(words);
        free(flat);
    }
}

static void what_is_switched_off_is_gone(void **state)
{
    (void)state;
    const struct gpu_spec all = GPU_SPEC_DEFAULTS;
    struct gpu_spec plain = all;
    plain.SPEC_REFRACTION = plain.SPEC_REFLECTION = plain.SPEC_TEXTURES = 0;
    plain.SPEC_SECONDARY = plain.SPEC_INSTANCED = plain.SPEC_FILTERS = 0;
    for (int i = 0; i < WAYS; ++i) {
        uint32_t of_all = specialized(ways[i], KERNEL_SHADE, &all).instructions;
        uint32_t of_plain = specialized(ways[i], KERNEL_SHADE, &plain).instructions;
        print_message("  %u instructions with every effect, %u without six\n", of_all, of_plain);
        assert_true(of_plain < of_all * 9 / 10);
    }
}

static void nonsense_is_left_to_the_driver(void **state)
{
    (void)state;
    uint32_t words[64], *out = NULL;
    size_t count = 0;
    memset(words, 0x5a, sizeof words);
    for (int i = 0; i < WAYS; ++i) {
        assert_false(ways[i](words, 64, NULL, 0, &out, &count));
        assert_null(out);
    }
}

/* Kernels cut short after each of their first instructions, and after some of the others. */
static void cut_kernels_are_refused(void **state)
{
    (void)state;
    const uint32_t *words = kernels[KERNEL_TRACE].words;
    const uint32_t total = (uint32_t)(kernels[KERNEL_TRACE].bytes / 4);
    const struct gpu_spec spec = GPU_SPEC_DEFAULTS;
    uint32_t cuts = 0;
    for (uint32_t at = HEADER_WORDS, i = 0; at < total; at += words[at] >> 16, ++i) {
        uint32_t *cut = malloc(at * sizeof *cut), *out = NULL; /* so that reading on is seen */
        size_t count = 0;
        if (!cut || (i > 500 && i % 97)) {
            free(cut);
            continue;
        }
        memcpy(cut, words, at * sizeof *cut);
        assert_false(
            spirv_evaluate(cut, at, (const uint32_t *)&spec, GPU_SPEC_COUNT, &out, &count));
        assert_null(out);
        free(cut);
        ++cuts;
    }
    print_message("  0 of %u cut kernels were taken\n", cuts);
    assert_true(cuts > 500);
}

/* Every binding that a function names is counted, and no other. */
static void bindings_follow_the_constants(void **state)
{
    (void)state;
    struct gpu_spec spec = GPU_SPEC_DEFAULTS;
    for (uint32_t i = 0; i < 2 * WAYS; ++i) {
        uint32_t path = i % 2 ? LOAD_TEXEL : LOAD_STORAGE;
        size_t count = 0;
        struct spirv_info info;
        spec.SPEC_LOAD_PATH = path;
        uint32_t *words = filled_in(ways[i / 2], KERNEL_CLOSEST, &spec, &count);
        assert_true(spirv_inspect(words, count, &info));
        assert_true(info.instructions > 0 &&
                    info.instructions < tally_of(words, count).instructions);
        assert_int_equal(info.bindings >> BIND_NODES & 1, path == LOAD_STORAGE);
        assert_int_equal(info.bindings >> BIND_NODE_TEXELS & 1, path == LOAD_TEXEL);
        assert_int_equal(info.bindings >> BIND_ENVIRONMENT & 1, 1);
        assert_int_equal(info.bindings >> BIND_COSTS & 1, 0); /* SPEC_COUNT is 0 */
        free(words);
    }
}

/* The number of the file of the only kernel in the cache. Writing it anew gives another one. */
static ino_t cached_file(const char *folder, char *path, size_t size)
{
    glob_t found;
    struct stat about;
    char pattern[128];
    snprintf(pattern, sizeof pattern, "%s/whit/kernel-*", folder);
    assert_int_equal(glob(pattern, 0, NULL, &found), 0);
    assert_int_equal(found.gl_pathc, 1);
    snprintf(path, size, "%s", found.gl_pathv[0]);
    globfree(&found);
    assert_int_equal(stat(path, &about), 0);
    return about.st_ino;
}

static void flip_bit(const char *path, long at)
{
    FILE *file = fopen(path, "r+b");
    assert_non_null(file);
    assert_int_equal(fseek(file, at, SEEK_SET), 0);
    int byte = fgetc(file);
    assert_int_equal(fseek(file, at, SEEK_SET), 0);
    assert_int_not_equal(fputc(byte ^ 4, file), EOF);
    assert_int_equal(fclose(file), 0);
}

static void assert_same_info(const struct pipeline_info *a, const struct pipeline_info *b)
{
    assert_true(a->specialized == b->specialized && a->instructions == b->instructions);
    assert_int_equal(a->bindings, b->bindings);
}

static void kernels_are_kept_and_damage_is_seen(void **state)
{
    (void)state;
    char folder[] = "/tmp/whit-kernels-XXXXXX", path[256];
    assert_non_null(mkdtemp(folder));
    assert_int_equal(setenv("XDG_CACHE_HOME", folder, 1), 0);
    const struct gpu_spec spec = GPU_SPEC_DEFAULTS;
    const struct pipeline_params params = {.spirv = kernels[KERNEL_TRACE].words,
                                           .spirv_bytes = kernels[KERNEL_TRACE].bytes,
                                           .spec = (const uint32_t *)&spec,
                                           .spec_count = GPU_SPEC_COUNT};
    struct pipeline_info first, again;
    assert_true(pipeline_count(&params, &first));
    ino_t file = cached_file(folder, path, sizeof path);
    assert_true(pipeline_count(&params, &again));
    assert_same_info(&again, &first);
    assert_int_equal(cached_file(folder, path, sizeof path), file);
    for (long at = 0; at < 200; at += 20) { /* header and words */
        file = cached_file(folder, path, sizeof path);
        flip_bit(path, at);
        FILE *held = fopen(path, "rb"); /* so that its number is not given to another one */
        assert_true(pipeline_count(&params, &again));
        assert_same_info(&again, &first);
        assert_int_not_equal(cached_file(folder, path, sizeof path), file);
        fclose(held);
    }
    assert_int_equal(unlink(path), 0);
    char inner[128];
    snprintf(inner, sizeof inner, "%s/whit", folder);
    assert_int_equal(rmdir(inner), 0);
    assert_int_equal(rmdir(folder), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(constants_are_gone_and_floats_stay_exact),
        cmocka_unit_test(evaluated_kernels_call_nothing),
        cmocka_unit_test(what_is_switched_off_is_gone),
        cmocka_unit_test(nonsense_is_left_to_the_driver),
        cmocka_unit_test(cut_kernels_are_refused),
        cmocka_unit_test(bindings_follow_the_constants),
        cmocka_unit_test(kernels_are_kept_and_damage_is_seen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
