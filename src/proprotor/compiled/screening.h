/* Steps of scans whose points have eigenvalues alone: what the roots of a step have at its ends, one in each lane. */

#ifndef SCREENING_H
#define SCREENING_H

#include "eigen.h"

#define VECTORS (MOST_STATES / LANES)
#define TRUST 0.5 /* in cubics whose slopes are differences, as in crossings.py */
#define UNSEEN 0.5 /* of the bend: error of a cubic, as in parting.py */

typedef lanes row[VECTORS];

/* Steps of all lines in the order of their lines and positions. `line`, `before` and `after` (steps); `successor` (steps,
   states), a permutation; `position` (points); `values` and `change` (points, states), pairs of real and imaginary part;
   `error` (points, states); `block` (states). */
struct scan {
    int states;
    ptrdiff_t steps, points;
    double level;
    const int64_t *line, *before, *after, *successor, *block;
    const double *position, *values, *error;
    double *change;
};

/* A cubic over a step: values at both ends, and the slopes there times the length of the step. */
struct cubic {
    lanes start, end, slope_start, slope_end;
};

/* The roots of a step: values and changes at both ends, real and imaginary parts, the changes times the length; growth,
   its error, and the side of the level on which it lies, 0 where it is neutral; how far each root may go. */
struct ends {
    int states, vectors;
    row value[2][2], change[2][2];
    struct cubic growth[VECTORS];
    row error[2], side[2], way;
    whole block[VECTORS], there[VECTORS];
};

static inline lanes length_of(lanes real, lanes imaginary) { return root(real * real + imaginary * imaginary); }

static inline lanes cubic_at(lanes t, const struct cubic *c)
{
    lanes rise = c->end - c->start, a = c->slope_start - rise, b = rise - c->slope_end;
    return c->start + t * (rise + (1.0 - t) * (a + t * (b - a)));
}

/* How far a cubic may leave the straight line between its ends. */
static inline lanes bend(const struct cubic *c)
{
    lanes rise = c->end - c->start;
    return larger(magnitude(c->slope_start - rise), magnitude(c->slope_end - rise)) / 4.0;
}

/* How the error of a cubic is spread over a step. */
static inline lanes band(lanes t) { return 16.0 * (t * t) * ((1.0 - t) * (1.0 - t)); }

/* The cubic of one root in all lanes. */
static inline struct cubic of_lane(const struct cubic *rows, int state)
{
    const struct cubic *own = rows + state / LANES;
    int lane = state % LANES;
    return (struct cubic){all(own->start[lane]), all(own->end[lane]), all(own->slope_start[lane]), all(own->slope_end[lane])};
}

static inline double one(const lanes *row, int state) { return row[state / LANES][state % LANES]; }

int keeps_off(const struct scan *scan, const struct ends *ends, ptrdiff_t step, ptrdiff_t first, ptrdiff_t last, int state);
whole meets(const struct ends *ends, int state, int vector);

#endif
