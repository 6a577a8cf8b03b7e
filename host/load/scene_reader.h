/* Reading values out of a scene file's JSON, with errors that name the place: file, line, column
   and path (`objects[3].material`). Functions give false after they logged one error; the caller
   passes that up. Keys that are absent leave *out as it was. */
#ifndef LOAD_SCENE_READER_H
#define LOAD_SCENE_READER_H

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "load/load.h"

/* Where a value is: a chain of keys and indices, on the stack of whoever reads it. */
struct place {
    const struct place *parent; /* NULL: the whole file */
    const char *key;            /* NULL: an array's element */
    size_t index;
};

/* What an object added to the scene: nodes below `parent`, and what is on them. */
struct scene_range {
    uint32_t parent, first_node, node_end, first_instance, instance_end, first_channel, channel_end,
        first_light, light_end, first_camera, camera_end;
};

struct reader {
    struct scene *scene;
    const whit_load_params *params;
    const char *path;
    const char *text; /* ends with a zero byte */
    size_t text_bytes;
    uint32_t lines_before; /* of the file, where the text is one line of it */
    whit_result result;
    uint32_t material_end;           /* materials below it have the names that objects refer to */
    uint32_t plain_material;         /* for objects that name none, or SCENE_NONE so far */
    struct key_table material_names; /* of these; the first of each */
    struct key_table shapes;         /* their mesh, by what they are */
    struct key_table model_keys;     /* index of models */
    struct scene_range *models;
    uint32_t model_count, model_capacity;
};

/* The text as JSON, which the caller releases; NULL after an error, which says the place. */
json_t *reader_parse(struct reader *reader);
/* Logs `path:line:column: place: message`; always false. */
bool reader_fail(struct reader *reader, const struct place *place, const char *format, ...)
    WHIT_PRINTF(3, 4);
bool reader_no_memory(struct reader *reader);
/* scene_afford for what is at `place`; false is the end. */
bool reader_afford(struct reader *reader, const struct place *place, uint64_t bytes,
                   const char *format, ...) WHIT_PRINTF(4, 5);
/* 0 once looking would take long in a file of very many materials. */
uint32_t reader_line(const struct reader *reader, const struct place *place);

/* `value` is an object and has only keys out of `known` (NULL-terminated), or "comment". */
bool reader_object(struct reader *reader, const struct place *place, const json_t *value,
                   const char *const *known);
/* Likewise, over several lists. */
bool reader_object_lists(struct reader *reader, const struct place *place, const json_t *value,
                         const char *const *const *lists, size_t list_count);

/* The first key that `lists` lack and one of `others` has, or NULL. */
const char *reader_foreign_key(const json_t *value, const char *const *const *lists,
                               size_t list_count, const char *const *const *others,
                               size_t other_count);

bool reader_number(struct reader *reader, const struct place *place, const json_t *object,
                   const char *key, double min, double max, double *out);
bool reader_float(struct reader *reader, const struct place *place, const json_t *object,
                  const char *key, double min, double max, float *out);
bool reader_count(struct reader *reader, const struct place *place, const json_t *object,
                  const char *key, uint32_t min, uint32_t max, uint32_t *out);
bool reader_bool(struct reader *reader, const struct place *place, const json_t *object,
                 const char *key, bool *out);
/* *out is borrowed from the JSON. */
bool reader_string(struct reader *reader, const struct place *place, const json_t *object,
                   const char *key, const char **out);
/* Index of the string in `names` (NULL-terminated). */
bool reader_choice(struct reader *reader, const struct place *place, const json_t *object,
                   const char *key, const char *const *names, uint32_t *out);
/* Exactly `count` numbers. */
bool reader_numbers(struct reader *reader, const struct place *place, const json_t *object,
                    const char *key, size_t count, double *out);
/* The same for a value that is already at hand. */
bool reader_vector(struct reader *reader, const struct place *place, const json_t *value,
                   size_t count, double *out);
/* A grey level, [r, g, b] (both linear), or "#rrggbb" (sRGB). */
bool reader_color(struct reader *reader, const struct place *place, const json_t *object,
                  const char *key, float out[3]);
bool reader_color_value(struct reader *reader, const struct place *place, const json_t *value,
                        float out[3]);
/* Name of the known word nearest to `word`, or NULL when none is near. */
const char *reader_nearest(const char *word, const char *const *known);

/* scene_objects.c */
bool reader_objects(struct reader *reader, const struct place *place, const json_t *value,
                    uint32_t parent, uint32_t depth);

#endif
