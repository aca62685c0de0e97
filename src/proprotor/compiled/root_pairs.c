/* Two roots that cannot be told apart over a step of a scan, as in root_pairs.py: whether they stay off the level. */

#include "screening.h"

#include <string.h>

#define APPROACH 0.9 /* as all numbers here, those of root_pairs.py */
#define MEETING 0.5
#define WITHIN_REACH 3.0
#define OF_CHORD 0.01
#define MANY 6 /* points through which a polynomial goes */
#define FEW 4
#define PARTS 32 /* of a step, which give the places within */
#define PLACES (PARTS / LANES)

/* Return which roots of a vector one root may meet or turn away from, see `may_meet`. */
whole meets(const struct ends *ends, int state, int vector)
{
    lanes x = one(ends->value[0][0], state) - ends->value[0][0][vector], y = one(ends->value[0][1], state) - ends->value[0][1][vector];
    lanes u = one(ends->value[1][0], state) - ends->value[1][0][vector], v = one(ends->value[1][1], state) - ends->value[1][1][vector];
    lanes before = x * x + y * y, after = u * u + v * v, along = u - x, across = v - y;
    lanes square = along * along + across * across;
    lanes at = -(x * along + y * across) / choose(square == 0.0, all(1.0), square);
    at = choose(at < 0.0, all(0.0), choose(at > 1.0, all(1.0), at));
    lanes next_x = x + at * along, next_y = y + at * across, nearest = next_x * next_x + next_y * next_y;
    whole found = (nearest < APPROACH * APPROACH * smaller(before, after)) | (smaller(before, after) < MEETING * MEETING * larger(before, after));
    lanes there = length_of(ends->value[1][0][vector] - one(ends->value[0][0], state), ends->value[1][1][vector] - one(ends->value[0][1], state));
    lanes back = length_of(one(ends->value[1][0], state) - ends->value[0][0][vector], one(ends->value[1][1], state) - ends->value[0][1][vector]);
    found |= there + back <= WITHIN_REACH * (one(ends->way, state) + ends->way[vector]);
    whole own_block = ends->block[vector] == ends->block[state / LANES][state % LANES];
    found &= own_block & ends->there[vector];
    if (vector == state / LANES) found[state % LANES] = 0;
    return found;
}

/* Return the only root that one root may meet; -1 where there is none, or more than one. */
static int only_other(const struct ends *ends, int state)
{
    int found = -1;
    for (int vector = 0; vector < ends->vectors; vector++) {
        whole others = meets(ends, state, vector);
        if (!any(others)) continue;
        for (int lane = 0; lane < LANES; lane++) {
            if (!others[lane]) continue;
            if (found >= 0) return -1;
            found = vector * LANES + lane;
        }
    }
    return found;
}

/* The root at the end of a step that is a given root at its start, and the reverse. */
static int next_place(const struct scan *scan, ptrdiff_t step, int place) { return (int)scan->successor[step * scan->states + place]; }
static int place_before(const struct scan *scan, ptrdiff_t step, int place)
{
    int found = 0;
    while (found + 1 < scan->states && next_place(scan, step, found) != place) found++;
    return found;
}

/* The eigenvalues of one root at the points of a chain of steps: its place is known at the start of the step `here`. */
static void follow(const struct scan *scan, ptrdiff_t start, int here, int state, double value[MANY][2])
{
    int place[MANY];
    place[here] = state;
    for (int k = here; k < MANY - 1; k++) place[k + 1] = next_place(scan, start + k, place[k]);
    for (int k = here; k > 0; k--) place[k - 1] = place_before(scan, start + k - 1, place[k]);
    for (int k = 0; k < MANY; k++) {
        int64_t point = k < MANY - 1 ? scan->before[start + k] : scan->after[start + k - 1];
        memcpy(value[k], scan->values + 2 * (point * scan->states + place[k]), sizeof value[k]);
    }
}

/* The polynomial through some points of a complex quantity, at one vector of places. */
static void polynomial(int count, const double *x, double (*y)[2], lanes wanted, lanes found[2])
{
    found[0] = found[1] = all(0.0);
    for (int k = 0; k < count; k++) {
        lanes share = all(1.0);
        double apart = 1.0;
        for (int j = 0; j < count; j++) {
            if (j == k) continue;
            share *= wanted - x[j];
            apart *= x[k] - x[j];
        }
        share /= apart;
        for (int part = 0; part < 2; part++) found[part] += share * y[k][part];
    }
}

/* A smooth quantity of a pair at one vector of places, and how wrong it may be. */
struct smooth {
    lanes value[2], wrong;
};

static struct smooth along_scan(const double *x, double (*y)[2], int here, lanes wanted)
{
    int from = here - FEW / 2 + 1;
    from = from < 0 ? 0 : from > MANY - FEW ? MANY - FEW : from;
    lanes rough[2], chord[2];
    struct smooth found;
    polynomial(MANY, x, y, wanted, found.value);
    polynomial(FEW, x + from, y + from, wanted, rough);
    polynomial(2, x + here, y + here, wanted, chord);
    found.wrong = length_of(found.value[0] - rough[0], found.value[1] - rough[1]);
    found.wrong += OF_CHORD * length_of(found.value[0] - chord[0], found.value[1] - chord[1]);
    return found;
}

/* Return where both roots of a pair stay on a side of the level, by their sum and the square of their difference. */
static whole is_off(const struct smooth *sum, const struct smooth *square, double side, double level)
{
    lanes size = length_of(square->value[0], square->value[1]);
    lanes one = root((size + magnitude(square->value[0])) / 2.0), other = choose(one > 0.0, magnitude(square->value[1]) / (2.0 * one), all(0.0));
    whole turned = square->value[0] < 0.0;
    lanes real = choose(turned, other, one), imaginary = copy_sign(choose(turned, one, other), square->value[1]);
    lanes wrong_square = square->wrong / TRUST, wrong_root = smaller(root(wrong_square), wrong_square / root(size));
    lanes wrong = (1.0 + fabs(level)) * (sum->wrong / TRUST + wrong_root) / 2.0;
    whole found = every(-1);
    for (int way = -1; way <= 1; way += 2) {
        lanes x = (sum->value[0] + way * real) / 2.0, y = (sum->value[1] + way * imaginary) / 2.0;
        found &= side * (x + level * length_of(x, y)) - wrong > 0.0;
    }
    return found;
}

/* Return whether a root of a step stays on one side of the level for certain, with the one root that it may meet; `first`
   and `last` are the steps of the line. See `keep_off`. */
int keeps_off(const struct scan *scan, const struct ends *ends, ptrdiff_t step, ptrdiff_t first, ptrdiff_t last, int state)
{
    double side = one(ends->side[0], state);
    int partner = only_other(ends, state);
    if (side == 0.0 || partner < 0 || only_other(ends, partner) != state || last - first < MANY - 1) return 0;
    for (int end = 0; end < 2; end++)
        if (one(ends->side[end], state) != side || one(ends->side[end], partner) != side) return 0;
    ptrdiff_t start = step - MANY / 2 + 1;
    if (start > last - MANY + 1) start = last - MANY + 1;
    if (start < first) start = first;
    int here = (int)(step - start);
    double x[MANY], value[MANY][2], other[MANY][2], sum[MANY][2], square[MANY][2];
    follow(scan, start, here, state, value);
    follow(scan, start, here, partner, other);
    for (int k = 0; k < MANY; k++) {
        x[k] = scan->position[k < MANY - 1 ? scan->before[start + k] : scan->after[start + k - 1]];
        double a = value[k][0] - other[k][0], b = value[k][1] - other[k][1];
        for (int part = 0; part < 2; part++) sum[k][part] = value[k][part] + other[k][part];
        square[k][0] = a * a - b * b, square[k][1] = 2.0 * a * b;
    }
    whole found = every(-1);
    for (int vector = 0; vector < PLACES && !any(~found); vector++) {
        lanes share = {0};
        for (int lane = 0; lane < LANES; lane++) {
            int part = vector * LANES + lane + 1;
            share[lane] = (double)(part < PARTS ? part : PARTS / 2) / PARTS;
        }
        lanes wanted = x[here] + share * (x[here + 1] - x[here]);
        struct smooth sums = along_scan(x, sum, here, wanted), squares = along_scan(x, square, here, wanted);
        found &= is_off(&sums, &squares, side, scan->level);
    }
    return !any(~found);
}
