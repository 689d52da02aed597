// Detects temperatures that are probably in kelvin, degrees Fahrenheit or tenths of degrees.
#pragma once

#include <optional>
#include <vector>

#include "recording/findings.h"
#include "recording/recording.h"

namespace heatsoak::recording {

/// Returns the suspicious temperature scales. `ambient_C`: air temperature if the user states it; the
/// recording's own ambient temperature takes precedence.
std::vector<Suspicion> suspicious_scales(const Recording& recording, std::optional<double> ambient_C);

}  // namespace heatsoak::recording
