/* The perspective camera that the user moves, in double. Lengths are in world units, angles in
   radians unless named otherwise. */
#ifndef VIEW_CAMERA_H
#define VIEW_CAMERA_H

#include <stdbool.h>
#include <stddef.h>

struct view_camera {
    double eye[3], target[3], up[3]; /* eye != target; up is not parallel to target - eye */
    double fov_y_degrees;
    bool along_y; /* `up` is for this view alone: turning it goes on about y */
};

/* Makes it the camera with these values. */
void camera_set(struct view_camera *camera, const double eye[3], const double target[3],
                const double up[3], double fov_y_degrees);
/* Moves the target along the view to where the middle of these bounds lies beside it; at least a
   quarter of their longest side away, for a camera among or behind the objects. The picture stays
   as it is. */
void camera_reach(struct view_camera *camera, const double lo[3], const double hi[3]);
/* Moves the camera, in its direction, so that it looks at the middle of the box and has all of it
   in the picture. An empty box counts as one around the origin. */
void camera_show(struct view_camera *camera, const double lo[3], const double hi[3], double aspect);
/* Makes the camera look at its target along an axis (0..2), towards negative values (`from` 1) or
   positive ones (`from` -1). */
void camera_along(struct view_camera *camera, int axis, int from);

/* Turns the eye around the target by angles: `right` about the up axis, `up` about the horizontal
   axis, but not beyond the poles. */
void camera_orbit(struct view_camera *camera, double right, double up);
/* Turns the camera in place. */
void camera_turn(struct view_camera *camera, double right, double up);
/* Moves eye and target, by multiples of the distance between them. */
void camera_fly(struct view_camera *camera, double right, double up, double forward);
/* Multiplies the distance to the target by a factor: 0.5 halves it. It never becomes 0, nor too
   large for a float. */
void camera_zoom(struct view_camera *camera, double factor);
/* Makes `point` the target, seen from the same direction and distance. */
void camera_focus(struct view_camera *camera, const double point[3]);

/* Writes "ex,ey,ez,tx,ty,tz,ux,uy,uz,fov", as --camera takes it. */
void camera_to_text(const struct view_camera *camera, char *text, size_t text_bytes);
/* False: the text is no such list, or its numbers make no camera. */
bool camera_from_text(const char *text, struct view_camera *camera);

/* Projects the part of the line from `a` to `b` that is in front of the eye into a picture of width
   x height: `line` gets pixels x0, y0, x1, y1 from the upper left. False: no part is in front. */
bool camera_project(const struct view_camera *camera, const double a[3], const double b[3],
                    double width, double height, double line[4]);

#endif
