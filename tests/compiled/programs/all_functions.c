/* Read matrices and equations of motion from files, and write what each function of proprotor.h finds. */

#include "proprotor.h"

#include <stdio.h>

enum { COUNT = 11, N = 5, MOTIONS = 5, STATES = 7 };

static int moved(int out, const char *name, void *numbers, size_t size)
{
    FILE *file = fopen(name, out ? "wb" : "rb");
    size_t done = !file ? 0 : out ? fwrite(numbers, 1, size, file) : fread(numbers, 1, size, file);
    return !file || fclose(file) || done != size;
}

int main(void)
{
    static double matrices[COUNT * N * N], motion[3][MOTIONS * N * N];
    static double values[2 * COUNT * N], vectors[2 * COUNT * N * N], roots[2 * MOTIONS * STATES];
    unsigned char handed_over[COUNT], rest[MOTIONS];
    int held[] = {0, 2};
    if (moved(0, "matrices.bin", matrices, sizeof matrices) || moved(0, "motion.bin", motion, sizeof motion)) return 1;
    if (proprotor_eigenvalues(N, COUNT, matrices, values, vectors, handed_over) != PROPROTOR_DONE) return 2;
    if (proprotor_roots_of_motion(N, 2, held, MOTIONS, motion[0], motion[1], motion[2], roots, rest) != PROPROTOR_DONE) return 3;
    return moved(1, "values.bin", values, sizeof values) || moved(1, "vectors.bin", vectors, sizeof vectors)
        || moved(1, "roots.bin", roots, sizeof roots) || moved(1, "handed_over.bin", handed_over, sizeof handed_over);
}
