/* Balance and matrices by the plans for rotors without linkages and drive train. */

#include "plain.h"

#define FOR(name) plain_##name

#include "points.h"
