// The topic of `describe verdict`.
#pragma once

#include "cli/command.h"

namespace heatsoak::cli {

Topic verdict_topic();

}  // namespace heatsoak::cli
