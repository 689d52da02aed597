// Topics of `list` and `describe` for effects that are not part of the thermal network.
#pragma once

#include <vector>

#include "cli/command.h"

namespace heatsoak::cli {

/// Returns all topics: sensor effects and those of the commands.
std::vector<Topic> all_topics();

}  // namespace heatsoak::cli
