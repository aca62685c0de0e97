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

/* Return the larger number, NaN if one is. */
static inline lanes largest(lanes number, lanes so_far) { return choose((number > so_far) | (number != number), number, so_far); }

/* Begin power iteration with a matrix without negative entries. */
static inline void begin_power(int size, square matrix, lanes *weight)
{
    for (int i = 0; i < size; i++) {
        matrix[i][i] += FLOOR;
        weight[i] = all(0.0);
        for (int j = 0; j < size; j++) weight[i] += matrix[i][j];
    }
}

/* Take a step of power iteration, and return the bound of Collatz and Wielandt on the spectral radius. */
static inline lanes power_step(int size, square matrix, lanes *weight)
{
    lanes next[MOST_UNKNOWNS], bound = {0};
    for (int i = 0; i < size; i++) {
        next[i] = all(0.0);
        for (int j = 0; j < size; j++) next[i] += matrix[i][j] * weight[j];
        bound = largest(next[i] / weight[i], bound);
    }
    for (int i = 0; i < size; i++) weight[i] = next[i];
    return bound;
}

/* Return where the spectral radius is small enough, by the bound after 2, 4 and 8 steps. */
static inline whole contracts(int size, square matrix)
{
    lanes weight[MOST_UNKNOWNS];
    whole found = every(0);
    begin_power(size, matrix, weight);
    for (int step = 1; step <= POWER_STEPS && any(~found); step++) {
        whole enough = power_step(size, matrix, weight) <= CONTRACTION; /* false for NaN */
        if (step == 2 || step == 4 || step == POWER_STEPS) found |= enough;
    }
    return found;
}

/* Return the bound after all steps. */
static inline lanes radius_of(int size, square matrix)
{
    lanes weight[MOST_UNKNOWNS], bound = {0};
    begin_power(size, matrix, weight);
    for (int step = 1; step <= POWER_STEPS; step++) bound = power_step(size, matrix, weight);
    return bound;
}

/* Find how much Newton's iteration moves in one window of the path, entry by entry: half its length, what its middle leaves
   out of the loads, the mean of the slopes at both ends of the path, and how far the ends are from it. */
static inline void move_in(int size, lanes half, lanes left_out, const struct slopes *mean, const struct slopes *aside, square matrix)
{
    lanes rows[MOST_UNKNOWNS * 3 * MOST_UNKNOWNS];
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
}

/* Find the mean of the slopes at both ends of a path, and how far the ends are from it. */
static inline void find_middle(int size, const struct slopes *before, const struct slopes *after, struct slopes *mean, struct slopes *aside)
{
    for (int i = 0; i < size; i++)
        for (int j = 0; j < size; j++) {
            mean->full[i][j] = (before->full[i][j] + after->full[i][j]) / 2.0;
            mean->airloads[i][j] = (before->airloads[i][j] + after->airloads[i][j]) / 2.0;
            aside->full[i][j] = after->full[i][j] - mean->full[i][j];
            aside->airloads[i][j] = after->airloads[i][j] - mean->airloads[i][j];
        }
}

/* Return where the slopes contract in all of the windows of the path. */
static inline whole contracts_in_all(int size, int windows, const struct slopes *before, const struct slopes *after)
{
    struct slopes mean, aside;
    square matrix;
    find_middle(size, before, after, &mean, &aside);
    whole found = every(-1);
    for (int window = 0; window < windows && any(found); window++) {
        move_in(size, all(0.5 / windows), all(1.0 - (2 * window + 1) * (0.5 / windows)), &mean, &aside, matrix);
        found &= contracts(size, matrix);
    }
    return found;
}

/* Return the radius in a step of the path from one share of the loads to another. */
static inline lanes radius_between(int size, lanes share, lanes to, const struct slopes *before, const struct slopes *after)
{
    struct slopes mean, aside;
    square matrix;
    lanes half = (to - share) / 2.0;
    find_middle(size, before, after, &mean, &aside);
    move_in(size, half, 1.0 - (share + half), &mean, &aside, matrix);
    return radius_of(size, matrix);
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

/* Return the radius in a step of the path, with slopes by angles or by moments, whichever is smaller. */
static inline lanes radius_in_step(int size, const unsigned char *sprung, lanes share, lanes to, const struct slopes *before, const struct slopes *after)
{
    struct slopes first, last;
    lanes by_angles = radius_between(size, share, to, before, after);
    count_by_moments(size, sprung, before, &first);
    count_by_moments(size, sprung, after, &last);
    lanes by_moments = radius_between(size, share, to, &first, &last);
    return choose((by_moments < by_angles) | (by_angles != by_angles), by_moments, by_angles);
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
