/* Balance and matrices by the plans for rotors without linkages and drive train. */

#include "plain.h"

#define FOR(name) plain_##name

/* Pitch that the linkages of the hinges take off. */
#define BY_HINGES(q) all(0.0)

#include "points.h"
