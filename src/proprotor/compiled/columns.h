/* Numbers of many points in memory, read into the lanes of vectors and written from them. */

#ifndef COLUMNS_H
#define COLUMNS_H

#include "lanes.h"

#include <stddef.h>
#include <string.h>

/* Numbers with a stride from point to point and one along a blade; a stride of 0 is for what all share. Zero without a
   place. */
struct column {
    const double *at;
    ptrdiff_t point, along;
};

/* Load one number of as many points as there are lanes; lanes behind the last point repeat it. */
static inline lanes load(const struct column *column, ptrdiff_t point, ptrdiff_t points, ptrdiff_t place)
{
    if (!column->at) return all(0.0);
    const double *at = column->at + place * column->along;
    if (!column->point) return all(*at);
    lanes found = {0};
    if (column->point == 1 && point + LANES <= points) {
        memcpy(&found, at + point, sizeof found);
        return found;
    }
    for (int lane = 0; lane < LANES; lane++)
        found[lane] = at[column->point * (point + lane < points ? point + lane : points - 1)];
    return found;
}

/* Load numbers that follow each other in memory, those of two points `stride` apart; quicker than one by one. */
static inline void load_row(const double *at, ptrdiff_t stride, ptrdiff_t point, ptrdiff_t points, ptrdiff_t count, lanes *into)
{
    for (int lane = 0; lane < LANES; lane++) {
        const double *own = at + stride * (point + lane < points ? point + lane : points - 1);
        for (ptrdiff_t k = 0; k < count; k++) ((double *)into)[k * LANES + lane] = own[k];
    }
}

/* Store numbers in the same order. */
static inline void store_row(const lanes *from, double *at, ptrdiff_t stride, ptrdiff_t point, ptrdiff_t points, ptrdiff_t count)
{
    for (int lane = 0; lane < LANES && point + lane < points; lane++) {
        double *own = at + stride * (point + lane);
        for (ptrdiff_t k = 0; k < count; k++) own[k] = ((const double *)from)[k * LANES + lane];
    }
}

/* Store one number of as many points as there are lanes, `stride` apart. */
static inline void store(lanes value, double *at, ptrdiff_t stride, ptrdiff_t point, ptrdiff_t points)
{
    for (int lane = 0; lane < LANES && point + lane < points; lane++) at[stride * (point + lane)] = value[lane];
}

/* The same for the lanes in which a condition holds. */
static inline void store_where(whole where, lanes value, double *at, ptrdiff_t stride, ptrdiff_t point, ptrdiff_t points)
{
    for (int lane = 0; lane < LANES && point + lane < points; lane++)
        if (where[lane]) at[stride * (point + lane)] = value[lane];
}

#endif
