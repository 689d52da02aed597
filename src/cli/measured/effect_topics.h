// What single runs of a measurement may deviate in.
#pragma once

#include <vector>

#include "cli/command.h"

namespace heatsoak {

std::vector<Topic> effect_topics();

}  // namespace heatsoak
