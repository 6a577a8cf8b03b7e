/* The golden of a suite: a text file beside it that describes its pictures when they were accepted.
   Its format lets git merge what two people accept: each case and each part begins with a line that
   does not change and ends with an empty one, and no two cases have equal lines, because git takes
   equal lines of both sides for one. */
#ifndef APP_CHECK_GOLDEN_H
#define APP_CHECK_GOLDEN_H

#include <stdbool.h>
#include <stdint.h>

#include "whit/whit.h"

enum { GOLDEN_REASON_MAX = 120, GOLDEN_FORMAT = 2 };

/* Devices and the double reference draw pictures of other bits, so each has goldens of its own. */
enum golden_kind { GOLDEN_OF_DEVICE, GOLDEN_OF_REFERENCE };

/* A part of a picture's input: a mesh, a material, a light of a scene. */
struct golden_part {
    char *key;     /* `mesh ball of room.json`: kind, name and file */
    uint32_t hash; /* of the key and of all that a picture depends on */
};

/* Describes a picture: an accepted one of a golden, or one just drawn. */
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
    uint32_t line;                 /* number of its first line in the file */
};

struct golden {
    bool exists;
    enum golden_kind kind;
    char by[32]; /* version of whit that wrote it last; only for people */
    struct golden_case *cases;
    uint32_t count, capacity; /* sorted by name */
    struct golden_part *parts;
    uint32_t part_count, part_capacity; /* sorted by key */
};

/* The path of the suite's golden: .whit or .suite is replaced by .golden, or by .reference.golden;
   free() it. NULL: out of memory. */
char *golden_path(const char *suite, enum golden_kind kind);
/* The path of the suite that would have the same golden: with .suite in place of .whit, or .whit in
   place of .suite; free() it. NULL: out of memory, or the suite has neither ending. */
char *golden_other_suite(const char *suite);
/* Reads a golden; it is empty where there is no file. False, with an error that names file and
   line, where the file is damaged, cannot be read, or is of the other kind. Call golden_finish() in
   any case. */
bool golden_read(struct golden *golden, const char *path, enum golden_kind kind);
/* Reads a golden from text, which is changed; `where` stands for the path in messages. */
bool golden_read_text(struct golden *golden, const char *where, char *text, enum golden_kind kind);
void golden_finish(struct golden *golden);

/* The case of that name; NULL: there is none. */
struct golden_case *golden_find(const struct golden *golden, const char *name);
/* The key of the part with this hash; NULL: the golden has no such part, though a case names it. */
const char *golden_part_key(const struct golden *golden, uint32_t hash);

/* Replaces the case named like `item` by a copy of `item`, or adds the copy. Its parts must be
   added by golden_put_part. Call golden_sort() before anything is looked up. False: out of memory.
 */
bool golden_put(struct golden *golden, const struct golden_case *item);
bool golden_put_part(struct golden *golden, const char *key, uint32_t hash);
/* Puts cases, parts and the parts of each case in order, and drops parts that are there twice. */
void golden_sort(struct golden *golden);
void golden_remove(struct golden *golden, uint32_t index);

/* "device", "reference"; reports use these words too. */
const char *golden_kind_word(enum golden_kind kind);
/* The file's text, with only those parts that cases name; free() it. NULL: out of memory. */
char *golden_text(const struct golden *golden);
/* The lines of one case and of its parts, without the first line of a file. */
char *golden_case_text(const struct golden *golden, const char *name);

/* A part's short hash, of its key and the 64-bit hash of its content. */
uint32_t golden_part_hash(const char *key, uint64_t content);
/* Adds the hash of a part, for golden_sort() to put it in its place. False: out of memory. */
bool golden_case_add_part(struct golden_case *item, uint32_t hash);
/* Whether the case lists that hash of a part. */
bool golden_case_has_part(const struct golden_case *item, uint32_t hash);
void golden_case_finish(struct golden_case *item);

#endif
