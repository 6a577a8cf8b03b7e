/* The parts of a frozen scene: what a picture depends on, piece by piece, under names that are the
   same from run to run. A part's hash has its references to other parts by name, not by index, so
   that it does not change when parts are added in front. */
#ifndef SCENE_PARTS_H
#define SCENE_PARTS_H

#include "scene/scene.h"
#include "whit/whit_program.h"

struct scene_part {
    whit_part_kind kind;
    uint32_t index;   /* of its record in the scene's array of that kind */
    const char *name; /* in scene_parts.names */
    uint64_t hash;
};

/* "mesh", "material", ... */
const char *scene_part_kind_name(whit_part_kind kind);

/* Unique names of the records of one kind, by index. */
struct scene_names {
    char **names;
    uint32_t count;
    struct key_table table; /* index by name */
};

/* Kinds of names: those of whit_part_kind below WHIT_PART_ENVIRONMENT, and nodes, which are no
   parts of their own but are referred to by parts. */
enum { SCENE_NAMES_NODE = WHIT_PART_ENVIRONMENT, SCENE_NAMES };

struct scene_parts {
    struct scene_part *items;
    uint32_t count, capacity;
    uint32_t first[WHIT_PART_KINDS];       /* index in `items` of each kind's first part */
    struct scene_names names[SCENE_NAMES]; /* by whit_part_kind or SCENE_NAMES_NODE */
};

/* `scene` is frozen and still has its texels; it is not read afterwards. Release with
   scene_parts_finish, after a failure too. WHIT_ERROR_MEMORY, not logged. */
WHIT_CHECK whit_result scene_parts_init(const struct scene *scene, struct scene_parts *out);
void scene_parts_finish(struct scene_parts *parts);
/* The part of that kind and name; NULL: there is none. */
const struct scene_part *scene_parts_find(const struct scene_parts *parts, whit_part_kind kind,
                                          const char *name);
/* The name of the record with an index, "" for SCENE_NONE; and the index of the record with a name,
   or SCENE_NONE. `kind`: a whit_part_kind, or SCENE_NAMES_NODE. */
const char *scene_parts_name(const struct scene_parts *parts, unsigned kind, uint32_t index);
uint32_t scene_parts_index(const struct scene_parts *parts, unsigned kind, const char *name);

#endif
