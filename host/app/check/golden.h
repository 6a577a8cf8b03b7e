/* What the pictures of a suite were when they were accepted: a text beside the suite, made so that
   what two people accept merges by itself. Each case and each part begins with a line that does not
   change, and ends with an empty one; no two cases have a line that is the same, for git takes
   equal lines of both sides for one. */
#ifndef APP_CHECK_GOLDEN_H
#define APP_CHECK_GOLDEN_H

#include <stdbool.h>
#include <stdint.h>

#include "whit/whit.h"

enum { GOLDEN_REASON_MAX = 120, GOLDEN_FORMAT = 2 };

/* Devices and the double reference draw pictures of other bits, so each has goldens of its own. */
enum golden_kind { GOLDEN_OF_DEVICE, GOLDEN_OF_REFERENCE };

/* What a picture was made of: a mesh, a material, a light of a scene. */
struct golden_part {
    char *key;     /* `mesh ball of room.json`: what and where it is */
    uint32_t hash; /* of the key and of all that a picture depends on */
};

/* A picture: of a golden, or as it was drawn just now. */
struct golden_case {
    char *name;
    uint64_t ids, colors; /* hashes, of hit identities and of floats */
    uint32_t width, height;
    uint64_t rays[WHIT_RAY_KINDS];
    double mean[3];                /* linear, of pixels that are finite */
    char *made_by;                 /* its scene and options, as the suite names them */
    uint32_t *parts;               /* hashes, ascending */
    uint32_t part_count, capacity; /* of parts */
    char *reason;                  /* for which it was accepted; NULL: none was given */
    uint32_t line;                 /* of the file, the first of it */
};

struct golden {
    bool exists;
    enum golden_kind kind;
    char by[32]; /* the whit that wrote it last; it is for people alone */
    struct golden_case *cases;
    uint32_t count, capacity; /* sorted by name */
    struct golden_part *parts;
    uint32_t part_count, part_capacity; /* sorted by key */
};

/* Beside the suite, with .golden in the place of .whit or .suite, or .reference.golden; release
   with free(). NULL: out of memory. */
char *golden_path(const char *suite, enum golden_kind kind);
/* An empty one where there is no file. False, with an error that names file and line, where the
   file is damaged, cannot be read, or is of the other kind. golden_finish() it either way. */
bool golden_read(struct golden *golden, const char *path, enum golden_kind kind);
/* Likewise of text; `where` stands for the path in messages. Changes the text. */
bool golden_read_text(struct golden *golden, const char *where, char *text, enum golden_kind kind);
void golden_finish(struct golden *golden);

/* NULL: there is none. */
struct golden_case *golden_find(const struct golden *golden, const char *name);
/* The key of the part with this hash; NULL: the golden has no such part, though a case names it. */
const char *golden_part_key(const struct golden *golden, uint32_t hash);

/* Puts a copy of `item` in the place of the case of its name, or among the others. Its parts are to
   be put by golden_put_part. False: out of memory. */
bool golden_put(struct golden *golden, const struct golden_case *item);
bool golden_put_part(struct golden *golden, const char *key, uint32_t hash);
void golden_remove(struct golden *golden, uint32_t index);

/* "device", "reference": also of reports. */
const char *golden_kind_word(enum golden_kind kind);
/* The file's text, with those parts alone that cases name; free() it. NULL: out of memory. */
char *golden_text(const struct golden *golden);
/* The lines of one case and of its parts, without the first line of a file. */
char *golden_case_text(const struct golden *golden, const char *name);
/* Written beside and renamed. */
WHIT_CHECK whit_result golden_save(const struct golden *golden, const char *path);

/* A part's short hash: of its key and of the 64 bits that say what is in it. */
uint32_t golden_part_hash(const char *key, uint64_t content);
/* Takes part in the case's list, at its place. False: out of memory. */
bool golden_case_add_part(struct golden_case *item, uint32_t hash);
void golden_case_finish(struct golden_case *item);

#endif
