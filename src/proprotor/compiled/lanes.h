/* Vectors of doubles and of whole numbers: one lane for each of several problems that are solved alike.

   GCC and Clang have such vectors in C and print the instructions of the processor. Comparisons give -1 in a lane where
   they hold and 0 elsewhere. Without contraction of products and sums (-ffp-contract=off) every width has the same bits. */

#ifndef LANES_H
#define LANES_H

#include <math.h>
#include <stdint.h>

#ifndef LANES /* as wide as the registers of the processor; -DLANES=4 asks for another width */
#if defined(__AVX512F__)
#define LANES 8
#elif defined(__AVX2__)
#define LANES 4
#else
#define LANES 2
#endif
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

/* The nearest whole number, for numbers below 2^51. */
static inline lanes nearest(lanes value)
{
    const double shift = 6755399441055744.0; /* 1.5 * 2^52 */
    return (value + shift) - shift;
}

/* Sine of an angle and a number of quarter turns: Taylor's series within an eighth of a turn, else the library's. */
static inline lanes wave(lanes angle, int64_t quarters)
{
    const double first = 1.5707963109016418, second = 1.5893254712295857e-8, third = 6.1232339957367660e-17;
    lanes turns = nearest(angle * 0.6366197723675814);
    lanes x = ((angle - turns * first) - turns * second) - turns * third, square = x * x;
    lanes sine = -1.0 / 121645100408832000.0 * square + 1.0 / 355687428096000.0;
    sine = sine * square - 1.0 / 1307674368000.0;
    sine = sine * square + 1.0 / 6227020800.0;
    sine = sine * square - 1.0 / 39916800.0;
    sine = sine * square + 1.0 / 362880.0;
    sine = sine * square - 1.0 / 5040.0;
    sine = sine * square + 1.0 / 120.0;
    sine = sine * square - 1.0 / 6.0;
    sine = sine * square * x + x;
    lanes cosine = 1.0 / 20922789888000.0 * square - 1.0 / 87178291200.0;
    cosine = cosine * square + 1.0 / 479001600.0;
    cosine = cosine * square - 1.0 / 3628800.0;
    cosine = cosine * square + 1.0 / 40320.0;
    cosine = cosine * square - 1.0 / 720.0;
    cosine = cosine * square + 1.0 / 24.0;
    cosine = cosine * square * square - 0.5 * square + 1.0;
    whole quarter = (__builtin_convertvector(turns, whole) + quarters) & 3;
    lanes found = choose((quarter & 1) != 0, cosine, sine);
    return choose((quarter & 2) != 0, -found, found);
}

static inline lanes sine(lanes angle)
{
    lanes found = wave(angle, 0);
    whole far = ~(magnitude(angle) <= 1e5);
    for (int lane = 0; lane < LANES; lane++)
        if (far[lane]) found[lane] = sin(angle[lane]);
    return found;
}

static inline lanes cosine(lanes angle)
{
    lanes found = wave(angle, 1);
    whole far = ~(magnitude(angle) <= 1e5);
    for (int lane = 0; lane < LANES; lane++)
        if (far[lane]) found[lane] = cos(angle[lane]);
    return found;
}

/* Inverse tangent: Taylor's series within 15 degrees; larger angles from their complement and from 30 degrees. */
static inline lanes arc_tangent(lanes tangent)
{
    lanes x = magnitude(tangent);
    whole steep = x > 1.0;
    x = choose(steep, 1.0 / x, x);
    whole wide = x > 0.2679491924311227;
    x = choose(wide, (x * 1.7320508075688772 - 1.0) / (x + 1.7320508075688772), x);
    lanes square = x * x, sum = 1.0 / 29.0 - square * (1.0 / 31.0);
    for (int power = 27; power >= 3; power -= 2) sum = 1.0 / power - square * sum;
    sum = x - x * square * sum;
    sum = choose(wide, sum + 0.5235987755982989, sum);
    return copy_sign(choose(steep, 1.5707963267948966 - sum, sum), tangent);
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
