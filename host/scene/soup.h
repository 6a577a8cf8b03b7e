/* All triangles of a scene in one array, to choose a viewpoint by. Part of viewpoint.c. */
#ifndef SCENE_SOUP_H
#define SCENE_SOUP_H

#include "scene/scene.h"

#define SOUP_CELLS 16 /* of an outline, on a side of a cube map's face */

/* Triangles in a space where the scene is around the origin and its bounding sphere is 1. */
struct soup {
    float *corners;    /* 9 per triangle */
    uint8_t *pictured; /* 1 per triangle: whether its material has a diffuse texture */
    uint32_t count;
    uint32_t fit_count; /* triangles that the view has to show: may be more than `count`, by those
                           of moving instances at later times, or fewer, by soup_narrow */
    bool whole;         /* has all triangles; false: only boxes around instances, for the fit */
    bool under_sky; /* by soup_narrow: a sphere, half of one, or a box of sky is around the part */
    bool in_box;    /* it is a box */
    double centre[3], radius, half[3];
    /* The farthest corner in each cell of a cube map of directions, enough for a first fit. */
    float outline[6 * SOUP_CELLS * SOUP_CELLS][3];
    uint32_t outline_count;
};

/* Collects the triangles of `scene` at `pose`, and those at other times of its animation (even
   steps and keys): with many triangles boxes around its instances in their place. With very many
   triangles, or with spheres, only boxes. WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result soup_init(const struct scene *scene, const struct scene_pose *pose,
                                 struct soup *soup);
/* Sets centre, radius and half to those of a box. */
void soup_measure(const double lo[3], const double hi[3], struct soup *soup);
void soup_find_outline(struct soup *soup);
/* The same triangles in the space of the small part of the scene that nearly all of them are in,
   such as what stands on a wide floor or under a sky; these do not count (narrow.c). The part's
   triangles come first, and the view is fitted to them alone. `narrow` is zeroed where there is no
   such part, where instances move, and where `soup` has only boxes. WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result soup_narrow(const struct soup *soup, struct soup *narrow);
void soup_finish(struct soup *soup);

#endif
