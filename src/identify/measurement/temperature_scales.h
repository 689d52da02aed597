// Temperatures that look like kelvin, degrees Fahrenheit or tenths of degrees.
#pragma once

#include <string>
#include <vector>

#include "identify/measurement/recording.h"

namespace heatsoak {

std::vector<std::string> suspicious_scales(const Recording& recording);

}  // namespace heatsoak
