/* Bodies of media: a body is all triangles of one medium in one instance, or one sphere. */
#ifndef PICTURE_BODIES_H
#define PICTURE_BODIES_H

#include <stdbool.h>
#include <stdint.h>

#include "scene/scene.h"

struct body {
    uint32_t instance, material;
    uint32_t sphere;     /* index in its mesh, or SCENE_NONE: the body is triangles */
    double lo[3], hi[3]; /* world space, widened by `rounding` */
    double rounding;     /* bound of rounding errors, world units */
};

/* The bodies of a scene in one pose. A zeroed struct is empty. */
struct bodies {
    struct body *all;
    uint32_t count, capacity;
    uint64_t pose_hash;
    double searched,
        gap; /* surfaces of two bodies closer than `searched` are at least `gap` apart */
};

/* Whether light passes through a surface of this material into a medium of its own. */
bool bodies_bounded_by(const struct scene_material *m);
/* Lists all bodies of the scene, unless those of this pose are listed already. False: memory ran
   out. */
bool bodies_list(const struct scene *scene, const struct scene_pose *pose, struct bodies *bodies);
/* Whether surfaces of two bodies may come nearer than `distance_max`, in world units. Also true
   where finding out would take too long, or memory runs out. */
bool bodies_come_within(const struct scene *scene, const struct scene_pose *pose,
                        struct bodies *bodies, double distance_max);
void bodies_finish(struct bodies *bodies);

#endif
