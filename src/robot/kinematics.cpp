#include "robot/kinematics.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>

namespace heatsoak::robot {
namespace {

struct Rotated {
  double x;
  double y;
};

Rotated rotated(double x, double y, double angle_rad) {
  const double cosine = std::cos(angle_rad);
  const double sine = std::sin(angle_rad);
  return {cosine * x - sine * y, sine * x + cosine * y};
}

}  // namespace

BodyVelocity to_global(const BodyVelocity& local, double yaw_rad) {
  const Rotated turned = rotated(local.x_m_per_s, local.y_m_per_s, yaw_rad);
  return {turned.x, turned.y, local.yaw_rad_per_s};
}

BodyVelocity to_local(const BodyVelocity& global, double yaw_rad) { return to_global(global, -yaw_rad); }

BodyAcceleration to_global(const BodyAcceleration& local, double yaw_rad) {
  const Rotated turned = rotated(local.x_m_per_s2, local.y_m_per_s2, yaw_rad);
  return {turned.x, turned.y, local.yaw_rad_per_s2};
}

BodyAcceleration to_local(const BodyAcceleration& global, double yaw_rad) { return to_global(global, -yaw_rad); }

Wrench to_global(const Wrench& local, double yaw_rad) {
  const Rotated turned = rotated(local.x_N, local.y_N, yaw_rad);
  return {turned.x, turned.y, local.yaw_Nm};
}

Wrench to_local(const Wrench& global, double yaw_rad) { return to_global(global, -yaw_rad); }

BodyAcceleration acceleration_from_rates(const BodyVelocity& local, const BodyAcceleration& rates) {
  return {rates.x_m_per_s2 - local.yaw_rad_per_s * local.y_m_per_s, rates.y_m_per_s2 + local.yaw_rad_per_s * local.x_m_per_s,
          rates.yaw_rad_per_s2};
}

Kinematics make_kinematics(const Robot& robot) {
  const std::size_t count = robot.wheels.axis_rad.size();
  if (count < 3 || count > kMostWheels) {
    throw base::bad_input({robot.file.string()}, "wheels.axis_angles",
                          fmt::format("names {} wheels; a motion can be calculated for three or four", count));
  }
  Kinematics made;
  made.wheel_count = static_cast<int>(count);
  made.wheel_radius_m = robot.wheels.radius_m;
  made.contact_radius_m = robot.wheels.contact_radius_m;
  // The yaw column is divided by the contact radius to keep the matrix well scaled.
  Eigen::MatrixX3d jacobian(count, 3);
  for (std::size_t i = 0; i < count; ++i) {
    const double cosine = std::cos(robot.wheels.axis_rad[i]);
    const double sine = std::sin(robot.wheels.axis_rad[i]);
    made.wheels[i] = {cosine, sine, -sine, cosine};
    jacobian.row(static_cast<Eigen::Index>(i)) << -sine, cosine, 1.0;
  }
  // A usual robot has a condition number of a few; axles that differ by milliradians only have about a thousand.
  constexpr double kWorstCondition = 1e3;
  const Eigen::Vector3d squares = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(jacobian.transpose() * jacobian).eigenvalues();
  if (!(squares(2) <= kWorstCondition * kWorstCondition * squares(0))) {
    throw base::bad_input({robot.file.string()}, "wheels.axis_angles",
                          "leave a motion that no wheel can drive, or hardly; expected at least three clearly different angles");
  }
  const Eigen::Matrix3Xd inverse = jacobian.completeOrthogonalDecomposition().pseudoInverse();
  for (std::size_t i = 0; i < count; ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    made.inverse_x_factor[i] = inverse(0, column);
    made.inverse_y_factor[i] = inverse(1, column);
    made.inverse_yaw_per_m[i] = inverse(2, column) / made.contact_radius_m;
  }
  if (count == kMostWheels) {
    const Eigen::Matrix4d inner = Eigen::Matrix4d::Identity() - jacobian * inverse;
    Eigen::Index longest = 0;
    inner.colwise().squaredNorm().maxCoeff(&longest);
    Eigen::Vector4d::Map(made.inner_share.data()) = inner.col(longest).normalized();
  }
  return made;
}

BodyVelocity body_velocity(const Kinematics& kinematics, const PerWheel& wheel_speed_rad_per_s) {
  BodyVelocity velocity;
  for (int i = 0; i < kinematics.wheel_count; ++i) {
    const double rim_m_per_s = kinematics.wheel_radius_m * wheel_speed_rad_per_s[i];
    velocity.x_m_per_s += kinematics.inverse_x_factor[i] * rim_m_per_s;
    velocity.y_m_per_s += kinematics.inverse_y_factor[i] * rim_m_per_s;
    velocity.yaw_rad_per_s += kinematics.inverse_yaw_per_m[i] * rim_m_per_s;
  }
  return velocity;
}

}  // namespace heatsoak::robot
