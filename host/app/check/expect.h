/* Expectations of a suite, each about one picture: FIELD OP VALUE. */
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
    uint32_t field; /* index into expect_fields */
    uint32_t x, y;  /* for fields of a pixel */
    enum expect_op op;
    double numbers[3];
    uint32_t count;   /* how many numbers there are: 1 or 3 */
    char *word;       /* for fields that are names; NULL: none */
    double tolerance; /* for EXPECT_WITHIN */
};

struct drawing;

/* Reads one expectation, of `length` bytes, about a picture with these settings; NULL: they are
   not known, and a pixel may lie anywhere. False, with the reason in `why`. Call
   expectation_finish() in any case. */
bool expectation_read(struct check_expectation *one, const char *text, size_t length,
                      const struct settings *settings, char why[SETTING_WHY_BYTES]);
void expectation_finish(struct check_expectation *one);

/* Whether the picture must be drawn with traversal costs counted. */
bool expectation_counts(const struct check_expectation *one);

/* Checks the expectation on a drawing (expect_check.c); *is gets the actual value as text: free()
   it. Some fields take longer: leaks need exact arithmetic, fields of a probe need a kernel. Their
   errors were printed. WHIT_ERROR_FAILED: the expectation does not hold. */
WHIT_CHECK whit_result expectation_check(const struct check_expectation *one,
                                         const struct drawing *drawing, char **is);

/* ---- Fields ---- */

enum expect_kind { EXPECT_NUMBER, EXPECT_COLOR, EXPECT_NAME };

/* The value that a field has in a drawing. */
struct expect_value {
    double numbers[3];
    const char *word; /* NULL: none */
};

/* One colour of many pixels, channel by channel. */
enum color_of { COLOR_MEAN, COLOR_MIN, COLOR_MAX };

struct expect_field {
    const char *name;
    enum expect_kind kind;
    bool of_pixel, counts;
    bool floats; /* its numbers are floats, and are compared with the floats nearest to the text */
    /* Reads the field's value from a drawing. WHIT_ERROR_FAILED, without a message: the drawing has
       no such value. */
    whit_result (*read)(const struct drawing *drawing, const struct check_expectation *one,
                        struct expect_value *value);
    enum color_of color; /* of EXPECT_COLOR without a pixel */
    size_t stat;         /* of counts of rays: the offset of a uint64_t in whit_stats */
};
extern const struct expect_field expect_fields[]; /* ends with one without a name */

#endif
