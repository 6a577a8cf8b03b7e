#include "shader/compile.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>

#include "base/array.h"
#include "base/foreign.h"
#include "base/keep.h"
#include "base/spirv.h"
#include "base/text.h"
#include "shader/expand.h"
#include "shader/glslang.h"
#include "shader/scan.h"
#include "sources.h"

enum { REPLY_BYTES = 64 << 20, WHO_BYTES = 256 };

struct shader_compiler {
    whit_log log;
    whit_shader_limits limits;
    double clock_s;
    struct keep *keep; /* NULL: each request has a process of its own */
    uint32_t restarts; /* how often `keep` had to be started again */
    bool warned;       /* a warning has told that there is no sandbox */
};

/* --- the process ---------------------------------------------------------------------------- */

/* Offset of question.base in a request: behind the text and its 0, aligned to a word. */
static size_t base_at(size_t text_bytes)
{
    return (text_bytes + sizeof(uint32_t)) / sizeof(uint32_t) * sizeof(uint32_t);
}

/* A request is a glslang_question, then its text, then question.base. */
static int answer(const void *request, size_t bytes, void *to, child_write write)
{
    struct glslang_question question;
    if (bytes < sizeof question)
        return 1;
    memcpy(&question, request, sizeof question);
    question.text = (const char *)request + sizeof question;
    if (question.base_words)
        question.base = (const uint32_t *)(const void *)(question.text + base_at(question.bytes));
    return glslang_answer_question(&question, to, write);
}

static const struct keep_work work = {glslang_warm, answer};

struct shader_compiler *shader_compiler_create(const whit_log *log,
                                               const whit_shader_limits *limits, double clock_s)
{
    struct shader_compiler *compiler = calloc(1, sizeof *compiler);
    if (!compiler) {
        log_error(log, "no memory for a compiler of shaders");
        return NULL;
    }
    compiler->log = log_or_silence(log);
    if (limits)
        compiler->limits = *limits;
    compiler->clock_s = clock_s > 0.0 ? clock_s : 20.0;
    compiler->keep = keep_start(&work);
    return compiler;
}

void shader_compiler_destroy(struct shader_compiler *compiler)
{
    if (!compiler)
        return;
    keep_stop(compiler->keep);
    free(compiler);
}

static struct child_limits child_limits_of(const struct shader_compiler *compiler,
                                           const struct shader_request *request)
{
    const whit_shader_limits *limits = &compiler->limits;
    double usual_s = request->cpu_s > 0.0 ? request->cpu_s : 5.0;
    return (struct child_limits){
        .who = "compiler",
        .cpu_s = limits->cpu_s > 0.0 ? limits->cpu_s : usual_s,
        .clock_s = compiler->clock_s,
        .memory_bytes = limits->memory_bytes ? limits->memory_bytes : UINT64_C(1) << 30,
        .reply_bytes = REPLY_BYTES,
        .require_sandbox = limits->require_sandbox,
        .cancel = limits->cancel,
    };
}

struct one_shot {
    const void *request;
    size_t bytes;
};

static int answer_once(void *user, void *to, child_write write)
{
    const struct one_shot *once = user;
    return answer(once->request, once->bytes, to, write);
}

/* Runs a request in the process that is kept, in a new one if that has ended, or else in a process
   of its own. */
static enum child_end run(struct shader_compiler *c, const struct child_limits *limits,
                          const void *request, size_t bytes, struct child_reply *reply)
{
    enum { RESTARTS_MAX = 16 };
    for (uint32_t tries = 0; c->keep && tries < 2; ++tries) {
        bool alive;
        enum child_end end = keep_run(c->keep, limits, request, bytes, reply, &alive);
        if (alive && end != CHILD_NOT_STARTED)
            return end;
        keep_stop(c->keep);
        c->keep = c->restarts++ < RESTARTS_MAX ? keep_start(&work) : NULL;
        if (end != CHILD_NOT_STARTED)
            return end;
    }
    struct one_shot once = {request, bytes};
    return child_run(limits, answer_once, &once, reply);
}

/* --- errors --------------------------------------------------------------------------------- */

struct place {
    const whit_log *log;
    const struct shader_text *text;
    const struct shader_request *request;
    struct shader_errors *errors;
};

/* The file name in errors about the text as a whole. */
static const char *whole_name(const struct place *place)
{
    return place->text && place->text->file_count ? place->text->files[0].name
                                                  : place->request->kernel;
}

static whit_result explain(const struct place *place, enum child_end end,
                           const struct child_limits *limits, const struct child_reply *reply)
{
    const char *name = whole_name(place);
    switch (end) {
    case CHILD_TIME:
        shader_error_add(place->log, place->errors, name, 0, 0,
                         "it was not compiled within %.3g s of the processor's time, or %.3g s by "
                         "the clock",
                         limits->cpu_s, child_clock_limit_s(limits));
        return WHIT_ERROR_INPUT;
    case CHILD_MEMORY:
        if (reply->signal)
            shader_error_add(place->log, place->errors, name, 0, 0,
                             "the compiler was killed (signal %d), as where the machine runs out "
                             "of memory",
                             reply->signal);
        else
            shader_error_add(place->log, place->errors, name, 0, 0,
                             "the compiler asked for more than %.4g MiB of memory for it",
                             (double)limits->memory_bytes / 1048576.0);
        return WHIT_ERROR_INPUT;
    case CHILD_CRASHED: /* C++ ends by abort(), signal 6, where memory runs out */
        shader_error_add(place->log, place->errors, name, 0, 0,
                         "the compiler crashed on it (signal %d)%s", reply->signal,
                         reply->signal == 6 ? ", as where memory runs out"
                                            : ", as on brackets or blocks that are too deep");
        return WHIT_ERROR_INPUT;
    case CHILD_CANCELLED:
        return log_failure(place->log, WHIT_ERROR_CANCELLED, "%s: compiling was cancelled", name);
    case CHILD_NOT_STARTED:
        return log_failure(place->log, WHIT_ERROR_MEMORY,
                           "%s: the compiler's process could not be started", name);
    case CHILD_OPEN:
        return log_failure(place->log, WHIT_ERROR_USAGE,
                           "%s: the compiler cannot be locked in here (%s), and that is required",
                           name, strerror(reply->open_because));
    default:
        shader_error_add(place->log, place->errors, name, 0, 0,
                         end == CHILD_FORBIDDEN
                             ? "the compiler tried on it what it may not, and was stopped"
                             : "the compiler gave no usable reply");
        return WHIT_ERROR_INPUT;
    }
}

/* Finds a brace without its counterpart, which the compiler would report only at the end of all
   text. */
static bool find_open_brace(const struct shader_text *text, uint32_t *file, uint32_t *line)
{
    enum { DEPTH = 256 };
    for (uint32_t i = 0; i < text->file_count; ++i) {
        uint32_t lines[DEPTH], depth = 0;
        struct scan scan;
        scan_begin(&scan, text->files[i].text, text->files[i].bytes);
        *file = i;
        while (scan_next(&scan)) {
            *line = scan.token_line;
            if (scan_is(&scan, SCAN_SIGN, "{") && depth < DEPTH)
                lines[depth++] = scan.token_line;
            else if (scan_is(&scan, SCAN_SIGN, "}") && depth-- == 0)
                return true;
        }
        if (depth) {
            *line = lines[depth - 1];
            return true;
        }
    }
    return false;
}

/* Finds the first occurrence of `token` between `at` and `end`, in a line that begins at `begin`. A
   word within a longer word does not count. */
static const char *find_token(const char *begin, const char *at, const char *end, const char *token,
                              size_t bytes)
{
    bool word = scan_is_of_word(token[0]);
    for (; at + bytes <= end; ++at) {
        bool within = word && ((at > begin && scan_is_of_word(at[-1])) ||
                               (at + bytes < end && scan_is_of_word(at[bytes])));
        if (!within && memcmp(at, token, bytes) == 0)
            return at;
    }
    return NULL;
}

/* The column of the token that `reason` quotes first, as 'token', if it occurs once in its line;
   else 0. */
static uint32_t find_column(const struct shader_file *file, uint32_t line, const char *reason)
{
    const char *open = strchr(reason, '\''), *close = open ? strchr(open + 1, '\'') : NULL;
    const char *at = file->text, *end = at + file->bytes;
    for (uint32_t i = 1; at && i < line; ++i) {
        at = memchr(at, '\n', (size_t)(end - at));
        at = at ? at + 1 : NULL;
    }
    if (!at || !close || close == open + 1)
        return 0;
    const char *line_end = memchr(at, '\n', (size_t)(end - at));
    size_t bytes = (size_t)(close - open - 1);
    line_end = line_end ? line_end : end;
    const char *found = find_token(at, at, line_end, open + 1, bytes);
    bool once = found && !find_token(at, found + 1, line_end, open + 1, bytes);
    return once ? (uint32_t)(found - at) + 1 : 0;
}

/* Adds an error, with the column of the token that the reason quotes. */
static void add_error_at(const struct place *place, const struct shader_file *file, uint32_t line,
                         const char *reason)
{
    shader_error_add(place->log, place->errors, file->name, line, find_column(file, line, reason),
                     "%s", reason);
}

/* Reports a brace without its other one in place of an error that follows from it, where there is
   one. */
static bool add_brace_error(const struct place *place, const char *reason)
{
    uint32_t file, line;
    char text[SHADER_REASON_BYTES + 64];
    if (!place->text || !find_open_brace(place->text, &file, &line))
        return false;
    snprintf(text, sizeof text, "a brace without its other one: %s", reason);
    add_error_at(place, &place->text->files[file], line, text);
    return true;
}

static void add_own_error(const struct place *place, const struct glslang_error *error,
                          const char *reason)
{
    char name[SHADER_FILE_BYTES];
    if (add_brace_error(place, reason))
        return;
    const struct shader_stages *stages = place->request->stages;
    uint32_t index = stages && error->file >= stages->count
                         ? shader_stages_find(stages, place->request->kernel)
                         : error->file;
    if (stages && index < stages->count && stages->names[index])
        snprintf(name, sizeof name, "%s", stages->names[index]);
    else
        snprintf(name, sizeof name, "whit:%s",
                 error->file < shader_source_count ? shader_sources[error->file].path
                                                   : place->request->kernel);
    shader_error_add(place->log, place->errors, name, error->line, 0,
                     place->text && !stages
                         ? "%s (in whit's own text: what it uses of yours has another form)"
                         : "%s",
                     reason);
}

static uint32_t count_lines(const struct shader_file *file)
{
    uint32_t count = 1;
    for (size_t i = 0; i + 1 < file->bytes; ++i)
        count += file->text[i] == '\n';
    return count;
}

/* An error about something unclosed may have a line behind the file's end: it goes to the last
   line. The beginning of a function within another one means that a brace is missing before. */
static void add_user_error(const struct place *place, const struct glslang_error *error,
                           const char *reason)
{
    const struct shader_file *file = &place->text->files[error->file];
    uint32_t last = count_lines(file), line = error->line < last ? error->line : last;
    if (!strstr(reason, "unexpected '{'") || !add_brace_error(place, reason))
        add_error_at(place, file, line, reason);
}

/* Adds the errors of an answer. The child that wrote it is not trusted. */
static void add_errors(const struct place *place, const struct glslang_answer *answer)
{
    bool user = false;
    uint32_t count =
        answer->error_count < SHADER_ERROR_MAX ? answer->error_count : SHADER_ERROR_MAX;
    for (uint32_t i = 0; i < count; ++i)
        user = user || answer->errors[i].own == 0;
    for (uint32_t i = 0; i < count; ++i) {
        const struct glslang_error *error = &answer->errors[i];
        char reason[SHADER_REASON_BYTES];
        foreign_text(error->reason, sizeof error->reason, reason, sizeof reason);
        if (error->own == 0 && place->text && error->file < place->text->file_count) {
            add_user_error(place, error, reason);
        } else if (error->own == 1 && !user) {
            add_own_error(place, error, reason);
            if (!place->request->stages)
                break; /* other errors in whit's own text follow from this one */
        } else if (error->own > 1) {
            shader_error_add(place->log, place->errors, whole_name(place), 0, 0, "%s", reason);
        }
    }
    if (place->errors)
        place->errors->more += answer->more;
}

/* --- replies -------------------------------------------------------------------------------- */

/* Whether the parts of the answer have the size that it says. */
static bool is_whole(const struct glslang_answer *answer, size_t bytes)
{
    uint64_t words = answer->word_count, loops = answer->loop_count;
    uint64_t all = sizeof *answer + words * sizeof(uint32_t) + loops * sizeof(struct shader_loop);
    return words <= REPLY_BYTES && bytes == all &&
           (words ? words > SPV_HEADER_WORDS : answer->error_count > 0);
}

static bool take_code(const struct glslang_answer *answer, const uint8_t *data,
                      struct shader_code *code)
{
    code->bytes = (size_t)answer->word_count * sizeof *code->words;
    code->words = malloc(code->bytes);
    code->loops = array_alloc(answer->loop_count, sizeof *code->loops);
    if (!code->words || !code->loops) {
        shader_code_free(code);
        return false;
    }
    memcpy(code->words, data, code->bytes);
    memcpy(code->loops, data + code->bytes, answer->loop_count * sizeof *code->loops);
    code->loop_count = answer->loop_count;
    code->instructions = answer->instructions;
    code->reaches = answer->reaches & SHADER_REACHES_ALL;
    memcpy(code->opens, answer->opens, sizeof code->opens);
    return true;
}

static whit_result take_reply(const struct place *place, const struct child_reply *reply,
                              struct shader_code *code)
{
    struct glslang_answer *got = malloc(sizeof *got);
    whit_result result = WHIT_ERROR_INPUT;
    if (!got)
        return log_failure(place->log, WHIT_ERROR_MEMORY, "no memory for a kernel");
    if (reply->size_bytes >= sizeof *got)
        memcpy(got, reply->data, sizeof *got);
    if (reply->size_bytes < sizeof *got || !is_whole(got, reply->size_bytes)) {
        shader_error_add(place->log, place->errors, whole_name(place), 0, 0,
                         "the compiler gave no usable reply");
    } else if (!got->word_count) {
        add_errors(place, got);
    } else if (take_code(got, reply->data + sizeof *got, code)) {
        result = WHIT_OK;
    } else {
        log_error(place->log, "no memory for a kernel");
        result = WHIT_ERROR_MEMORY;
    }
    free(got);
    return result;
}

/* --- a request ------------------------------------------------------------------------------ */

/* A tag for names of whit's own files, which a user's text can contain only by chance. */
static void make_own_tag(char own[GLSLANG_OWN_BYTES])
{
    uint64_t number = 0;
    if (getrandom(&number, sizeof number, 0) != (ssize_t)sizeof number)
        number = (uint64_t)(uintptr_t)own;
    snprintf(own, GLSLANG_OWN_BYTES, "whit%016llx.", (unsigned long long)number);
}

/* Makes the request for the compiler's process, with the kernel's text; free() it. */
static whit_result make_question(const struct place *place, uint8_t **request, size_t *bytes)
{
    struct glslang_question question = {.trust = place->request->trust,
                                        .names = place->request->names,
                                        .base_words =
                                            place->request->base_bytes / sizeof(uint32_t)};
    make_own_tag(question.own);
    struct expanded expanded;
    whit_result result = expand_kernel(place->log, place->text, place->request, question.own,
                                       &expanded, place->errors);
    if (result != WHIT_OK)
        return result;
    question.bytes = expanded.bytes;
    question.user_at = expanded.user_at;
    question.user_end = expanded.user_end;
    size_t behind = base_at(expanded.bytes), base_bytes = place->request->base_bytes;
    *bytes = sizeof question + behind + base_bytes;
    *request = malloc(*bytes);
    if (*request) {
        memcpy(*request, &question, sizeof question);
        memcpy(*request + sizeof question, expanded.text, expanded.bytes + 1);
        if (base_bytes)
            memcpy(*request + sizeof question + behind, place->request->base, base_bytes);
    } else {
        log_error(place->log, "no memory for the text of a kernel");
        result = WHIT_ERROR_MEMORY;
    }
    free(expanded.text);
    return result;
}

static void warn_of_open(struct shader_compiler *compiler, const struct child_reply *reply)
{
    if (!reply->open_because || compiler->warned)
        return;
    compiler->warned = true;
    log_warning(&compiler->log,
                "shaders are compiled without a sandbox: its filter cannot be set here (%s)",
                strerror(reply->open_because));
}

whit_result shader_compile(struct shader_compiler *compiler, const struct shader_text *text,
                           const struct shader_request *request, struct shader_code *code,
                           struct shader_errors *errors)
{
    *code = (struct shader_code){0};
    const struct place place = {&compiler->log, text && text->file_count ? text : NULL, request,
                                errors};
    struct child_limits limits = child_limits_of(compiler, request);
    size_t bytes;
    uint8_t *question;
    whit_result result = make_question(&place, &question, &bytes);
    if (result != WHIT_OK)
        return result;
    struct child_reply reply;
    enum child_end end = run(compiler, &limits, question, bytes, &reply);
    free(question);
    if (end != CHILD_OPEN)
        warn_of_open(compiler, &reply);
    result = end == CHILD_DONE ? take_reply(&place, &reply, code)
                               : explain(&place, end, &limits, &reply);
    child_reply_free(&reply);
    return result;
}

void shader_code_free(struct shader_code *code)
{
    free(code->words);
    free(code->loops);
    *code = (struct shader_code){0};
}
