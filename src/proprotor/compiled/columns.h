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

/* The first halves of two vectors, and the second halves, number by number in turns. */
#if LANES == 8
#define FIRST_HALVES(a, b) (lanes){(a)[0], (b)[0], (a)[1], (b)[1], (a)[2], (b)[2], (a)[3], (b)[3]}
#define SECOND_HALVES(a, b) (lanes){(a)[4], (b)[4], (a)[5], (b)[5], (a)[6], (b)[6], (a)[7], (b)[7]}
#elif LANES == 4
#define FIRST_HALVES(a, b) (lanes){(a)[0], (b)[0], (a)[1], (b)[1]}
#define SECOND_HALVES(a, b) (lanes){(a)[2], (b)[2], (a)[3], (b)[3]}
#else
#define FIRST_HALVES(a, b) (lanes){(a)[0], (b)[0]}
#define SECOND_HALVES(a, b) (lanes){(a)[1], (b)[1]}
#endif

/* Exchange rows and columns of as many vectors as there are lanes. */
static inline void exchange(lanes *rows)
{
#pragma GCC unroll 8
    for (int step = 1; step < LANES; step *= 2) {
        lanes before[LANES];
#pragma GCC unroll 8
        for (int k = 0; k < LANES; k++) before[k] = rows[k];
#pragma GCC unroll 8
        for (int k = 0; k < LANES / 2; k++) {
            rows[2 * k] = FIRST_HALVES(before[k], before[k + LANES / 2]);
            rows[2 * k + 1] = SECOND_HALVES(before[k], before[k + LANES / 2]);
        }
    }
}

/* Load numbers that follow each other in memory, those of two points `stride` apart; quicker than one by one. The last
   block of as many numbers as there are lanes may repeat some of the block before. */
static inline void load_row(const double *at, ptrdiff_t stride, ptrdiff_t point, ptrdiff_t points, ptrdiff_t count, lanes *into)
{
    const double *own[LANES];
    for (int lane = 0; lane < LANES; lane++) own[lane] = at + stride * (point + lane < points ? point + lane : points - 1);
    for (ptrdiff_t k = 0; count < LANES && k < count; k++)
        for (int lane = 0; lane < LANES; lane++) into[k][lane] = own[lane][k];
    for (ptrdiff_t k = 0; count >= LANES && k < count; k += LANES) {
        lanes rows[LANES];
        if (k > count - LANES) k = count - LANES;
#pragma GCC unroll 8
        for (int lane = 0; lane < LANES; lane++) memcpy(&rows[lane], own[lane] + k, sizeof(lanes));
        exchange(rows);
#pragma GCC unroll 8
        for (int row = 0; row < LANES; row++) into[k + row] = rows[row];
    }
}

/* Store numbers in the same order. */
static inline void store_row(const lanes *from, double *at, ptrdiff_t stride, ptrdiff_t point, ptrdiff_t points, ptrdiff_t count)
{
    int few = count < LANES || points - point < LANES;
    for (int lane = 0; few && lane < LANES && point + lane < points; lane++)
        for (ptrdiff_t k = 0; k < count; k++) at[stride * (point + lane) + k] = from[k][lane];
    for (ptrdiff_t k = 0; !few && k < count; k += LANES) {
        lanes rows[LANES];
        if (k > count - LANES) k = count - LANES;
#pragma GCC unroll 8
        for (int row = 0; row < LANES; row++) rows[row] = from[k + row];
        exchange(rows);
#pragma GCC unroll 8
        for (int lane = 0; lane < LANES; lane++) memcpy(at + stride * (point + lane) + k, &rows[lane], sizeof(lanes));
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
