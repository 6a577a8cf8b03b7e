#include "base/affine.h"

#include <math.h>

struct affine affine_identity(void)
{
    return (struct affine){{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}};
}

struct affine affine_multiply(const struct affine *a, const struct affine *b)
{
    struct affine out;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c) {
            double sum = c == 3 ? a->m[4 * r + 3] : 0.0;
            for (int k = 0; k < 3; ++k)
                sum += a->m[4 * r + k] * b->m[4 * k + c];
            out.m[4 * r + c] = sum;
        }
    }
    return out;
}

struct affine affine_from_trs(const double translation[3], const double rotation[4],
                              const double scale[3])
{
    double x = rotation[0], y = rotation[1], z = rotation[2], w = rotation[3];
    double length = sqrt(x * x + y * y + z * z + w * w);
    if (length > 0.0 && isfinite(length)) {
        x /= length, y /= length, z /= length, w /= length;
    } else {
        x = y = z = 0.0, w = 1.0;
    }
    double rot[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - z * w),     2 * (x * z + y * w),
                     2 * (x * y + z * w),     1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
                     2 * (x * z - y * w),     2 * (y * z + x * w),     1 - 2 * (x * x + y * y)};
    struct affine out;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c)
            out.m[4 * r + c] = rot[3 * r + c] * scale[c];
        out.m[4 * r + 3] = translation[r];
    }
    return out;
}

double affine_determinant(const struct affine *a)
{
    const double *m = a->m;
    return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) +
           m[2] * (m[4] * m[9] - m[5] * m[8]);
}

bool affine_is_identity(const struct affine *a)
{
    struct affine identity = affine_identity();
    for (int i = 0; i < 12; ++i) {
        if (a->m[i] != identity.m[i])
            return false;
    }
    return true;
}

bool affine_is_finite(const struct affine *a)
{
    for (int i = 0; i < 12; ++i) {
        if (!isfinite(a->m[i]))
            return false;
    }
    return true;
}

/* Whether the determinant is farther from 0 than its rounding error: at most three roundings of
   each of six products and two of the sums, below 6 x 2^-53 of their sizes. A matrix of rank 2 with
   decimal entries can have a determinant of some 2^-54 instead of 0. */
static bool is_invertible(const double *m, double det)
{
    double size = fabs(m[0]) * (fabs(m[5] * m[10]) + fabs(m[6] * m[9])) +
                  fabs(m[1]) * (fabs(m[4] * m[10]) + fabs(m[6] * m[8])) +
                  fabs(m[2]) * (fabs(m[4] * m[9]) + fabs(m[5] * m[8]));
    return fabs(det) > 0x1p-50 * size && isfinite(1.0 / det);
}

bool affine_invert(const struct affine *a, struct affine *out)
{
    const double *m = a->m;
    double det = affine_determinant(a);
    double inv = 1.0 / det;
    if (!is_invertible(m, det))
        return false;
    struct affine r = {{(m[5] * m[10] - m[6] * m[9]) * inv, (m[2] * m[9] - m[1] * m[10]) * inv,
                        (m[1] * m[6] - m[2] * m[5]) * inv, 0, (m[6] * m[8] - m[4] * m[10]) * inv,
                        (m[0] * m[10] - m[2] * m[8]) * inv, (m[2] * m[4] - m[0] * m[6]) * inv, 0,
                        (m[4] * m[9] - m[5] * m[8]) * inv, (m[1] * m[8] - m[0] * m[9]) * inv,
                        (m[0] * m[5] - m[1] * m[4]) * inv, 0}};
    for (int i = 0; i < 3; ++i)
        r.m[4 * i + 3] = -(r.m[4 * i] * m[3] + r.m[4 * i + 1] * m[7] + r.m[4 * i + 2] * m[11]);
    if (!affine_is_finite(&r))
        return false;
    *out = r;
    return true;
}

void affine_point(const struct affine *a, const double in[3], double out[3])
{
    affine_vector(a, in, out);
    for (int r = 0; r < 3; ++r)
        out[r] += a->m[4 * r + 3];
}

void affine_vector(const struct affine *a, const double in[3], double out[3])
{
    double p[3];
    for (int r = 0; r < 3; ++r)
        p[r] = a->m[4 * r] * in[0] + a->m[4 * r + 1] * in[1] + a->m[4 * r + 2] * in[2];
    out[0] = p[0], out[1] = p[1], out[2] = p[2];
}
