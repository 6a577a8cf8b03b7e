/* Affine maps in double: row-major 3x4, the last column is the translation. Scene transforms are
   composed in double and rounded to float once, at upload. */
#ifndef BASE_AFFINE_H
#define BASE_AFFINE_H

#include <stdbool.h>

struct affine {
    double m[12]; /* m[4 * row + column] */
};

struct affine affine_identity(void);
struct affine affine_multiply(const struct affine *a, const struct affine *b); /* a after b */
/* `rotation` is a quaternion x, y, z, w of any length but 0 (0 counts as identity). */
struct affine affine_from_trs(const double translation[3], const double rotation[4],
                              const double scale[3]);
double affine_determinant(const struct affine *a); /* of the 3x3 part */
bool affine_is_finite(const struct affine *a);
bool affine_is_identity(const struct affine *a);
/* False, with *out unchanged, when the 3x3 part has no finite inverse, or its determinant is not
   farther from 0 than its rounding error. */
bool affine_invert(const struct affine *a, struct affine *out);
void affine_point(const struct affine *a, const double in[3], double out[3]);
void affine_vector(const struct affine *a, const double in[3], double out[3]);

#endif
