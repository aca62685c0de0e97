/* Balance and matrices by the plans for all rotors. */

#include "general.h"

#define FOR(name) general_##name

/* Pitch that the linkages of the hinges take off. */
#define BY_HINGES(q) ((q)[Q_KINEMATIC_PITCH_FLAP_COUPLING] * (q)[Q_CONING] + (q)[Q_KINEMATIC_PITCH_LAG_COUPLING] * (q)[Q_LAG])

#include "points.h"
