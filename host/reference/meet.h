/* Where lines meet primitives. */
#ifndef REFERENCE_MEET_H
#define REFERENCE_MEET_H

#include "reference/inside.h"

/* A ray in the space of a tree, with what the test of triangles needs. */
struct line {
    double origin[3], dir[3];
    int x, y, z; /* z: where the direction is longest */
    double shear_x, shear_y;
};

struct candidate {
    bool met;
    double t, u, v;
    struct dvec3 normal;
    bool front;
    bool owned; /* of triangles that share the point one owns it */
};

struct line line_make(const double origin[3], const double dir[3]);
struct candidate meet_triangle(const struct line *line, const struct gpu_triangle *triangle);
/* One of the ends of the chord. `self`: the line starts on it; then only the far end is there. */
struct candidate meet_sphere(const struct line *line, const struct gpu_triangle *sphere,
                             bool at_exit, bool self);

#endif
