/* The bound of trim_bound.py for many points: whether matrices contract, which slopes of two trims make. */

#include "columns.h"
#include "rows.h"

#define MOST_UNKNOWNS 4
#define CONTRACTION 0.5 /* as all numbers here, those of trim_bound.py */
#define REACH 2.0
#define FLOOR 1e-9
#define WINDOWS 4
#define POWER_STEPS 8

typedef lanes square[MOST_UNKNOWNS][MOST_UNKNOWNS];

static void load_square(int size, const double *at, ptrdiff_t point, ptrdiff_t points, square into)
{
    struct column own = {at, (ptrdiff_t)size * size, 1};
    for (int i = 0; i < size; i++)
        for (int j = 0; j < size; j++) into[i][j] = load(&own, point, points, i * size + j);
}

/* Return where the spectral radius of a matrix without negative entries is small enough, by the bound of Collatz and
   Wielandt after 2, 4 and 8 steps of power iteration. */
static whole contracts(int size, square matrix)
{
    lanes weight[MOST_UNKNOWNS], next[MOST_UNKNOWNS];
    whole found = every(0);
    for (int i = 0; i < size; i++) {
        matrix[i][i] += FLOOR;
        weight[i] = all(0.0);
        for (int j = 0; j < size; j++) weight[i] += matrix[i][j];
    }
    for (int step = 1; step <= POWER_STEPS && any(~found); step++) {
        whole enough = every(-1);
        for (int i = 0; i < size; i++) {
            next[i] = all(0.0);
            for (int j = 0; j < size; j++) next[i] += matrix[i][j] * weight[j];
            enough &= next[i] / weight[i] <= CONTRACTION; /* false for NaN */
        }
        for (int i = 0; i < size; i++) weight[i] = next[i];
        if (step == 2 || step == 4 || step == POWER_STEPS) found |= enough;
    }
    return found;
}

/* Return where the slopes of one window of the path contract; half its length, and what its middle leaves of the loads. */
static whole contracts_in(int size, double half, double left_out, square full, square airloads, square full_aside, square airloads_aside)
{
    lanes rows[MOST_UNKNOWNS * 3 * MOST_UNKNOWNS];
    square matrix;
    int columns = 3 * size;
    for (int i = 0; i < size; i++)
        for (int j = 0; j < size; j++) {
            lanes *row = rows + i * columns + j;
            row[0] = full[i][j] - left_out * airloads[i][j];
            row[size] = half * airloads[i][j];
            row[2 * size] = full_aside[i][j] - left_out * airloads_aside[i][j];
        }
    solve_rows(size, columns, rows);
    for (int i = 0; i < size; i++)
        for (int j = 0; j < size; j++) {
            const lanes *row = rows + i * columns + j;
            matrix[i][j] = magnitude(row[size]) + REACH * magnitude(row[2 * size]);
        }
    return contracts(size, matrix);
}

/* Find which points with slopes (points, size, size) at the undeflected blade and at a trim have one path between both:
   in the fewest windows, by angles. Slopes are those with all of the airloads, and the part of the airloads. */
void lead_to_end(ptrdiff_t points, int size, const double *const *before, const double *const *after, unsigned char *found)
{
    for (ptrdiff_t point = 0; point < points; point += LANES) {
        square mean[2], aside[2], end;
        for (int part = 0; part < 2; part++) {
            load_square(size, before[part], point, points, mean[part]);
            load_square(size, after[part], point, points, end);
            for (int i = 0; i < size; i++)
                for (int j = 0; j < size; j++) {
                    mean[part][i][j] = (mean[part][i][j] + end[i][j]) / 2.0;
                    aside[part][i][j] = end[i][j] - mean[part][i][j];
                }
        }
        whole all_contract = every(-1);
        for (int window = 0; window < WINDOWS && any(all_contract); window++) {
            double left_out = 1.0 - (2 * window + 1) * (0.5 / WINDOWS);
            all_contract &= contracts_in(size, 0.5 / WINDOWS, left_out, mean[0], mean[1], aside[0], aside[1]);
        }
        for (int lane = 0; lane < LANES && point + lane < points; lane++) found[point + lane] = all_contract[lane] != 0;
    }
}

/* Find which slopes (points, size, size) are so near to those expected that one trim has both, by angles. */
void near_each_other(ptrdiff_t points, int size, const double *slopes, const double *expected, unsigned char *found)
{
    for (ptrdiff_t point = 0; point < points; point += LANES) {
        lanes rows[MOST_UNKNOWNS * 2 * MOST_UNKNOWNS];
        square here, there;
        load_square(size, slopes, point, points, here);
        load_square(size, expected, point, points, there);
        for (int i = 0; i < size; i++)
            for (int j = 0; j < size; j++) {
                rows[i * 2 * size + j] = there[i][j];
                rows[i * 2 * size + size + j] = here[i][j] - there[i][j];
            }
        solve_rows(size, 2 * size, rows);
        for (int i = 0; i < size; i++)
            for (int j = 0; j < size; j++) here[i][j] = magnitude(rows[i * 2 * size + size + j]);
        whole near = contracts(size, here);
        for (int lane = 0; lane < LANES && point + lane < points; lane++) found[point + lane] = near[lane] != 0;
    }
}
