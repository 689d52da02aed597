// Friction torques of a robot's wheels by the law of the plant.
#pragma once

#include "robot/wheel_laws.h"

namespace heatsoak::robot {

/// Returns the friction torque of each wheel, with the sign of its speed.
inline PerWheel friction_torques_Nm(const FrictionConfig& friction, const Kinematics& kinematics, const BodyVelocity& local,
                                    const PerWheel& wheel_speed_rad_per_s) {
  const Wheels speed_rad_per_s = as_wheels(wheel_speed_rad_per_s);
  return per_wheel(friction_torque_Nm(friction, dry_friction_Nm(friction, wheel_arrays(kinematics), local),
                                      smooth_sign(speed_rad_per_s, friction.smoothing_rad_per_s), speed_rad_per_s));
}

}  // namespace heatsoak::robot
