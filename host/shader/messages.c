#include "shader/messages.h"

#include <ctype.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "shader/expand.h"
#include "shader/link.h"
#include "shader/scan.h"

enum { NOBODY = 2, LINE_BYTES = 2048, SIGN_BYTES = 32 };

static bool has_error(const struct glslang_answer *answer, uint32_t own, uint32_t file,
                      uint32_t line)
{
    for (uint32_t i = 0; i < answer->error_count; ++i) {
        const struct glslang_error *error = &answer->errors[i];
        if (error->own == own && error->file == file && error->line == line)
            return true;
    }
    return false;
}

void messages_add(struct glslang_answer *answer, uint32_t own, uint32_t file, uint32_t line,
                  const char *reason)
{
    if (own != NOBODY && has_error(answer, own, file, line))
        return; /* other errors of a line follow from the first */
    if (answer->error_count == SHADER_ERROR_MAX) {
        answer->more++;
        return;
    }
    struct glslang_error *error = &answer->errors[answer->error_count++];
    *error = (struct glslang_error){own, file, line, {0}};
    snprintf(error->reason, sizeof error->reason, "%s", reason);
}

/* --- places in the user's text -------------------------------------------------------------- */

/* Scans the user's part of the text, and keeps track of the place in the user's file by #line. */
struct walk {
    struct scan scan;
    uint32_t file, first, shift; /* line `shift` of the part is line `first` of `file` */
};

static void walk_begin(struct walk *walk, const struct glslang_question *question)
{
    memset(walk, 0, sizeof *walk);
    scan_begin(&walk->scan, question->text + question->user_at,
               question->user_end - question->user_at);
}

static void follow_line(struct walk *walk)
{
    uint32_t line = walk->scan.token_line;
    if (!scan_next(&walk->scan))
        return;
    walk->first = (uint32_t)strtoul(walk->scan.text, NULL, 10);
    walk->shift = line + 1;
    if (scan_next(&walk->scan) && walk->scan.kind == SCAN_STRING)
        walk->file = (uint32_t)strtoul(walk->scan.text + strlen(EXPAND_USER_TAG), NULL, 10);
}

static uint32_t line_of(const struct walk *walk, uint32_t line)
{
    return walk->first + line - walk->shift;
}

bool messages_find_word(const struct glslang_question *question, const char *word, uint32_t *file,
                        uint32_t *line)
{
    struct walk walk;
    walk_begin(&walk, question);
    while (scan_next(&walk.scan)) {
        if (scan_is(&walk.scan, SCAN_DIRECTIVE, "line")) {
            follow_line(&walk);
        } else if (scan_is(&walk.scan, SCAN_WORD, word)) {
            *file = walk.file;
            *line = line_of(&walk, walk.scan.token_line);
            return true;
        }
    }
    return false;
}

/* The place of a function's body, or, if it has none, the first place of its name. */
static bool find_function(const struct glslang_question *question, const char *name, uint32_t *file,
                          uint32_t *line)
{
    struct walk walk, words;
    struct scan_functions functions = {.braces = 0};
    walk_begin(&walk, question);
    while (scan_next_function(&walk.scan, &functions)) {
        if (strcmp(functions.name, name) != 0)
            continue;
        walk_begin(&words, question);
        while (scan_next(&words.scan)) {
            if (scan_is(&words.scan, SCAN_DIRECTIVE, "line"))
                follow_line(&words);
            if (words.scan.token_line == functions.line && scan_is(&words.scan, SCAN_WORD, name)) {
                *file = words.file;
                *line = line_of(&words, functions.line);
                return true;
            }
        }
    }
    return messages_find_word(question, name, file, line);
}

/* --- words ---------------------------------------------------------------------------------- */

/* Names of signs in glslang's grammar, and how they are shown. */
static const char *const signs[][2] = {
    {"LEFT_BRACE", "'{'"},
    {"RIGHT_BRACE", "'}'"},
    {"LEFT_PAREN", "'('"},
    {"RIGHT_PAREN", "')'"},
    {"LEFT_BRACKET", "'['"},
    {"RIGHT_BRACKET", "']'"},
    {"SEMICOLON", "';'"},
    {"COMMA", "','"},
    {"EQUAL", "'='"},
    {"DOT", "'.'"},
    {"COLON", "':'"},
    {"QUESTION", "'?'"},
    {"PLUS", "'+'"},
    {"DASH", "'-'"},
    {"STAR", "'*'"},
    {"SLASH", "'/'"},
    {"PERCENT", "'%'"},
    {"LEFT_ANGLE", "'<'"},
    {"RIGHT_ANGLE", "'>'"},
    {"BANG", "'!'"},
    {"TILDE", "'~'"},
    {"AMPERSAND", "'&'"},
    {"VERTICAL_BAR", "'|'"},
    {"CARET", "'^'"},
    {"IDENTIFIER", "a name"},
    {"INTCONSTANT", "a number"},
    {"UINTCONSTANT", "a number"},
    {"FLOATCONSTANT", "a number"},
    {"BOOLCONSTANT", "'true' or 'false'"},
    {"INC_OP", "'++'"},
    {"DEC_OP", "'--'"},
    {"LE_OP", "'<='"},
    {"GE_OP", "'>='"},
    {"EQ_OP", "'=='"},
    {"NE_OP", "'!='"},
    {"AND_OP", "'&&'"},
    {"OR_OP", "'||'"},
    {"XOR_OP", "'^^'"},
    {"LEFT_OP", "'<<'"},
    {"RIGHT_OP", "'>>'"},
    {"ADD_ASSIGN", "'+='"},
    {"SUB_ASSIGN", "'-='"},
    {"MUL_ASSIGN", "'*='"},
    {"DIV_ASSIGN", "'/='"},
    {"MOD_ASSIGN", "'%='"},
};

/* Writes a token of glslang's grammar as it stands in a text. A keyword's name there is the keyword
   in capitals. False: it is no such token. */
static bool write_sign(const char *word, size_t length, char sign[SIGN_BYTES])
{
    for (size_t i = 0; i < sizeof signs / sizeof *signs; ++i) {
        if (strlen(signs[i][0]) == length && strncmp(signs[i][0], word, length) == 0)
            return snprintf(sign, SIGN_BYTES, "%s", signs[i][1]) > 0;
    }
    char keyword[SIGN_BYTES];
    snprintf(keyword, sizeof keyword, "%.*s", (int)length, word);
    for (char *c = keyword; *c; ++c)
        *c = (char)tolower((unsigned char)*c);
    snprintf(sign, SIGN_BYTES, "'%.28s'", keyword);
    return length && isupper((unsigned char)word[0]) && scan_is_keyword(keyword);
}

/* Turns `'x' :  reason ` into `'x': reason` and `'' : reason` into `reason`, and names of tokens in
   glslang's grammar into the signs. */
static void tidy(const char *from, char out[SHADER_REASON_BYTES])
{
    size_t used = 0;
    char sign[SIGN_BYTES];
    from += strncmp(from, "'' : ", 5) == 0 ? 5 : 0;
    from += strspn(from, " ");
    bool grammar = strncmp(from, "syntax error", 12) == 0;
    while (*from && used + 8 < SHADER_REASON_BYTES) {
        size_t word = 0;
        while (scan_is_of_word(from[word]))
            word++;
        bool is_sign = grammar && write_sign(from, word, sign);
        bool colon = strncmp(from, "' : ", 4) == 0;
        size_t length = word ? word : colon ? 3 + strspn(from + 3, " ") : 1;
        used += (size_t)snprintf(out + used, SHADER_REASON_BYTES - used, "%.*s",
                                 is_sign || colon ? INT_MAX : (int)length,
                                 is_sign ? sign
                                 : colon ? "': "
                                         : from);
        used = used < SHADER_REASON_BYTES ? used : SHADER_REASON_BYTES - 1;
        from += length;
    }
    while (used && isspace((unsigned char)out[used - 1]))
        used--;
    out[used] = 0;
}

/* --- lines of a log ------------------------------------------------------------------------- */

static const char *behind(const char *text, const char *start)
{
    size_t length = strlen(start);
    return strncmp(text, start, length) == 0 ? text + length : NULL;
}

/* Cuts a mangled name: `f(vf3;` becomes `f`. */
static void plain_name(const char *mangled, char *out, size_t out_bytes)
{
    mangled += strspn(mangled, " ");
    snprintf(out, out_bytes, "%.*s", (int)strcspn(mangled, "( "), mangled);
}

/* Errors about functions, which glslang reports after all text, with their names in the next
   line. */
static bool take_function(struct glslang_answer *answer, const struct glslang_question *question,
                          const char *preprocessed, const char *line, const char *next)
{
    char name[256], called[256] = "", why[SHADER_REASON_BYTES];
    uint32_t file = 0, at = 0;
    bool recursion = strstr(line, "Recursion detected") != NULL;
    if (!recursion && !strstr(line, "No function definition"))
        return false;
    const char *calling = strstr(next, " calling ");
    plain_name(next, name, sizeof name);
    bool left = scan_finds(preprocessed, strlen(preprocessed), name, NULL);
    bool written = scan_finds(question->text + question->user_at,
                              question->user_end - question->user_at, name, NULL);
    if (calling)
        plain_name(calling + strlen(" calling "), called, sizeof called);
    if (recursion && strcmp(name, called) == 0)
        snprintf(why, sizeof why, "%s calls itself: there is no recursion in GLSL", name);
    else if (recursion)
        snprintf(why, sizeof why,
                 "%s calls %s, which leads back to it: there is no recursion in GLSL", name,
                 called);
    else if (link_is_hook(name) && !left && written)
        snprintf(why, sizeof why,
                 "the preprocessor leaves no function %.16s: an #if or a macro hides it", name);
    else if (link_is_hook(name) && left)
        snprintf(why, sizeof why,
                 "%.16s has other parameters than whit's own: `whit shader new %.16s` prints it",
                 name, name);
    else
        snprintf(why, sizeof why, "%s is called and has no body", name);
    uint32_t own = find_function(question, name, &file, &at) ? 0 : NOBODY;
    messages_add(answer, own, file, at, why);
    return true;
}

/* Whether a macro is defined in front of the user's text. */
static bool is_own_macro(const struct glslang_question *question, const char *name)
{
    char define[SHADER_REASON_BYTES + 16];
    size_t length = (size_t)snprintf(define, sizeof define, "\n#define %s", name);
    for (const char *at = strstr(question->text, define); at; at = strstr(at + 1, define)) {
        if (!scan_is_of_word(at[length]))
            return at < question->text + question->user_at;
    }
    return false;
}

/* Replaces what glslang says where whit knows a better reason. `user`: it is about the user's text.
 */
static void explain(const struct glslang_question *question, bool user,
                    char why[SHADER_REASON_BYTES])
{
    char *extension = user ? strstr(why, ": required extension not requested") : NULL;
    const char *name = strrchr(why, ' ');
    if (strncmp(why, "'dbg': no matching", 18) == 0 && strstr(question->text, "#define HAS_DBG\n"))
        snprintf(why, SHADER_REASON_BYTES,
                 "dbg(x) takes a float, int, uint, bool or a vector of two to four of these");
    else if (strstr(why, "same parameter storage qualifiers"))
        snprintf(why, SHADER_REASON_BYTES,
                 "parameters of whit's functions are `in` or `inout`, as `whit shader new` prints "
                 "them, and never `const`");
    else if (strcmp(why, "memory exhausted") == 0) /* bison's words for a full stack */
        snprintf(why, SHADER_REASON_BYTES, "brackets or blocks that are too deep");
    else if (extension && strncmp(why, "'string literal'", 16) == 0)
        snprintf(why, SHADER_REASON_BYTES,
                 "there are no strings in whit's shaders: dbg(x) shows the value of x");
    else if (extension)
        strcpy(extension, " is not there in whit's shaders");
    else if (strstr(why, "Macro redefined") && is_own_macro(question, name + 1)) {
        char copy[SHADER_REASON_BYTES];
        snprintf(copy, sizeof copy, "%s", name + 1);
        snprintf(why, SHADER_REASON_BYTES, "'%.64s' is a name of whit's: another name is needed",
                 copy);
    }
}

/* Adds an error of the form "NAME:LINE: reason"; without a name it has no file. */
static void take_error(struct glslang_answer *answer, const struct glslang_question *question,
                       const char *line)
{
    char why[SHADER_REASON_BYTES];
    const char *file = behind(line, question->own), *user = behind(line, EXPAND_USER_TAG);
    char *end = NULL;
    uint32_t own = user ? 0 : file ? 1 : NOBODY, number = 0, at = 0;
    const char *rest = user ? user : file;
    if (rest && isdigit((unsigned char)*rest)) {
        number = (uint32_t)strtoul(rest, &end, 10);
        if (*end == ':')
            at = (uint32_t)strtoul(end + 1, &end, 10);
        line = *end == ':' ? end + 1 + strspn(end + 1, " ") : end;
    } else {
        own = NOBODY;
    }
    tidy(line, why);
    explain(question, own == 0, why);
    if (!strstr(why, "compilation terminated") && !strstr(why, "compilation errors.") && why[0])
        messages_add(answer, own, number, at, why);
}

void messages_take(struct glslang_answer *answer, const struct glslang_question *question,
                   const char *preprocessed, const char *log)
{
    char line[LINE_BYTES], next[LINE_BYTES];
    for (const char *at = log; at && *at;) {
        size_t length = strcspn(at, "\n");
        snprintf(line, sizeof line, "%.*s", (int)length, at);
        at += length + (at[length] == '\n');
        snprintf(next, sizeof next, "%.*s", (int)strcspn(at, "\n"), at);
        const char *error = behind(line, "ERROR: ");
        if (error && !take_function(answer, question, preprocessed, error, next))
            take_error(answer, question, error);
    }
    if (!answer->error_count)
        messages_add(answer, NOBODY, 0, 0, "glslang refuses it without a reason");
}
