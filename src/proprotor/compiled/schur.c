/* Real Schur form of many small matrices, one in each lane.

   Balancing by powers of two, reduction to Hessenberg form by reflections, and the QR iteration with two shifts
   (Francis 1961), with the test for small subdiagonal entries of Ahues and Tisseur (1997). All lanes take the same steps
   over the rows that any of them still needs, and a reflection of a lane that has finished these rows changes nothing.
   No lane reads another, so a matrix has the same eigenvalues in any company. */

#include "eigen.h"

#define ITERATIONS 40 /* for each eigenvalue */
#define BALANCE_SWEEPS 6
#define PATIENCE 8 /* sweeps from the first row of a block before others are tried */
#define EXPONENT 0x7ff0000000000000 /* of a number, in place */
#define TWICE_ONE 0x7fe0000000000000 /* twice the exponent of one: less that of a power of two, it is that of its inverse */

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

/* Return where a subdiagonal entry of row k that is small beside the diagonal is as good as zero. */
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
    return (under <= bound) & (product <= larger(allowed, all(TINY)));
}

/* Set small subdiagonal entries to zero and find the first row of the last block of each lane. */
static void divide(int n, lanes *h, struct progress *at)
{
    int last = greatest(at->high);
    at->low = every(0);
    for (int k = 1; k <= last; k++) {
        lanes under = magnitude(AT(k, k - 1)), size = magnitude(AT(k - 1, k - 1)) + magnitude(AT(k, k));
        whole small = under <= TINY, doubtful = ((under <= EPSILON * size) | (size == 0.0)) & ~small & (at->high >= k);
        if (any(doubtful)) small |= doubtful & is_small(n, h, k);
        small &= at->high >= k;
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

/* Take the eigenvalues of a block of one or two rows of a lane. */
static void take_block(int n, double *h, double *z, int lane, ptrdiff_t low, ptrdiff_t high, double *real, double *imaginary)
{
    double *wr = real + high * LANES + lane, *wi = imaginary + high * LANES + lane;
    if (high == low) {
        *wr = OF_LANE(high, high);
        *wi = 0.0;
        return;
    }
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

/* Take the eigenvalues of blocks of one or two rows until the last block of each lane has more. */
static void take(int n, double *h, double *z, struct progress *at, double *real, double *imaginary)
{
    for (int lane = 0; lane < LANES; lane++) {
        ptrdiff_t low = at->low[lane], high = at->high[lane];
        if (high < 0 || high - low > 1) continue;
        while (high >= 0 && high - low <= 1) {
            take_block(n, h, z, lane, low, high, real, imaginary);
            low = high = low - 1;
            while (low > 0 && OF_LANE(low, low - 1) != 0.0) low--;
        }
        at->low[lane] = low;
        at->high[lane] = high;
        at->steps[lane] = 0;
    }
}

/* Where the sweep of each lane starts, what it makes of the subdiagonal entry there, and the column that it starts from. */
struct bulge {
    whole start;
    lanes before, a, b, c;
};

/* Begin a sweep in a lane: put the first column of the product with both shifts into the column before the block, or where
   there is none into `bulge`. A sweep starts at the first row of the block; where many did not help, after the last pair of
   small subdiagonal entries. */
static void start_lane(int n, double *h, const struct progress *at, int lane, struct bulge *bulge)
{
    int64_t low = at->low[lane], high = at->high[lane], m = at->steps[lane] < PATIENCE ? low : high - 2;
    /* The shifts as trace and determinant of a matrix of two rows: its four numbers. */
    double first = OF_LANE(high, high), second = OF_LANE(high - 1, high - 1), a, b, c;
    double product = OF_LANE(high, high - 1) * OF_LANE(high - 1, high);
    if (at->steps[lane] % 10 == 9) {
        double size = fabs(OF_LANE(high, high - 1)) + fabs(OF_LANE(high - 1, high - 2));
        first = second = 0.75 * size + first;
        product = -0.4375 * size * size;
    }
    for (;; m--) {
        double here = OF_LANE(m, m), next = OF_LANE(m + 1, m + 1), under = OF_LANE(m + 1, m);
        double to_first = first - here, to_second = second - here;
        a = to_first * to_second - product + OF_LANE(m, m + 1) * under;
        b = under * (next - here - to_first - to_second), c = under * OF_LANE(m + 2, m + 1);
        if (m == low) break;
        double size = fabs(OF_LANE(m - 1, m - 1)) + fabs(here) + fabs(next);
        if (fabs(OF_LANE(m, m - 1)) * (fabs(b) + fabs(c)) <= EPSILON * fabs(a) * size) break;
    }
    bulge->start[lane] = m;
    if (m == 0) {
        bulge->a[lane] = a, bulge->b[lane] = b, bulge->c[lane] = c;
        return;
    }
    if (m > low) bulge->before[lane] = OF_LANE(m, m - 1) * (b != 0.0 || c != 0.0 ? -fabs(a) / hypot(a, hypot(b, c)) : 1.0);
    OF_LANE(m, m - 1) = a, OF_LANE(m + 1, m - 1) = b, OF_LANE(m + 2, m - 1) = c;
}

/* A reflection I - (1, v1, v2)' * (factor, w1, w2) of two or three rows and columns. */
struct turn {
    int count;
    lanes factor, v1, v2, w1, w2;
};

/* Apply a reflection to vectors of two or three numbers `along` apart; the vectors are `across` apart. */
static inline void turn_vectors(const struct turn *turn, lanes *vector, ptrdiff_t along, ptrdiff_t across, int vectors)
{
    lanes factor = turn->factor, v1 = turn->v1, v2 = turn->v2, w1 = turn->w1, w2 = turn->w2, *end = vector + across * vectors;
    if (turn->count == 2)
        for (; vector != end; vector += across) {
            lanes sum = vector[0] + v1 * vector[along];
            vector[0] -= factor * sum, vector[along] -= w1 * sum;
        }
    else
        for (; vector != end; vector += across) {
            lanes sum = vector[0] + v1 * vector[along] + v2 * vector[2 * along];
            vector[0] -= factor * sum, vector[along] -= w1 * sum, vector[2 * along] -= w2 * sum;
        }
}

/* Find the reflection that moves the bulge on from row k, which turns the column before it into its first entry. Where the
   bulge of a lane is elsewhere there are zeros, and the reflection changes nothing. */
static inline struct turn next_turn(int n, lanes *h, const struct bulge *bulge, int last, int k)
{
    lanes head = bulge->a, b = bulge->b, c = bulge->c;
    if (k > 0) head = AT(k, k - 1), b = AT(k + 1, k - 1), c = k + 2 < n ? AT(k + 2, k - 1) : all(0.0);
    lanes rest = larger(magnitude(b), magnitude(c)), size = larger(magnitude(head), rest);
    whole needed = rest > 0.0;
    lanes scale = (lanes)((whole)size & EXPONENT), inverse = (lanes)(every(TWICE_ONE) - (whole)scale);
    lanes a = choose(needed, head * inverse, all(1.0));
    b *= inverse, c *= inverse;
    lanes length = -copy_sign(root(a * a + b * b + c * c), a), sum = a - length;
    lanes both = 1.0 / (length * sum), beside = both * length;
    struct turn found = {.count = k + 2 <= last ? 3 : 2};
    found.factor = choose(needed, -sum * sum * both, all(0.0));
    found.v1 = b * beside, found.v2 = c * beside;
    found.w1 = found.factor * found.v1, found.w2 = found.factor * found.v2;
    if (k > 0) {
        AT(k, k - 1) = choose(bulge->start == k, bulge->before, choose(needed, length * scale, head));
        AT(k + 1, k - 1) = all(0.0);
        if (k + 2 < n) AT(k + 2, k - 1) = all(0.0);
    }
    return found;
}

/* One sweep of both shifts through the block of each lane; for vectors z takes part, and all of the matrix. */
static void sweep(int n, lanes *h, lanes *z, struct progress *at)
{
    struct bulge bulge = {every(-1), {0}, {0}, {0}, {0}};
    whole active = at->high >= 0;
    for (int lane = 0; lane < LANES; lane++)
        if (active[lane]) start_lane(n, (double *)h, at, lane, &bulge);
    int last = greatest(at->high), first = least(pick(active, at->low, every(n)));
    int top = z ? 0 : first, end = z ? n - 1 : last;
    for (int k = least(pick(active, bulge.start, every(n))); k < last; k++) {
        struct turn turn = next_turn(n, h, &bulge, last, k);
        int bottom = k + 3 < last ? k + 3 : last;
        turn_vectors(&turn, &AT(k, k), n, 1, end - k + 1);
        turn_vectors(&turn, &AT(top, k), 1, n, bottom - top + 1);
        if (z) turn_vectors(&turn, z + k, 1, n, n);
    }
}

whole schur(int n, lanes *h, lanes *z, lanes *real, lanes *imaginary, whole failed)
{
    struct progress progress = {.failed = failed}, *at = &progress;
    if (z)
        for (ptrdiff_t k = 0; k < (ptrdiff_t)n * n; k++) z[k] = all(k % (n + 1) == 0 ? 1.0 : 0.0);
    balance(n, h, z);
    reduce(n, h, z);
    at->high = pick(at->failed, every(-1), every(n - 1));
    at->steps = every(0);
    while (any(at->high >= 0)) {
        divide(n, h, at);
        take(n, (double *)h, (double *)z, at, (double *)real, (double *)imaginary);
        whole tired = (at->high >= 0) & (at->steps >= ITERATIONS);
        at->failed |= tired;
        at->high = pick(tired, every(-1), at->high);
        if (any(at->high >= 0)) sweep(n, h, z, at);
        at->steps += 1;
    }
    return at->failed;
}
