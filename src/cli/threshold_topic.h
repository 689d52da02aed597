// Thresholds of `check`: what `list` and `describe` say of them.
#pragma once

#include <vector>

#include "cli/command.h"

namespace heatsoak {

std::vector<Topic> threshold_topics();

}  // namespace heatsoak
