// Topics of the deviations that single runs of a measurement may have.
#pragma once

#include <vector>

#include "cli/command.h"

namespace heatsoak::cli {

std::vector<Topic> effect_topics();

}  // namespace heatsoak::cli
