/* Equations of motion of many points: on a support, and solved for the accelerations. */

#include "motion.h"

#include "columns.h"

#define CLEARLY_MASS 1e-6 /* of massless.py: a pivot of M + its transpose, in its diagonal */
#define LARGEST_FACTOR 10.0 /* of a row that is taken off another, rows scaled to a largest entry of one */

void load_equations(int n, int count_held, const int32_t *held, ptrdiff_t first, ptrdiff_t count, const double *const *matrices, lanes *equations)
{
    const double *mass = matrices[0], *damping = matrices[1], *stiffness = matrices[2];
    ptrdiff_t size = (ptrdiff_t)n * n;
    for (ptrdiff_t i = 0; i < n; i++) {
        lanes *row = equations + i * (2 * n + count_held), *last = row + n + count_held;
        load_row(mass + i * n, size, first, count, n, row);
        load_row(stiffness + i * n, size, first, count, n, last); /* until the damping takes this place */
        for (int j = 0; j < count_held; j++) row[n + j] = last[held[j]];
        load_row(damping + i * n, size, first, count, n, last);
    }
}

whole eliminate(int n, int columns, lanes *rows)
{
    whole unsafe = every(0);
    for (int i = 0; i < n; i++) {
        lanes *row = rows + (ptrdiff_t)i * columns, most = {0};
        for (int j = 0; j < n; j++) most = larger(most, magnitude(row[j]));
        unsafe |= ~(most > 0.0);
        lanes scale = 1.0 / most;
        for (int j = 0; j < columns; j++) row[j] *= scale;
    }
    for (int k = 0; k < n; k++) {
        const lanes *pivot = rows + (ptrdiff_t)k * columns;
        lanes inverse = 1.0 / pivot[k];
        unsafe |= ~(magnitude(pivot[k]) > 0.0);
        for (int i = k + 1; i < n; i++) {
            lanes *row = rows + (ptrdiff_t)i * columns, factor = row[k] * inverse;
            unsafe |= ~(magnitude(factor) <= LARGEST_FACTOR);
            for (int j = k + 1; j < columns; j++) row[j] -= factor * pivot[j];
        }
    }
    for (int k = n - 1; k >= 0; k--) {
        lanes *pivot = rows + (ptrdiff_t)k * columns, inverse = 1.0 / pivot[k];
        for (int j = n; j < columns; j++) pivot[j] *= inverse;
        for (int i = 0; i < k; i++) {
            lanes *row = rows + (ptrdiff_t)i * columns, factor = row[k];
            for (int j = n; j < columns; j++) row[j] -= factor * pivot[j];
        }
    }
    return unsafe;
}

whole find_state_matrix(int n, int count_held, const int32_t *held, ptrdiff_t first, ptrdiff_t count, const double *const *matrices, lanes *equations, lanes *h)
{
    int states = n + count_held, wide = n + states;
    load_equations(n, count_held, held, first, count, matrices, equations);
    whole unsafe = eliminate(n, wide, equations);
    for (int i = 0; i < count_held; i++)
        for (int j = 0; j < states; j++) h[i * states + j] = all(j == count_held + held[i] ? 1.0 : 0.0);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < states; j++) h[(count_held + i) * states + j] = -equations[i * wide + n + j];
    return unsafe;
}

/* State matrices (count, states, states) of equations of motion, as of `roots_of_motion`; `unsafe` marks those that
   elimination in the order of the rows does not solve well. `work` has room for one of them and its equations. */
void state_matrices(int n, int count_held, const int32_t *held, ptrdiff_t count, const double *const *matrices, double *found, unsigned char *unsafe, lanes *work)
{
    ptrdiff_t size = (ptrdiff_t)(n + count_held) * (n + count_held);
    for (ptrdiff_t first = 0; first < count; first += LANES) {
        whole failed = find_state_matrix(n, count_held, held, first, count, matrices, work + size, work);
        store_row(work, found, size, first, count, size);
        for (int lane = 0; lane < LANES && first + lane < count; lane++) unsafe[first + lane] = failed[lane] != 0;
    }
}

#define HUB 6 /* coordinates of a hub, the first of a rotor alone */
#define MOST 64

/* Put a matrix (points, size, columns) of a rotor alone on a support with `modes` coordinates, whose hub moves by `motion`
   (6, modes), in the lanes from a point on: its rows, and its columns too if these are coordinates, not inputs. The
   support's own matrix is added. */
static void put_on_support(ptrdiff_t point, ptrdiff_t points, int size, int columns, int modes, const lanes *motion, const double *rotor, const struct column *addition, double *found)
{
    int rows = modes + size - HUB, moved = addition ? HUB : 0, first = addition ? modes : 0;
    int wide = first + columns - moved;
    ptrdiff_t own = (ptrdiff_t)size * columns, result = (ptrdiff_t)rows * wide;
    lanes at_hub[HUB * MOST], row[MOST + HUB], sum[MOST];
    for (int i = 0; i < size; i++) {
        lanes *into = i < HUB ? at_hub + i * MOST : sum;
        load_row(rotor + (ptrdiff_t)i * columns, own, point, points, columns, row);
        for (int j = 0; j < first; j++) into[j] = all(0.0);
        for (int k = 0; k < moved; k++)
            for (int j = 0; j < first; j++) into[j] += row[k] * motion[k * modes + j];
        for (int j = first; j < wide; j++) into[j] = row[moved + j - first];
        if (i >= HUB) store_row(sum, found + (ptrdiff_t)(modes + i - HUB) * wide, result, point, points, wide);
    }
    for (int i = 0; i < modes; i++) {
        if (first) load_row(addition->at + (ptrdiff_t)i * modes, addition->point, point, points, first, sum);
        for (int j = first; j < wide; j++) sum[j] = all(0.0);
        for (int k = 0; k < HUB; k++)
            for (int j = 0; j < wide; j++) sum[j] += motion[k * modes + i] * at_hub[k * MOST + j];
        store_row(sum, found + (ptrdiff_t)i * wide, result, point, points, wide);
    }
}

/* Return in which lanes every motion has mass for certain, by the pivots of M + its transpose; `rows` becomes its factor. */
static whole has_mass(int n, lanes *rows)
{
    whole certain = every(-1);
    for (int i = 0; i < n; i++)
        for (int j = 0; j <= i; j++) rows[i * n + j] += rows[j * n + i];
    for (int k = 0; k < n; k++) {
        /* Row k of the factor: its entries times their pivots, then divided by these. */
        lanes pivot = rows[k * n + k];
        for (int j = 0; j < k; j++) {
            lanes sum = rows[k * n + j];
            for (int i = 0; i < j; i++) sum -= rows[k * n + i] * rows[j * n + i];
            rows[k * n + j] = sum;
        }
        for (int j = 0; j < k; j++) {
            lanes factor = rows[k * n + j] * rows[j * n + j];
            pivot -= factor * rows[k * n + j];
            rows[k * n + j] = factor;
        }
        certain &= (pivot > CLEARLY_MASS * rows[k * n + k]) & (pivot < INFINITY); /* false for NaN */
        rows[k * n + k] = 1.0 / pivot;
    }
    return certain;
}

static void find_mass(ptrdiff_t point, ptrdiff_t points, int n, const double *mass, unsigned char *found, lanes *rows)
{
    load_row(mass, (ptrdiff_t)n * n, point, points, (ptrdiff_t)n * n, rows);
    whole certain = has_mass(n, rows);
    for (int lane = 0; lane < LANES && point + lane < points; lane++) found[point + lane] = certain[lane] != 0;
}

/* Matrices M, C, K (points, size, size) and, unless it is null, B (points, size, inputs) of a rotor alone on a support,
   with the support's own M, C, K added: (points, modes + size - 6, ...); and in which mass matrices every motion has
   mass for certain. `rows` has room for one of these. */
void on_support(ptrdiff_t points, int size, int modes, int inputs, const double *const *rotor, const struct column *hub, const struct column *additions, double *const *found, unsigned char *certain, lanes *rows)
{
    for (ptrdiff_t point = 0; point < points; point += LANES) {
        lanes motion[HUB * MOST];
        load_row(hub->at, hub->point, point, points, (ptrdiff_t)HUB * modes, motion);
        for (int k = 0; k < 3; k++)
            put_on_support(point, points, size, size, modes, motion, rotor[k], &additions[k], found[k]);
        if (rotor[3]) put_on_support(point, points, size, inputs, modes, motion, rotor[3], NULL, found[3]);
        find_mass(point, points, modes + size - HUB, found[0], certain, rows);
    }
}

/* Find in which mass matrices (points, n, n) every motion has mass for certain. `rows` has room for n * n. */
void have_mass(ptrdiff_t points, int n, const double *mass, unsigned char *found, lanes *rows)
{
    for (ptrdiff_t point = 0; point < points; point += LANES) find_mass(point, points, n, mass, found, rows);
}
