/* Vectors of fractions of any size, for oracles. */
#ifndef TESTS_FRACTION_FIXTURE_H
#define TESTS_FRACTION_FIXTURE_H

#include <gmp.h>

#include "base/vec.h"

/* a b - c d */
static inline void set_product(mpq_t out, const mpq_t a, const mpq_t b, const mpq_t c,
                               const mpq_t d)
{
    mpq_t left, right;
    mpq_inits(left, right, NULL);
    mpq_mul(left, a, b);
    mpq_mul(right, c, d);
    mpq_sub(out, left, right);
    mpq_clears(left, right, NULL);
}

/* p.(q x r) */
static inline void set_triple(mpq_t out, mpq_t p[3], mpq_t q[3], mpq_t r[3])
{
    mpq_t part;
    mpq_init(part);
    mpq_set_ui(out, 0, 1);
    for (int k = 0; k < 3; ++k) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        set_product(part, q[i], r[j], q[j], r[i]);
        mpq_mul(part, part, p[k]);
        mpq_add(out, out, part);
    }
    mpq_clear(part);
}

static inline void set_vector(mpq_t out[3], struct vec3 v)
{
    mpq_set_d(out[0], (double)v.x);
    mpq_set_d(out[1], (double)v.y);
    mpq_set_d(out[2], (double)v.z);
}

#endif
