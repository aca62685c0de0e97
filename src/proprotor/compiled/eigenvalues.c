/* Eigenvalues and right vectors of many small real matrices at once: one matrix in each lane of a vector register. */

#include "eigen.h"

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

/* Return whether the matrix times a combination of its vectors is not what the eigenvalues say; `room` for 4 * n. */
static unsigned char miss_matrix(int n, const double *matrix, const double *values, const double *vectors, double *room)
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
            double entry = matrix[(ptrdiff_t)i * n + j];
            a += entry * sum[2 * j], b += entry * sum[2 * j + 1];
            row += fabs(entry);
        }
        norm = fmax(norm, row);
        worst = fmax(worst, fmax(fabs(a - expected[2 * i]), fabs(b - expected[2 * i + 1])));
    }
    return !(worst <= 1e-13 * n * norm * fmax(size, 1.0));
}

/* Find the eigenvalues of `count` matrices of n rows, one after the other in memory, as complex numbers, and their right
   vectors as columns unless `vectors` is null. `work` has room for 4 * n * n + 4 * n vectors of lanes. A matrix that is
   not finite, or whose iteration or check fails, is marked in `handed_over`: another solver should take it. */
void eigenvalues(int n, ptrdiff_t count, const double *matrices, double *values, double *vectors, unsigned char *handed_over, lanes *work)
{
    ptrdiff_t size = (ptrdiff_t)n * n;
    lanes *h = work, *z = vectors ? h + size : NULL, *x = h + 2 * size, *wr = h + 4 * size, *wi = wr + n, *v = wi + n;
    for (ptrdiff_t first = 0; first < count; first += LANES) {
        for (int lane = 0; lane < LANES; lane++) {
            const double *matrix = matrices + size * (first + lane < count ? first + lane : first);
            for (ptrdiff_t k = 0; k < size; k++) ((double *)h)[k * LANES + lane] = matrix[k];
        }
        lanes most = {0}, square = {0};
        whole finite = every(-1);
        for (ptrdiff_t k = 0; k < size; k++) {
            most = larger(magnitude(h[k]), most);
            finite &= magnitude(h[k]) <= LARGEST; /* false for NaN */
        }
        finite &= (most >= SMALLEST) | (most == 0.0);
        whole failed = ~finite;
        lanes scale = power_of_two(-exponent(choose((most > 0.0) & finite, most, all(1.0))));
        lanes trace = {0}, trace_of_square = {0};
        for (ptrdiff_t k = 0; k < size; k++) {
            h[k] = choose(finite, h[k] * scale, all(0.0));
            square += h[k] * h[k];
        }
        for (int i = 0; i < n; i++) {
            trace += AT(i, i);
            for (int j = 0; j < n; j++) trace_of_square += AT(i, j) * AT(j, i);
        }
        for (int i = 0; i < n; i++) wr[i] = wi[i] = all(0.0);
        failed = schur(n, h, z, wr, wi, failed);
        failed |= miss_traces(n, wr, wi, trace, trace_of_square, root(square));
        lanes back = 1.0 / scale;
        for (int lane = 0; lane < LANES && first + lane < count; lane++) {
            for (int i = 0; i < n; i++) {
                values[2 * ((first + lane) * n + i)] = wr[i][lane] * back[lane];
                values[2 * ((first + lane) * n + i) + 1] = wi[i][lane] * back[lane];
            }
            handed_over[first + lane] = failed[lane] != 0;
        }
        if (!vectors) continue;
        ptrdiff_t matrices_left = count - first;
        triangular_vectors(n, h, wr, wi, x);
        store_vectors(n, z, x, v, vectors + 2 * first * size, matrices_left);
        for (ptrdiff_t k = first; k < first + LANES && k < count; k++)
            handed_over[k] |= miss_matrix(n, matrices + k * size, values + 2 * k * n, vectors + 2 * k * size, (double *)v);
    }
}
