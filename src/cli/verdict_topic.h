// The topic of `describe verdict`.
#pragma once

#include "cli/command.h"

namespace heatsoak {

Topic verdict_topic();

}  // namespace heatsoak
