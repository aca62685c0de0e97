/* Trim and matrices of rotors in one go, for points without any reservation. What is doubtful about the trim of another
   point, and what is to be said of a point without a trim, is found out step by step. */

#define TORQUE 3 /* rows of the balance */
#define THRUST 4
#define THREE_QUARTERS 0.75

/* What keeps a point from being without reservation, see trim_reasons.py, trim_start.py and airfoil.py. */
struct limits {
    double angle, from_air, induced, incidence, mach, no_spring;
    int32_t finds_collective, lag_is_free;
    unsigned char sprung[UNKNOWNS]; /* which free unknowns are those of flap and lag */
};

/* Return where nothing keeps a point from a trim, as far as the inputs tell. */
static whole may_begin(const struct limits *limits, const lanes *q, lanes tip)
{
    lanes speed = q[Q_AIRSPEED], tip_speed = q[Q_ROTOR_SPEED] * tip, sound = q[Q_SPEED_OF_SOUND];
    whole good = (speed >= 0.0) & (speed < INFINITY) & (tip_speed * tip_speed + speed * speed < sound * sound);
    if (limits->finds_collective) good &= q[Q_DENSITY] > 0.0;
    if (limits->lag_is_free) {
        whole limp = q[Q_LAG_STIFFNESS] <= limits->no_spring * larger(q[Q_FLAP_STIFFNESS], all(1.0));
        good &= ~(limp & (q[Q_LAG_HINGE_OFFSET] * q[Q_LAG_FIRST_MOMENT] == 0.0));
    }
    return good;
}

/* Return where all sums of principal minors of the blade's stiffness are positive: then it has no negative eigenvalue. */
static whole cannot_diverge(const struct search *search, const struct slopes *slopes)
{
    lanes m[3][3] = {{{0}}}, trace = {0}, minors = {0};
    int size = 0;
    for (int i = 0; i < search->count; i++) size += search->unknowns[i] != COLLECTIVE; /* which comes last */
    for (int i = 0; i < size; i++)
        for (int j = 0; j < size; j++) m[i][j] = slopes->full[i][j];
    for (int i = 0; i < size; i++) {
        trace += m[i][i];
        for (int j = 0; j < i; j++) minors += m[i][i] * m[j][j] - m[i][j] * m[j][i];
    }
    lanes determinant = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]);
    determinant += m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    whole good = every(-1);
    if (size > 0) good &= trace > 0.0;
    if (size > 1) good &= minors > 0.0;
    if (size > 2) good &= determinant > 0.0;
    return good;
}

/* Return where nothing makes a trim doubtful. */
static whole is_without_doubt(const struct search *search, const struct limits *limits, const struct walk *walk, const lanes *q, lanes tip, lanes direction)
{
    whole good = cannot_diverge(search, &walk->last.slopes) & (walk->angle <= limits->incidence) & (walk->mach <= limits->mach);
    for (int k = 0; k < COLLECTIVE; k++) good &= magnitude(walk->state[k]) <= limits->angle;
    if (limits->finds_collective) good &= magnitude(walk->state[COLLECTIVE] - direction) < limits->from_air;
    lanes disk = 2.0 * q[Q_DENSITY] * 3.141592653589793 * tip * tip * q[Q_AIRSPEED] * q[Q_AIRSPEED];
    lanes thrust = work_after(search, walk, THRUST) * q[Q_N_BLADES];
    return good & (magnitude(thrust) <= limits->induced * disk);
}

/* Results: state and state before the last step (4, points), thrust, torque and number of steps; matrices as of
   `matrices_of_rotor`; which points have all of these, and which points have at least a trim at the end of their path, with
   its states and number of steps. The other numbers mean nothing. */
struct rotors {
    double *state, *before, *thrust, *torque;
    int64_t *iterations;
    unsigned char *served, *trimmed;
    double *matrices[4];
};

/* Find the trims of the lanes that may begin, and return where the trim is at the end of its path: `near` and `last` are the
   two stages of the search. */
static whole find_trims(struct blades *blades, const struct search *near, const struct search *last, const struct limits *limits, whole begun, lanes air, struct walk *walk, whole *steps)
{
    struct path path = {0};
    memcpy(path.state, walk->state, sizeof path.state);
    blades->search = near;
    walk_to_trim(blades, begun, walk, 0);
    struct slopes end = walk->last.slopes;
    whole led = walk->arrived & have_one_path(near->count, limits->sprung, walk->arrived, &walk->first, &end);
    *steps = walk->steps;
    if (any(begun & ~led)) {
        whole arrived = follow(blades, begun & ~led, limits->sprung, limits->finds_collective, air, &path);
        keep(arrived, sizeof path.state, path.state, walk->state);
        keep(arrived, sizeof end, &path.slopes, &end);
        *steps += path.steps;
        led |= arrived;
    }
    blades->search = last;
    walk_to_trim(blades, led, walk, 0);
    *steps += walk->steps;
    return walk->arrived & have_one_trim(last->count, limits->sprung, walk->arrived, &walk->last.slopes, &end);
}

/* Find trim and matrices of rotors: `places` are those of the moments of the loads among the quantities. */
void FOR(rotors_in_flight)(ptrdiff_t points, const struct blade *blade, const struct search *near, const struct search *last, const struct limits *limits, const struct layouts *layouts, const int32_t *places, const struct rotors *found)
{
    for (ptrdiff_t point = 0; point < points; point += LANES) {
        lanes q[QUANTITIES], tip = load(&blade->tip, point, points, 0);
        struct walk walk = {0};
        struct blades blades = blades_at(blade, near, point, points, q);
        lanes air = arc_tangent(q[Q_AIRSPEED] / (THREE_QUARTERS * q[Q_ROTOR_SPEED] * tip));
        walk.state[COLLECTIVE] = limits->finds_collective ? air : load(&blade->collective, point, points, 0);
        whole steps, trimmed = find_trims(&blades, near, last, limits, may_begin(limits, q, tip), air, &walk, &steps);
        whole served = trimmed & is_without_doubt(last, limits, &walk, q, tip, air);
        for (int lane = 0; lane < LANES && point + lane < points; lane++) {
            found->served[point + lane] = served[lane] != 0;
            found->trimmed[point + lane] = trimmed[lane] != 0;
            found->iterations[point + lane] = steps[lane];
        }
        if (!any(trimmed)) continue;
        for (int k = 0; k < UNKNOWNS; k++) {
            store(walk.state[k], found->state + k * points, 1, point, points);
            store(walk.before[k], found->before + k * points, 1, point, points);
        }
        if (!any(served)) continue;
        set_state(last, walk.before, blades.offset, q);
        find_matrices(blade, point, points, layouts, q, walk.moments, places, found->matrices);
        store(work_after(last, &walk, THRUST) * q[Q_N_BLADES], found->thrust, 1, point, points);
        store(work_after(last, &walk, TORQUE) * q[Q_N_BLADES], found->torque, 1, point, points);
    }
}
