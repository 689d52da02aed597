// `simulate --jerk-sweep`: effect of the jerk limit on slip, time, precision and heat.
#pragma once

#include <string>

#include "cli/command.h"
#include "simulate/core_drive.h"

namespace heatsoak {

ExitCode sweep_jerk(const Robot& robot, const Motor& motor, const DriveOptions& drive, const std::string& plot, Session& session);

}  // namespace heatsoak
