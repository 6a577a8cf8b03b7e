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
    double share; /* of fronts in what is seen; of a board: in what shows pictures, if anything */
    double fill;  /* of the rectangle around what is seen */
    double close; /* share of what is seen that is nearer than 1 / the nearness asked for */
    double level; /* share of the middle row that shows anything */
};

/* With the eye at the origin, looking away from `toward_eye`. */
void view_make(const double toward_eye[3], double fov_y, struct view *out);
/* All of the scene in the picture, of VIEW_FOV_Y; the eye stays in the direction `way` from the
   scene's middle. `closely`: as near as it can be. */
void view_fit(const struct soup *soup, const double way[3], bool closely, struct view *view);

void sketch_draw(const struct soup *soup, const struct view *view, struct sketch *out);
/* `board`: its front is where its pictures are the right way round. */
struct verdict view_judge(const struct soup *soup, const struct view *view, double nearness,
                          bool board);

#endif
