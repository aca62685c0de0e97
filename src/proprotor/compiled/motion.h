/* Equations of motion in the lanes: their mass matrix, and what stands on their right side. */

#ifndef MOTION_H
#define MOTION_H

#include "lanes.h"

#include <stddef.h>

/* Load M, and K of the held coordinates and C beside it, row by row. */
void load_equations(int n, int count_held, const int32_t *held, ptrdiff_t first, ptrdiff_t count, const double *const *matrices, lanes *equations);

/* Solve the first n columns of n rows for the others, rows in their order; return the lanes in which this loses digits. */
whole eliminate(int n, int columns, lanes *rows);

/* Find the matrix h of the equations in first order: rates of the held coordinates, then accelerations; return the lanes
   in which elimination loses digits. */
whole find_state_matrix(int n, int count_held, const int32_t *held, ptrdiff_t first, ptrdiff_t count, const double *const *matrices, lanes *equations, lanes *h);

#endif
