/* Intersects lines with triangles and spheres, in double. Triangles by edge functions of vertices
   sheared along the line (Woop, Benthin and Wald 2013), which are watertight in any precision. */
#include "reference/meet.h"

struct line line_make(const double origin[3], const double dir[3])
{
    struct line line;
    double max = 0.0;
    line.z = 2;
    for (int i = 0; i < 3; ++i) {
        line.origin[i] = origin[i];
        line.dir[i] = dir[i];
        if (fabs(dir[i]) > max) {
            max = fabs(dir[i]);
            line.z = i;
        }
    }
    line.x = (line.z + 1) % 3;
    line.y = (line.z + 2) % 3;
    line.shear_x = dir[line.x] / dir[line.z];
    line.shear_y = dir[line.y] / dir[line.z];
    return line;
}

/* A vertex in the sheared space, in which the line is the z axis; z is t. */
static struct dvec3 sheared(const struct line *line, const float vertex[3])
{
    double z = (double)vertex[line->z] - line->origin[line->z];
    double x = (double)vertex[line->x] - line->origin[line->x];
    double y = (double)vertex[line->y] - line->origin[line->y];
    return d3(x - line->shear_x * z, y - line->shear_y * z, z / line->dir[line->z]);
}

/* Twice the signed area of the triangle of an edge and the line; exactly negated for the reversed
   edge. */
static double edge_area(struct dvec3 from, struct dvec3 to)
{
    return from.x * to.y - from.y * to.x;
}

/* Whether the triangle owns the edge that the line goes through, by the fill rule of rasterizers
   (Pineda 1988); true where the line misses the edge. */
static bool owns_edge(double area, struct dvec3 from, struct dvec3 to, bool left)
{
    double dx = to.x - from.x, dy = to.y - from.y;
    if (area != 0.0)
        return true;
    return left ? dy > 0.0 || (dy == 0.0 && dx > 0.0) : dy < 0.0 || (dy == 0.0 && dx < 0.0);
}

struct candidate meet_triangle(const struct line *line, const struct gpu_triangle *triangle)
{
    struct candidate m = {.met = false};
    struct dvec3 a = sheared(line, triangle->v0), b = sheared(line, triangle->v1),
                 c = sheared(line, triangle->v2);
    double bc = edge_area(b, c), ca = edge_area(c, a), ab = edge_area(a, b);
    bool below = bc < 0.0 || ca < 0.0 || ab<0.0, above = bc> 0.0 || ca > 0.0 || ab > 0.0;
    if (below == above) /* the line misses the triangle, or sees it edge-on */
        return m;
    double area = bc + ca + ab;
    m.met = true;
    m.u = ca / area;
    m.v = ab / area;
    m.t = (bc * a.z + ca * b.z + ab * c.z) / area;
    /* The front is counter-clockwise as seen from the line's origin. Shearing along a negative axis
       mirrors the picture. */
    m.front = above == (line->dir[line->z] < 0.0);
    m.owned =
        owns_edge(bc, b, c, above) && owns_edge(ca, c, a, above) && owns_edge(ab, a, b, above);
    return m;
}

/* Computes the half chord from the line's distance to the centre, and the end nearer to the origin
   from the product of both ends, so that nothing cancels (Haines et al. 2019). */
struct candidate meet_sphere(const struct line *line, const struct gpu_triangle *sphere,
                             bool at_exit, bool self)
{
    struct candidate m = {.owned = true, .front = !at_exit};
    struct dvec3 d = dvec3_load(line->dir);
    struct dvec3 c = dvec3_sub(d3_load(sphere->v0), dvec3_load(line->origin));
    double radius = (double)sphere->v1[0], dd = dvec3_dot(d, d), middle = dvec3_dot(c, d) / dd;
    struct dvec3 off = dvec3_along(c, d, -middle);
    double room = radius * radius - dvec3_dot(off, off);
    if (!(room >= 0.0))
        return m;
    double half = sqrt(room / dd);
    double far = middle < 0.0 ? middle - half : middle + half;
    double near = far != 0.0 ? (dvec3_dot(c, c) - radius * radius) / (dd * far) : 0.0;
    m.t = at_exit ? fmax(near, far) : fmin(near, far);
    m.met = !self || (at_exit && middle > 0.0);
    struct dvec3 to_end = d3_scale(d, at_exit ? half : -half);
    m.normal = d3_unit_or(dvec3_sub(to_end, off), d3(0, 1, 0));
    return m;
}
