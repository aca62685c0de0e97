/* Linear equations of a few rows, one set in each lane. */

#ifndef ROWS_H
#define ROWS_H

#include "lanes.h"

/* Solve the first `count` columns of `count` rows for the others, which become the solutions, with exchanges of rows in
   each lane; without an inverse these are not finite. */
static inline void solve_rows(int count, int columns, lanes *rows)
{
    for (int k = 0; k < count; k++) {
        lanes *pivot = rows + k * columns;
        for (int i = k + 1; i < count; i++) {
            lanes *row = rows + i * columns;
            whole better = magnitude(row[k]) > magnitude(pivot[k]);
            for (int j = k; j < columns; j++) {
                lanes upper = pivot[j], lower = row[j];
                pivot[j] = choose(better, lower, upper), row[j] = choose(better, upper, lower);
            }
        }
        for (int i = k + 1; i < count; i++) {
            lanes *row = rows + i * columns, factor = row[k] / pivot[k];
            for (int j = k + 1; j < columns; j++) row[j] -= factor * pivot[j];
        }
    }
    for (int k = count - 1; k >= 0; k--) {
        lanes *pivot = rows + k * columns;
        for (int j = count; j < columns; j++) {
            for (int i = k + 1; i < count; i++) pivot[j] -= pivot[i] * rows[i * columns + j];
            pivot[j] /= pivot[k];
        }
    }
}

#endif
