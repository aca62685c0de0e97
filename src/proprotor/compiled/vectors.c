/* Vectors of a block triangular matrix by substitution, and in the states of the matrix itself. */

#include "eigen.h"

void triangular_vectors(int n, const lanes *h, const lanes *real, const lanes *imaginary, lanes *x)
{
    lanes smallest = {0};
    for (int i = 0; i < n; i++)
        for (int j = i > 0 ? i - 1 : 0; j < n; j++) smallest = larger(smallest, magnitude(AT(i, j)));
    smallest = larger(EPSILON * smallest, all(1e-70)); /* the fourth power must be a number */
    for (int k = 0; k < n; k++) {
        lanes *a = x + (ptrdiff_t)k * n, *b = a + (ptrdiff_t)n * n; /* real and imaginary part */
        lanes wr = real[k], wi = imaginary[k];
        for (int i = 0; i < n; i++) a[i] = b[i] = all(0.0);
        /* A block of two rows starts at `first`, one row at k. */
        whole second = k > 0 ? (whole)(AT(k, k - 1) != 0.0) : every(0);
        whole first = k + 1 < n ? (whole)(AT(k + 1, k) != 0.0) : every(0);
        a[k] = choose(first | second, all(0.0), all(1.0));
        if (any(second)) {
            a[k] = choose(second, AT(k, k - 1), a[k]);
            a[k - 1] = choose(second, 0.5 * (AT(k - 1, k - 1) - AT(k, k)), a[k - 1]);
            b[k - 1] = choose(second, wi, b[k - 1]);
        }
        if (any(first)) {
            a[k + 1] = choose(first, AT(k + 1, k), a[k + 1]);
            a[k] = choose(first, 0.5 * (AT(k, k) - AT(k + 1, k + 1)), a[k]);
            b[k] = choose(first, wi, b[k]);
        }
        int last = any(first) ? k + 1 : k;
        whole begun = first | ~second; /* lanes whose next row is k - 1; the others go on at k - 2 */
        lanes kept_a = {0}, kept_b = {0};
        whole waits = every(0);
        for (int i = k - 1; i >= 0; i--) {
            whole works = i == k - 1 ? begun : every(-1);
            if (!any(works)) continue;
            lanes right_a = {0}, right_b = {0};
            for (int j = i + 1; j <= last; j++) {
                right_a -= AT(i, j) * a[j];
                right_b -= AT(i, j) * b[j];
            }
            lanes da = AT(i, i) - wr, db = -wi;
            whole below = works & (i > 0 ? (whole)(AT(i, i > 0 ? i - 1 : 0) != 0.0) : every(0));
            /* One row: x = right / (here - root), a divisor that is too small replaced. */
            lanes size = da * da + db * db;
            whole none = size < smallest * smallest;
            lanes ca = choose(none, smallest, da), cb = choose(none, all(0.0), db), cs = choose(none, smallest * smallest, size);
            lanes xa = (right_a * ca + right_b * cb) / cs, xb = (right_b * ca - right_a * cb) / cs;
            if (any(waits)) {
                /* Two rows, this one and the one below it, by Cramer's rule. */
                lanes ea = AT(i + 1, i + 1) - wr, eb = -wi, over = AT(i, i + 1), under = AT(i + 1, i);
                lanes ta = da * ea - db * eb - over * under, tb = da * eb + db * ea, ts = ta * ta + tb * tb;
                whole flat = ts < smallest * smallest * smallest * smallest;
                ta = choose(flat, smallest * smallest, ta), tb = choose(flat, all(0.0), tb);
                ts = choose(flat, ta * ta, ts);
                lanes na = ea * right_a - eb * right_b - over * kept_a, nb = ea * right_b + eb * right_a - over * kept_b;
                lanes ma = da * kept_a - db * kept_b - under * right_a, mb = da * kept_b + db * kept_a - under * right_b;
                xa = choose(waits, (na * ta + nb * tb) / ts, xa), xb = choose(waits, (nb * ta - na * tb) / ts, xb);
                a[i + 1] = choose(waits, (ma * ta + mb * tb) / ts, a[i + 1]);
                b[i + 1] = choose(waits, (mb * ta - ma * tb) / ts, b[i + 1]);
            }
            kept_a = right_a, kept_b = right_b;
            a[i] = choose(works & ~below, xa, a[i]), b[i] = choose(works & ~below, xb, b[i]);
            waits = below;
            whole large = larger(magnitude(a[i]), magnitude(b[i])) > 1e100;
            if (any(large)) {
                lanes scale = choose(large, all(1e-100), all(1.0));
                kept_a *= scale, kept_b *= scale;
                for (int j = i; j <= last; j++) a[j] *= scale, b[j] *= scale;
            }
        }
    }
}

void store_vectors(int n, const lanes *z, const lanes *x, lanes *v, double *vectors, ptrdiff_t matrices)
{
    lanes *va = v, *vb = v + n;
    for (int k = 0; k < n; k++) {
        const lanes *a = x + (ptrdiff_t)k * n, *b = a + (ptrdiff_t)n * n;
        int last = k + 1 < n ? k + 1 : k;
        lanes most = {0}, square = {0};
        for (int i = 0; i < n; i++) {
            lanes sum_a = {0}, sum_b = {0};
            for (int j = 0; j <= last; j++) {
                sum_a += z[(ptrdiff_t)i * n + j] * a[j];
                sum_b += z[(ptrdiff_t)i * n + j] * b[j];
            }
            va[i] = sum_a, vb[i] = sum_b;
            most = larger(larger(magnitude(sum_a), magnitude(sum_b)), most);
        }
        lanes scale = 1.0 / choose(most > 0.0, most, all(1.0));
        for (int i = 0; i < n; i++) {
            va[i] *= scale, vb[i] *= scale;
            square += va[i] * va[i] + vb[i] * vb[i];
        }
        scale = 1.0 / root(square);
        for (int lane = 0; lane < LANES && lane < matrices; lane++) {
            double *column = vectors + 2 * ((ptrdiff_t)lane * n * n + k);
            for (int i = 0; i < n; i++) {
                column[2 * (ptrdiff_t)i * n] = va[i][lane] * scale[lane];
                column[2 * (ptrdiff_t)i * n + 1] = vb[i][lane] * scale[lane];
            }
        }
    }
}

