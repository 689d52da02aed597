// Detects temperatures whose response to heat is impossible for a motor: swapped channels, wrong sign.
#pragma once

#include <span>
#include <vector>

#include "recording/findings.h"
#include "recording/quality.h"
#include "recording/recording.h"

namespace heatsoak::recording {

/// Returns the temperatures that are probably swapped or have the wrong sign.
std::vector<Suspicion> suspicious_places(const Recording& recording, std::span<const ChannelQuality> channels);

}  // namespace heatsoak::recording
