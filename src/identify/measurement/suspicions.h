// What looks like a wrong unit, a wrong sign or swapped channels. Said to the user, never acted on.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "identify/measurement/quality.h"
#include "identify/measurement/recording.h"

namespace heatsoak {

std::vector<std::string> suspicions(const Recording& recording, std::span<const ChannelQuality> channels);

}  // namespace heatsoak
