#include "shader/module.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"

static const uint32_t WHIT_OWN = UINT32_MAX;

static bool is_type(uint32_t op)
{
    return op >= OP_TYPE_VOID && op <= OP_TYPE_FUNCTION;
}

/* An instruction with a type has the type's id in front of its result id, and no other instruction
   begins with the id of a type. */
uint32_t spv_result(const struct spv_module *m, const uint32_t *words)
{
    uint32_t op = spv_op(words), length = spv_length(words);
    if ((is_type(op) || op == OP_STRING || op == OP_EXT_INST_IMPORT || op == OP_LABEL) &&
        length >= 2)
        return words[1];
    if (length < 3 || op == OP_NAME || op == OP_MEMBER_NAME || op == OP_DECORATE ||
        op == OP_DECORATE + 1 || op == OP_ENTRY_POINT || op == OP_LINE)
        return 0;
    const uint32_t *type = spv_def(m, words[1]);
    return type && is_type(spv_op(type)) ? words[2] : 0;
}

const uint32_t *spv_def(const struct spv_module *m, uint32_t id)
{
    return id < m->bound && m->defined_at[id] ? m->words + m->defined_at[id] : NULL;
}

uint32_t spv_type_of(const struct spv_module *m, uint32_t id)
{
    const uint32_t *def = spv_def(m, id);
    return def && !is_type(spv_op(def)) && spv_length(def) >= 3 && spv_def(m, def[1]) ? def[1] : 0;
}

bool spv_constant_value(const struct spv_module *m, uint32_t id, uint32_t *value)
{
    const uint32_t *def = spv_def(m, id);
    if (!def || spv_op(def) != OP_CONSTANT || spv_length(def) != 4)
        return false;
    *value = def[3];
    return true;
}

const char *spv_string(const struct spv_module *m, uint32_t id)
{
    const uint32_t *def = spv_def(m, id);
    if (!def || spv_op(def) != OP_STRING)
        return "";
    const char *text = (const char *)(def + 2);
    return memchr(text, 0, 4 * (size_t)(spv_length(def) - 2)) ? text : "";
}

const char *spv_name(const struct spv_module *m, uint32_t id)
{
    for (const uint32_t *words = spv_step(m, NULL); words; words = spv_step(m, words)) {
        if (spv_op(words) == OP_NAME && spv_length(words) > 2 && words[1] == id)
            return (const char *)(words + 2);
    }
    return "";
}

static uint64_t times(uint64_t size, uint64_t count)
{
    return size && count > UINT64_MAX / size ? UINT64_MAX : size * count;
}

/* Gives the value of a constant; for a specialization constant its default. UINT64_MAX: it is not
   known. */
static uint64_t usual_length(const struct spv_module *m, uint32_t id)
{
    const uint32_t *def = spv_def(m, id);
    bool known = def && spv_length(def) == 4 &&
                 (spv_op(def) == OP_CONSTANT || spv_op(def) == OP_SPEC_CONSTANT);
    return known ? def[3] : UINT64_MAX;
}

uint64_t spv_size(const struct spv_module *m, uint32_t type)
{
    const uint32_t *def = spv_def(m, type);
    uint64_t sum = 0;
    if (!def || spv_length(def) < 2)
        return UINT64_MAX;
    switch (spv_op(def)) {
    case OP_TYPE_BOOL:
        return 4;
    case OP_TYPE_INT:
    case OP_TYPE_FLOAT:
        return (def[2] + 7) / 8;
    case OP_TYPE_VECTOR:
    case OP_TYPE_MATRIX:
        return times(spv_size(m, def[2]), def[3]);
    case OP_TYPE_ARRAY:
        return times(spv_size(m, def[2]), usual_length(m, def[3]));
    case OP_TYPE_STRUCT:
        for (uint32_t i = 2; i < spv_length(def); ++i) {
            uint64_t size = spv_size(m, def[i]);
            sum = size > UINT64_MAX - sum ? UINT64_MAX : sum + size;
        }
        return sum;
    default:
        return UINT64_MAX;
    }
}

/* --- reading -------------------------------------------------------------------------------- */

static void read_name(struct spv_module *m, const uint32_t *words)
{
    const char *name = (const char *)(words + 2);
    size_t bytes = 4 * (size_t)(spv_length(words) - 2);
    if (bytes > sizeof "whit_fuel" && strncmp(name, "whit_fuel", bytes) == 0)
        m->fuel = words[1];
    if (bytes >= sizeof "whit_fuel_loop" && strncmp(name, "whit_fuel_loop", bytes) == 0)
        m->fuel_loop = words[1];
}

static bool is_private(const struct spv_module *m, uint32_t id)
{
    const uint32_t *def = spv_def(m, id);
    return def && spv_op(def) == OP_VARIABLE && def[3] == STORAGE_PRIVATE;
}

bool spv_read(struct spv_module *m, const uint32_t *words, size_t count, const char *own)
{
    *m = (struct spv_module){.words = words, .count = count, .own = own};
    if (count < SPV_HEADER_WORDS || words[0] != SPV_MAGIC || words[SPV_BOUND_AT] > SPV_BOUND_MAX ||
        count > UINT32_MAX)
        return false;
    m->bound = m->next_id = words[SPV_BOUND_AT];
    m->defined_at = calloc(m->bound + (size_t)1, sizeof *m->defined_at);
    if (!m->defined_at)
        return false;
    for (size_t at = SPV_HEADER_WORDS; at < count; at += spv_length(words + at)) {
        uint32_t length = spv_length(words + at), op = spv_op(words + at);
        if (length == 0 || length > count - at)
            return false;
        uint32_t id = spv_result(m, words + at);
        if (id >= m->bound)
            return false;
        if (id)
            m->defined_at[id] = (uint32_t)at;
        if (op == OP_FUNCTION && !m->functions_at)
            m->functions_at = at;
        if (op == OP_NAME && length > 2)
            read_name(m, words + at);
        if (op == OP_EXT_INST_IMPORT)
            m->glsl = words[at + 1];
    }
    m->fuel = is_private(m, m->fuel) ? m->fuel : 0;
    m->fuel_loop = is_private(m, m->fuel_loop) ? m->fuel_loop : 0;
    m->place.file = WHIT_OWN;
    return m->functions_at != 0;
}

void spv_finish(struct spv_module *m)
{
    free(m->defined_at);
    free(m->globals.words);
    free(m->zeroed.words);
    free(m->body.words);
    free(m->constants);
    *m = (struct spv_module){0};
}

const uint32_t *spv_step(const struct spv_module *m, const uint32_t *words)
{
    const uint32_t *next = words ? words + spv_length(words) : m->words + SPV_HEADER_WORDS;
    return next < m->words + m->functions_at ? next : NULL;
}

const uint32_t *spv_next_function(const struct spv_module *m, const uint32_t *function)
{
    const uint32_t *end = m->words + m->count,
                   *at = function ? function + spv_length(function) : m->words + m->functions_at;
    while (at < end && spv_op(at) != OP_FUNCTION)
        at += spv_length(at);
    return at < end ? at : NULL;
}

uint32_t spv_function_words(const struct spv_module *m, const uint32_t *function)
{
    const uint32_t *end = m->words + m->count, *at = function;
    while (at < end && spv_op(at) != OP_FUNCTION_END)
        at += spv_length(at);
    return (uint32_t)((at < end ? at + 1 : at) - function);
}

/* --- what stands where in an instruction ------------------------------------------------------ */

/* The number of words, from the first, that may be ids. */
static uint32_t id_words(uint32_t op, uint32_t length)
{
    static const struct {
        uint16_t op, words;
    } few[] = {{OP_TYPE_INT, 2},
               {OP_TYPE_FLOAT, 2},
               {OP_TYPE_VECTOR, 3},
               {OP_TYPE_MATRIX, 3},
               {OP_CONSTANT, 3},
               {OP_SPEC_CONSTANT, 3},
               {OP_COMPOSITE_EXTRACT, 4},
               {OP_COMPOSITE_INSERT, 5},
               {OP_VECTOR_SHUFFLE, 5},
               {OP_LOAD, 4},
               {OP_STORE, 3},
               {OP_COPY_MEMORY, 3},
               {OP_ARRAY_LENGTH, 4},
               {OP_LOOP_MERGE, 3},
               {OP_SELECTION_MERGE, 2},
               {OP_BRANCH_CONDITIONAL, 4}};
    for (size_t i = 0; i < sizeof few / sizeof *few; ++i) {
        if (few[i].op == op && few[i].words < length)
            return few[i].words;
    }
    return length;
}

bool spv_is_id(const uint32_t *words, uint32_t i)
{
    switch (spv_op(words)) {
    case OP_TYPE_POINTER:
        return i != 2;
    case OP_VARIABLE:
    case OP_FUNCTION:
        return i != 3;
    case OP_EXT_INST:
        return i != 4;
    case OP_SWITCH: /* pairs of a 32-bit literal and a label */
        return i < 3 || i % 2 == 0;
    default:
        return i < id_words(spv_op(words), spv_length(words));
    }
}

/* --- where an instruction stands ------------------------------------------------------------ */

static struct spv_place place_of(const struct spv_module *m, const uint32_t *line)
{
    struct spv_place place = {WHIT_OWN, line[2]};
    const char *name = spv_string(m, line[1]);
    if (strncmp(name, m->own, strlen(m->own)) == 0)
        return place;
    const char *dot = strchr(name, '.');
    place.file = dot ? (uint32_t)strtoul(dot + 1, NULL, 10) : 0;
    return place;
}

bool spv_follow(struct spv_module *m, const uint32_t *words)
{
    uint32_t op = spv_op(words), length = spv_length(words);
    if (op == OP_LINE && length == 4)
        m->place = place_of(m, words);
    if (op == OP_FUNCTION && length == 5) {
        m->function = words[2];
        m->return_type = words[1];
        m->user_function = m->place.file != WHIT_OWN;
    }
    return m->user_function || m->place.file != WHIT_OWN;
}

/* --- what is added -------------------------------------------------------------------------- */

void spv_put(struct spv_module *m, struct spv_words *to, const uint32_t *words, uint32_t count)
{
    while (to->capacity - to->count < count) {
        uint32_t full = to->capacity;
        if (!array_reserve((void **)&to->words, full, &to->capacity, sizeof *to->words)) {
            m->failed = true;
            return;
        }
    }
    if (count)
        memcpy(to->words + to->count, words, count * sizeof *words);
    to->count += count;
}

void spv_emit(struct spv_module *m, uint32_t op, const uint32_t *operands, uint32_t count)
{
    uint32_t head = spv_head(op, count + 1);
    spv_put(m, &m->body, &head, 1);
    spv_put(m, &m->body, operands, count);
}

/* A `type` of these keys, which are no ids, says what kind of lookup was cached. */
#define LOOKED_UP  UINT32_MAX
#define NULL_OF    (UINT32_MAX - 1)
#define POINTER_TO (UINT32_MAX - 2)
#define TRUE_OF    (UINT32_MAX - 3)

/* The id of the module's type that `words` define, but for its id; 0: there is none. */
static uint32_t find_type(const struct spv_module *m, const uint32_t *words)
{
    size_t bytes = (spv_length(words) - 2) * sizeof *words;
    for (const uint32_t *at = spv_step(m, NULL); at; at = spv_step(m, at)) {
        if (at[0] == words[0] && memcmp(at + 2, words + 2, bytes) == 0)
            return at[1];
    }
    return 0;
}

/* The id that is kept in m->constants under a type and a value, or that of the instruction `words`,
   which is added, with an id in place of its 0. A type (its first word is that 0) is not added if
   the module has it. */
static uint32_t find_or_add(struct spv_module *m, uint32_t type, uint32_t value, uint32_t *words)
{
    for (uint32_t i = 0; i < m->constant_count; ++i) {
        if (m->constants[i].type == type && m->constants[i].value == value)
            return m->constants[i].id;
    }
    bool defines_type = words[1] == 0;
    uint32_t id = defines_type ? find_type(m, words) : 0;
    if (!id) {
        id = words[defines_type ? 1 : 2] = m->next_id++;
        spv_put(m, &m->globals, words, spv_length(words));
    }
    const struct spv_constant constant = {type, value, id};
    if (!ARRAY_PUSH(m->constants, m->constant_count, m->constant_capacity, constant))
        m->failed = true;
    return id;
}

uint32_t spv_uint(struct spv_module *m)
{
    uint32_t words[] = {spv_head(OP_TYPE_INT, 4), 0, 32, 0};
    return find_or_add(m, LOOKED_UP, OP_TYPE_INT, words);
}

uint32_t spv_bool(struct spv_module *m)
{
    uint32_t words[] = {spv_head(OP_TYPE_BOOL, 2), 0};
    return find_or_add(m, LOOKED_UP, OP_TYPE_BOOL, words);
}

uint32_t spv_constant(struct spv_module *m, uint32_t type, uint32_t value)
{
    uint32_t words[] = {spv_head(OP_CONSTANT, 4), type, 0, value};
    return find_or_add(m, type, value, words);
}

uint32_t spv_null(struct spv_module *m, uint32_t type)
{
    uint32_t words[] = {spv_head(OP_CONSTANT_NULL, 3), type, 0};
    return find_or_add(m, NULL_OF, type, words);
}

uint32_t spv_true(struct spv_module *m, uint32_t type)
{
    uint32_t words[] = {spv_head(OP_CONSTANT_TRUE, 3), type, 0};
    return find_or_add(m, TRUE_OF, type, words);
}

uint32_t spv_pointer(struct spv_module *m, uint32_t type)
{
    uint32_t words[] = {spv_head(OP_TYPE_POINTER, 4), 0, STORAGE_FUNCTION, type};
    return find_or_add(m, POINTER_TO, type, words);
}

bool spv_is_remark(uint32_t op)
{
    return (op >= OP_SOURCE_CONTINUED && op <= OP_LINE) || op == OP_NO_LINE ||
           op == OP_MODULE_PROCESSED;
}

static bool begins_as_zero(const struct spv_module *m, const uint32_t *words)
{
    bool found = false;
    for (uint32_t i = 0; spv_op(words) == OP_VARIABLE && i < m->zeroed.count; ++i)
        found = found || m->zeroed.words[i] == words[2];
    return found && spv_length(words) == 4;
}

/* The null constant is put just before the variable, since other added constants come behind all
   variables. */
static void put_zeroed(struct spv_module *m, struct spv_words *out, const uint32_t *words)
{
    uint32_t type = spv_def(m, words[1])[3], zero = m->next_id++;
    const uint32_t constant[] = {spv_head(OP_CONSTANT_NULL, 3), type, zero};
    const uint32_t variable[] = {spv_head(OP_VARIABLE, 5), words[1], words[2], words[3], zero};
    spv_put(m, out, constant, 3);
    spv_put(m, out, variable, 5);
}

struct spv_words spv_write(struct spv_module *m, bool keeps_remarks)
{
    struct spv_words out = {0};
    spv_put(m, &out, m->words, SPV_HEADER_WORDS);
    for (const uint32_t *words = spv_step(m, NULL); words; words = spv_step(m, words)) {
        if (begins_as_zero(m, words))
            put_zeroed(m, &out, words);
        else if (keeps_remarks || !spv_is_remark(spv_op(words)))
            spv_put(m, &out, words, spv_length(words));
    }
    spv_put(m, &out, m->globals.words, m->globals.count);
    for (uint32_t at = 0; at < m->body.count; at += spv_length(m->body.words + at)) {
        if (keeps_remarks || !spv_is_remark(spv_op(m->body.words + at)))
            spv_put(m, &out, m->body.words + at, spv_length(m->body.words + at));
    }
    if (!m->failed)
        out.words[SPV_BOUND_AT] = m->next_id;
    return out;
}
