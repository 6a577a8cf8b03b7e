/* All triangles of a scene at once, for whoever chooses a viewpoint. Part of viewpoint.c. */
#ifndef SCENE_SOUP_H
#define SCENE_SOUP_H

#include "scene/scene.h"

#define SOUP_CELLS 16 /* of an outline, on a side of a cube map's face */

/* Triangles in a space where the scene is around the origin and its bounding sphere is 1. */
struct soup {
    float *corners;    /* 9 per triangle */
    uint8_t *pictured; /* 1 per triangle: whether its material has a diffuse texture */
    uint32_t count;
    uint32_t fit_count; /* with those that only the fit looks at: where things are later on */
    bool whole;         /* else boxes around the instances stand for them */
    double centre[3], radius, half[3];
    /* The farthest corner in each of some directions: enough for a first fit. */
    float outline[6 * SOUP_CELLS * SOUP_CELLS][3];
    uint32_t outline_count;
};

/* `scene` as `pose` places it, and boxes around its instances as they are later on. With very many
   triangles, or spheres, only boxes. WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result soup_init(const struct scene *scene, const struct scene_pose *pose,
                                 struct soup *soup);
/* The same triangles around the small part of the scene that nearly all of them are in, such as
   what stands on a wide floor: those come first, and the fit looks at them alone. `narrow` is
   zeroed where there is no such part, or where it cannot be told: only boxes, or things that move.
   WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result soup_narrow(const struct soup *soup, struct soup *narrow);
void soup_finish(struct soup *soup);

#endif
