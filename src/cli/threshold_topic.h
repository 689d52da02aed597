// Topics of `list` and `describe` for the thresholds of `check`.
#pragma once

#include <vector>

#include "cli/command.h"

namespace heatsoak::cli {

std::vector<Topic> threshold_topics();

}  // namespace heatsoak::cli
