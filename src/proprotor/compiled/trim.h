/* Newton's method for the trim of many blades, one in each lane, until each lane has arrived. */

#include "bounds.h"

#define BALANCES 5 /* flap, lag, pitch, torque, thrust */
#define UNKNOWNS MOST_UNKNOWNS /* coning, lag, elastic pitch, collective */
#define ELASTIC_PITCH 2
#define COLLECTIVE 3
#define LARGEST_STEP 0.3 /* rad, as all numbers here, which are those of trim_balance.py and trim_solver.py */
#define CONVERGED 1e-13
#define STALLED 1e-9
#define NEAR 1e-3
#define ALMOST 1e-10

/* What is free in the trim, the rows of the balance that close it, and what a search begins and ends with. */
struct search {
    ptrdiff_t count;
    const int32_t *unknowns, *rows;
    int32_t target, diagonal, unloaded, most;
    int32_t ends_near; /* whether a lane arrives near the trim, where the next step would be negligible */
    struct layout residual, slopes, work, work_slopes, precone;
};

/* The balance at a state: of the free unknowns, residual and slopes; the work of the airloads on all rows. */
struct linear {
    lanes residual[UNKNOWNS], work[BALANCES], work_slopes[BALANCES][UNKNOWNS];
    struct slopes slopes;
};

/* A search in the lanes: state, and state, balance, loads, step and air of the last step; slopes at the first step. */
struct walk {
    lanes state[UNKNOWNS], before[UNKNOWNS], moments[LOADS * POWERS * MOST_SEGMENTS], step[UNKNOWNS];
    struct linear last;
    struct slopes first;
    whole steps, arrived;
    lanes angle, mach;
};

static void set_state(const struct search *search, const lanes *state, lanes offset, lanes *q)
{
    q[Q_CONING] = state[0];
    q[Q_LAG] = state[1];
    q[Q_ELASTIC_PITCH] = state[2];
    q[Q_PITCH] = state[COLLECTIVE] + state[2] - BY_HINGES(q);
    q[Q_STRUCTURAL_PITCH] = q[Q_PITCH] + offset;
    trim_integrals(q);
    effective_stiffness(q);
    if (search->diagonal) {
        q[Q_FLAP_LAG_STIFFNESS] = q[Q_FLAP_LAG_STIFFNESS_SLOPE] = all(0.0);
        q[Q_FLAP_LAG_STIFFNESS_CURVATURE] = all(0.0);
    }
}

static void linearise(const struct search *search, const lanes *structure, const lanes *done, lanes load, struct linear *at)
{
    lanes residual[BALANCES], slopes[BALANCES * UNKNOWNS], of_hinges[BALANCES * UNKNOWNS];
    ptrdiff_t hinges = search->work_slopes.columns;
    fill(&search->residual, structure, residual);
    fill(&search->slopes, structure, slopes);
    fill(&search->work, done, at->work);
    fill(&search->work_slopes, done, of_hinges);
    for (int row = 0; row < BALANCES; row++)
        for (int k = 0; k < search->count; k++) {
            /* The collective moves the blade as the elastic pitch does. */
            ptrdiff_t column = search->unknowns[k] < hinges ? search->unknowns[k] : hinges - 1;
            at->work_slopes[row][k] = of_hinges[row * hinges + column];
        }
    for (int i = 0; i < search->count; i++) {
        int row = search->rows[i];
        at->residual[i] = residual[row] - at->work[row];
        if (row == search->target) at->residual[i] += load;
        for (int k = 0; k < search->count; k++) {
            lanes own = at->work_slopes[row][k];
            at->slopes.full[i][k] = slopes[row * UNKNOWNS + search->unknowns[k]] + own;
            at->slopes.airloads[i][k] = search->unknowns[i] == COLLECTIVE ? all(0.0) : own;
        }
    }
}

/* Solve for Newton's step with exchanges of rows in each lane; NaN without an inverse. */
static void solve_step(int count, const struct linear *at, lanes *step)
{
    lanes rows[UNKNOWNS * (UNKNOWNS + 1)];
    for (int i = 0; i < count; i++) {
        for (int j = 0; j < count; j++) rows[i * (count + 1) + j] = at->slopes.full[i][j];
        rows[i * (count + 1) + count] = at->residual[i];
    }
    solve_rows(count, count + 1, rows);
    for (int k = 0; k < count; k++) {
        lanes newton = rows[k * (count + 1) + count];
        lanes within = choose(newton > LARGEST_STEP, all(LARGEST_STEP), newton);
        step[k] = choose(within < -LARGEST_STEP, all(-LARGEST_STEP), within);
    }
}

/* Add the part of precone to the residual of the undeflected blade. */
static void add_precone_load(const struct search *search, const lanes *q, lanes *residual)
{
    lanes results[PRECONE_LOAD_RESULTS], own[BALANCES];
    precone_load(q, results);
    fill(&search->precone, results, own);
    for (int i = 0; i < search->count; i++)
        if (search->unknowns[i] != COLLECTIVE) residual[i] += own[search->rows[i]];
}

/* The blades in the lanes, with the search for their trims: q holds their quantities, those of the last state too. */
struct blades {
    const struct blade *blade;
    const struct search *search;
    ptrdiff_t point, points;
    lanes *q, load, offset, precone;
};

static struct blades blades_at(const struct blade *blade, const struct search *search, ptrdiff_t point, ptrdiff_t points, lanes *q)
{
    load_quantities(blade, point, points, q);
    lanes own = load(&blade->load, point, points, 0), offset = load(&blade->structural_offset, point, points, 0);
    return (struct blades){blade, search, point, points, q, own, offset, q[Q_PRECONE]};
}

/* Find the balance at a state and a share of the precone. The radial moments of the loads and the air are told if there is
   a place for them. */
static void balance_at(const struct blades *blades, whole where, const lanes *state, lanes share, struct linear *at, lanes *moments, struct air *air)
{
    lanes structure[BALANCE_RESULTS], done[WORK_RESULTS], own_moments[LOADS * POWERS * MOST_SEGMENTS];
    struct air own_air = {where, 0, {0}, {0}};
    blades->q[Q_PRECONE] = share * blades->precone;
    set_state(blades->search, state, blades->offset, blades->q);
    evaluate(blades->blade, blades->point, blades->points, blades->q, structure, done, moments ? moments : own_moments, air ? air : &own_air);
    linearise(blades->search, structure, done, blades->load, at);
    blades->q[Q_PRECONE] = blades->precone;
}

/* Subtract a step from the free unknowns in some lanes, and return its largest part, NaN if one part is. */
static lanes take_step(const struct search *search, whole where, const lanes *step, lanes *state)
{
    lanes size = {0};
    for (int k = 0; k < search->count; k++) {
        lanes *own = &state[search->unknowns[k]];
        *own = choose(where, *own - step[k], *own);
        size = largest(magnitude(step[k]), size);
    }
    return size;
}

/* Return where a step is the last, by its size and the size of the step before. */
static whole is_last(const struct search *search, lanes size, lanes before)
{
    whole last = (size <= CONVERGED) | ((size <= STALLED) & (size >= 0.5 * before));
    if (!search->ends_near) return last;
    lanes ratio = size / (before * before), next = size * size * larger(ratio, all(1.0));
    return (size <= NEAR) & (last | (next <= ALMOST));
}

/* Set some lanes of numbers to others. */
static void keep(whole where, size_t bytes, const void *others, void *numbers)
{
    const lanes *from = others;
    lanes *to = numbers;
    for (size_t k = 0; k < bytes / sizeof(lanes); k++) to[k] = choose(where, from[k], to[k]);
}

/* Search the trims of the active lanes from the state of the walk on. */
static void walk_to_trim(const struct blades *blades, whole active, struct walk *walk, double *stations)
{
    const struct search *search = blades->search;
    ptrdiff_t size_of_moments = LOADS * POWERS * blades->blade->segments * sizeof(lanes);
    lanes moments[LOADS * POWERS * MOST_SEGMENTS], size_before = all(INFINITY);
    walk->steps = walk->arrived = every(0);
    for (int count = 0; count < search->most && any(active); count++) {
        struct linear at = {0};
        struct air air = {active, stations, {0}, {0}};
        lanes step[UNKNOWNS] = {{0}};
        int unloaded = search->unloaded && count == 0;
        balance_at(blades, active, walk->state, all(unloaded ? 0.0 : 1.0), &at, moments, &air);
        if (unloaded) add_precone_load(search, blades->q, at.residual);
        solve_step(search->count, &at, step);
        if (count == 0) walk->first = at.slopes;
        keep(active, sizeof at, &at, &walk->last);
        keep(active, sizeof step, step, walk->step);
        keep(active, sizeof walk->state, walk->state, walk->before);
        keep(active, size_of_moments, moments, walk->moments);
        keep(active, sizeof(lanes), &air.angle, &walk->angle);
        keep(active, sizeof(lanes), &air.mach, &walk->mach);
        lanes size = take_step(search, active, step, walk->state);
        whole last = is_last(search, size, size_before);
        walk->steps += active & 1;
        size_before = choose(active, size, size_before);
        walk->arrived |= active & last;
        active &= ~last & (size == size);
    }
}

/* Return the work of the airloads on a row after the last step. */
static lanes work_after(const struct search *search, const struct walk *walk, int row)
{
    lanes found = walk->last.work[row];
    for (int k = 0; k < search->count; k++) found += walk->last.work_slopes[row][k] * walk->step[k];
    return found;
}

/* Results of a search, (points) or (..., points): the state before the last step, slopes at the first and the last step
   (2, count, count), work after the last step, the moments of the loads, doubts as in `balance_of_blade`. */
struct found {
    double *state, *before, *first, *last, *work, *moments, *doubts;
    int64_t *iterations;
    unsigned char *active; /* in: the points that are searched; out: those that arrived */
};

static void store_slopes(ptrdiff_t n, const struct slopes *at, whole where, double *slopes, ptrdiff_t point, ptrdiff_t points)
{
    for (ptrdiff_t i = 0; i < n; i++)
        for (ptrdiff_t k = 0; k < n; k++) {
            store_where(where, at->full[i][k], slopes + i * n + k, n * n, point, points);
            store_where(where, at->airloads[i][k], slopes + (points * n + i) * n + k, n * n, point, points);
        }
}

/* Search the trims of points from their states on. */
void FOR(search_trim)(ptrdiff_t points, const struct blade *blade, const struct search *search, const struct found *found)
{
    ptrdiff_t count_moments = LOADS * POWERS * blade->segments;
    for (ptrdiff_t point = 0; point < points; point += LANES) {
        whole active = every(0);
        for (int lane = 0; lane < LANES && point + lane < points; lane++) active[lane] = -(int64_t)(found->active[point + lane] != 0);
        if (!any(active)) continue;
        lanes q[QUANTITIES];
        struct walk walk = {0};
        for (int k = 0; k < UNKNOWNS; k++) {
            struct column own = {found->state + k * points, 1, 0};
            walk.state[k] = load(&own, point, points, 0);
        }
        struct blades blades = blades_at(blade, search, point, points, q);
        walk_to_trim(&blades, active, &walk, found->doubts);
        store_slopes(search->count, &walk.first, active, found->first, point, points);
        store_slopes(search->count, &walk.last.slopes, active, found->last, point, points);
        for (int k = 0; k < UNKNOWNS; k++) store(walk.state[k], found->state + k * points, 1, point, points);
        if (found->before) {
            for (int k = 0; k < UNKNOWNS; k++) store_where(active, walk.before[k], found->before + k * points, 1, point, points);
            for (int row = 0; row < BALANCES; row++)
                store_where(active, work_after(search, &walk, row), found->work + row, BALANCES, point, points);
            for (ptrdiff_t k = 0; k < count_moments; k++) store_where(active, walk.moments[k], found->moments + k * points, 1, point, points);
        }
        for (int lane = 0; lane < LANES && point + lane < points; lane++) {
            found->iterations[point + lane] += walk.steps[lane];
            found->active[point + lane] = walk.arrived[lane] != 0;
        }
    }
}
