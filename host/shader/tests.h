/* Tests in a user's file: `//@ test` on the line before `void NAME(uint seed) { ... }`, with
   check(...) in its body. Kernels of pictures do not have them. In the kernel that runs them, each
   check gets the word and bit of its result as first arguments. */
#ifndef SHADER_TESTS_H
#define SHADER_TESTS_H

#include "shader/text.h"
#include "whit/whit_shader.h"

enum { SHADER_TESTS_MAX = 256, SHADER_CHECKS_MAX = 1024 /* a test */, SHADER_CHECK_BYTES = 96 };

/* A test: what whit_shader_test points to, and its place in the file's text. */
struct shader_test {
    char name[64];
    uint32_t file, line;
    size_t begin, end; /* byte offsets: of `void`, and behind the closing brace */
    uint32_t first_check, check_count;
};

struct shader_check {
    char text[SHADER_CHECK_BYTES]; /* source text of the argument */
    uint32_t file, line;
    uint32_t number; /* index in its test */
    size_t at;       /* byte offset behind its bracket */
};

/* All tests, in the order of files and lines. */
struct shader_tests {
    struct shader_test *tests;
    struct shader_check *checks;
    uint32_t test_count, test_capacity, check_count, check_capacity;
};

/* Finds the tests of all files. WHIT_ERROR_INPUT, with the reasons in `errors` (may be NULL) and
   logged: a function of another form, check() outside of a test, or more than the limits.
   WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result shader_tests_read(const whit_log *log, const struct shader_text *text,
                                         struct shader_tests *tests, struct shader_errors *errors);
void shader_tests_free(struct shader_tests *tests); /* accepts a zeroed one */
/* Number of 32-bit words with a bit for each check of the test that has most. */
uint32_t shader_tests_words(const struct shader_tests *tests);

/* Copies the text for kernels of pictures, with tests replaced by blanks, or with `numbered` for
   the kernel that runs the tests. Lines keep their numbers; without `numbered` bytes keep their
   offsets. Free it by shader_text_end_copy. False: no memory. */
bool shader_tests_text(const struct shader_tests *tests, const struct shader_text *text,
                       bool numbered, struct shader_text *out);

/* The GLSL of run_test(), which calls a test by its index; free() it. NULL: no memory. */
char *shader_tests_call(const struct shader_tests *tests);

#endif
