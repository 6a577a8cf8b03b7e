/* What libm gives in other bits by its version and by the processor's instructions, in the same
   bits on every machine whose doubles are IEEE's: by sums, products, quotients and square roots,
   which the build lets no compiler fuse (-ffp-contract=off). For all that is computed before it is
   uploaded, so that scenes are the same everywhere; tests/same.cmake refuses libm's there.

   Within 1 ulp of the exact value, logarithms and powers within 0.55 ulp
   (tests/unit/base_same_test.c), but for angles that underflow; so that a float rounded from it is
   nearly always that of libm. Special values are those of C, but for what is said. */
#ifndef BASE_SAME_H
#define BASE_SAME_H

/* Angles of more than 10^6 are first reduced by multiples of the double nearest to 2 pi, not of 2
   pi. */
double same_sin(double angle);
double same_cos(double angle);
double same_tan(double angle);

double same_acos(double x);
double same_atan2(double y, double x);

double same_log(double x);
double same_log2(double x);
double same_log10(double x);
double same_exp(double x);
/* NaN for x < 0. */
double same_pow(double x, double y);

#endif
