/* Scratch numbers that are freed at the end of their block:
   own_rational *rational = rational_create(...); */
#ifndef OWNED_RATIONAL_H
#define OWNED_RATIONAL_H

#include "oracle/rational.h"

#define own_rational __attribute__((cleanup(drop_rational), unused)) struct rational

static inline void drop_rational(struct rational **at)
{
    rational_destroy(*at);
}

#endif
