/* Intersections of lines with primitives. */
#ifndef REFERENCE_MEET_H
#define REFERENCE_MEET_H

#include "reference/inside.h"

/* A ray in the space of a tree, with values for the test of triangles. */
struct line {
    double origin[3], dir[3];
    int x, y, z; /* axes; z: the one with the direction's largest component */
    double shear_x, shear_y;
};

struct candidate {
    bool met;
    double t, u, v;
    struct dvec3 normal;
    bool front;
    bool owned; /* of several triangles that share the point, exactly one has this set */
};

struct line line_make(const double origin[3], const double dir[3]);
struct candidate meet_triangle(const struct line *line, const struct gpu_triangle *triangle);
/* One of the two hits, the far one with `at_exit`. `self`: the line starts on the sphere; then only
   the far one exists. */
struct candidate meet_sphere(const struct line *line, const struct gpu_triangle *sphere,
                             bool at_exit, bool self);

#endif
