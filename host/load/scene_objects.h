/* Readers for objects of a scene file. As in scene_reader.h, functions give false after they logged
   one error. */
#ifndef LOAD_SCENE_OBJECTS_H
#define LOAD_SCENE_OBJECTS_H

#include "load/scene_reader.h"

#define INSTANCES_MAX 4000000u

enum shape {
    SHAPE_BOX,
    SHAPE_PLANE,
    SHAPE_SPHERE,
    SHAPE_ICOSPHERE,
    SHAPE_TORUS,
    SHAPE_CYLINDER,
    SHAPE_CONE,
    SHAPE_TERRAIN,
    SHAPE_STRANDS,
    SHAPE_ATRIUM,
    SHAPE_SPHEREFLAKE,
    SHAPE_BALL,
    SHAPE_BALLS,
    SHAPE_COUNT
};

/* scene_shapes.c: names and allowed keys by enum shape; shape_names and each list of keys end with
   NULL. */
extern const char *const shape_names[SHAPE_COUNT + 1];
extern const char *const *const shape_keys[SHAPE_COUNT];
/* Adds a shape's mesh and instances, below `node`. */
bool reader_shape(struct reader *reader, const struct place *place, const json_t *object,
                  enum shape shape, const char *name, uint32_t node);

/* scene_models.c: adds the model that the object names, below `node`. */
bool reader_model(struct reader *reader, const struct place *place, const json_t *object,
                  uint32_t node);

/* scene_transform.c: reads the object's transform into `node`. */
bool reader_transform(struct reader *reader, const struct place *place, const json_t *object,
                      struct scene_node *node);

#endif
