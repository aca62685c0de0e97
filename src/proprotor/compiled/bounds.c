/* The bound of trim_bound.py for many points. */

#include "bounds.h"
#include "columns.h"

static void load_slopes(int size, const double *const *at, ptrdiff_t point, ptrdiff_t points, struct slopes *into)
{
    struct column full = {at[0], (ptrdiff_t)size * size, 1}, airloads = {at[1], (ptrdiff_t)size * size, 1};
    for (int i = 0; i < size; i++)
        for (int j = 0; j < size; j++) {
            into->full[i][j] = load(&full, point, points, i * size + j);
            into->airloads[i][j] = load(&airloads, point, points, i * size + j);
        }
}

static void store_answers(whole answers, unsigned char *found, ptrdiff_t point, ptrdiff_t points)
{
    for (int lane = 0; lane < LANES && point + lane < points; lane++) found[point + lane] = answers[lane] != 0;
}

/* Find which points with slopes (points, size, size) at the undeflected blade and at a trim have one path between both.
   Slopes are those with all of the airloads, and the part of the airloads; `sprung` says which rows are flap and lag. */
void lead_to_end(ptrdiff_t points, int size, const unsigned char *sprung, const double *const *before, const double *const *after, unsigned char *found)
{
    for (ptrdiff_t point = 0; point < points; point += LANES) {
        struct slopes first, last;
        load_slopes(size, before, point, points, &first);
        load_slopes(size, after, point, points, &last);
        store_answers(have_one_path(size, sprung, every(-1), &first, &last), found, point, points);
    }
}

/* Find which slopes (points, size, size) are so near to those expected that one trim has both. */
void near_each_other(ptrdiff_t points, int size, const unsigned char *sprung, const double *const *slopes, const double *const *expected, unsigned char *found)
{
    for (ptrdiff_t point = 0; point < points; point += LANES) {
        struct slopes here, there;
        load_slopes(size, slopes, point, points, &here);
        load_slopes(size, expected, point, points, &there);
        store_answers(have_one_trim(size, sprung, every(-1), &here, &there), found, point, points);
    }
}
