// Temperatures that look like kelvin, degrees Fahrenheit or tenths of degrees.
#pragma once

#include <string>
#include <vector>

#include "identify/measurement/recording.h"

namespace heatsoak {

/// `ambient_C`: of the air as the user states it, NaN where not; a recording's own goes before it.
std::vector<std::string> suspicious_scales(const Recording& recording, double ambient_C);

}  // namespace heatsoak
