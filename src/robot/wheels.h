// Values of all wheels as one array, so that a law is evaluated for all of them at once.
#pragma once

#include <Eigen/Core>

#include "robot/kinematics.h"

namespace heatsoak::robot {

/// One value per wheel with element-wise arithmetic. The fourth value is 0 for a robot with three wheels, as in PerWheel.
using Wheels = Eigen::Array<double, kMostWheels, 1>;

inline Eigen::Map<const Wheels> as_wheels(const PerWheel& values) { return Eigen::Map<const Wheels>(values.data()); }
inline Eigen::Map<Wheels> as_wheels(PerWheel& values) { return Eigen::Map<Wheels>(values.data()); }

inline PerWheel per_wheel(const Wheels& values) { return {values[0], values[1], values[2], values[3]}; }

/// Directions of all wheels; 0 for a missing wheel.
struct WheelArrays {
  Wheels rolling_x_share;
  Wheels rolling_y_share;
  Wheels axle_x_share;
  Wheels axle_y_share;
  Wheels arm_m;          ///< contact radius
  Wheels present_share;  ///< 1 for an existing wheel, else 0
};
inline WheelArrays wheel_arrays(const Kinematics& kinematics) {
  const auto& w = kinematics.wheels;
  const Wheels present_share(1.0, 1.0, 1.0, kinematics.wheel_count == kMostWheels ? 1.0 : 0.0);
  return {{w[0].rolling_x_share, w[1].rolling_x_share, w[2].rolling_x_share, w[3].rolling_x_share},
          {w[0].rolling_y_share, w[1].rolling_y_share, w[2].rolling_y_share, w[3].rolling_y_share},
          {w[0].axle_x_share, w[1].axle_x_share, w[2].axle_x_share, w[3].axle_x_share},
          {w[0].axle_y_share, w[1].axle_y_share, w[2].axle_y_share, w[3].axle_y_share},
          kinematics.contact_radius_m * present_share,
          present_share};
}

}  // namespace heatsoak::robot
