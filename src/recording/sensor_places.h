// Detects temperatures whose response to heat is impossible for a motor: swapped channels, wrong sign.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "recording/quality.h"
#include "recording/recording.h"

namespace heatsoak::recording {

std::vector<std::string> suspicious_places(const Recording& recording, std::span<const ChannelQuality> channels);

}  // namespace heatsoak::recording
