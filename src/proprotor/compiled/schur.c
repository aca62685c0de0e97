/* Real Schur form of many small matrices, one in each lane.

   Balancing by powers of two, reduction to Hessenberg form by reflections, and the QR iteration with two shifts
   (Francis 1961), with the test for small subdiagonal entries of Ahues and Tisseur (1997). All lanes take the same steps
   over the rows that any of them still needs, and a reflection of a lane that has finished these rows changes nothing.
   No lane reads another, so a matrix has the same eigenvalues in any company. */

#include "eigen.h"

#define ITERATIONS 40 /* for each eigenvalue */
#define BALANCE_SWEEPS 6

/* Apply the reflection I - factor * v * v' to vectors of `count` entries. */
static void reflect(lanes *first, ptrdiff_t along, ptrdiff_t across, int count, int vectors, const lanes *v, lanes factor)
{
    int vector = 0;
    for (; vector + 4 <= vectors; vector += 4) {
        lanes *a = first + vector * across, *b = a + across, *c = b + across, *d = c + across;
        lanes in_a = {0}, in_b = {0}, in_c = {0}, in_d = {0};
        for (int k = 0; k < count; k++) {
            in_a += v[k] * a[k * along];
            in_b += v[k] * b[k * along];
            in_c += v[k] * c[k * along];
            in_d += v[k] * d[k * along];
        }
        in_a *= factor, in_b *= factor, in_c *= factor, in_d *= factor;
        for (int k = 0; k < count; k++) {
            a[k * along] -= v[k] * in_a;
            b[k * along] -= v[k] * in_b;
            c[k * along] -= v[k] * in_c;
            d[k * along] -= v[k] * in_d;
        }
    }
    for (; vector < vectors; vector++) {
        lanes *a = first + vector * across;
        lanes in_a = {0};
        for (int k = 0; k < count; k++) in_a += v[k] * a[k * along];
        in_a *= factor;
        for (int k = 0; k < count; k++) a[k * along] -= v[k] * in_a;
    }
}

/* Scale row and column of each state by a power of two until both have about the same norm; the scales go into z. */
static void balance(int n, lanes *h, lanes *z)
{
    int changed = 1;
    whole spent[MOST_STATES];
    for (int i = 0; i < n; i++) spent[i] = every(0);
    for (int sweep = 0; changed && sweep < BALANCE_SWEEPS; sweep++) {
        changed = 0;
        for (int i = 0; i < n; i++) {
            lanes row = {0}, column = {0};
            for (int j = 0; j < n; j++) {
                row += AT(i, j) * AT(i, j);
                column += AT(j, i) * AT(j, i);
            }
            whole power = (exponent(row) - exponent(column)) / 4;
            whole wanted = (row > 0.0) & (column > 0.0) & (power != 0) & (spent[i] + power < 100) & (spent[i] + power > -100);
            if (!any(wanted)) continue;
            power &= wanted;
            changed = 1;
            spent[i] += power;
            lanes factor = power_of_two(power), inverse = power_of_two(-power);
            for (int j = 0; j < n; j++) AT(i, j) *= inverse;
            for (int j = 0; j < n; j++) AT(j, i) *= factor;
            if (z) z[(ptrdiff_t)i * n + i] *= factor;
        }
    }
}

/* Reduce to Hessenberg form; z, if there is one, takes the same reflections of its columns. */
static void reduce(int n, lanes *h, lanes *z)
{
    lanes v[MOST_STATES];
    for (int k = 0; k + 2 < n; k++) {
        lanes below = {0}, head = AT(k + 1, k);
        for (int i = k + 2; i < n; i++) below += AT(i, k) * AT(i, k);
        whole needed = below > 0.0;
        lanes length = -copy_sign(root(head * head + below), head);
        lanes factor = choose(needed, (length - head) / choose(needed, length, all(1.0)), all(0.0));
        lanes scale = 1.0 / choose(needed, head - length, all(1.0));
        v[0] = all(1.0);
        for (int i = k + 2; i < n; i++) {
            v[i - k - 1] = AT(i, k) * scale;
            AT(i, k) = all(0.0);
        }
        AT(k + 1, k) = choose(needed, length, head);
        reflect(&AT(k + 1, k + 1), n, 1, n - k - 1, n - k - 1, v, factor);
        reflect(&AT(0, k + 1), 1, n, n - k - 1, n, v, factor);
        if (z) reflect(z + k + 1, 1, n, n - k - 1, n, v, factor);
    }
}

/* Where each lane is: it works on the rows from `low` to `high`; a lane that has finished has a high of -1. */
struct progress {
    whole low, high, steps, failed;
};

/* Return where the subdiagonal entry of row k is as good as zero. */
static whole is_small(int n, const lanes *h, int k)
{
    lanes under = magnitude(AT(k, k - 1)), over = magnitude(AT(k - 1, k));
    lanes here = magnitude(AT(k, k)), apart = magnitude(AT(k - 1, k - 1) - AT(k, k));
    lanes size = here + magnitude(AT(k - 1, k - 1));
    lanes around = k >= 2 ? magnitude(AT(k - 1, k - 2)) : all(0.0);
    around += k + 1 < n ? magnitude(AT(k + 1, k)) : all(0.0);
    lanes bound = EPSILON * choose(size == 0.0, around, size);
    /* The product of both entries against the difference of the diagonal, without a division. */
    lanes most = larger(here, apart), least = smaller(here, apart);
    lanes product = larger(under, over) * smaller(under, over) * (most + larger(under, over));
    lanes allowed = EPSILON * least * most * (most + larger(under, over));
    whole conservative = (product <= larger(allowed, all(TINY)));
    return (under <= TINY) | ((under <= bound) & conservative);
}

/* Set small subdiagonal entries to zero and find the first row of the last block of each lane. */
static void divide(int n, lanes *h, struct progress *at)
{
    int last = greatest(at->high);
    at->low = every(0);
    for (int k = 1; k <= last; k++) {
        whole small = is_small(n, h, k) & (at->high >= k);
        AT(k, k - 1) = choose(small, all(0.0), AT(k, k - 1));
        at->low = pick(small, every(k), at->low);
    }
}

#define OF_LANE(row, column) h[((ptrdiff_t)(row) * n + (column)) * LANES + lane]

/* Turn two rows and columns of one lane so that a block with two real eigenvalues becomes triangular. */
static void make_triangular(int n, double *h, double *z, int lane, ptrdiff_t k, double length)
{
    double p = length, q = OF_LANE(k, k - 1), size = hypot(p, q);
    p /= size, q /= size;
    for (ptrdiff_t j = k - 1; j < n; j++) {
        double upper = OF_LANE(k - 1, j), lower = OF_LANE(k, j);
        OF_LANE(k - 1, j) = p * upper + q * lower;
        OF_LANE(k, j) = p * lower - q * upper;
    }
    for (ptrdiff_t i = 0; i <= k; i++) {
        double left = OF_LANE(i, k - 1), right = OF_LANE(i, k);
        OF_LANE(i, k - 1) = p * left + q * right;
        OF_LANE(i, k) = p * right - q * left;
    }
    OF_LANE(k, k - 1) = 0.0;
    h = z;
    for (ptrdiff_t i = 0; i < n; i++) {
        double left = OF_LANE(i, k - 1), right = OF_LANE(i, k);
        OF_LANE(i, k - 1) = p * left + q * right;
        OF_LANE(i, k) = p * right - q * left;
    }
}

/* Take the eigenvalues of blocks of one or two rows; return whether a lane had such a block. */
static int take(int n, double *h, double *z, struct progress *at, double *real, double *imaginary)
{
    int taken = 0;
    for (int lane = 0; lane < LANES; lane++) {
        ptrdiff_t high = at->high[lane];
        if (high < 0 || high - at->low[lane] > 1) continue;
        double *wr = real + high * LANES + lane, *wi = imaginary + high * LANES + lane;
        if (high == at->low[lane]) {
            *wr = OF_LANE(high, high);
            *wi = 0.0;
        } else {
            double d = OF_LANE(high, high), a = OF_LANE(high - 1, high - 1);
            double product = OF_LANE(high, high - 1) * OF_LANE(high - 1, high);
            double mean = 0.5 * (a - d), inside = mean * mean + product, length = sqrt(fabs(inside));
            if (inside >= 0.0) {
                length = mean + copysign(length, mean);
                wr[-LANES] = d + length;
                wr[0] = length != 0.0 ? d - product / length : d;
                wi[-LANES] = wi[0] = 0.0;
                if (z) make_triangular(n, h, z, lane, high, length);
            } else {
                wr[-LANES] = wr[0] = d + mean;
                wi[-LANES] = length;
                wi[0] = -length;
            }
        }
        at->high[lane] = at->low[lane] - 1;
        at->steps[lane] = 0;
        taken = 1;
    }
    return taken;
}

/* The two shifts as trace and determinant of a matrix of two rows: its four numbers. */
struct shifts {
    lanes first, second, product;
};

static struct shifts shifts_of(int n, const double *h, const struct progress *at)
{
    struct shifts found = {{0}, {0}, {0}};
    for (int lane = 0; lane < LANES; lane++) {
        int64_t high = at->high[lane];
        if (high < 2) continue;
        double first = OF_LANE(high, high), second = OF_LANE(high - 1, high - 1);
        double product = OF_LANE(high, high - 1) * OF_LANE(high - 1, high);
        if (at->steps[lane] % 10 == 9) {
            double size = fabs(OF_LANE(high, high - 1)) + fabs(OF_LANE(high - 1, high - 2));
            first = second = 0.75 * size + first;
            product = -0.4375 * size * size;
        }
        found.first[lane] = first;
        found.second[lane] = second;
        found.product[lane] = product;
    }
    return found;
}

/* Apply the reflection of two or three columns to some rows. */
static inline void turn_columns(lanes *row, ptrdiff_t n, int rows, int columns, lanes factor, lanes v1, lanes v2)
{
    lanes w1 = factor * v1, w2 = factor * v2;
    for (; rows > 0; rows--, row += n) {
        lanes sum = row[0] + v1 * row[1];
        if (columns == 3) sum += v2 * row[2];
        row[0] -= factor * sum, row[1] -= w1 * sum;
        if (columns == 3) row[2] -= w2 * sum;
    }
}

/* One sweep of both shifts through the block of each lane; for vectors z takes part, and all of the matrix. */
static void sweep(int n, lanes *h, lanes *z, struct progress *at)
{
    struct shifts shift = shifts_of(n, (const double *)h, at);
    whole active = at->high >= 0, start = at->low;
    int first = least(pick(active, at->low, every(n))), last = greatest(at->high);
    int top = z ? 0 : first, end = z ? n - 1 : last;
    lanes p = {0}, q = {0}, r = {0};
    /* Start after the last pair of small subdiagonal entries. */
    whole open = active;
    for (int m = last - 2; m >= first && any(open); m--) {
        whole inside = open & (m <= at->high - 2) & (m >= at->low);
        if (!any(inside)) continue;
        lanes here = AT(m, m), next = AT(m + 1, m + 1), under = AT(m + 1, m);
        lanes to_first = shift.first - here, to_second = shift.second - here;
        lanes new_p = to_first * to_second - shift.product + AT(m, m + 1) * under;
        lanes new_q = under * (next - here - to_first - to_second);
        lanes new_r = under * AT(m + 2, m + 1);
        p = choose(inside, new_p, p), q = choose(inside, new_q, q), r = choose(inside, new_r, r);
        start = pick(inside, every(m), start);
        whole begins = m == at->low;
        if (m > 0) {
            lanes left = magnitude(AT(m, m - 1)) * (magnitude(new_q) + magnitude(new_r));
            lanes right = magnitude(new_p) * (magnitude(AT(m - 1, m - 1)) + magnitude(here) + magnitude(next));
            begins |= left <= EPSILON * right;
        }
        open &= ~(inside & begins);
    }
    for (int k = least(pick(active, start, every(n))); k < last; k++) {
        whole at_start = start == k, works = active & (start <= k) & (k < at->high), three = works & (k + 1 < at->high);
        lanes a = p, b = q, c = r;
        if (k > 0) {
            a = choose(at_start, a, AT(k, k - 1)), b = choose(at_start, b, AT(k + 1, k - 1));
            c = choose(at_start, c, k + 2 < n ? AT(k + 2, k - 1) : all(0.0));
        }
        c = choose(three, c, all(0.0));
        lanes size = larger(magnitude(a), larger(magnitude(b), magnitude(c)));
        whole needed = works & (larger(magnitude(b), magnitude(c)) > 0.0);
        lanes scale = 1.0 / choose(needed, size, all(1.0));
        a *= scale, b *= scale, c *= scale;
        lanes length = -copy_sign(root(a * a + b * b + c * c), a);
        lanes factor = choose(needed, (length - a) / choose(needed, length, all(1.0)), all(0.0));
        lanes inverse = 1.0 / choose(needed, a - length, all(1.0));
        lanes v1 = choose(needed, b * inverse, all(0.0)), v2 = choose(needed, c * inverse, all(0.0));
        lanes w1 = factor * v1, w2 = factor * v2;
        if (k > 0) {
            whole chased = needed & ~at_start;
            AT(k, k - 1) = choose(chased, length * size, choose(needed, AT(k, k - 1) * (1.0 - factor), AT(k, k - 1)));
            AT(k + 1, k - 1) = choose(chased, all(0.0), AT(k + 1, k - 1));
            if (k + 2 < n) AT(k + 2, k - 1) = choose(chased, all(0.0), AT(k + 2, k - 1));
        }
        int bottom = k + 3 < last ? k + 3 : last;
        if (k + 2 <= last) {
            for (int j = k; j <= end; j++) {
                lanes sum = AT(k, j) + v1 * AT(k + 1, j) + v2 * AT(k + 2, j);
                AT(k, j) -= factor * sum, AT(k + 1, j) -= w1 * sum, AT(k + 2, j) -= w2 * sum;
            }
            turn_columns(&AT(top, k), n, bottom - top + 1, 3, factor, v1, v2);
            if (z) turn_columns(z + k, n, n, 3, factor, v1, v2);
        } else {
            for (int j = k; j <= end; j++) {
                lanes sum = AT(k, j) + v1 * AT(k + 1, j);
                AT(k, j) -= factor * sum, AT(k + 1, j) -= w1 * sum;
            }
            turn_columns(&AT(top, k), n, bottom - top + 1, 2, factor, v1, v2);
            if (z) turn_columns(z + k, n, n, 2, factor, v1, v2);
        }
    }
}

whole schur(int n, lanes *h, lanes *z, lanes *real, lanes *imaginary, whole failed)
{
    struct progress progress = {every(0), every(0), every(0), failed}, *at = &progress;
    if (z)
        for (ptrdiff_t k = 0; k < (ptrdiff_t)n * n; k++) z[k] = all(k % (n + 1) == 0 ? 1.0 : 0.0);
    balance(n, h, z);
    reduce(n, h, z);
    at->high = pick(at->failed, every(-1), every(n - 1));
    at->steps = every(0);
    while (any(at->high >= 0)) {
        divide(n, h, at);
        if (take(n, (double *)h, (double *)z, at, (double *)real, (double *)imaginary)) continue;
        whole tired = (at->high >= 0) & (at->steps >= ITERATIONS);
        at->failed |= tired;
        at->high = pick(tired, every(-1), at->high);
        if (any(at->high >= 0)) sweep(n, h, z, at);
        at->steps += 1;
    }
    return at->failed;
}
