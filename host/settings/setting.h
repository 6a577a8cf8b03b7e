/* An option as a row of a table: what it is called, what it takes, and where its value stands in a
   record. Parsing, help, completion, manual pages, recipes, JSON, keys and panels read these rows.
 */
#ifndef SETTINGS_SETTING_H
#define SETTINGS_SETTING_H

#include "settings/values.h"

enum { SETTING_TEXT_BYTES = 384, SETTING_PATH_BYTES = 1024, SETTING_FOLDERS_MAX = 8 };
/* The sizes of the text that setting_write gives, and of the reason why setting_read refuses. */
enum { SETTING_VALUE_BYTES = SETTING_PATH_BYTES, SETTING_WHY_BYTES = 1400 };

enum setting_kind {
    SETTING_FLAG,    /* bool: the option has no argument and sets it */
    SETTING_CHOICE,  /* an enumeration or uint32_t: one of the words of `values` */
    SETTING_EITHER,  /* bool: the same */
    SETTING_COUNT,   /* uint32_t: min to max */
    SETTING_NUMBER,  /* double: min to max */
    SETTING_BYTES,   /* uint64_t: more than 0; a whole number, or one with K, M or G behind it */
    SETTING_SIZE,    /* uint32_t[2]: WxH */
    SETTING_TEXT,    /* char[SETTING_TEXT_BYTES]; "": not given */
    SETTING_PAIRS,   /* the same: "NAME=VALUE,NAME=VALUE"; the option adds pairs, or replaces those
                        of the same name */
    SETTING_FOLDERS, /* char[SETTING_FOLDERS_MAX][SETTING_PATH_BYTES]: the option adds one */
    SETTING_NAME,    /* const char *, of the command line; NULL: not given */
    SETTING_OWN,     /* by `read` and `write` */
    SETTING_GONE, /* none: the option is refused with `help`, which says what stands in its place */
    SETTING_HELP, /* none: --help and --help-all */
};

/* What another value may change. */
enum setting_change {
    SETTING_RUN,   /* nothing of a picture, nor how it is made */
    SETTING_COST,  /* time and memory alone: ids and pixels are the same bytes */
    SETTING_LIGHT, /* colours, and not what camera rays meet */
    SETTING_HITS,  /* what rays meet */
    SETTING_PLACE, /* what is looked at, in which size and at which time */
    SETTING_PAINT, /* what of it is painted: colours, or costs */
};

/* What has to be made anew for another value. */
enum setting_need {
    SETTING_NEEDS_VIEW,   /* nothing: whit_renderer_set_view */
    SETTING_NEEDS_KERNEL, /* a renderer */
    SETTING_NEEDS_TREES,  /* trees, and a renderer over them */
    SETTING_NEEDS_SCENE,  /* all of it */
};

struct setting {
    const char *name;     /* "light-samples" */
    char letter;          /* the short option; 0: none */
    const char *argument; /* how help names it; NULL: by the words of `values`, or there is none */
    const char *help;     /* one line or more */
    const char *usual;    /* how help names the default; NULL: as it is written; "": not at all */
    enum setting_kind kind;
    size_t offset; /* of the value in its record */
    const struct setting_value *values;
    double min, max;
    /* Used by SETTING_OWN alone. `why` is the reason for a refusal, printed behind "--NAME".
       False from `write`: there is nothing to say. */
    bool (*read)(const struct setting *setting, const char *text, void *record,
                 char why[SETTING_WHY_BYTES]);
    bool (*write)(const void *record, char text[SETTING_VALUE_BYTES]);
    bool developer; /* for those who work on whit: --help-all alone lists it */

    /* Used by the table of settings (settings.h) alone. */
    uint32_t commands; /* bits of enum settings_command */
    enum setting_change change;
    enum setting_need need;
    const char *json; /* its key; NULL: `name` with _ for - */
    bool always;      /* recipes and JSON name it though it is at its default */
    bool trusted;     /* says what files may reach: no file of settings may */
    bool of_machine;  /* says where a picture is made: no recipe does */
    /* Whether a value other than the default says something of this picture; NULL: always. */
    bool (*tells)(const void *record, bool recipe);
    /* Used by the viewer. */
    const char *title;                      /* in the panel of settings; NULL: not there */
    const struct setting_value *steps;      /* of keys and panel; NULL: `values`, or numbers */
    const struct setting_value *more_steps; /* behind those, of the panel alone; or NULL */
    double step, shown_min, shown_max;      /* of numbers: of the key, and of the slider */
    int key, key_back;     /* capital letters; key_back 0: with Shift; key 0: it has none */
    const char *key_skips; /* a word that keys pass over, which another key is for; or NULL */
};

/* Where a value is, checked to be of the kind's type. An enumeration is a uint32_t to C. */
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
/* `member` and `second` are neighbours. */
#define SETTING_AT_SIZE(type, member, second)                                                      \
    .kind = SETTING_SIZE,                                                                          \
    .offset = SETTING_AT(type, member, uint32_t) +                                                 \
              0 * sizeof(char[offsetof(type, second) == offsetof(type, member) + 4 ? 1 : -1])

/* Puts what `text` says into `record`; false, with why it is refused and nothing changed. `text` is
   not read where the option has no argument, and is borrowed by SETTING_NAME. */
bool setting_read(const struct setting *setting, const char *text, void *record,
                  char why[SETTING_WHY_BYTES]);
/* The text that reads back as the value of `record`; of SETTING_FOLDERS that of entry `index`.
   False: there is nothing to say. */
bool setting_write(const struct setting *setting, const void *record, uint32_t index,
                   char text[SETTING_VALUE_BYTES]);
/* Whether two records have the same value. */
bool setting_same(const struct setting *setting, const void *a, const void *b);
/* Takes over the value. */
void setting_copy(const struct setting *setting, const void *from, void *to);
bool setting_has_argument(const struct setting *setting);

/* Says why in printf's words; false. */
bool setting_refuse(char why[SETTING_WHY_BYTES], const char *format, ...) WHIT_PRINTF(2, 3);
/* The shortest decimal that reads back as `number`. */
void setting_write_number(double number, char *text, size_t text_bytes);

#endif
