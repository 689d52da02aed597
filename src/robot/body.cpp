#include "robot/body.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace heatsoak::robot {
namespace {

FrictionConfig make_friction(const Robot& robot, const Kinematics& kinematics) {
  FrictionConfig friction;
  friction.wheel_torque_Nm = robot.friction.wheel_torque_Nm.value();
  friction.wheel_damping_Nm_s_per_rad = robot.friction.wheel_damping_Nm_s_per_rad.value();
  friction.by_heading = robot.friction.heading.constant_Nm.has_value() || !robot.friction.heading.wheels.empty();
  if (friction.by_heading) {
    friction.heading.constant_Nm.fill(robot.friction.heading.constant_Nm.value_or(0.0));
    friction.heading.sine_Nm.fill(robot.friction.heading.sine_Nm.value_or(0.0));
    for (std::size_t i = 0; i < robot.friction.heading.wheels.size(); ++i) {
      const HeadingWheel& wheel = robot.friction.heading.wheels[i];
      friction.heading.constant_Nm[i] = wheel.constant_Nm;
      friction.heading.sine_Nm[i] = wheel.sine_Nm;
      friction.heading.phase_offset[i] = Direction::of(wheel.phase_rad - rolling_phase_rad(kinematics.wheels[i]));
    }
    friction.heading.double_angle_Nm = robot.friction.heading.double_angle_Nm.value_or(0.0);
    friction.heading.rotation_Nm = robot.friction.heading.rotation_Nm.value_or(robot.friction.wheel_torque_Nm.value());
    std::ranges::transform(robot.friction.heading.double_angle_phase_rad, friction.heading.double_angle_phase.begin(), &Direction::of);
  }
  return friction;
}

/// Returns whether the robot stands at rest: non-negative wheel loads can balance the moment of its weight.
bool stands(const WeightConfig& weight) {
  const LoadMoment moment = load_moment(weight, {}, {}, 0.0);
  LoadMoment carried;
  const NormalLoads loads = normal_loads(weight, moment);
  for (int i = 0; i < weight.wheel_count; ++i) {
    carried.x_Nm += loads.force_N[i] * weight.contact_x_m[i];
    carried.y_Nm += loads.force_N[i] * weight.contact_y_m[i];
  }
  const double rounding_Nm = 1e-9 * weight.mass_kg * kGravity_m_per_s2;
  return std::abs(carried.x_Nm - moment.x_Nm) < rounding_Nm && std::abs(carried.y_Nm - moment.y_Nm) < rounding_Nm;
}

}  // namespace

BodyConfig make_body(const Robot& robot, const motor::MotorValues& motor) {
  constexpr std::array<std::string_view, 4> kTables{"body", "wheels", "friction", "traction"};
  require_parameters(robot, kTables);
  if (!motor.rotor_inertia_kg_m2) {
    throw base::bad_input({}, "figures.rotor_inertia", "is missing in the motor file: it is needed for the acceleration of a wheel");
  }
  BodyConfig body;
  body.kinematics = make_kinematics(robot);
  body.weight = make_weight(body.kinematics, robot.mass_kg, robot.body.center_of_gravity_height_m.value(),
                            robot.body.center_of_gravity_x_m.value_or(0.0), robot.body.center_of_gravity_y_m.value_or(0.0));
  if (!stands(body.weight)) {
    throw base::bad_input(
        {robot.file.string()}, "wheels.axis_angles",
        "put all wheels on one side of the centre of gravity, so the robot tips over at standstill; expected the centre of "
        "gravity between the wheels");
  }
  body.friction = make_friction(robot, body.kinematics);
  body.traction.traction_ratio = robot.traction.coefficient_ratio.value();
  body.traction.slip_speed_m_per_s = robot.traction.slip_speed_m_per_s.value();
  body.traction.roller_drag_ratio = body.friction.by_heading ? 0.0 : robot.friction.roller_drag_ratio.value();
  body.rolling_efficiency = robot.friction.rolling_efficiency.value_or(1.0);
  body.yaw_inertia_kg_m2 = robot.body.yaw_inertia_kg_m2.value();
  body.wheel_inertia_kg_m2 =
      robot.wheels.inertia_kg_m2.value() + robot.drive.gear_ratio * robot.drive.gear_ratio * *motor.rotor_inertia_kg_m2;
  return body;
}

Wrench wrench_of_acceleration(const BodyConfig& body, double yaw_rad_per_s, const BodyAcceleration& acceleration) {
  const double c_x = body.weight.center_of_gravity_x_m;
  const double c_y = body.weight.center_of_gravity_y_m;
  const double square = yaw_rad_per_s * yaw_rad_per_s;
  Wrench wrench;
  wrench.x_N = body.weight.mass_kg * (acceleration.x_m_per_s2 - acceleration.yaw_rad_per_s2 * c_y - square * c_x);
  wrench.y_N = body.weight.mass_kg * (acceleration.y_m_per_s2 + acceleration.yaw_rad_per_s2 * c_x - square * c_y);
  wrench.yaw_Nm = body.yaw_inertia_kg_m2 * acceleration.yaw_rad_per_s2 + c_x * wrench.y_N - c_y * wrench.x_N;
  return wrench;
}

double kinetic_energy_J(const BodyConfig& body, const BodyVelocity& local, const PerWheel& wheel_speed_rad_per_s) {
  const double x_m_per_s = local.x_m_per_s - local.yaw_rad_per_s * body.weight.center_of_gravity_y_m;
  const double y_m_per_s = local.y_m_per_s + local.yaw_rad_per_s * body.weight.center_of_gravity_x_m;
  double energy_J = 0.5 * body.weight.mass_kg * (x_m_per_s * x_m_per_s + y_m_per_s * y_m_per_s) +
                    0.5 * body.yaw_inertia_kg_m2 * local.yaw_rad_per_s * local.yaw_rad_per_s;
  for (int i = 0; i < body.kinematics.wheel_count; ++i) {
    energy_J += 0.5 * body.wheel_inertia_kg_m2 * wheel_speed_rad_per_s[i] * wheel_speed_rad_per_s[i];
  }
  return energy_J;
}

}  // namespace heatsoak::robot
