/* Records as the kernels see them, read from SPIR-V, against the C compiler's. */
#include "../unit/unit.h"

#include "abi/bvh.h"
#include "abi/queues.h"
#include "abi/shade.h"
#include "abi/spec.h"
#include "base/spirv.h"
#include "kernels.h"

#include "abi_check.h"
#include "records.h"

enum { IDS_MAX = 65536, MEMBERS_MAX = 64 };

/* In the order of the header: a record, then its members. */
static const struct entry {
    const char *record, *member; /* member: NULL for the record itself */
    size_t bytes;                /* its size, or the member's offset */
} table[] = {
#define TABLE_RECORD(record)         {#record, NULL, sizeof(struct record)},
#define TABLE_MEMBER(record, member) {#record, #member, offsetof(struct record, member)},
    RECORDS(TABLE_RECORD, TABLE_MEMBER)};
enum { TABLE_COUNT = sizeof table / sizeof *table };

static const struct constant {
    uint32_t id;
    const char *name;
    uint32_t value;
} constants[] = {
#define CONSTANT(id, name, value) {id, #name, value},
    GPU_SPEC_LIST(CONSTANT)};

struct id {
    const char *name;
    const char *member_names[MEMBERS_MAX];
    int32_t offsets[MEMBERS_MAX]; /* -1: not decorated */
    uint32_t member_count, element, stride, value;
    int32_t spec_id;
    bool is_struct, is_array;
};

struct module {
    struct id *ids;
    uint32_t count;
};

static void read_decoration(struct id *id, uint32_t decoration, uint32_t value)
{
    if (decoration == DECORATION_ARRAY_STRIDE)
        id->stride = value;
    else if (decoration == DECORATION_SPEC_ID)
        id->spec_id = (int32_t)value;
}

static void read_instruction(struct module *module, const uint32_t *op, uint32_t length)
{
    struct id *id = &module->ids[op[1]];
    switch (spv_op(op)) {
    case OP_NAME:
        id->name = (const char *)&op[2];
        break;
    case OP_MEMBER_NAME:
        assert_true(op[2] < MEMBERS_MAX);
        id->member_names[op[2]] = (const char *)&op[3];
        break;
    case OP_DECORATE:
        read_decoration(id, op[2], length > 3 ? op[3] : 0);
        break;
    case OP_MEMBER_DECORATE:
        assert_true(op[2] < MEMBERS_MAX);
        if (op[3] == DECORATION_OFFSET)
            id->offsets[op[2]] = (int32_t)op[4];
        break;
    case OP_TYPE_STRUCT:
        id->is_struct = true;
        id->member_count = length - 2;
        break;
    case OP_TYPE_RUNTIME_ARRAY:
        id->is_array = true;
        id->element = op[2];
        break;
    case OP_SPEC_CONSTANT:
        module->ids[op[2]].value = op[3];
        break;
    default:
        break;
    }
}

static struct module module_read(const uint32_t *words, size_t bytes)
{
    struct module module = {.count = words[SPV_BOUND_AT]};
    assert_int_equal(words[0], SPV_MAGIC);
    assert_true(module.count < IDS_MAX);
    module.ids = calloc(module.count, sizeof *module.ids);
    assert_non_null(module.ids);
    for (uint32_t i = 0; i < module.count; ++i) {
        module.ids[i].spec_id = -1;
        memset(module.ids[i].offsets, -1, sizeof module.ids[i].offsets);
    }
    for (size_t i = SPV_HEADER_WORDS; i < bytes / sizeof *words;) {
        uint32_t length = spv_length(words + i);
        assert_true(length > 0 && i + length <= bytes / sizeof *words);
        if (length > 1 && words[i + 1] < module.count)
            read_instruction(&module, &words[i], length);
        i += length;
    }
    return module;
}

static const struct entry *find_record(const char *name)
{
    for (size_t i = 0; i < TABLE_COUNT; ++i) {
        if (!table[i].member && strcmp(table[i].record, name) == 0)
            return &table[i];
    }
    fail_msg("%s is not in the table", name);
    return NULL;
}

/* Structs of local variables have no offsets. */
static bool is_laid_out(const struct id *id)
{
    return id->is_struct && id->name && strncmp(id->name, "gpu_", 4) == 0 && id->offsets[0] >= 0;
}

static void check_struct(const struct id *id)
{
    const struct entry *entry = find_record(id->name);
    for (uint32_t i = 0; i < id->member_count; ++i) {
        ++entry;
        assert_true(entry < table + TABLE_COUNT && entry->member);
        assert_string_equal(entry->record, id->name);
        assert_string_equal(entry->member, id->member_names[i]);
        if ((size_t)id->offsets[i] != entry->bytes)
            fail_msg("%s.%s is at %d in SPIR-V, at %zu in C", id->name, entry->member,
                     id->offsets[i], entry->bytes);
    }
    ++entry;
    if (entry < table + TABLE_COUNT && entry->member)
        fail_msg("%s.%s is not in SPIR-V", id->name, entry->member);
}

/* The number of records seen in arrays. */
static uint32_t check_module(const uint32_t *words, size_t bytes)
{
    struct module module = module_read(words, bytes);
    uint32_t strides = 0;
    for (uint32_t i = 0; i < module.count; ++i) {
        const struct id *id = &module.ids[i];
        if (is_laid_out(id))
            check_struct(id);
        if (!id->is_array || id->element >= module.count || !is_laid_out(&module.ids[id->element]))
            continue;
        const struct entry *record = find_record(module.ids[id->element].name);
        if (id->stride != record->bytes)
            fail_msg("%s: stride %u in SPIR-V, size %zu in C", record->record, id->stride,
                     record->bytes);
        ++strides;
    }
    free(module.ids);
    return strides;
}

TEST(every_record_has_the_same_layout)
{
    uint32_t records = 0;
    for (size_t i = 0; i < TABLE_COUNT; ++i)
        records += !table[i].member;
    assert_true(records >= 10 && TABLE_COUNT > 100);
    assert_int_equal(check_module(abi_check, sizeof abi_check), records);
}

TEST(kernels_use_these_layouts)
{
    for (int i = 0; i < KERNEL_COUNT; ++i) {
        uint32_t records = check_module(kernels[i].words, kernels[i].bytes);
        assert_true(records > 0);
    }
}

static void check_constants(const uint32_t *words, size_t bytes, bool all)
{
    struct module module = module_read(words, bytes);
    bool seen[GPU_SPEC_COUNT] = {false};
    for (uint32_t i = 0; i < module.count; ++i) {
        const struct id *id = &module.ids[i];
        if (id->spec_id < 0 || !id->name || strncmp(id->name, "SPEC_", 5) != 0)
            continue;
        assert_true((uint32_t)id->spec_id < GPU_SPEC_COUNT);
        const struct constant *constant = &constants[id->spec_id];
        assert_string_equal(id->name, constant->name);
        assert_int_equal(id->value, constant->value);
        seen[id->spec_id] = true;
    }
    for (uint32_t i = 0; all && i < GPU_SPEC_COUNT; ++i)
        assert_true(seen[i]);
    free(module.ids);
}

/* render/ passes struct gpu_spec as an array of words indexed by id. */
TEST(constants_are_in_the_order_of_their_ids)
{
    assert_int_equal(sizeof constants / sizeof *constants, GPU_SPEC_COUNT);
    const struct gpu_spec defaults = GPU_SPEC_DEFAULTS;
    uint32_t words[GPU_SPEC_COUNT];
    memcpy(words, &defaults, sizeof words);
    for (uint32_t i = 0; i < GPU_SPEC_COUNT; ++i) {
        assert_int_equal(constants[i].id, i);
        assert_int_equal(constants[i].value, words[i]);
    }
    check_constants(abi_check, sizeof abi_check, true);
    for (int i = 0; i < KERNEL_COUNT; ++i)
        check_constants(kernels[i].words, kernels[i].bytes, false);
}
