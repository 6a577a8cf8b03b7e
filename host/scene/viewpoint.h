/* Where to look at a scene from when its file has no camera. Part of scene_freeze. */
#ifndef SCENE_VIEWPOINT_H
#define SCENE_VIEWPOINT_H

#include "scene/scene.h"

enum viewpoint_kind {
    VIEWPOINT_CORNER,   /* three-quarter view from the front, right and above */
    VIEWPOINT_TURNED,   /* the same from another side */
    VIEWPOINT_STRAIGHT, /* along x or z: boards, boxes with an open side */
    VIEWPOINT_INSIDE    /* rooms */
};

struct viewpoint {
    enum viewpoint_kind kind;
    double eye[3], target[3]; /* world; up is +y */
    double fov_y;
    bool part;      /* shows a small part that nearly all triangles are in, floor and sky aside;
                       false: all of the scene */
    bool under_sky; /* the part is inside of a sphere, half of one or box, which keeps out light */
    double lo[3], hi[3]; /* bounds of what is shown: of the part, INSIDE: of a cube around the
                            target; lo > hi: it is everything */
    /* World position of a lamp; INSIDE: ahead of the eye, and from there half of the free distance
       to the left and up; else to the left of the eye and above it. */
    double lamp[3];
};

/* Chooses by the scene's triangles at `pose`. The view fits a picture of 4:3; a wider one shows all
   of it too. WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result viewpoint_choose(const struct scene *scene, const struct scene_pose *pose,
                                        struct viewpoint *out);

#endif
