/* Views of a scene, drawn very small to be judged. Part of viewpoint.c; spaces as in soup.h. */
#ifndef SCENE_SKETCH_H
#define SCENE_SKETCH_H

#include "scene/soup.h"

#define SKETCH_ACROSS 64
#define SKETCH_DOWN   48
#define VIEW_FOV_Y    0.69813170079773183 /* 40 degrees */

struct view {
    double eye[3], right[3], up[3], forward[3];
    double tan_x, tan_y;
};

struct sketch {
    float nearness[SKETCH_DOWN][SKETCH_ACROSS]; /* 1 / depth; 0: nothing */
    bool front[SKETCH_DOWN][SKETCH_ACROSS];
    bool pictured[SKETCH_DOWN][SKETCH_ACROSS];
};

struct verdict {
    double share; /* share of covered pixels (of a board: of textured ones, if any) with a front */
    double fill;  /* share of pixels that are covered, within the rectangle around these */
    double close; /* share of covered pixels that are nearer than 1 / `nearness` */
    double level; /* share of pixels that are covered, within the middle row */
};

/* Makes a view with the eye at the origin that looks along -toward_eye. */
void view_make(const double toward_eye[3], double fov_y, struct view *out);
/* Makes a view of VIEW_FOV_Y with all of the scene in it and the eye in the direction `way` from
   the scene's middle. `closely`: as near as it can be. */
void view_fit(const struct soup *soup, const double way[3], bool closely, struct view *view);

void sketch_draw(const struct soup *soup, const struct view *view, struct sketch *out);
/* `board`: a flat object, whose front is the side with its textures; see verdict.share. */
struct verdict view_judge(const struct soup *soup, const struct view *view, double nearness,
                          bool board);

#endif
