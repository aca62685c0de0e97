/* Nearest roots of steps, as in screening.py, and which steps of scans may hold a crossing, as `where_to_part` of
   parting.py tells by differences in place of derivatives. */

#include "screening.h"

#include <string.h>

#define OTHER_BLOCK 1e305 /* as in screening.py */
#define GRID 16 /* parts of a step, whose ends are looked at */
#define AT_ONCE ((GRID + LANES) / LANES) /* vectors of these places, and of two extrema */

/* The numbers of the states in the lanes of a vector. */
static whole numbers(int vector)
{
    whole found = every(0);
    for (int lane = 0; lane < LANES; lane++) found[lane] = vector * LANES + lane;
    return found;
}

static int vectors_of(int states) { return (states + LANES - 1) / LANES; }

/* Return the place of the root nearest to a number, the first of several. */
static int nearest_root(int vectors, const lanes *real, const lanes *imaginary, const whole *blocks, double x, double y, int64_t block)
{
    lanes least = all(INFINITY);
    whole place = every(0);
    for (int vector = 0; vector < vectors; vector++) {
        lanes a = x - real[vector], b = y - imaginary[vector], square = a * a + b * b;
        square = choose(blocks[vector] == block, square, all(OTHER_BLOCK));
        whole nearer = square < least;
        least = choose(nearer, square, least);
        place = pick(nearer, numbers(vector), place);
    }
    int found = 0;
    for (int lane = 1; lane < LANES; lane++)
        if (least[lane] < least[found] || (least[lane] == least[found] && place[lane] < place[found])) found = lane;
    return (int)place[found];
}

/* Find the nearest root at the later point of each step, (steps, states); `shared` (steps) says where two roots have the
   same. Values (points, states) are finite. */
void nearest_roots(ptrdiff_t steps, int states, const int64_t *before, const int64_t *after, const double *values, const int64_t *block, int64_t *successor, unsigned char *shared)
{
    int vectors = vectors_of(states);
    row real, imaginary;
    whole blocks[VECTORS];
    for (int k = 0; k < vectors * LANES; k++) blocks[k / LANES][k % LANES] = k < states ? block[k] : -1;
    for (ptrdiff_t step = 0; step < steps; step++) {
        const double *own = values + 2 * before[step] * states, *later = values + 2 * after[step] * states;
        unsigned char taken[MOST_STATES] = {0};
        for (int k = 0; k < vectors * LANES; k++) {
            real[k / LANES][k % LANES] = k < states ? later[2 * k] : 0.0;
            imaginary[k / LANES][k % LANES] = k < states ? later[2 * k + 1] : 0.0;
        }
        shared[step] = 0;
        for (int k = 0; k < states; k++) {
            int found = nearest_root(vectors, real, imaginary, blocks, own[2 * k], own[2 * k + 1], block[k]);
            shared[step] |= taken[found];
            taken[found] = 1;
            successor[step * states + k] = found;
        }
    }
}

/* Set the changes of the roots with the position: differences to the neighbours, of which the nearer counts more. `weight`
   has room for a number of each point. */
static void find_changes(const struct scan *scan, double *weight)
{
    int states = scan->states;
    memset(scan->change, 0, 2 * scan->points * states * sizeof(double));
    memset(weight, 0, scan->points * sizeof(double));
    for (ptrdiff_t step = 0; step < scan->steps; step++) {
        int64_t before = scan->before[step], after = scan->after[step];
        double length = scan->position[after] - scan->position[before];
        weight[before] += 1.0 / length, weight[after] += 1.0 / length;
        for (int k = 0; k < states; k++) {
            ptrdiff_t start = 2 * (before * states + k), end = 2 * (after * states + scan->successor[step * states + k]);
            for (int part = 0; part < 2; part++) {
                double rate = (scan->values[end + part] - scan->values[start + part]) / length;
                scan->change[start + part] += rate / length, scan->change[end + part] += rate / length;
            }
        }
    }
    for (ptrdiff_t point = 0; point < scan->points; point++)
        for (int k = 0; weight[point] > 0.0 && k < 2 * states; k++) scan->change[2 * point * states + k] /= weight[point];
}

/* Set growth and its slope at one end of a vector of roots, with the side of the level on which they lie. */
static void set_growth(const struct scan *scan, struct ends *ends, int end, int vector)
{
    lanes x = ends->value[end][0][vector], y = ends->value[end][1][vector], growth = x, slope = ends->change[end][0][vector];
    if (scan->level != 0.0) {
        lanes size = length_of(x, y), along = x * slope + y * ends->change[end][1][vector];
        growth += scan->level * size;
        slope += scan->level * along / choose(size > 0.0, size, all(1.0));
    }
    struct cubic *cubic = &ends->growth[vector];
    *(end ? &cubic->end : &cubic->start) = growth;
    *(end ? &cubic->slope_end : &cubic->slope_start) = slope;
    lanes side = choose(growth > 0.0, all(1.0), choose(growth < 0.0, all(-1.0), all(0.0)));
    ends->side[end][vector] = choose(magnitude(growth) <= ends->error[end][vector], all(0.0), side);
}

/* Load what the roots of a step have at its ends. */
static void load_ends(const struct scan *scan, ptrdiff_t step, struct ends *ends)
{
    int states = scan->states;
    int64_t point[2] = {scan->before[step], scan->after[step]};
    double length = scan->position[point[1]] - scan->position[point[0]];
    for (int k = 0; k < states; k++) {
        int vector = k / LANES, lane = k % LANES;
        for (int end = 0; end < 2; end++) {
            ptrdiff_t place = point[end] * states + (end ? scan->successor[step * states + k] : k);
            for (int part = 0; part < 2; part++) {
                ends->value[end][part][vector][lane] = scan->values[2 * place + part];
                ends->change[end][part][vector][lane] = scan->change[2 * place + part] * length;
            }
            ends->error[end][vector][lane] = scan->error[place];
        }
    }
    for (int vector = 0; vector < ends->vectors; vector++) {
        lanes straight = length_of(ends->value[1][0][vector] - ends->value[0][0][vector], ends->value[1][1][vector] - ends->value[0][1][vector]);
        lanes both = length_of(ends->change[0][0][vector], ends->change[0][1][vector]);
        both += length_of(ends->change[1][0][vector], ends->change[1][1][vector]);
        ends->way[vector] = larger(straight, both);
        for (int end = 0; end < 2; end++) set_growth(scan, ends, end, vector);
    }
}

/* The cubic of the square of the imaginary part, and how wrong it may be: minus infinity for roots that are no pairs. */
static struct cubic square_of(const struct ends *ends, int vector, lanes *wrong)
{
    lanes y = ends->value[0][1][vector], v = ends->value[1][1][vector];
    struct cubic found = {y * y, v * v, 2.0 * y * ends->change[0][1][vector], 2.0 * v * ends->change[1][1][vector]};
    *wrong = choose((found.start > 0.0) & (found.end > 0.0), UNSEEN * bend(&found), all(-INFINITY));
    return found;
}

/* Return which roots of a vector are not the conjugates of others. */
static whole counts(const struct ends *ends, int vector)
{
    return ~((ends->value[0][1][vector] < 0.0) & (ends->value[1][1][vector] < 0.0)) & ends->there[vector];
}

/* Return which roots of a vector come as near to the level as they may go over the step, or cross it. */
static whole may_reach(const struct ends *ends, int vector)
{
    const struct cubic *growth = &ends->growth[vector];
    lanes wrong, none = all(0.0), first = ends->side[0][vector], last = ends->side[1][vector];
    struct cubic square = square_of(ends, vector, &wrong);
    lanes rise = square.end - square.start;
    lanes away = 4.0 / 27.0 * (magnitude(square.slope_start - rise) + magnitude(square.slope_end - rise));
    lanes parted = root(larger(away + wrong - smaller(square.start, square.end), none));
    lanes reach = ends->way[vector] + UNSEEN * bend(growth) / TRUST + parted;
    reach += larger(magnitude(growth->slope_start), magnitude(growth->slope_end));
    whole near = (smaller(magnitude(growth->start), magnitude(growth->end)) <= reach) | (first * last < 0.0);
    return near & counts(ends, vector) & ((first != 0.0) | (last != 0.0));
}

/* Set the extrema of a cubic within its step, a half where there is none. */
static void find_extrema(const struct cubic *c, double *found)
{
    double rise = c->end[0] - c->start[0], first = c->slope_start[0], last = c->slope_end[0];
    double c3 = first + last - 2.0 * rise, c2 = 3.0 * rise - 2.0 * first - last, length = sqrt(c2 * c2 - 3.0 * c3 * first);
    double q = -(c2 + (c2 < 0.0 ? -length : length)), places[2] = {q / (3.0 * c3), first / q};
    for (int k = 0; k < 2; k++) found[k] = places[k] > 0.0 && places[k] < 1.0 ? places[k] : 0.5;
}

/* Return whether the band of a root with both ends on one side leaves open whether it crosses. */
static int band_is_open(const struct ends *ends, int state)
{
    lanes t[AT_ONCE], wrong;
    double first = one(ends->side[0], state), last = one(ends->side[1], state), side = first != 0.0 ? first : last, noise = 0.0;
    struct cubic growth = of_lane(ends->growth, state), squares = square_of(ends, state / LANES, &wrong), square = of_lane(&squares, state % LANES);
    double of_square = wrong[state % LANES], extrema[2];
    find_extrema(&growth, extrema);
    for (int k = 0; k < AT_ONCE * LANES; k++)
        t[k / LANES][k % LANES] = k < GRID - 1 ? (k + 1) / (double)GRID : k < GRID + 1 ? extrema[k - GRID + 1] : 0.5;
    if (first == 0.0 || last == 0.0) noise = 10.0 * fmax(one(ends->error[0], state), one(ends->error[1], state));
    lanes width = UNSEEN * bend(&growth) / TRUST;
    for (int vector = 0; vector < AT_ONCE; vector++) {
        lanes spread = band(t[vector]), inside = side * cubic_at(t[vector], &growth) - width * spread + noise;
        if (side < 0.0 && of_square > -INFINITY) inside -= root(larger(of_square * spread - cubic_at(t[vector], &square), all(0.0)));
        if (any(~(inside > 0.0))) return 1;
    }
    return 0;
}

/* Return whether two roots that are real at one end of a step, and a pair at the other, may cross before they join. */
static int couple_is_open(const struct ends *ends, int end, int state, int other)
{
    struct cubic mean, square;
    lanes *means[] = {&mean.start, &mean.end, &mean.slope_start, &mean.slope_end};
    lanes *squares[] = {&square.start, &square.end, &square.slope_start, &square.slope_end};
    for (int at = 0; at < 2; at++) {
        double x = one(ends->value[at][0], state) - one(ends->value[at][0], other), y = one(ends->value[at][1], state) - one(ends->value[at][1], other);
        double u = one(ends->change[at][0], state) - one(ends->change[at][0], other), v = one(ends->change[at][1], state) - one(ends->change[at][1], other);
        *means[at] = all((one(ends->value[at][0], state) + one(ends->value[at][0], other)) / 2.0);
        *means[at + 2] = all((one(ends->change[at][0], state) + one(ends->change[at][0], other)) / 2.0);
        *squares[at] = all((x * x - y * y) / 4.0);
        *squares[at + 2] = all((x * u - y * v) / 2.0);
    }
    double first = one(ends->side[end], state), second = one(ends->side[end], other), pair = one(ends->side[1 - end], state);
    if (first * second < 0.0) return 1;
    if (first != second || first != pair || pair == 0.0) return 0;
    for (int k = 1; k < GRID; k++) {
        lanes t = all(k / (double)GRID), spread = UNSEEN * band(t) / TRUST;
        double apart = cubic_at(t, &square)[0] + spread[0] * bend(&square)[0];
        if (!(apart > 0.0)) continue; /* no longer real: the mean is their real part, whose own cubic is judged */
        if (-pair * cubic_at(t, &mean)[0] + spread[0] * bend(&mean)[0] + sqrt(apart) >= 0.0) return 1;
    }
    return 0;
}

/* Return whether any two real roots of an end that are a pair at the other end may cross. */
static int any_couple_is_open(const struct ends *ends)
{
    for (int end = 0; end < 2; end++) {
        const lanes *here = ends->value[end][1], *there = ends->value[1 - end][1], *real = ends->value[1 - end][0];
        int mixed[MOST_STATES], count = 0;
        for (int vector = 0; vector < ends->vectors; vector++) {
            whole own = (here[vector] == 0.0) & (there[vector] != 0.0) & ends->there[vector];
            for (int lane = 0; any(own) && lane < LANES; lane++)
                if (own[lane]) mixed[count++] = vector * LANES + lane;
        }
        for (int i = 0; i < count; i++)
            for (int j = i + 1; j < count; j++) {
                int a = mixed[i], b = mixed[j];
                int is_pair = one(real, a) == one(real, b) && one(there, a) == -one(there, b);
                is_pair &= ends->block[a / LANES][a % LANES] == ends->block[b / LANES][b % LANES];
                if (is_pair && couple_is_open(ends, end, a, b)) return 1;
            }
    }
    return 0;
}

static int may_meet_any(const struct ends *ends, int state)
{
    for (int vector = 0; vector < ends->vectors; vector++)
        if (any(meets(ends, state, vector))) return 1;
    return 0;
}

/* Return whether a step may hold a crossing; `onset` says whether a root becomes unstable in it, followed without doubt. */
static int is_asked(const struct scan *scan, const struct ends *ends, ptrdiff_t step, ptrdiff_t first, ptrdiff_t last, unsigned char *onset)
{
    whole near[VECTORS];
    int crosses = 0;
    *onset = 0;
    for (int vector = 0; vector < ends->vectors; vector++) {
        near[vector] = may_reach(ends, vector);
        whole crossing = counts(ends, vector) & ((ends->side[0][vector] > 0.0) != (ends->side[1][vector] > 0.0));
        whole begins = crossing & (ends->side[0][vector] < 0.0) & (ends->side[1][vector] > 0.0);
        crosses |= any(crossing);
        for (int lane = 0; any(begins) && lane < LANES; lane++)
            if (begins[lane] && !may_meet_any(ends, vector * LANES + lane)) *onset = 1;
    }
    if (crosses || any_couple_is_open(ends)) return 1;
    for (int state = 0; state < ends->states; state++) {
        if (!near[state / LANES][state % LANES]) continue;
        if (may_meet_any(ends, state) ? !keeps_off(scan, ends, step, first, last, state) : band_is_open(ends, state)) return 1;
    }
    return 0;
}

/* Find which steps of the scans may hold a crossing, and in which a root becomes unstable for certain, both (steps). `weight`
   has room for a number of each point. */
void screen_steps(const struct scan *scan, double *weight, unsigned char *asked, unsigned char *onsets)
{
    struct ends ends = {scan->states, vectors_of(scan->states), .way = {{0}}};
    for (int k = 0; k < scan->states; k++) {
        ends.block[k / LANES][k % LANES] = scan->block[k];
        ends.there[k / LANES][k % LANES] = -1;
    }
    find_changes(scan, weight);
    for (ptrdiff_t first = 0, last; first < scan->steps; first = last) {
        for (last = first; last < scan->steps && scan->line[last] == scan->line[first];) last++;
        for (ptrdiff_t step = first; step < last; step++) {
            load_ends(scan, step, &ends);
            asked[step] = is_asked(scan, &ends, step, first, last, &onsets[step]);
        }
    }
}
