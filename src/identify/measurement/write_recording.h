// A recording as canonical CSV, for other programs and for keeping.
#pragma once

#include <string>

#include "identify/measurement/recording.h"

namespace heatsoak {

/// Every channel in its unit with all of its digits, a blank cell where it is left out. Motor and conditions stand in comments.
std::string to_canonical_csv(const Recording& recording);

}  // namespace heatsoak
