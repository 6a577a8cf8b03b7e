/* Tests in a user's file: `//@ test` on the line in front of `void NAME(uint seed) { ... }`, with
   check(...) in its body. Stages have them not; the kernel that runs them has a number in front of
   what each check says. */
#ifndef SHADER_TESTS_H
#define SHADER_TESTS_H

#include "shader/text.h"
#include "whit/whit_shader.h"

enum { SHADER_TESTS_MAX = 256, SHADER_CHECKS_MAX = 1024 /* of a test */, SHADER_CHECK_BYTES = 96 };

/* What whit_shader_test and whit_shader_check point to, and where it stands in the file's text. */
struct shader_test {
    char name[64];
    uint32_t file, line;
    size_t begin, end; /* bytes, from its `void` to behind its last brace */
    uint32_t first_check, check_count;
};

struct shader_check {
    char text[SHADER_CHECK_BYTES]; /* what it says, without what stands behind */
    uint32_t file, line;
    uint32_t number; /* in its test */
    size_t at;       /* byte behind its bracket */
};

/* In the order of files and lines. */
struct shader_tests {
    struct shader_test *tests;
    struct shader_check *checks;
    uint32_t test_count, test_capacity, check_count, check_capacity;
};

/* Finds the tests of all files. WHIT_ERROR_INPUT, with what is wrong in `errors` (may be NULL) and
   logged: a function of another form, check() outside of a test, more than the limits; or
   WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result shader_tests_read(const whit_log *log, const struct shader_text *text,
                                         struct shader_tests *tests, struct shader_errors *errors);
void shader_tests_free(struct shader_tests *tests); /* accepts a zeroed one */
/* Words that have a bit for each check of the longest test. */
uint32_t shader_tests_words(const struct shader_tests *tests);

/* The text for stages, in which tests are blank, or with `numbered` for the kernel that runs them.
   Lines stay where they are, and without `numbered` bytes do too. Freed by shader_text_end_copy.
   False: no memory. */
bool shader_tests_text(const struct shader_tests *tests, const struct shader_text *text,
                       bool numbered, struct shader_text *out);

/* The GLSL that calls each test by its number; free() it. NULL: no memory. */
char *shader_tests_call(const struct shader_tests *tests);

#endif
