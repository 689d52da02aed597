// Plausibility checks after the friction fit: units, signs, order of the wheels.
#pragma once

#include <optional>
#include <vector>

#include "friction/findings.h"
#include "friction/friction_fit.h"
#include "robot/friction.h"

namespace heatsoak::friction {

/// Returns implausible results; nothing is corrected. `drive`: constants of the motor, if known.
std::vector<FrictionSuspicion> friction_suspicions(const SteadyParts& steady, const FrictionFit& fit, const robot::Kinematics& kinematics,
                                                   const std::optional<robot::DriveConstants>& drive);

}  // namespace heatsoak::friction
