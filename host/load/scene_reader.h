/* Reads values from a scene file's JSON. Errors name the place: file, line, column and path
   (`objects[3].material`). Functions give false after they logged one error; the caller returns
   false then too. If a key is absent, *out stays as it was. */
#ifndef LOAD_SCENE_READER_H
#define LOAD_SCENE_READER_H

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "load/load.h"

/* The place of a value in the JSON: a chain of keys and indices, on the stacks of the functions
   that read it. */
struct place {
    const struct place *parent; /* NULL: the whole file */
    const char *key;            /* NULL: an array's element */
    size_t index;
};

/* The parts of a scene that one object added, as ranges of indices: nodes below `parent`, and
   instances, channels, lights and cameras on these. Ends are exclusive. */
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
    uint32_t lines_before; /* lines of the file in front of the text, where it is one line of it */
    whit_result result;
    uint32_t material_end;           /* objects can refer to materials below this index by name */
    uint32_t plain_material;         /* for objects without one; SCENE_NONE: not added yet */
    struct key_table material_names; /* index by name, of the first material with that name */
    struct key_table shapes;         /* mesh by shape_key */
    struct key_table model_keys;     /* index in `models` by path, material, lights and cameras */
    struct scene_range *models;
    uint32_t model_count, model_capacity;
};

/* Parses the text; the caller releases the JSON. NULL after an error was logged. */
json_t *reader_parse(struct reader *reader);
/* Logs `path:line:column: place: message`; always false. */
bool reader_fail(struct reader *reader, const struct place *place, const char *format, ...)
    WHIT_PRINTF(3, 4);
bool reader_no_memory(struct reader *reader);
/* scene_afford for what is at `place`; logs with that place. */
bool reader_afford(struct reader *reader, const struct place *place, uint64_t bytes,
                   const char *format, ...) WHIT_PRINTF(4, 5);
/* The line of a value, from 1; 0, without a search, in very large files with many materials and
   lights, where searching for all of them would take long. */
uint32_t reader_line(const struct reader *reader, const struct place *place);

/* Checks that `value` is an object with no keys but those in `known` (NULL-terminated), and
   "comment". */
bool reader_object(struct reader *reader, const struct place *place, const json_t *value,
                   const char *const *known);
/* The same with several lists of known keys. */
bool reader_object_lists(struct reader *reader, const struct place *place, const json_t *value,
                         const char *const *const *lists, size_t list_count);

/* The first key of `value` that is in `others` but not in `lists`, or NULL. */
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
/* Reads a string that must be in `names` (NULL-terminated); *out is its index there. */
bool reader_choice(struct reader *reader, const struct place *place, const json_t *object,
                   const char *key, const char *const *names, uint32_t *out);
/* Reads an array of exactly `count` numbers. */
bool reader_numbers(struct reader *reader, const struct place *place, const json_t *object,
                    const char *key, size_t count, double *out);
/* The same for a JSON value instead of an object's key. */
bool reader_vector(struct reader *reader, const struct place *place, const json_t *value,
                   size_t count, double *out);
/* Reads one number from `min` to `max`, which stands for all `count`, or an array of so many. */
bool reader_extent(struct reader *reader, const struct place *place, const json_t *object,
                   const char *key, double min, double max, size_t count, double *out);
/* Reads a colour: a grey level or [r, g, b], both linear, or "#rrggbb" in sRGB. */
bool reader_color(struct reader *reader, const struct place *place, const json_t *object,
                  const char *key, float out[3]);
bool reader_color_value(struct reader *reader, const struct place *place, const json_t *value,
                        float out[3]);
/* The word in `known` that is spelt most like `word`, or NULL when none is near. */
const char *reader_nearest(const char *word, const char *const *known);

/* scene_objects.c */
bool reader_objects(struct reader *reader, const struct place *place, const json_t *value,
                    uint32_t parent, uint32_t depth);

#endif
