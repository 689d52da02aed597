#include "robot/traction.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "robot/wheel_laws.h"

namespace heatsoak::robot {
namespace {

/// Computes loads of the wheels in `standing`, linear in the contact position; for three wheels they are determinate.
bool plane_loads(const WeightConfig& weight, const LoadMoment& moment, const std::array<bool, kMostWheels>& standing, PerWheel& force_N) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  for (int i = 0; i < weight.wheel_count; ++i) {
    if (standing[i]) {
      const Eigen::Vector3d row(1.0, weight.contact_x_m[i], weight.contact_y_m[i]);
      normal += row * row.transpose();
    }
  }
  const Eigen::Vector3d plane = normal.ldlt().solve(Eigen::Vector3d(weight.mass_kg * kGravity_m_per_s2, moment.x_Nm, moment.y_Nm));
  bool all_press = true;
  for (int i = 0; i < weight.wheel_count; ++i) {
    force_N[i] = standing[i] ? plane(0) + plane(1) * weight.contact_x_m[i] + plane(2) * weight.contact_y_m[i] : 0.0;
    all_press = all_press && force_N[i] >= 0.0;
  }
  return all_press;
}

void scale_to_weight(const WeightConfig& weight, PerWheel& force_N) {
  double sum_N = 0.0;
  for (double& each : force_N) {
    each = std::max(each, 0.0);
    sum_N += each;
  }
  for (double& each : force_N) {
    each *= sum_N > 0.0 ? weight.mass_kg * kGravity_m_per_s2 / sum_N : 0.0;
  }
}

/// Loads after lift-off: the wheel with the smallest load in the four-wheel solution is lifted.
NormalLoads loads_with_a_wheel_lifted(const WeightConfig& weight, const LoadMoment& moment, const PerWheel& all_N) {
  NormalLoads loads{all_N, true};
  if (weight.wheel_count == kMostWheels) {
    std::array<bool, kMostWheels> standing{true, true, true, true};
    standing[static_cast<std::size_t>(std::min_element(all_N.begin(), all_N.end()) - all_N.begin())] = false;
    if (plane_loads(weight, moment, standing, loads.force_N)) {
      return loads;
    }
  }
  loads.force_N = all_N;
  scale_to_weight(weight, loads.force_N);
  return loads;
}

}  // namespace

WeightConfig make_weight(const Kinematics& kinematics, double mass_kg, double height_m, double x_m, double y_m) {
  WeightConfig made;
  made.mass_kg = mass_kg;
  made.center_of_gravity_height_m = height_m;
  made.center_of_gravity_x_m = x_m;
  made.center_of_gravity_y_m = y_m;
  made.wheel_count = kinematics.wheel_count;
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  for (int i = 0; i < made.wheel_count; ++i) {
    made.contact_x_m[i] = kinematics.contact_radius_m * kinematics.wheels[i].axle_x_share;
    made.contact_y_m[i] = kinematics.contact_radius_m * kinematics.wheels[i].axle_y_share;
    const Eigen::Vector3d row(1.0, made.contact_x_m[i], made.contact_y_m[i]);
    normal += row * row.transpose();
  }
  const Eigen::Matrix3d inverse = normal.inverse();
  for (int i = 0; i < made.wheel_count; ++i) {
    const Eigen::Vector3d loads = inverse * Eigen::Vector3d(1.0, made.contact_x_m[i], made.contact_y_m[i]);
    made.level_share[i] = loads(0);
    made.along_x_per_m[i] = loads(1);
    made.along_y_per_m[i] = loads(2);
  }
  return made;
}

NormalLoads normal_loads(const WeightConfig& weight, const LoadMoment& moment) {
  const Wheels plane_N = plane_loads_N(weight, moment);
  const NormalLoads loads{per_wheel(plane_N), plane_N.minCoeff() < 0.0};
  return loads.lifted ? loads_with_a_wheel_lifted(weight, moment, loads.force_N) : loads;
}

}  // namespace heatsoak::robot
