#include "shader/refuse.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "sources.h"

/* The last opcode of SPIR-V without extensions; extensions have larger ones. */
enum { LAST_PLAIN = 403, DEMOTE = 5380, TERMINATE = 4416 };

static bool within(uint32_t op, uint32_t first, uint32_t last)
{
    return op >= first && op <= last;
}

static const char *refused_operation(uint32_t op)
{
    if (op == OP_CONTROL_BARRIER || op == OP_MEMORY_BARRIER)
        return "barriers are whit's own: functions of users run for one ray alone";
    if (op == OP_KILL || op == TERMINATE || op == DEMOTE)
        return "a ray cannot be discarded: return something";
    if (within(op, OP_ATOMIC_LOAD, OP_ATOMIC_XOR))
        return "atomic operations are whit's own: functions of users write nothing but their "
               "results";
    if (within(op, OP_IMAGE_FIRST, OP_IMAGE_LAST) || op == OP_IMAGE_TEXEL_POINTER)
        return "images are whit's own";
    if (within(op, OP_GROUP_ELECT, OP_GROUP_LAST))
        return "subgroups are whit's own: which rays go together is not told";
    if (within(op, OP_DPDX_FIRST, OP_FWIDTH_LAST))
        return "there are no derivatives: functions of users run for one ray alone";
    if (op > LAST_PLAIN)
        return "an operation that is not to be had here";
    return NULL;
}

static bool is_fuel(const struct spv_module *m, uint32_t id)
{
    return id && (id == m->fuel || id == m->fuel_loop);
}

static const char *refused_write(const struct spv_module *m, const uint32_t *words)
{
    const uint32_t *pointer = spv_def(m, spv_type_of(m, words[1]));
    uint32_t storage = pointer && spv_op(pointer) == OP_TYPE_POINTER ? pointer[2] : UINT32_MAX;
    if (is_fuel(m, words[1]))
        return "whit_fuel is whit's own";
    if (storage == STORAGE_FUNCTION || storage == STORAGE_PRIVATE)
        return NULL;
    return "writes into buffers are whit's own: functions of users write nothing but their results";
}

static const char *refused_type(const struct spv_module *m, uint32_t type)
{
    const uint32_t *def = spv_def(m, type);
    while (def && (spv_op(def) == OP_TYPE_VECTOR || spv_op(def) == OP_TYPE_MATRIX))
        def = spv_def(m, def[2]);
    if (def && spv_op(def) == OP_TYPE_FLOAT && def[2] != 32)
        return "floats have 32 bits here: no double, no half";
    if (def && spv_op(def) == OP_TYPE_INT && def[2] < 32)
        return "integers have 32 bits or 64 here";
    return NULL;
}

/* Whether this reads a built-in variable such as gl_GlobalInvocationID. */
static bool reads_input(const struct spv_module *m, const uint32_t *words)
{
    uint32_t op = spv_op(words);
    const uint32_t *from = op == OP_LOAD || op == OP_ACCESS_CHAIN ? spv_def(m, words[3]) : NULL;
    return from && spv_op(from) == OP_VARIABLE && from[3] == STORAGE_INPUT;
}

const char *refuse_instruction(const struct spv_module *m, const uint32_t *words)
{
    uint32_t op = spv_op(words);
    if (op == OP_LINE || op == OP_NO_LINE || op == OP_LABEL || spv_length(words) < 2)
        return refused_operation(op == OP_NO_LINE ? OP_LINE : op);
    if (op == OP_LOAD && is_fuel(m, words[3]))
        return "whit_fuel is whit's own";
    if (reads_input(m, words))
        return "built-in variables are whit's own: pixel() and sample_number() tell calls apart";
    const char *why = op == OP_STORE || op == OP_COPY_MEMORY ? refused_write(m, words) : NULL;
    if (!why)
        why = refused_operation(op);
    if (why)
        return why;
    return refused_type(m, op == OP_STORE ? spv_type_of(m, words[2]) : words[1]);
}

const char *refuse_file(const struct spv_module *m, const uint32_t *function)
{
    const uint32_t *line = function - 4; /* the OpLine that glslang puts before a function */
    if (line < m->words + m->functions_at - 4 || line[0] != spv_head(OP_LINE, 4))
        return "";
    const char *name = spv_string(m, line[1]);
    size_t length = strlen(m->own);
    if (strncmp(name, m->own, length) != 0)
        return NULL;
    unsigned long index = strtoul(name + length, NULL, 10);
    return index < shader_source_count ? shader_sources[index].path : "";
}

bool refuse_call(const struct spv_module *m, const uint32_t *words, char *why)
{
    const uint32_t *function = spv_def(m, words[3]);
    const char *file = function ? refuse_file(m, function) : "";
    const char *name = file ? spv_name(m, words[3]) : NULL;
    if (!file || strncmp(file, "hook/", 5) == 0 || strncmp(file, "lib/", 4) == 0)
        return false;
    snprintf(why, SHADER_REASON_BYTES,
             "%.*s is whit's own: what can be called stands in shaders/hook/interface.glsl",
             (int)strcspn(name, "("), name);
    return true;
}

static bool was_counted(struct refuse_variables *all, struct spv_module *m, uint32_t table)
{
    for (uint32_t i = 0; i < all->table_count; ++i) {
        if (all->tables[i] == table)
            return true;
    }
    if (!ARRAY_PUSH(all->tables, all->table_count, all->table_capacity, table))
        m->failed = true;
    return false;
}

/* Whether a variable holds a scalar or vector argument of a call. glslang makes one for each
   argument, and drivers keep them in registers. */
static bool is_argument(const struct spv_module *m, const uint32_t *words, const uint32_t *pointer)
{
    const uint32_t *type = pointer && spv_length(pointer) == 4 ? spv_def(m, pointer[3]) : NULL;
    uint32_t op = type ? spv_op(type) : OP_TYPE_STRUCT;
    return op >= OP_TYPE_BOOL && op <= OP_TYPE_VECTOR &&
           strcmp(spv_name(m, words[2]), "param") == 0;
}

const char *refuse_variable(struct refuse_variables *all, struct spv_module *m,
                            const uint32_t *words)
{
    const uint32_t *pointer = spv_def(m, words[1]);
    if (is_argument(m, words, pointer) || (spv_length(words) == 5 && was_counted(all, m, words[4])))
        return NULL;
    uint64_t bytes = pointer && spv_length(pointer) == 4 ? spv_size(m, pointer[3]) : UINT64_MAX;
    bool before = all->refused;
    all->bytes = bytes > UINT64_MAX - all->bytes ? UINT64_MAX : all->bytes + bytes;
    all->refused = all->bytes > REFUSE_VARIABLE_BYTES;
    return all->refused && !before ? "variables of more than 16 KiB together, up to this one"
                                   : NULL;
}

uint32_t refuse_capability(const struct spv_module *m, const char **name)
{
    /* Matrix, Shader, Int64, SampledBuffer, ImageBuffer, GroupNonUniform and its kinds. */
    static const uint32_t known[] = {0, 1, 11, 46, 47, 61, 62, 63, 64, 65};
    static const struct {
        uint32_t capability;
        const char *name;
    } names[] = {{9, "16-bit floats"},   {10, "double"},      {22, "16-bit integers"},
                 {39, "8-bit integers"}, {51, "derivatives"}, {5, "addresses"}};
    for (const uint32_t *words = spv_step(m, NULL); words; words = spv_step(m, words)) {
        bool found = spv_op(words) != OP_CAPABILITY;
        for (size_t i = 0; !found && i < sizeof known / sizeof *known; ++i)
            found = words[1] == known[i];
        if (found)
            continue;
        *name = "";
        for (size_t i = 0; i < sizeof names / sizeof *names; ++i)
            *name = names[i].capability == words[1] ? names[i].name : *name;
        return words[1];
    }
    return 0;
}
