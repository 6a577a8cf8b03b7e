/* The camera that the user moves: a perspective one, in double. Lengths are in world units, angles
   in radians unless named otherwise. */
#ifndef VIEW_CAMERA_H
#define VIEW_CAMERA_H

#include <stdbool.h>
#include <stddef.h>

struct view_camera {
    double eye[3], target[3], up[3]; /* eye != target; up is not along their difference */
    double fov_y_degrees;
};

/* The same direction, onto the middle of the box, from where all of it is in the picture; an empty
   box is one around the origin. */
void camera_show(struct view_camera *camera, const double lo[3], const double hi[3], double aspect);
/* Along an axis, 0..2, towards negative (`from` 1) or positive (-1), onto the same target. */
void camera_along(struct view_camera *camera, int axis, int from);

/* Around the target: `right` about the up axis, `up` above the horizon, which it does not pass. */
void camera_orbit(struct view_camera *camera, double right, double up);
/* Turns in place. */
void camera_turn(struct view_camera *camera, double right, double up);
/* Eye and target alike, in parts of the distance between them. */
void camera_fly(struct view_camera *camera, double right, double up, double forward);
/* Nearer to the target by a factor: 0.5 halves the distance. Never onto it. */
void camera_zoom(struct view_camera *camera, double factor);
/* Looks at a point, from the same direction and distance. */
void camera_focus(struct view_camera *camera, const double point[3]);

/* "ex,ey,ez,tx,ty,tz,ux,uy,uz,fov", as --camera takes it. */
void camera_to_text(const struct view_camera *camera, char *text, size_t text_bytes);
/* False where the text is no such list of numbers that makes a camera. */
bool camera_from_text(const char *text, struct view_camera *camera);

/* Where the part in front of the eye of a line from `a` to `b` is, in a picture of width x height:
   pixels x0, y0, x1, y1 from the upper left. False where all of it is behind. */
bool camera_project(const struct view_camera *camera, const double a[3], const double b[3],
                    double width, double height, double line[4]);

#endif
