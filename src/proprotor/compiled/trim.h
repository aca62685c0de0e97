/* Newton's method for the trim of many blades, one in each lane, until each lane has arrived. */

#define BALANCES 5 /* flap, lag, pitch, torque, thrust */
#define UNKNOWNS 4 /* coning, lag, elastic pitch, collective */
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
    struct column load, structural_offset;
    struct layout residual, slopes, work, work_slopes, precone;
};

/* The balance at a state: of the free unknowns, residual and slopes with all of the airloads, and the airloads' part. */
struct linear {
    lanes residual[UNKNOWNS], full[UNKNOWNS][UNKNOWNS], airloads[UNKNOWNS][UNKNOWNS];
    lanes work[BALANCES], work_slopes[BALANCES][UNKNOWNS];
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
            at->full[i][k] = slopes[row * UNKNOWNS + search->unknowns[k]] + own;
            at->airloads[i][k] = search->unknowns[i] == COLLECTIVE ? all(0.0) : own;
        }
    }
}

/* Solve for Newton's step with exchanges of rows in each lane; NaN without an inverse. */
static void solve_step(int count, const struct linear *at, lanes *step)
{
    lanes rows[UNKNOWNS * (UNKNOWNS + 1)];
    for (int i = 0; i < count; i++) {
        for (int j = 0; j < count; j++) rows[i * (count + 1) + j] = at->full[i][j];
        rows[i * (count + 1) + count] = at->residual[i];
    }
    solve_rows(count, count + 1, rows);
    for (int k = 0; k < count; k++) {
        lanes newton = rows[k * (count + 1) + count];
        lanes within = choose(newton > LARGEST_STEP, all(LARGEST_STEP), newton);
        step[k] = choose(within < -LARGEST_STEP, all(-LARGEST_STEP), within);
    }
}

/* Results of a search, (points) or (..., points): the state before the last step, slopes at the first and the last step
   (2, count, count), work and its slopes, the moments of the loads, doubts as in `balance_of_blade`. */
struct found {
    double *state, *before, *first, *last, *work, *moments, *doubts;
    int64_t *iterations;
    unsigned char *active; /* in: the points that are searched; out: those that arrived */
};

static void store_slopes(const struct search *search, const struct linear *at, whole where, double *slopes, ptrdiff_t point, ptrdiff_t points)
{
    ptrdiff_t n = search->count, size = n * n;
    for (int lane = 0; lane < LANES && point + lane < points; lane++) {
        if (!where[lane]) continue;
        for (ptrdiff_t i = 0; i < n; i++)
            for (ptrdiff_t k = 0; k < n; k++) {
                slopes[(point + lane) * size + i * n + k] = at->full[i][k][lane];
                slopes[(points + point + lane) * size + i * n + k] = at->airloads[i][k][lane];
            }
    }
}

/* Search the trims of points from their states on. */
void FOR(search_trim)(ptrdiff_t points, const struct blade *blade, const struct search *search, const struct found *found)
{
    ptrdiff_t count_moments = LOADS * POWERS * blade->segments;
    for (ptrdiff_t point = 0; point < points; point += LANES) {
        whole active = every(0), arrived = every(0);
        for (int lane = 0; lane < LANES && point + lane < points; lane++) active[lane] = -(int64_t)(found->active[point + lane] != 0);
        if (!any(active)) continue;
        lanes q[QUANTITIES], state[UNKNOWNS], structure[BALANCE_RESULTS], done[WORK_RESULTS], moments[LOADS * POWERS * MOST_SEGMENTS];
        lanes size_before = all(INFINITY), load_here = load(&search->load, point, points, 0);
        lanes offset = load(&search->structural_offset, point, points, 0);
        whole steps = every(0);
        for (int k = 0; k < UNKNOWNS; k++) {
            struct column own = {found->state + k * points, 1, 0};
            state[k] = load(&own, point, points, 0);
        }
        load_quantities(blade, point, points, q);
        lanes precone = q[Q_PRECONE];
        for (int count = 0; count < search->most && any(active); count++) {
            struct linear at;
            lanes step[UNKNOWNS] = {{0}}, size = {0};
            int unloaded = search->unloaded && count == 0;
            q[Q_PRECONE] = unloaded ? all(0.0) : precone;
            set_state(search, state, offset, q);
            evaluate(blade, point, points, q, structure, done, moments, active, found->doubts);
            linearise(search, structure, done, load_here, &at);
            if (unloaded) {
                lanes results[PRECONE_LOAD_RESULTS], own[BALANCES];
                q[Q_PRECONE] = precone;
                precone_load(q, results);
                fill(&search->precone, results, own);
                for (int i = 0; i < search->count; i++)
                    if (search->unknowns[i] != COLLECTIVE) at.residual[i] += own[search->rows[i]];
            }
            solve_step(search->count, &at, step);
            if (found->first && count == 0) store_slopes(search, &at, active, found->first, point, points);
            store_slopes(search, &at, active, found->last, point, points);
            if (found->before) {
                for (int k = 0; k < UNKNOWNS; k++) store_where(active, state[k], found->before + k * points, 1, point, points);
                for (int row = 0; row < BALANCES; row++) {
                    lanes after = at.work[row];
                    for (int k = 0; k < search->count; k++) after += at.work_slopes[row][k] * step[k];
                    store_where(active, after, found->work + row, BALANCES, point, points);
                }
                for (ptrdiff_t k = 0; k < count_moments; k++) store_where(active, moments[k], found->moments + k * points, 1, point, points);
            }
            for (int k = 0; k < search->count; k++) {
                lanes *own = &state[search->unknowns[k]];
                *own = choose(active, *own - step[k], *own);
                size = choose(magnitude(step[k]) <= size, size, magnitude(step[k])); /* NaN stays */
            }
            whole last = (size <= CONVERGED) | ((size <= STALLED) & (size >= 0.5 * size_before));
            if (search->ends_near) {
                lanes ratio = size / (size_before * size_before), next = size * size * larger(ratio, all(1.0));
                last = (size <= NEAR) & (last | (next <= ALMOST));
            }
            steps += active & 1;
            size_before = choose(active, size, size_before);
            arrived |= active & last;
            active &= ~last & (size == size);
        }
        for (int k = 0; k < UNKNOWNS; k++) store(state[k], found->state + k * points, 1, point, points);
        for (int lane = 0; lane < LANES && point + lane < points; lane++) {
            found->iterations[point + lane] += steps[lane];
            found->active[point + lane] = arrived[lane] != 0;
        }
    }
}
