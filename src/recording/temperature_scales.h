// Detects temperatures that are probably in kelvin, degrees Fahrenheit or tenths of degrees.
#pragma once

#include <string>
#include <vector>

#include "recording/recording.h"

namespace heatsoak {

/// Returns sentences about suspicious temperature scales. `ambient_C`: air temperature stated by the user, NaN if not stated; the
/// recording's own ambient temperature takes precedence.
std::vector<std::string> suspicious_scales(const Recording& recording, double ambient_C);

}  // namespace heatsoak
