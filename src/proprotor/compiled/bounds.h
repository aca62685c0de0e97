/* The bound of trim_bound.py in the lanes: whether the slopes of two trims belong to one path, or to one trim. */

#ifndef BOUNDS_H
#define BOUNDS_H

#include "rows.h"

#define MOST_UNKNOWNS 4
#define CONTRACTION 0.5 /* as all numbers here, those of trim_bound.py */
#define REACH 2.0
#define FLOOR 1e-9
#define FEWEST_WINDOWS 4
#define MOST_WINDOWS 16
#define POWER_STEPS 8

typedef lanes square[MOST_UNKNOWNS][MOST_UNKNOWNS];

/* Slopes at a state: with all of the airloads, and the part of the airloads. */
struct slopes {
    square full, airloads;
};

/* Return where the spectral radius of a matrix without negative entries is small enough, by the bound of Collatz and
   Wielandt after 2, 4 and 8 steps of power iteration. */
static inline whole contracts(int size, square matrix)
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

/* Return where the slopes of one window of the path contract: half its length, what its middle leaves out of the loads,
   the mean of the slopes at both ends of the path, and how far the ends are from it. */
static inline whole contracts_in(int size, double half, double left_out, const struct slopes *mean, const struct slopes *aside)
{
    lanes rows[MOST_UNKNOWNS * 3 * MOST_UNKNOWNS];
    square matrix;
    int columns = 3 * size;
    for (int i = 0; i < size; i++)
        for (int j = 0; j < size; j++) {
            lanes *row = rows + i * columns + j;
            row[0] = mean->full[i][j] - left_out * mean->airloads[i][j];
            row[size] = half * mean->airloads[i][j];
            row[2 * size] = aside->full[i][j] - left_out * aside->airloads[i][j];
        }
    solve_rows(size, columns, rows);
    for (int i = 0; i < size; i++)
        for (int j = 0; j < size; j++) {
            const lanes *row = rows + i * columns + j;
            matrix[i][j] = magnitude(row[size]) + REACH * magnitude(row[2 * size]);
        }
    return contracts(size, matrix);
}

/* Return where the slopes contract in all of the windows of the path. */
static inline whole contracts_in_all(int size, int windows, const struct slopes *before, const struct slopes *after)
{
    struct slopes mean, aside;
    for (int i = 0; i < size; i++)
        for (int j = 0; j < size; j++) {
            mean.full[i][j] = (before->full[i][j] + after->full[i][j]) / 2.0;
            mean.airloads[i][j] = (before->airloads[i][j] + after->airloads[i][j]) / 2.0;
            aside.full[i][j] = after->full[i][j] - mean.full[i][j];
            aside.airloads[i][j] = after->airloads[i][j] - mean.airloads[i][j];
        }
    whole found = every(-1);
    for (int window = 0; window < windows && any(found); window++) {
        double left_out = 1.0 - (2 * window + 1) * (0.5 / windows);
        found &= contracts_in(size, 0.5 / windows, left_out, &mean, &aside);
    }
    return found;
}

/* Set slopes per unit of the moments that springs and centrifugal force set against flap and lag, see
   `Slopes.by_moments`; `sprung` says which rows are flap and lag. */
static inline void count_by_moments(int size, const unsigned char *sprung, const struct slopes *given, struct slopes *found)
{
    lanes rows[MOST_UNKNOWNS * 2 * MOST_UNKNOWNS], stiffest = {0};
    for (int i = 0; i < size; i++)
        for (int j = 0; j < size; j++)
            if (sprung[j]) stiffest = larger(magnitude(given->full[i][j] - given->airloads[i][j]), stiffest);
    stiffest = choose(stiffest > 0.0, stiffest, all(1.0));
    for (int i = 0; i < size; i++)
        for (int j = 0; j < size; j++) {
            lanes own = i == j ? stiffest : all(0.0);
            rows[i * 2 * size + j] = sprung[i] ? given->full[i][j] - given->airloads[i][j] : own;
            rows[i * 2 * size + size + j] = all(i == j ? 1.0 : 0.0);
        }
    solve_rows(size, 2 * size, rows);
    for (int i = 0; i < size; i++)
        for (int j = 0; j < size; j++) {
            found->full[i][j] = found->airloads[i][j] = all(0.0);
            for (int k = 0; k < size; k++) {
                lanes angle = rows[k * 2 * size + size + j];
                found->full[i][j] += given->full[i][k] * angle;
                found->airloads[i][j] += given->airloads[i][k] * angle;
            }
        }
}

/* Return where points with these slopes at the undeflected blade and at a trim have one path between both; lanes that are
   not wanted need no answer. */
static inline whole have_one_path(int size, const unsigned char *sprung, whole wanted, const struct slopes *before, const struct slopes *after)
{
    struct slopes first, last;
    whole found = contracts_in_all(size, FEWEST_WINDOWS, before, after);
    if (!any(wanted & ~found)) return found;
    count_by_moments(size, sprung, before, &first);
    count_by_moments(size, sprung, after, &last);
    found |= contracts_in_all(size, FEWEST_WINDOWS, &first, &last);
    for (int windows = 2 * FEWEST_WINDOWS; windows <= MOST_WINDOWS && any(wanted & ~found); windows *= 2)
        found |= contracts_in_all(size, windows, before, after) | contracts_in_all(size, windows, &first, &last);
    return found;
}

/* Return where the relative difference of slopes contracts. */
static inline whole differ_little(int size, const struct slopes *found, const struct slopes *expected)
{
    lanes rows[MOST_UNKNOWNS * 2 * MOST_UNKNOWNS];
    square matrix;
    for (int i = 0; i < size; i++)
        for (int j = 0; j < size; j++) {
            rows[i * 2 * size + j] = expected->full[i][j];
            rows[i * 2 * size + size + j] = found->full[i][j] - expected->full[i][j];
        }
    solve_rows(size, 2 * size, rows);
    for (int i = 0; i < size; i++)
        for (int j = 0; j < size; j++) matrix[i][j] = magnitude(rows[i * 2 * size + size + j]);
    return contracts(size, matrix);
}

/* Return where slopes are so near those expected that one trim has both; lanes that are not wanted need no answer. */
static inline whole have_one_trim(int size, const unsigned char *sprung, whole wanted, const struct slopes *found, const struct slopes *expected)
{
    struct slopes here, there;
    whole near = differ_little(size, found, expected);
    if (!any(wanted & ~near)) return near;
    count_by_moments(size, sprung, found, &here);
    count_by_moments(size, sprung, expected, &there);
    return near | differ_little(size, &here, &there);
}

#endif
