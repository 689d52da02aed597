#include "robot/body.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace heatsoak {
namespace {

double given_or(double value, double otherwise) { return std::isnan(value) ? otherwise : value; }

FrictionConfig make_friction(const Robot& robot, const Kinematics& kinematics) {
  FrictionConfig friction;
  friction.wheel_torque_Nm = robot.wheel_friction_torque_Nm;
  friction.wheel_damping_Nm_s_per_rad = robot.wheel_damping_Nm_s_per_rad;
  friction.by_heading = !std::isnan(robot.heading_constant_Nm) || !robot.heading_wheels.empty();
  if (friction.by_heading) {
    friction.heading.constant_Nm.fill(robot.heading_constant_Nm);
    friction.heading.sine_Nm.fill(robot.heading_sine_Nm);
    for (std::size_t i = 0; i < robot.heading_wheels.size(); ++i) {
      const HeadingWheel& wheel = robot.heading_wheels[i];
      friction.heading.constant_Nm[i] = wheel.constant_Nm;
      friction.heading.sine_Nm[i] = wheel.sine_Nm;
      friction.heading.phase_offset[i] = Direction::of(wheel.phase_rad - rolling_phase_rad(kinematics.wheels[i]));
    }
    friction.heading.double_angle_Nm = given_or(robot.heading_double_angle_Nm, 0.0);
    friction.heading.rotation_Nm = given_or(robot.heading_rotation_Nm, robot.wheel_friction_torque_Nm);
    std::ranges::transform(robot.heading_double_angle_phase_rad, friction.heading.double_angle_phase.begin(), &Direction::of);
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

BodyConfig make_body(const Robot& robot, const MotorValues& motor) {
  constexpr std::array<std::string_view, 4> kTables{"body", "wheels", "friction", "traction"};
  require_parameters(robot, kTables);
  if (std::isnan(motor.rotor_inertia_kg_m2)) {
    throw bad_input({}, "figures.rotor_inertia", "of the motor is missing: without it no acceleration of a wheel can be calculated");
  }
  BodyConfig body;
  body.kinematics = make_kinematics(robot);
  body.weight = make_weight(body.kinematics, robot.mass_kg, robot.center_of_gravity_height_m, given_or(robot.center_of_gravity_x_m, 0.0),
                            given_or(robot.center_of_gravity_y_m, 0.0));
  if (!stands(body.weight)) {
    throw bad_input({robot.file.string()}, "wheels.axis_angles",
                    "put all wheels on one side of the centre of gravity, so the robot tips over at standstill; expected the centre of "
                    "gravity between the wheels");
  }
  body.friction = make_friction(robot, body.kinematics);
  body.traction.traction_ratio = robot.traction_ratio;
  body.traction.slip_speed_m_per_s = robot.slip_speed_m_per_s;
  body.traction.roller_drag_ratio = body.friction.by_heading ? 0.0 : robot.roller_drag_ratio;
  body.rolling_efficiency = given_or(robot.rolling_efficiency, 1.0);
  body.yaw_inertia_kg_m2 = robot.yaw_inertia_kg_m2;
  body.wheel_inertia_kg_m2 = robot.wheel_inertia_kg_m2 + robot.gear_ratio * robot.gear_ratio * motor.rotor_inertia_kg_m2;
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

double transmission_loss_Nm(double efficiency, double output_Nm, double speed_rad_per_s, double smoothing_rad_per_s) {
  return loss_torque_Nm(1.0 / efficiency - 1.0, 1.0 - efficiency, output_Nm, smooth_sign(speed_rad_per_s, smoothing_rad_per_s));
}

}  // namespace heatsoak
