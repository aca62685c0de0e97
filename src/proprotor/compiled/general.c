/* Balance and matrices by the plans for all rotors. */

#include "general.h"

#define FOR(name) general_##name

#include "points.h"
