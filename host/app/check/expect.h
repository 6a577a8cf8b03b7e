/* What a suite expects of a picture: FIELD OP VALUE. */
#ifndef APP_CHECK_EXPECT_H
#define APP_CHECK_EXPECT_H

#include "settings/settings.h"

enum expect_op {
    EXPECT_EQUAL,
    EXPECT_OTHER,
    EXPECT_AT_MOST,
    EXPECT_AT_LEAST,
    EXPECT_BELOW,
    EXPECT_ABOVE,
    EXPECT_WITHIN,
};

struct check_expectation {
    char *text; /* "leaks == 0" */
    uint32_t line;
    uint32_t field; /* of the table in expect.c */
    uint32_t x, y;  /* of a pixel's field */
    enum expect_op op;
    double numbers[3];
    uint32_t count;   /* of numbers: 1, or 3 */
    char *word;       /* of fields that are names; NULL: none */
    double tolerance; /* WITHIN */
};

struct drawing;

/* Reads one expectation, of `length` bytes, about a picture with these settings. False, with why
   in words that quote what is wrong. expectation_finish() it either way. */
bool expectation_read(struct check_expectation *one, const char *text, size_t length,
                      const struct settings *settings, char why[SETTING_WHY_BYTES]);
void expectation_finish(struct check_expectation *one);

/* Whether pictures are to be drawn with what traversals cost. */
bool expectation_counts(const struct check_expectation *one);

/* Whether it is so of a drawing (expect_check.c); *is gets what is: free() it. Some fields take
   longer: exact arithmetic for leaks, a kernel for what a probe tells. Errors of these were said.
   WHIT_ERROR_FAILED: it is not so. */
WHIT_CHECK whit_result expectation_check(const struct check_expectation *one,
                                         const struct drawing *drawing, char **is);

/* ---- Fields ---- */

enum expect_kind { EXPECT_NUMBER, EXPECT_COLOR, EXPECT_NAME };

/* The value that a field has in a drawing. */
struct expect_value {
    double numbers[3];
    const char *word; /* NULL: none */
};

struct expect_field {
    const char *name;
    enum expect_kind kind;
    bool of_pixel, counts;
    /* WHIT_ERROR_FAILED, in silence: a number that there is none of. */
    whit_result (*read)(const struct drawing *drawing, const struct check_expectation *one,
                        struct expect_value *value);
};
extern const struct expect_field expect_fields[]; /* ends with one without a name */

#endif
