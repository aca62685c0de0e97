/* The functions of proprotor.h for MATLAB and Octave:

       [values, handed_over, vectors] = proprotor_mex('eigenvalues', matrices)
       [values, handed_over] = proprotor_mex('roots_of_motion', mass, damping, stiffness, held)

   Matrices are pages, n by n by count. `values` has a column for each matrix, `vectors` a page with a vector in each
   column, and `handed_over` a logical number for each matrix: where it is true, use eig. `held` are the coordinates, from
   1, whose displacement is a state; without it all are. To build it, in MATLAB and in Octave:

       mex CFLAGS="$CFLAGS -O2 -std=gnu11 -march=native -ffp-contract=off" proprotor_mex.c proprotor.c
       setenv('CFLAGS', '-O2 -std=gnu11 -march=native -ffp-contract=off'); mkoctfile --mex proprotor_mex.c proprotor.c */

#include "mex.h"
#include "proprotor.h"

#include <string.h>

/* The pages of a real array of square matrices. */
struct pages {
    mwSize n, count;
    const double *numbers;
};

static struct pages pages_of(const mxArray *given)
{
    if (!mxIsDouble(given) || mxIsComplex(given) || mxIsSparse(given) || mxGetNumberOfDimensions(given) > 3)
        mexErrMsgIdAndTxt("proprotor:matrices", "matrices must be a full real array, n by n by count");
    const mwSize *sizes = mxGetDimensions(given);
    if (sizes[0] != sizes[1]) mexErrMsgIdAndTxt("proprotor:matrices", "matrices must be square");
    return (struct pages){sizes[0], mxGetNumberOfDimensions(given) > 2 ? sizes[2] : 1, mxGetPr(given)};
}

/* MATLAB has matrices column by column, C row by row. */
static double *row_by_row(struct pages given)
{
    mwSize n = given.n, size = n * n;
    double *found = mxMalloc((size * given.count + 1) * sizeof(double));
    for (mwSize page = 0; page < given.count; page++)
        for (mwSize row = 0; row < n; row++)
            for (mwSize column = 0; column < n; column++)
                found[page * size + row * n + column] = given.numbers[page * size + column * n + row];
    return found;
}

static double *room_for(mwSize numbers) { return mxMalloc((2 * numbers + 1) * sizeof(double)); }

/* A column of complex numbers for each matrix. */
static mxArray *columns_of(mwSize rows, mwSize count, const double *numbers)
{
    mxArray *found = mxCreateDoubleMatrix(rows, count, mxCOMPLEX);
    double *real = mxGetPr(found), *imaginary = mxGetPi(found);
    for (mwSize k = 0; k < rows * count; k++) real[k] = numbers[2 * k], imaginary[k] = numbers[2 * k + 1];
    return found;
}

/* Complex matrices that lie row by row, as pages. */
static mxArray *complex_pages(mwSize n, mwSize count, const double *numbers)
{
    mwSize sizes[] = {n, n, count};
    mxArray *found = mxCreateNumericArray(3, sizes, mxDOUBLE_CLASS, mxCOMPLEX);
    double *real = mxGetPr(found), *imaginary = mxGetPi(found);
    for (mwSize page = 0; page < count; page++)
        for (mwSize row = 0; row < n; row++)
            for (mwSize column = 0; column < n; column++) {
                mwSize here = (page * n + column) * n + row, there = (page * n + row) * n + column;
                real[here] = numbers[2 * there], imaginary[here] = numbers[2 * there + 1];
            }
    return found;
}

static void check(int code)
{
    if (code == PROPROTOR_BAD_SIZE) mexErrMsgIdAndTxt("proprotor:size", "1 to 256 states, and coordinates that exist");
    if (code == PROPROTOR_NO_MEMORY) mexErrMsgIdAndTxt("proprotor:memory", "not enough memory");
}

static void eigenvalues(int wanted, mxArray *found[], const mxArray *given)
{
    struct pages matrices = pages_of(given);
    mwSize n = matrices.n, count = matrices.count;
    double *values = room_for(n * count), *vectors = wanted > 2 ? room_for(n * n * count) : NULL;
    mxArray *handed_over = mxCreateLogicalMatrix(1, count);
    check(proprotor_eigenvalues((int)n, (long long)count, row_by_row(matrices), values, vectors, (unsigned char *)mxGetLogicals(handed_over)));
    found[0] = columns_of(n, count, values);
    if (wanted > 1) found[1] = handed_over;
    if (wanted > 2) found[2] = complex_pages(n, count, vectors);
}

static int *held_of(const mxArray *given, mwSize n, int *count)
{
    if (given && (!mxIsDouble(given) || mxIsComplex(given) || mxIsSparse(given)))
        mexErrMsgIdAndTxt("proprotor:held", "held must be the numbers of coordinates");
    *count = given ? (int)mxGetNumberOfElements(given) : (int)n;
    int *held = mxMalloc((*count + 1) * sizeof(int));
    for (int k = 0; k < *count; k++) {
        double place = given ? mxGetPr(given)[k] - 1 : k;
        held[k] = place >= 0 && place < n && place == (int)place ? (int)place : -1;
    }
    return held;
}

static void roots_of_motion(int wanted, mxArray *found[], int handed, const mxArray *given[])
{
    struct pages parts[3];
    for (int k = 0; k < 3; k++) {
        parts[k] = pages_of(given[k]);
        if (parts[k].n != parts[0].n || parts[k].count != parts[0].count)
            mexErrMsgIdAndTxt("proprotor:matrices", "mass, damping and stiffness must have one size");
    }
    mwSize n = parts[0].n, count = parts[0].count;
    int count_held, *held = held_of(handed > 3 ? given[3] : NULL, n, &count_held);
    double *values = room_for((n + count_held) * count);
    mxArray *handed_over = mxCreateLogicalMatrix(1, count);
    check(proprotor_roots_of_motion((int)n, count_held, held, (long long)count, row_by_row(parts[0]), row_by_row(parts[1]), row_by_row(parts[2]), values, (unsigned char *)mxGetLogicals(handed_over)));
    found[0] = columns_of(n + count_held, count, values);
    if (wanted > 1) found[1] = handed_over;
}

/* What is allocated here MATLAB frees when the function returns or fails. */
void mexFunction(int wanted, mxArray *found[], int handed, const mxArray *given[])
{
    char name[32] = "";
    if (handed > 0 && mxIsChar(given[0])) mxGetString(given[0], name, sizeof name);
    if (!strcmp(name, "eigenvalues") && handed == 2)
        eigenvalues(wanted, found, given[1]);
    else if (!strcmp(name, "roots_of_motion") && (handed == 4 || handed == 5))
        roots_of_motion(wanted, found, handed - 1, given + 1);
    else
        mexErrMsgIdAndTxt("proprotor:call", "proprotor_mex('eigenvalues', matrices) or proprotor_mex('roots_of_motion', mass, damping, stiffness, held)");
}
