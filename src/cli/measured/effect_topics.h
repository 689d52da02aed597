// What only measurements can have: errors of sensors, and what a run may deviate in.
#pragma once

#include <vector>

#include "cli/command.h"

namespace heatsoak {

std::vector<Topic> effect_topics();

}  // namespace heatsoak
