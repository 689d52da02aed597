// What looks wrong about a drive once its friction is known: units, signs, the order of the wheels.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "identify/friction/friction_fit.h"
#include "robot/friction.h"

namespace heatsoak {

/// In sentences, said and not acted on. `drive` is that of the motor, where it is known.
std::vector<std::string> friction_suspicions(const SteadyParts& steady, const FrictionFit& fit, const Kinematics& kinematics,
                                             const std::optional<DriveConstants>& drive);

}  // namespace heatsoak
