// Detects temperatures whose response to heat is impossible for a motor: swapped channels, wrong sign.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "recording/quality.h"
#include "recording/recording.h"

namespace heatsoak::recording {

/// Returns sentences about temperatures that are probably swapped or have the wrong sign; empty if there are none.
std::vector<std::string> suspicious_places(const Recording& recording, std::span<const ChannelQuality> channels);

}  // namespace heatsoak::recording
