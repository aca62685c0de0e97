/* Vectors of doubles and of whole numbers: one lane for each of several problems that are solved alike.

   GCC and Clang have such vectors in C and print the instructions of the processor. Comparisons give -1 in a lane where
   they hold and 0 elsewhere. Without contraction of products and sums (-ffp-contract=off) every width has the same bits. */

#ifndef LANES_H
#define LANES_H

#include <math.h>
#include <stdint.h>

#if defined(__AVX512F__)
#define LANES 8
#elif defined(__AVX2__)
#define LANES 4
#else
#define LANES 2
#endif

#define EPSILON 2.220446049250313e-16
#define TINY 1e-292

typedef double lanes __attribute__((vector_size(8 * LANES)));
typedef int64_t whole __attribute__((vector_size(8 * LANES)));

static inline lanes all(double value) { return value - (lanes){0}; }
static inline whole every(int64_t value) { return value - (whole){0}; }
static inline whole pick(whole where, whole yes, whole no) { return (where & yes) | (~where & no); }
static inline lanes choose(whole where, lanes yes, lanes no) { return (lanes)pick(where, (whole)yes, (whole)no); }
static inline lanes magnitude(lanes value) { return (lanes)((whole)value & INT64_MAX); }
static inline lanes copy_sign(lanes value, lanes sign)
{
    return (lanes)(((whole)value & INT64_MAX) | ((whole)sign & INT64_MIN));
}
static inline lanes larger(lanes a, lanes b) { return choose(a > b, a, b); }
static inline lanes smaller(lanes a, lanes b) { return choose(a > b, b, a); }

static inline lanes root(lanes value)
{
    lanes found;
    for (int lane = 0; lane < LANES; lane++) found[lane] = sqrt(value[lane]);
    return found;
}

static inline int any(whole where)
{
    int64_t found = 0;
    for (int lane = 0; lane < LANES; lane++) found |= where[lane];
    return found != 0;
}

static inline int greatest(whole value)
{
    int64_t found = value[0];
    for (int lane = 1; lane < LANES; lane++) found = value[lane] > found ? value[lane] : found;
    return (int)found;
}

static inline int least(whole value) { return -greatest(-value); }

/* The exponent of a positive number, and two to a power between -1000 and 1000. */
static inline whole exponent(lanes value) { return (((whole)value >> 52) & 0x7ff) - 1023; }
static inline lanes power_of_two(whole power) { return (lanes)((power + 1023) << 52); }

#endif
