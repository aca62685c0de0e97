/* The steps to eigenvalues and vectors of one real matrix in each lane: n * n vectors of lanes, row by row. */

#ifndef EIGEN_H
#define EIGEN_H

#include "lanes.h"

#include <stddef.h>

#define MOST_STATES 256
#define AT(row, column) h[(ptrdiff_t)(row) * n + (column)]

/* Make h block triangular with blocks of one or two rows, and find its eigenvalues. z, if there is one, becomes the
   matrix of the change of states. Return the lanes whose iteration does not end. */
whole schur(int n, lanes *h, lanes *z, lanes *real, lanes *imaginary, whole failed);

/* Find the vectors of a block triangular matrix: x (2 * n * n), real parts and imaginary parts, a row for each vector. */
void triangular_vectors(int n, const lanes *h, const lanes *real, const lanes *imaginary, lanes *x);

/* Store the vectors z * x, each of length one, as columns of complex matrices; `v` has room for 2 * n. */
void store_vectors(int n, const lanes *z, const lanes *x, lanes *v, double *vectors, ptrdiff_t matrices);

/* Eigenvalues and right vectors of matrices, and of equations of motion, see eigenvalues.c. */
void eigenvalues(int n, ptrdiff_t count, const double *matrices, double *values, double *vectors, unsigned char *handed_over, lanes *work);
void roots_of_motion(int n, int count_held, const int32_t *held, ptrdiff_t count, const double *const *matrices, double *values, double *vectors, unsigned char *handed_over, lanes *work);

#endif
