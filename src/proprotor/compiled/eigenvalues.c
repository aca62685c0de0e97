/* Eigenvalues and right vectors of many small real matrices at once: one matrix in each lane of a vector register. */

#include "columns.h"
#include "eigen.h"
#include "motion.h"

#include <string.h>

#define LARGEST 1e300 /* matrices with larger or smaller entries are handed over */
#define SMALLEST 1e-290

/* Return where sums of the eigenvalues and of their squares are not the traces of the matrix and of its square. */
static whole miss_traces(int n, const lanes *real, const lanes *imaginary, lanes trace, lanes trace_of_square, lanes norm)
{
    for (int i = 0; i < n; i++) {
        trace -= real[i];
        trace_of_square -= real[i] * real[i] - imaginary[i] * imaginary[i];
    }
    lanes allowed = 1e-14 * n * norm;
    return ~(magnitude(trace) <= allowed) | ~(magnitude(trace_of_square) <= allowed * norm * 4.0);
}

/* Return whether the matrix times a combination of its vectors is not what the eigenvalues say; `room` for 4 * n. The
   entries of the matrix are `stride` apart. */
static unsigned char miss_matrix(int n, const double *matrix, ptrdiff_t stride, const double *values, const double *vectors, double *room)
{
    double *sum = room, *expected = room + 2 * n, worst = 0.0, norm = 0.0, size = 0.0;
    for (int i = 0; i < n; i++) {
        sum[2 * i] = sum[2 * i + 1] = expected[2 * i] = expected[2 * i + 1] = 0.0;
        for (int k = 0; k < n; k++) {
            double a = vectors[2 * ((ptrdiff_t)i * n + k)], b = vectors[2 * ((ptrdiff_t)i * n + k) + 1];
            double weight = 1.0 + 0.6180339887498949 * k - floor(0.6180339887498949 * k); /* no two alike */
            a *= weight, b *= weight;
            sum[2 * i] += a, sum[2 * i + 1] += b;
            expected[2 * i] += a * values[2 * k] - b * values[2 * k + 1];
            expected[2 * i + 1] += a * values[2 * k + 1] + b * values[2 * k];
        }
        size = fmax(size, fmax(fabs(sum[2 * i]), fabs(sum[2 * i + 1])));
    }
    for (int i = 0; i < n; i++) {
        double a = 0.0, b = 0.0, row = 0.0;
        for (int j = 0; j < n; j++) {
            double entry = matrix[stride * ((ptrdiff_t)i * n + j)];
            a += entry * sum[2 * j], b += entry * sum[2 * j + 1];
            row += fabs(entry);
        }
        norm = fmax(norm, row);
        worst = fmax(worst, fmax(fabs(a - expected[2 * i]), fabs(b - expected[2 * i + 1])));
    }
    return !(worst <= 1e-13 * n * norm * fmax(size, 1.0));
}

/* Room for one matrix in each lane. */
struct room {
    lanes *h, *z, *x, *real, *imaginary, *v;
};

static struct room room_of(int n, lanes *work, int vectors)
{
    ptrdiff_t size = (ptrdiff_t)n * n;
    lanes *values = work + 4 * size;
    return (struct room){work, vectors ? work + size : NULL, work + 2 * size, values, values + n, values + 2 * n};
}

/* Solve for the matrices h in the lanes, which are overwritten, and return the lanes that are handed over. */
static whole solve(int n, struct room room, lanes *scale)
{
    lanes *h = room.h, most = {0}, square = {0}, trace = {0}, trace_of_square = {0};
    ptrdiff_t size = (ptrdiff_t)n * n;
    whole finite = every(-1);
    for (ptrdiff_t k = 0; k < size; k++) {
        most = larger(magnitude(h[k]), most);
        finite &= magnitude(h[k]) <= LARGEST; /* false for NaN */
    }
    finite &= (most >= SMALLEST) | (most == 0.0);
    *scale = power_of_two(exponent(choose((most > 0.0) & finite, most, all(1.0))));
    lanes inverse = 1.0 / *scale;
    for (ptrdiff_t k = 0; k < size; k++) {
        h[k] = choose(finite, h[k] * inverse, all(0.0));
        square += h[k] * h[k];
    }
    for (int i = 0; i < n; i++) {
        trace += AT(i, i);
        for (int j = 0; j < n; j++) trace_of_square += AT(i, j) * AT(j, i);
    }
    for (int i = 0; i < n; i++) room.real[i] = room.imaginary[i] = all(0.0);
    whole failed = schur(n, h, room.z, room.real, room.imaginary, ~finite);
    if (room.z) triangular_vectors(n, h, room.real, room.imaginary, room.x);
    return failed | miss_traces(n, room.real, room.imaginary, trace, trace_of_square, root(square));
}

/* Store eigenvalues as complex numbers, and which lanes are handed over. */
static void store_values(int n, struct room room, lanes scale, whole failed, ptrdiff_t left, double *values, unsigned char *handed_over)
{
    for (int lane = 0; lane < LANES && lane < left; lane++) {
        for (int i = 0; i < n; i++) {
            values[2 * (lane * n + i)] = room.real[i][lane] * scale[lane];
            values[2 * (lane * n + i) + 1] = room.imaginary[i][lane] * scale[lane];
        }
        handed_over[lane] = failed[lane] != 0;
    }
}

/* Find the eigenvalues of `count` matrices of n rows, one after the other in memory, as complex numbers, and their right
   vectors as columns unless `vectors` is null. `work` has room for 4 * n * n + 4 * n vectors of lanes. A matrix that is
   not finite, or whose iteration or check fails, is marked in `handed_over`: another solver should take it. */
void eigenvalues(int n, ptrdiff_t count, const double *matrices, double *values, double *vectors, unsigned char *handed_over, lanes *work)
{
    ptrdiff_t size = (ptrdiff_t)n * n;
    struct room room = room_of(n, work, vectors != NULL);
    for (ptrdiff_t first = 0; first < count; first += LANES) {
        load_row(matrices, size, first, count, size, room.h);
        lanes scale;
        whole failed = solve(n, room, &scale);
        store_values(n, room, scale, failed, count - first, values + 2 * first * n, handed_over + first);
        if (!vectors) continue;
        store_vectors(n, room.z, room.x, room.v, vectors + 2 * first * size, count - first);
        for (ptrdiff_t k = first; k < first + LANES && k < count; k++)
            handed_over[k] |= miss_matrix(n, matrices + k * size, 1, values + 2 * k * n, vectors + 2 * k * size, (double *)room.v);
    }
}

/* Find the eigenvalues of equations of motion M, C, K (count, n, n) in first order, and their right vectors unless
   `vectors` is null. `held` are the coordinates whose displacement is a state. A mass matrix that elimination in the order
   of its rows would not solve well is handed over. `work` has room for 5 * states * states + 4 * states vectors of lanes,
   and for the equations. */
void roots_of_motion(int n, int count_held, const int32_t *held, ptrdiff_t count, const double *const *matrices, double *values, double *vectors, unsigned char *handed_over, lanes *work)
{
    int states = n + count_held;
    ptrdiff_t size = (ptrdiff_t)states * states;
    struct room room = room_of(states, work, vectors != NULL);
    lanes *h = room.h, *state_matrix = work + 4 * size + 4 * states, *equations = state_matrix + size;
    for (ptrdiff_t first = 0; first < count; first += LANES) {
        whole failed = find_state_matrix(n, count_held, held, first, count, matrices, equations, h);
        if (vectors) memcpy(state_matrix, h, size * sizeof(lanes));
        lanes scale;
        failed |= solve(states, room, &scale);
        store_values(states, room, scale, failed, count - first, values + 2 * first * states, handed_over + first);
        if (!vectors) continue;
        store_vectors(states, room.z, room.x, room.v, vectors + 2 * first * size, count - first);
        for (ptrdiff_t k = first; k < first + LANES && k < count; k++) {
            const double *own = (const double *)state_matrix + (k - first);
            handed_over[k] |= miss_matrix(states, own, LANES, values + 2 * k * states, vectors + 2 * k * size, (double *)room.v);
        }
    }
}
