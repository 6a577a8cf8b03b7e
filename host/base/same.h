/* Functions whose bits in libm depend on its version and on the processor's instructions, here with
   the same bits on every machine with IEEE doubles: made of sums, products, quotients and square
   roots, which the build lets no compiler fuse (-ffp-contract=off). For all that is computed before
   upload, so that scenes are the same everywhere; tests/same.cmake refuses libm's functions there.

   They are within 1 ulp of the exact value, logarithms and powers within 0.55 ulp
   (tests/unit/base_same_test.c), except angles that underflow; so that a float rounded from one is
   nearly always that of libm. Special values are those of C, except where stated. */
#ifndef BASE_SAME_H
#define BASE_SAME_H

/* Angles above 10^6 are first reduced by multiples of the double nearest to 2 pi, not of 2 pi
   itself. */
double same_sin(double angle);
double same_cos(double angle);
double same_tan(double angle);

double same_acos(double x);
double same_atan2(double y, double x);

double same_log(double x);
double same_log2(double x);
double same_log10(double x);
double same_exp(double x);
/* NaN for x < 0, unless y is 0. */
double same_pow(double x, double y);

#endif
