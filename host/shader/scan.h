/* Splits GLSL into tokens, without a preprocessor: for questions about a user's text that do not
   need the compiler. */
#ifndef SHADER_SCAN_H
#define SHADER_SCAN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum scan_kind {
    SCAN_END,
    SCAN_WORD,       /* a name, a keyword or a number */
    SCAN_SIGN,       /* one character, in text[0] */
    SCAN_DIRECTIVE,  /* text is its name, or ""; tokens of its line follow */
    SCAN_NEWLINE,    /* the end of a directive's line; others give no token */
    SCAN_STRING,     /* text is what is between the quotes */
    SCAN_ANNOTATION, /* a line `//@ ...`, if the scan has `annotations`: see `annotation` */
    SCAN_BAD,        /* damaged text, see `reason`; the last token */
};

enum { SCAN_TEXT_BYTES = 1024 };

/* The state of a scan, set up by scan_begin. */
struct scan {
    const char *begin, *at, *end;
    uint32_t line; /* line number of `at`, from 1 */
    bool at_line_start, in_directive;
    bool annotations; /* set it behind scan_begin: annotations are tokens, no comments */
    /* The current token. */
    enum scan_kind kind;
    uint32_t token_line;
    const char *start;          /* where it begins */
    char text[SCAN_TEXT_BYTES]; /* a longer token is cut */
    const char *annotation;     /* behind its //@ */
    const char *reason;
};

/* Whether a character may be part of a word. */
bool scan_is_of_word(char c);
/* Whether GLSL has or reserves the word. */
bool scan_is_keyword(const char *name);

void scan_begin(struct scan *scan, const char *text, size_t bytes);
/* Reads the next token; false at the end, or where the text is damaged. Comments are skipped, and
   lines that end with a backslash are joined with the next. */
bool scan_next(struct scan *scan);
bool scan_is(const struct scan *scan, enum scan_kind kind, const char *text);

/* Finds functions with a body at the top level, one by one, from where `scan` is; zero it first.
   After a function was found, `scan` is behind the brace that opens its body. */
struct scan_functions {
    char name[SCAN_TEXT_BYTES];
    uint32_t line;
    uint32_t braces, brackets;        /* open braces and brackets */
    uint32_t depths[64], depth_count; /* `braces` at each open #if */
    bool closed;                      /* a name and its brackets in () have been read */
};
bool scan_next_function(struct scan *scan, struct scan_functions *functions);
/* The same token by token, to be called after each scan_next. True: the current token opens the
   body of a function. */
bool scan_follow(const struct scan *scan, struct scan_functions *functions);
/* Whether a text has a function of this name with a body at the top level. *line, which may be
   NULL: that of its name. */
bool scan_finds(const char *text, size_t bytes, const char *name, uint32_t *line);

/* Copies the text from behind a bracket up to its closing one into `out`, which has `bytes`: runs
   of blanks and comments become one blank, none at the ends. It ends with "..." if `out` is too
   small or the bracket does not close. */
void scan_copy_brackets(const char *at, char *out, size_t bytes);

#endif
