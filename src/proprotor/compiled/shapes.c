/* Motion of the coordinates in the modes of many points, one point after the other. */

#include <complex.h>
#include <math.h>
#include <stddef.h>
#include <stdint.h>

/* CMPLX of complex.h, which Clang does not have beside every C library. */
static inline double complex complex_of(double real, double imaginary)
{
    double complex found;
    __real__ found = real;
    __imag__ found = imaginary;
    return found;
}

/* Divide the motion of the coordinates by its largest component, which is then exactly one; NaN is not the largest. */
static void make_largest_one(int n, ptrdiff_t stride, double complex *motion)
{
    int largest = 0;
    double most = 0.0;
    for (int i = 0; i < n; i++) {
        double a = creal(motion[i * stride]), b = cimag(motion[i * stride]), size = a * a + b * b;
        if (size > most) most = size, largest = i;
    }
    double complex one = motion[largest * stride];
    if (isnan(creal(one)) || isnan(cimag(one))) one = NAN;
    /* The inverse with a scale that neither overflows nor vanishes. */
    double scale = fmax(fabs(creal(one)), fabs(cimag(one))), a = creal(one) / scale, b = cimag(one) / scale;
    double c = a / (a * a + b * b) / scale, d = -b / (a * a + b * b) / scale;
    for (int i = 0; i < n; i++) {
        double x = creal(motion[i * stride]), y = cimag(motion[i * stride]);
        motion[i * stride] = complex_of(x * c - y * d, x * d + y * c);
    }
    motion[largest * stride] = isnan(creal(one)) ? NAN : 1.0;
}

/* Find the motion (points, n, states) of n coordinates in the modes, each with its largest component one, by eigenvalues
   (points, states) and right vectors (points, states, states). `order` (points, states) says which mode comes where;
   `displaced` which state is the displacement of a coordinate, or is negative for one that has a rate alone. */
void coordinate_motions(ptrdiff_t points, int n, int states, const int32_t *displaced, const double complex *values, const double complex *right, const int64_t *order, double complex *found)
{
    for (ptrdiff_t point = 0; point < points; point++) {
        const double complex *vectors = right + point * states * states, *rates = vectors + (ptrdiff_t)(states - n) * states;
        for (int mode = 0; mode < states; mode++) {
            int64_t column = order[point * states + mode];
            double complex value = values[point * states + column], *motion = found + point * n * states + mode;
            double square = creal(value) * creal(value) + cimag(value) * cimag(value);
            for (int i = 0; i < n; i++) {
                double complex rate = rates[(ptrdiff_t)i * states + column];
                if (displaced[i] >= 0) motion[i * states] = vectors[(ptrdiff_t)displaced[i] * states + column];
                else motion[i * states] = square > 0.0 ? rate * conj(value) / square : NAN;
                if (isnan(square)) motion[i * states] = complex_of(NAN, 0.0);
            }
            make_largest_one(n, states, motion);
        }
    }
}
