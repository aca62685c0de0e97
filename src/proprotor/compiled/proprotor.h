/* Eigenvalues of many small matrices, and roots of many equations of motion, for programs in C, Fortran or MATLAB.

   Matrices lie one after the other, row by row. A complex number is two doubles, real and imaginary part. Each function
   returns PROPROTOR_DONE, or why nothing was computed. `handed_over` tells for each matrix whether another solver, such as
   LAPACK's dgeev, should take it: 1 for a matrix that is not finite, too large or too small, or whose check failed; its
   results mean nothing. No matrix changes the results of another. */

#ifndef PROPROTOR_H
#define PROPROTOR_H

#ifdef __cplusplus
extern "C" {
#endif

enum { PROPROTOR_DONE, PROPROTOR_BAD_SIZE, PROPROTOR_NO_MEMORY };

/* Eigenvalues (count, n) of matrices (count, n, n), 1 <= n <= 256, and right vectors of length one as the columns of
   `vectors` (count, n, n), unless that is a null pointer. */
int proprotor_eigenvalues(int n, long long count, const double *matrices, double *values, double *vectors, unsigned char *handed_over);

/* Roots (count, n + count_held) of M x'' + C x' + K x = 0, matrices (count, n, n), n + count_held <= 256. `held` are the
   coordinates, from 0, whose displacement is a state; the columns of K of the others are not read. Such a coordinate has
   a rate alone. A mass matrix that needs an exchange of rows is handed over. */
int proprotor_roots_of_motion(int n, int count_held, const int *held, long long count, const double *mass, const double *damping, const double *stiffness, double *values, unsigned char *handed_over);

#ifdef __cplusplus
}
#endif

#endif
