/* An option as a row of a table: its name, its values, and the offset of its value in a record (a
   struct with the values of all options of the table). Parsing, help, completion, manual pages,
   recipes, JSON, keys and panels read these rows. */
#ifndef SETTINGS_SETTING_H
#define SETTINGS_SETTING_H

#include "settings/values.h"

enum { SETTING_TEXT_BYTES = 384, SETTING_PATH_BYTES = 1024, SETTING_FOLDERS_MAX = 8 };
/* The sizes of the text that setting_write gives, and of the reason why setting_read refuses. */
enum { SETTING_VALUE_BYTES = SETTING_PATH_BYTES, SETTING_WHY_BYTES = 1400 };
enum { SETTING_SIDE_MAX = 32768 }; /* the most of a picture's width or height, pixels */

enum setting_kind {
    SETTING_FLAG,    /* bool: the option has no argument and sets it */
    SETTING_CHOICE,  /* an enumeration or uint32_t: one of the words of `values` */
    SETTING_EITHER,  /* bool: one of the two words of `values` */
    SETTING_COUNT,   /* uint32_t: min to max */
    SETTING_NUMBER,  /* double: min to max; N/M is read too */
    SETTING_BYTES,   /* uint64_t: more than 0; a whole number, optionally with K, M or G behind
                        it */
    SETTING_SIZE,    /* uint32_t[2]: WxH */
    SETTING_TEXT,    /* char[SETTING_TEXT_BYTES]; "": not given */
    SETTING_PAIRS,   /* as SETTING_TEXT, "NAME=VALUE,NAME=VALUE"; the option adds pairs, or replaces
                        pairs of the same name */
    SETTING_FOLDERS, /* char[SETTING_FOLDERS_MAX][SETTING_PATH_BYTES]: the option adds one folder */
    SETTING_NAME,    /* const char *, of the command line; NULL: not given */
    SETTING_OWN,     /* any type: read and written by `read` and `write` */
    SETTING_GONE, /* no value: a removed option, refused with `help`, which names its replacement */
    SETTING_HELP, /* no value: --help and --help-all */
};

/* The most that a change of the value may affect. */
enum setting_change {
    SETTING_RUN,   /* neither the picture nor how it is made */
    SETTING_COST,  /* only time and memory: ids and pixels keep their bytes */
    SETTING_LIGHT, /* colours, but not what camera rays hit */
    SETTING_HITS,  /* what rays hit */
    SETTING_PLACE, /* camera, size and time of the picture */
    SETTING_PAINT, /* what is painted: colours or costs */
};

/* The objects that must be made anew for another value. */
enum setting_need {
    SETTING_NEEDS_VIEW,   /* nothing: whit_renderer_set_view is enough */
    SETTING_NEEDS_KERNEL, /* a renderer */
    SETTING_NEEDS_TREES,  /* trees, and a renderer over them */
    SETTING_NEEDS_SCENE,  /* everything: scene, trees and renderer */
};

struct setting {
    const char *name;     /* "light-samples" */
    char letter;          /* the short option; 0: none */
    const char *argument; /* the argument's name in help; NULL: the words of `values`, or no
                             argument */
    const char *help;     /* one line or more */
    const char *usual;    /* the default's name in help; NULL: the text of its value; "": not
                             named */
    enum setting_kind kind;
    size_t offset; /* of the value in its record */
    const struct setting_value *values;
    double min, max;
    /* Only for SETTING_OWN. `why` gets the reason for a refusal, printed behind "--NAME". `write`
       gives false where there is nothing to write. */
    bool (*read)(const struct setting *setting, const char *text, void *record,
                 char why[SETTING_WHY_BYTES]);
    bool (*write)(const void *record, char text[SETTING_VALUE_BYTES]);
    bool developer; /* for developers of whit: only --help-all lists it */
    bool written;   /* only for SETTING_NAME: the value is a file that the command writes */

    /* Only for the table of settings (settings.h). */
    uint32_t commands; /* bits of enum settings_command */
    enum setting_change change;
    enum setting_need need;
    const char *json; /* its key in JSON; NULL: `name` with _ for - */
    bool always;      /* recipes and JSON have it even at its default */
    bool trusted;     /* grants access to files: a file of settings must not set it */
    bool of_machine;  /* describes the machine: recipes leave it out */
    /* Whether a value other than the default matters for the picture of these settings; NULL:
       always. */
    bool (*tells)(const void *record, bool recipe);
    /* Used by the viewer. */
    const char *title;                      /* its name in the viewer's panel of settings; NULL: it
                                               is not in the panel */
    const struct setting_value *steps;      /* the values that keys and panel offer; NULL: `values`,
                                               or numbers */
    const struct setting_value *more_steps; /* further values that only the panel offers; or NULL */
    double step, shown_min, shown_max;      /* numbers: step of the key, and range of the slider */
    int key, key_back;     /* capital letters; key_back 0: Shift with `key` goes back; key 0: it has
                              no key */
    const char *key_skips; /* a word that keys skip because another key sets it; or NULL */
};

/* The offset of a value, checked at compile time to have type `c_type`. C treats an enumeration as
   uint32_t. */
#define SETTING_AT(type, member, c_type)                                                           \
    (offsetof(type, member) + 0 * sizeof(_Generic(((type *)NULL)->member, c_type : 1)))
#define SETTING_AT_FLAG(type, member) .kind = SETTING_FLAG, .offset = SETTING_AT(type, member, bool)
#define SETTING_AT_EITHER(type, member)                                                            \
    .kind = SETTING_EITHER, .offset = SETTING_AT(type, member, bool)
#define SETTING_AT_CHOICE(type, member)                                                            \
    .kind = SETTING_CHOICE, .offset = SETTING_AT(type, member, uint32_t)
#define SETTING_AT_COUNT(type, member)                                                             \
    .kind = SETTING_COUNT, .offset = SETTING_AT(type, member, uint32_t)
#define SETTING_AT_NUMBER(type, member)                                                            \
    .kind = SETTING_NUMBER, .offset = SETTING_AT(type, member, double)
#define SETTING_AT_BYTES(type, member)                                                             \
    .kind = SETTING_BYTES, .offset = SETTING_AT(type, member, uint64_t)
#define SETTING_AT_NAME(type, member)                                                              \
    .kind = SETTING_NAME, .offset = SETTING_AT(type, member, const char *)
#define SETTING_AT_TEXT(type, member)                                                              \
    .kind = SETTING_TEXT, .offset = SETTING_AT(type, member, char *)
#define SETTING_AT_PAIRS(type, member)                                                             \
    .kind = SETTING_PAIRS, .offset = SETTING_AT(type, member, char *)
/* Checks that `second` follows `member` directly. */
#define SETTING_AT_SIZE(type, member, second)                                                      \
    .kind = SETTING_SIZE,                                                                          \
    .offset = SETTING_AT(type, member, uint32_t) +                                                 \
              0 * sizeof(char[offsetof(type, second) == offsetof(type, member) + 4 ? 1 : -1])

/* Stores the value in `text` in `record`; false, with the reason, where it is refused and nothing
   changed. `text` is not read where the option has no argument, and is borrowed for
   SETTING_NAME. */
bool setting_read(const struct setting *setting, const char *text, void *record,
                  char why[SETTING_WHY_BYTES]);
/* Writes the text that reads back as the value in `record`; for SETTING_FOLDERS that of entry
   `index`. False: there is nothing to write. */
bool setting_write(const struct setting *setting, const void *record, uint32_t index,
                   char text[SETTING_VALUE_BYTES]);
/* Whether two records have the same value. */
bool setting_same(const struct setting *setting, const void *a, const void *b);
/* Copies the value from one record to another. */
void setting_copy(const struct setting *setting, const void *from, void *to);
bool setting_has_argument(const struct setting *setting);

/* Writes the reason by a printf format; gives false. */
bool setting_refuse(char why[SETTING_WHY_BYTES], const char *format, ...) WHIT_PRINTF(2, 3);
/* Reads a number or a fraction, such as 1/64; *end is the character behind it, or `text` where
   there is none. */
double setting_number(const char *text, char **end);
/* The shortest decimal that reads back as `number`. */
void setting_write_number(double number, char *text, size_t text_bytes);
/* The shortest decimal that reads back as the float. */
void setting_write_float(float number, char *text, size_t text_bytes);

#endif
