/* The plans of the derivation for many points: the balance of a blade at trim, and the matrices of a rotor.

   `plain.c` and `general.c` include this file once for each set of plans, which FOR tells apart in the names. */

#include "columns.h"
#include "rows.h"

#define LOADS (SECTION_LOADS_RESULTS - 2) /* the last two results say whether the loads are in doubt */
#define POWERS 3
#define MOST_SEGMENTS 8

/* A blade at many points: quantities by their places in the header of the plans, with a stride along the segments; radii,
   chord, twist, what an effective twist leaves out, ratios of chords, the airfoil's numbers and three weights of each
   station; the radius of the tip, and what closes the trim: the load of its row, a given collective. */
struct blade {
    ptrdiff_t segments;
    const ptrdiff_t *ends; /* the first station of each segment, and one behind the last */
    struct column radius, chord, twist, bent, square_ratio, cube_ratio;
    struct column lift_slope, zero_lift_angle, drag, moment;
    struct column weights[POWERS];
    struct column tip, load, collective, structural_offset;
    struct column quantities[QUANTITIES];
};

static void load_quantities(const struct blade *blade, ptrdiff_t point, ptrdiff_t points, lanes *q)
{
    for (int k = 0; k < QUANTITIES; k++) q[k] = load(&blade->quantities[k], point, points, 0);
}

/* Set the quantities that differ between segments. */
static void load_segment(const struct blade *blade, ptrdiff_t point, ptrdiff_t points, ptrdiff_t segment, lanes *q)
{
    for (int k = 0; k < QUANTITIES; k++)
        if (blade->quantities[k].along) q[k] = load(&blade->quantities[k], point, points, segment);
}

#define OUTBOARD 0.5 /* of the tip's radius, as in section_loads.py */

/* The air that sections meet in some lanes: angle of attack and Mach number of each station, (2, points, stations), unless
   there is no place for them; and the largest of both outboard. */
struct air {
    whole where;
    double *stations;
    lanes angle, mach;
};

static void note_air(const struct blade *blade, ptrdiff_t point, ptrdiff_t points, ptrdiff_t k, lanes r, lanes angle, lanes mach, struct air *air)
{
    ptrdiff_t stations = blade->ends[blade->segments];
    whole outboard = r >= OUTBOARD * load(&blade->tip, point, points, 0);
    lanes met = magnitude(angle + load(&blade->bent, point, points, k));
    air->angle = choose(outboard, larger(met, air->angle), air->angle);
    air->mach = choose(outboard, larger(mach, air->mach), air->mach);
    if (!air->stations) return;
    store_where(air->where, angle, air->stations + k, stations, point, points);
    store_where(air->where, mach, air->stations + points * stations + k, stations, point, points);
}

#define AT_ONCE 8 /* stations */

/* Find the loads of a station, and note its air. */
static void find_loads(const struct blade *blade, ptrdiff_t point, ptrdiff_t points, ptrdiff_t k, const lanes *line, lanes *q, lanes *loads, struct air *air)
{
    lanes r = load(&blade->radius, point, points, k);
    q[Q_CHORD] = load(&blade->chord, point, points, k);
    q[Q_SECTION_PITCH] = q[Q_PITCH] + load(&blade->twist, point, points, k);
    q[Q_SQUARE_RATIO] = load(&blade->square_ratio, point, points, k);
    q[Q_CUBE_RATIO] = load(&blade->cube_ratio, point, points, k);
    q[Q_LIFT_SLOPE] = load(&blade->lift_slope, point, points, k);
    q[Q_ZERO_LIFT_ANGLE] = load(&blade->zero_lift_angle, point, points, k);
    q[Q_DRAG_COEFFICIENT] = load(&blade->drag, point, points, k);
    q[Q_MOMENT_COEFFICIENT] = load(&blade->moment, point, points, k);
    q[Q_TANGENTIAL_VELOCITY] = line[LINE_UT_0] + r * line[LINE_UT_1];
    q[Q_AXIAL_VELOCITY] = line[LINE_UP_0] + r * line[LINE_UP_1];
    q[Q_RADIAL_VELOCITY] = line[LINE_UR_0];
    q[Q_SECTION_SPIN] = line[LINE_SPIN];
    section_loads(q, loads);
    note_air(blade, point, points, k, r, loads[LOADS], loads[LOADS + 1], air);
}

/* Add the radial moments of the loads of a segment. Each moment is read and written once for some stations: to store numbers
   takes longer than to multiply and add. */
static void add_moments(const struct blade *blade, ptrdiff_t point, ptrdiff_t points, ptrdiff_t segment, const lanes *line, lanes *q, lanes *moments, struct air *air)
{
    lanes loads[AT_ONCE][SECTION_LOADS_RESULTS], weights[AT_ONCE][POWERS];
    ptrdiff_t end = blade->ends[segment + 1];
    for (ptrdiff_t first = blade->ends[segment]; first < end; first += AT_ONCE) {
        int count = (int)(end - first < AT_ONCE ? end - first : AT_ONCE);
        for (int k = 0; k < count; k++) {
            find_loads(blade, point, points, first + k, line, q, loads[k], air);
            for (int power = 0; power < POWERS; power++) weights[k][power] = load(&blade->weights[power], point, points, first + k);
        }
        for (int load = 0; load < LOADS; load++) {
            lanes *own = moments + load * POWERS, zeroth = own[0], first_power = own[1], second = own[2];
            for (int k = 0; k < count; k++) {
                zeroth += weights[k][0] * loads[k][load];
                first_power += weights[k][1] * loads[k][load];
                second += weights[k][2] * loads[k][load];
            }
            own[0] = zeroth, own[1] = first_power, own[2] = second;
        }
    }
}

/* Where the results of a plan stand in a matrix: n is the n-th result, -n its negative, 0 is zero. */
struct layout {
    ptrdiff_t rows, columns;
    const int32_t *places;
};

static lanes entry(const struct layout *layout, const lanes *results, ptrdiff_t place)
{
    int32_t number = layout->places[place];
    return number > 0 ? results[number - 1] : number < 0 ? -results[-number - 1] : all(0.0);
}

static void fill(const struct layout *layout, const lanes *results, lanes *matrix)
{
    for (ptrdiff_t k = 0; k < layout->rows * layout->columns; k++) matrix[k] = entry(layout, results, k);
}

/* Evaluate the balance of a blade at trim: different results of the plans `balance` and `work`, and the radial moments of
   the section loads, of load and power and then of segment. */
static void evaluate(const struct blade *blade, ptrdiff_t point, ptrdiff_t points, lanes *q, lanes *structure, lanes *done, lanes *moments, struct air *air)
{
    air->angle = air->mach = all(0.0);
    lanes along[LINE_RESULTS], of_segment[WORK_RESULTS], own[LOADS * POWERS];
    balance(q, structure);
    for (int k = 0; k < WORK_RESULTS; k++) done[k] = all(0.0);
    for (ptrdiff_t segment = 0; segment < blade->segments; segment++) {
        for (int k = 0; k < LOADS * POWERS; k++) own[k] = all(0.0);
        load_segment(blade, point, points, segment, q);
        line(q, along);
        add_moments(blade, point, points, segment, along, q, own, air);
        work(q, along, own, of_segment);
        for (int k = 0; k < WORK_RESULTS; k++) done[k] += of_segment[k];
        for (int k = 0; k < LOADS * POWERS; k++) moments[k * blade->segments + segment] = own[k];
    }
}

/* Balance of a blade at trim states, as `proprotor.rotor.fused_balance.balanced`: rows of different results of the plans,
   and moments with the axes load and power, segment, point. */
void FOR(balance_of_blade)(ptrdiff_t points, const struct blade *blade, double *structure, double *virtual_work, double *all_moments, double *doubts)
{
    ptrdiff_t count = LOADS * POWERS * blade->segments;
    for (ptrdiff_t point = 0; point < points; point += LANES) {
        lanes q[QUANTITIES], results[BALANCE_RESULTS], total[WORK_RESULTS], moments[LOADS * POWERS * MOST_SEGMENTS];
        struct air air = {every(-1), doubts, {0}, {0}};
        load_quantities(blade, point, points, q);
        evaluate(blade, point, points, q, results, total, moments, &air);
        for (int k = 0; k < BALANCE_RESULTS; k++) store(results[k], structure + k, BALANCE_RESULTS, point, points);
        for (int k = 0; k < WORK_RESULTS; k++) store(total[k], virtual_work + k, WORK_RESULTS, point, points);
        for (ptrdiff_t k = 0; k < count; k++) store(moments[k], all_moments + k * points, 1, point, points);
    }
}

#include "path.h"

#define MOST_ENTRIES 1024

/* Store the sum of two matrices, the second of which may be missing. */
static void store_sum(const struct layout *one, const lanes *of_one, const struct layout *other, const lanes *of_other, double *matrices, ptrdiff_t point, ptrdiff_t points)
{
    lanes sum[MOST_ENTRIES];
    ptrdiff_t size = one->rows * one->columns;
    fill(one, of_one, sum);
    for (ptrdiff_t k = 0; other && k < size; k++) sum[k] += entry(other, of_other, k);
    store_row(sum, matrices, size, point, points, size);
}

/* Layouts of the plans: M, C, K, B without airloads; C, K, B of airloads; W, L, U and G of a segment. */
struct layouts {
    struct layout in_vacuum[4], of_airloads[3], virtual_motion, load_derivatives, motion, geometric;
};

#define MOST_WORK 256

/* Find the matrices M, C, K (points, n, n) and B (points, n, inputs) of the rotors in the lanes. Moments of the loads of
   the segments, if they are given, take their `places` among the quantities. */
static void find_matrices(const struct blade *blade, ptrdiff_t point, ptrdiff_t points, const struct layouts *layouts, lanes *q, const lanes *moments, const int32_t *places, double *const *matrices)
{
    const struct layout *w = &layouts->virtual_motion, *l = &layouts->load_derivatives, *u = &layouts->motion;
    lanes rotor[IN_VACUUM_RESULTS], results[SEGMENT_RESULTS], air[OF_AIRLOADS_RESULTS];
    lanes virtual_motion[MOST_WORK], motion[MOST_WORK], loads[MOST_WORK], done[MOST_WORK], geometric[MOST_WORK];
    in_vacuum(q, rotor);
    for (ptrdiff_t k = 0; k < w->columns * u->columns; k++) done[k] = all(0.0);
    for (ptrdiff_t k = 0; k < layouts->geometric.rows; k++) geometric[k] = all(0.0);
    for (ptrdiff_t at = 0; at < blade->segments; at++) {
        load_segment(blade, point, points, at, q);
        for (int k = 0; moments && k < LOADS * POWERS; k++)
            if (places[k] >= 0) q[places[k]] = moments[k * blade->segments + at];
        segment(q, results);
        fill(w, results, virtual_motion);
        fill(u, results, motion);
        for (ptrdiff_t row = 0; row < l->rows; row++)
            for (ptrdiff_t column = 0; column < u->columns; column++) {
                lanes sum = all(0.0);
                for (ptrdiff_t k = 0; k < l->columns; k++)
                    if (l->places[row * l->columns + k])
                        sum += entry(l, results, row * l->columns + k) * motion[k * u->columns + column];
                loads[row * u->columns + column] = sum;
            }
        for (ptrdiff_t row = 0; row < w->columns; row++)
            for (ptrdiff_t load = 0; load < w->rows; load++) {
                if (!w->places[load * w->columns + row]) continue;
                lanes arm = virtual_motion[load * w->columns + row];
                for (ptrdiff_t k = 0; k < u->columns; k++) done[row * u->columns + k] += arm * loads[load * u->columns + k];
            }
        for (ptrdiff_t k = 0; k < layouts->geometric.rows; k++) geometric[k] += entry(&layouts->geometric, results, k);
    }
    if (blade->segments) of_airloads(q, done, geometric, air);
    for (int k = 0; k < 4; k++)
        store_sum(&layouts->in_vacuum[k], rotor, k && blade->segments ? &layouts->of_airloads[k - 1] : 0, air, matrices[k], point, points);
}

/* Matrices of rotors, as `proprotor.rotor.fused.rotor_matrices`. */
void FOR(matrices_of_rotor)(ptrdiff_t points, const struct blade *blade, const struct layouts *layouts, double *const *matrices)
{
    for (ptrdiff_t point = 0; point < points; point += LANES) {
        lanes q[QUANTITIES];
        load_quantities(blade, point, points, q);
        find_matrices(blade, point, points, layouts, q, 0, 0, matrices);
    }
}

#include "whole.h"
