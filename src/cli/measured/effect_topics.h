// Help topics of `describe` about effects that exist in single runs only.
#pragma once

#include <vector>

#include "cli/command.h"

namespace heatsoak::cli {

std::vector<Topic> effect_topics();

}  // namespace heatsoak::cli
