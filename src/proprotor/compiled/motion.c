/* Equations of motion of many points: on a support, and solved for the accelerations. */

#include "motion.h"

#include "columns.h"

#define CLEARLY_MASS 1e-6 /* of massless.py: a pivot of M + its transpose, in its diagonal */
#define LARGEST_FACTOR 10.0 /* of a row that is taken off another, rows scaled to a largest entry of one */

void load_equations(int n, int count_held, const int32_t *held, ptrdiff_t first, ptrdiff_t count, const double *const *matrices, lanes *equations)
{
    int wide = 2 * n + count_held;
    for (int lane = 0; lane < LANES; lane++) {
        ptrdiff_t start = (first + lane < count ? first + lane : count - 1) * n * n;
        const double *mass = matrices[0] + start, *damping = matrices[1] + start, *stiffness = matrices[2] + start;
        for (int i = 0; i < n; i++) {
            double *row = (double *)(equations + (ptrdiff_t)i * wide) + lane;
            for (int j = 0; j < n; j++) row[j * LANES] = mass[i * n + j];
            for (int j = 0; j < count_held; j++) row[(n + j) * LANES] = stiffness[i * n + held[j]];
            for (int j = 0; j < n; j++) row[(n + count_held + j) * LANES] = damping[i * n + j];
        }
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

#define HUB 6 /* coordinates of a hub, the first of a rotor alone */
#define MOST 64

/* Put a matrix (points, size, columns) of a rotor alone on a support with `modes` coordinates, whose hub moves by `hub`
   (6, modes): its rows, and its columns too if these are coordinates, not inputs. The support's own matrix is added. */
static void put_on_support(ptrdiff_t points, int size, int columns, int modes, int are_inputs, const double *rotor, const struct column *hub, const struct column *addition, double *found)
{
    int others = size - HUB, rows = modes + others, moved = are_inputs ? 0 : HUB, first = are_inputs ? 0 : modes;
    int wide = first + columns - moved;
    struct column own = {rotor, (ptrdiff_t)size * columns, 1};
    for (ptrdiff_t point = 0; point < points; point += LANES) {
        lanes motion[HUB * MOST], at_hub[HUB * MOST];
        for (int k = 0; k < HUB * modes; k++) motion[k] = load(hub, point, points, k);
        for (int i = 0; i < size; i++) {
            lanes row[MOST];
            for (int j = 0; j < first; j++) row[j] = all(0.0);
            for (int k = 0; k < moved; k++) {
                lanes here = load(&own, point, points, (ptrdiff_t)i * columns + k);
                for (int j = 0; j < first; j++) row[j] += here * motion[k * modes + j];
            }
            for (int j = first; j < wide; j++) row[j] = load(&own, point, points, (ptrdiff_t)i * columns + moved + j - first);
            for (int j = 0; j < wide; j++) {
                if (i < HUB) at_hub[i * MOST + j] = row[j];
                else store(row[j], found + (ptrdiff_t)(modes + i - HUB) * wide + j, (ptrdiff_t)rows * wide, point, points);
            }
        }
        for (int i = 0; i < modes; i++)
            for (int j = 0; j < wide; j++) {
                lanes sum = j < first ? load(addition, point, points, (ptrdiff_t)i * modes + j) : all(0.0);
                for (int k = 0; k < HUB; k++) sum += motion[k * modes + i] * at_hub[k * MOST + j];
                store(sum, found + (ptrdiff_t)i * wide + j, (ptrdiff_t)rows * wide, point, points);
            }
    }
}

/* Matrices M, C, K (points, size, size) and, unless it is null, B (points, size, inputs) of a rotor alone on a support,
   with the support's own M, C, K added: (points, modes + size - 6, ...). */
void on_support(ptrdiff_t points, int size, int modes, int inputs, const double *const *rotor, const struct column *hub, const struct column *additions, double *const *found)
{
    for (int k = 0; k < 3; k++) put_on_support(points, size, size, modes, 0, rotor[k], hub, &additions[k], found[k]);
    if (rotor[3]) put_on_support(points, size, inputs, modes, 1, rotor[3], hub, 0, found[3]);
}

/* Find in which mass matrices (points, n, n) every motion has mass for certain, by the pivots of M + its transpose. `rows`
   has room for n * n. */
void have_mass(ptrdiff_t points, int n, const double *mass, unsigned char *found, lanes *rows)
{
    struct column own = {mass, (ptrdiff_t)n * n, 1};
    for (ptrdiff_t point = 0; point < points; point += LANES) {
        whole certain = every(-1);
        for (int i = 0; i < n; i++)
            for (int j = 0; j <= i; j++)
                rows[i * n + j] = load(&own, point, points, i * n + j) + load(&own, point, points, j * n + i);
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
            certain &= pivot > CLEARLY_MASS * rows[k * n + k]; /* false for NaN */
            rows[k * n + k] = 1.0 / pivot;
        }
        for (int lane = 0; lane < LANES && point + lane < points; lane++) found[point + lane] = certain[lane] != 0;
    }
}
