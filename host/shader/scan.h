/* GLSL as a row of words and signs, before macros: what is asked of a user's text without the
   compiler. */
#ifndef SHADER_SCAN_H
#define SHADER_SCAN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum scan_kind {
    SCAN_END,
    SCAN_WORD,      /* a name, a keyword or a number */
    SCAN_SIGN,      /* one character, in text[0] */
    SCAN_DIRECTIVE, /* text is its name, "" where there is none; its line's words follow */
    SCAN_NEWLINE,   /* the end of a directive's line; ends of other lines are nothing */
    SCAN_STRING,    /* text is what stands between the quotes */
    SCAN_BAD,       /* `reason` says why; nothing follows */
};

enum { SCAN_TEXT_BYTES = 1024 };

/* Set up by scan_begin. */
struct scan {
    const char *at, *end;
    uint32_t line; /* of `at`, from 1 */
    bool at_line_start, in_directive;
    /* The token in hand. */
    enum scan_kind kind;
    uint32_t token_line;
    char text[SCAN_TEXT_BYTES]; /* the start of a longer one */
    const char *reason;
};

void scan_begin(struct scan *scan, const char *text, size_t bytes);
/* The next token; false at the end, or where the text is damaged. Comments are skipped, and lines
   that end with a backslash go on. */
bool scan_next(struct scan *scan);
bool scan_is(const struct scan *scan, enum scan_kind kind, const char *text);

/* Functions with a body at the top level, one by one: `scan` stands behind the name when it
   returns. Begins where `scan` stands; zero it first. */
struct scan_functions {
    char name[SCAN_TEXT_BYTES];
    uint32_t line;
    uint32_t braces, brackets;        /* that are open */
    uint32_t depths[64], depth_count; /* of braces, at each #if */
    bool closed;                      /* name and its brackets are complete */
};
bool scan_next_function(struct scan *scan, struct scan_functions *functions);
/* The same token by token, each after scan_next: true where the one in hand opens a body. */
bool scan_follow(const struct scan *scan, struct scan_functions *functions);

/* What stands behind a bracket up to its other one, blanks as one and none at the ends; "..." where
   `bytes`, of `out`, are too few or the bracket does not close. */
void scan_copy_brackets(const char *at, char *out, size_t bytes);

#endif
