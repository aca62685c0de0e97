/* The path from the undeflected blade to the trim in the lanes, as trim_path.py and trim_start.py follow it, for trims that
   the bound alone does not connect with the undeflected blade. */

#include "trim.h"

#define FIRST_LENGTH 0.25 /* of the share of the loads; all numbers here are those of the two modules */
#define SHORTEST_LENGTH 1e-6
#define CAUTION 0.8
#define MOST_LENGTHS 400
#define CORRECTIONS 8
#define CORRECTED 1e-7
#define FARTHEST 60 /* degrees of the rigid blade's collective from the direction of the air */
#define DEGREE 0.017453292519943295
#define HALF_TURN 3.141592653589793
#define REFINEMENTS 60
#define SHARP 1e-12

/* A path in the lanes: state, share of the loads, slopes there, change of the unknowns with the share, number of steps. */
struct path {
    lanes state[UNKNOWNS], share, tangent[UNKNOWNS];
    struct slopes slopes;
    whole steps;
};

/* Take away what a share leaves out of the airloads. */
static void relieve(const struct search *search, lanes share, struct linear *at)
{
    lanes left_out = 1.0 - share;
    for (int i = 0; i < search->count; i++) {
        if (search->unknowns[i] != COLLECTIVE) at->residual[i] += left_out * at->work[search->rows[i]];
        for (int k = 0; k < search->count; k++) at->slopes.full[i][k] -= left_out * at->slopes.airloads[i][k];
    }
}

/* Set the loads that the share multiplies. */
static void loads_of_path(const struct search *search, lanes *q, const struct linear *at, lanes *loads)
{
    for (int i = 0; i < search->count; i++)
        loads[i] = search->unknowns[i] == COLLECTIVE ? all(0.0) : -at->work[search->rows[i]];
    add_precone_load(search, q, loads);
}

/* Run Newton at a share of the loads, and return where it arrives; slopes and loads are those before the last step. */
static whole correct(const struct blades *blades, whole going, lanes share, lanes *state, struct slopes *slopes, lanes *loads, whole *steps)
{
    whole arrived = every(0);
    for (int count = 0; count < CORRECTIONS && any(going); count++) {
        struct linear at = {0};
        lanes step[UNKNOWNS] = {{0}}, own[UNKNOWNS] = {{0}};
        balance_at(blades, going, state, share, &at, 0, 0);
        loads_of_path(blades->search, blades->q, &at, own);
        keep(going, sizeof at.slopes, &at.slopes, slopes);
        keep(going, sizeof own, own, loads);
        relieve(blades->search, share, &at);
        solve_step(blades->search->count, &at, step);
        lanes size = take_step(blades->search, going, step, state);
        *steps += going & 1;
        arrived |= going & (size <= CORRECTED);
        going &= size > CORRECTED;
    }
    return arrived;
}

/* Set the change of the unknowns with the share in some lanes. */
static void set_tangent(int count, whole where, const lanes *loads, struct path *path)
{
    lanes rows[UNKNOWNS * (UNKNOWNS + 1)];
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < count; k++)
            rows[i * (count + 1) + k] = path->slopes.full[i][k] - (1.0 - path->share) * path->slopes.airloads[i][k];
        rows[i * (count + 1) + count] = loads[i];
    }
    solve_rows(count, count + 1, rows);
    for (int k = 0; k < count; k++) path->tangent[k] = choose(where, -rows[k * (count + 1) + count], path->tangent[k]);
}

/* Return the residual of the row that closes the trim, at a pitch of the undeflected blade without precone. */
static lanes closing(const struct blades *blades, whole where, lanes pitch)
{
    struct linear at = {0};
    lanes state[UNKNOWNS] = {{0}};
    state[COLLECTIVE] = pitch;
    balance_at(blades, where, state, all(0.0), &at, 0, 0);
    return at.residual[blades->search->count - 1];
}

static whole have_other_signs(lanes a, lanes b) { return ((a < 0.0) & (b > 0.0)) | ((a > 0.0) & (b < 0.0)); }
static whole have_a_sign(lanes a, lanes b) { return ((a < 0.0) & (b < 0.0)) | ((a > 0.0) & (b > 0.0)); }

/* Return the root between two angles from the air, a and b, where the closing row has other signs, by the Illinois method. */
static lanes root_between(const struct blades *blades, whole going, lanes air, lanes a, lanes at_a, lanes b, lanes at_b)
{
    for (int count = 0; count < REFINEMENTS && any(going); count++) {
        lanes rise = at_b - at_a, part = choose(rise == 0.0, all(0.0), at_b / rise);
        lanes c = b - part * (b - a), at_c = closing(blades, going, air + c);
        whole crossed = have_other_signs(at_c, at_b), moves = magnitude(c - b) > SHARP;
        a = choose(going & crossed, b, a);
        at_a = choose(going, choose(crossed, at_b, at_a / 2.0), at_a);
        b = choose(going, c, b);
        at_b = choose(going, at_c, at_b);
        going &= moves;
    }
    return b;
}

/* Return the pitch nearest the direction of the air that gives the undeflected blade its torque or thrust; it is not finite
   where there is none. */
static lanes rigid_pitch(const struct blades *blades, whole looking, lanes air)
{
    lanes nearest_root = all(INFINITY), edge[2];
    edge[0] = edge[1] = closing(blades, looking, air);
    for (int count = 1; count <= FARTHEST && any(looking); count++) {
        for (int side = 0; side < 2; side++) {
            double degree = side ? -DEGREE : DEGREE;
            lanes near = all((count - 1) * degree), far = all(count * degree), value = closing(blades, looking, air + far);
            whole crossed = looking & (edge[side] == edge[side]) & (value == value) & ~have_a_sign(edge[side], value);
            lanes root = root_between(blades, crossed, air, near, edge[side], far, value);
            nearest_root = choose(crossed & (magnitude(root) < magnitude(nearest_root)), root, nearest_root);
            edge[side] = choose(looking, value, edge[side]);
        }
        looking &= nearest_root == INFINITY;
    }
    return air + nearest_root;
}

/* Let the propeller moment deflect the control system, at the rigid blade's pitch or at a given collective. */
static void balance_control(const lanes *q, int finds_collective, lanes *state)
{
    lanes stiffness = q[Q_CONTROL_STIFFNESS], given = state[COLLECTIVE];
    lanes moment = q[Q_PROPELLER_MOMENT] * q[Q_PITCH_INERTIA] * q[Q_ROTOR_SPEED] * q[Q_ROTOR_SPEED];
    if (finds_collective) {
        state[ELASTIC_PITCH] = choose(moment > 0.0, -moment * sine(2.0 * given) / (2.0 * stiffness), all(0.0));
        state[COLLECTIVE] = given - state[ELASTIC_PITCH];
        return;
    }
    lanes pitch = HALF_TURN * nearest(given / HALF_TURN);
    for (int count = 0; count < REFINEMENTS; count++) {
        lanes left = stiffness * (pitch - given) + moment * sine(2.0 * pitch) / 2.0;
        pitch -= left / (stiffness + moment * cosine(2.0 * pitch));
    }
    state[ELASTIC_PITCH] = pitch - given;
}

/* Set the state to the undeflected blade, and return where there is one; the state holds the collective, if it is given. */
static whole undeflect(const struct blades *blades, whole wanted, int finds_collective, lanes air, lanes *state)
{
    for (int k = 0; k < COLLECTIVE; k++) state[k] = all(0.0);
    if (finds_collective) state[COLLECTIVE] = rigid_pitch(blades, wanted, air);
    for (int k = 0; k < blades->search->count; k++)
        if (blades->search->unknowns[k] == ELASTIC_PITCH) balance_control(blades->q, finds_collective, state);
    return wanted & (magnitude(state[COLLECTIVE]) < INFINITY) & (magnitude(state[ELASTIC_PITCH]) < INFINITY);
}

/* Try a step in the share, and return where the path has a way to go and a step to take. */
static whole advance(const struct blades *blades, const unsigned char *sprung, whole active, lanes *length, struct path *path)
{
    const struct search *search = blades->search;
    lanes to = smaller(all(1.0), path->share + *length), trial[UNKNOWNS], loads[UNKNOWNS] = {{0}};
    struct slopes end = path->slopes;
    memcpy(trial, path->state, sizeof trial);
    for (int k = 0; k < search->count; k++) trial[search->unknowns[k]] += (to - path->share) * path->tangent[k];
    whole good = correct(blades, active, to, trial, &end, loads, &path->steps);
    lanes radius = radius_in_step(search->count, sprung, path->share, to, &path->slopes, &end);
    good &= radius <= CONTRACTION;
    keep(good, sizeof trial, trial, path->state);
    keep(good, sizeof end, &end, &path->slopes);
    path->share = choose(good, to, path->share);
    set_tangent(search->count, good, loads, path);
    lanes longer = smaller(larger(CAUTION * CONTRACTION / radius, all(0.25)), all(2.0));
    *length *= choose(good | (radius > CONTRACTION), longer, all(0.5));
    return active & (path->share < 1.0) & (*length >= SHORTEST_LENGTH);
}

/* Follow the path from the undeflected blade in the lanes that are wanted, and return where it leads to all of the loads. */
static whole follow(const struct blades *blades, whole wanted, const unsigned char *sprung, int finds_collective, lanes air, struct path *path)
{
    lanes length = all(FIRST_LENGTH), loads[UNKNOWNS] = {{0}};
    path->share = all(0.0);
    path->steps = every(0);
    whole active = undeflect(blades, wanted, finds_collective, air, path->state);
    active = correct(blades, active, path->share, path->state, &path->slopes, loads, &path->steps);
    set_tangent(blades->search->count, active, loads, path);
    for (int count = 0; count < MOST_LENGTHS && any(active); count++)
        active = advance(blades, sprung, active, &length, path);
    return wanted & (path->share == 1.0);
}
