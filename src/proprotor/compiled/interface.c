/* What programs in other languages call: sizes are checked, and memory is taken and given back. */

#include "proprotor.h"

#include "eigen.h"
#include "motion.h"

#include <stdlib.h>

static lanes *room_for(size_t vectors) { return aligned_alloc(sizeof(lanes), vectors * sizeof(lanes)); }

int proprotor_eigenvalues(int n, long long count, const double *matrices, double *values, double *vectors, unsigned char *handed_over)
{
    if (n < 1 || n > MOST_STATES || count < 0) return PROPROTOR_BAD_SIZE;
    lanes *room = room_for(4 * (size_t)n * n + 4 * (size_t)n);
    if (!room) return PROPROTOR_NO_MEMORY;
    eigenvalues(n, (ptrdiff_t)count, matrices, values, vectors, handed_over, room);
    free(room);
    return PROPROTOR_DONE;
}

int proprotor_roots_of_motion(int n, int count_held, const int *held, long long count, const double *mass, const double *damping, const double *stiffness, double *values, unsigned char *handed_over)
{
    if (n < 1 || count_held < 0 || count_held > n || n + count_held > MOST_STATES || count < 0) return PROPROTOR_BAD_SIZE;
    for (int k = 0; k < count_held; k++)
        if (held[k] < 0 || held[k] >= n) return PROPROTOR_BAD_SIZE;
    size_t states = (size_t)(n + count_held);
    lanes *room = room_for(5 * states * states + 4 * states + (size_t)n * (n + states));
    if (!room) return PROPROTOR_NO_MEMORY;
    const double *matrices[] = {mass, damping, stiffness};
    roots_of_motion(n, count_held, held, (ptrdiff_t)count, matrices, values, NULL, handed_over, room);
    free(room);
    return PROPROTOR_DONE;
}
