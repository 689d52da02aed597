// Verdicts: what `describe verdict` says.
#pragma once

#include "cli/command.h"

namespace heatsoak {

Topic verdict_topic();

}  // namespace heatsoak
