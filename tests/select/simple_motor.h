// A motor, a robot and duties whose temperatures have a closed form.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "given_demand.h"
#include "select/evaluate.h"
#include "select/spread.h"
#include "support/source_folder.h"
#include "thermal/steady_state.h"

namespace heatsoak::select {

inline motor::Motor motor_of_file(const std::string& id) { return motor::read_motor(kSource / "motor_db" / (id + ".toml")); }
inline robot::Robot robot_of_file(const std::string& id) { return robot::read_robot(kSource / "robot_core/robots" / (id + ".toml")); }
inline duty::Duty duty_of_file(const std::string& id) { return duty::read_duty(kSource / "duty_profiles" / (id + ".toml")); }

inline constexpr double kResistance_ohm = 0.5;
inline constexpr double kAlpha_per_K = 0.0039;
inline constexpr double kInner_K_per_W = 4.0;
inline constexpr double kOuter_K_per_W = 2.0;

inline void set_value(motor::Motor& motor, std::string_view key, double motor::MotorValues::*value, const base::ParameterValue& parameter) {
  motor.parameters[key] = parameter;
  motor.nominal.*value = parameter.value;
}

/// A motor that heats up within a minute or two, without drag.
inline motor::Motor simple_motor() {
  motor::Motor motor;
  motor.id = "simple";
  motor::MotorValues& values = motor.nominal;
  values.terminal_resistance_ohm = kResistance_ohm;
  values.torque_constant_Nm_per_A = 0.03;
  values.no_load_current_A = 0.0;
  values.temperature_coefficient_per_K = kAlpha_per_K;
  values.thermal_resistance_winding_stator_K_per_W = kInner_K_per_W;
  values.thermal_resistance_stator_ambient_K_per_W = kOuter_K_per_W;
  values.thermal_time_constant_winding_s = 4.0;
  values.thermal_time_constant_stator_s = 20.0;
  values.winding_limit_C = 155.0;
  return motor;
}

inline robot::Robot simple_robot() {
  robot::Robot robot;
  robot.id = "simple";
  robot.wheels.radius_m = 0.03;
  robot.battery.nominal_V = 24.0;
  return robot;
}

inline duty::Duty constant_current(double current_A, double duration_s = 600.0) {
  duty::Duty duty;
  duty.kind = duty::DutyKind::current;
  duty.ambient_C.value = 25.0;
  duty.load.value = 1.0;
  give(duty, {{duration_s, 0.0, 0.0, current_A}});
  return duty;
}

inline MotorEvaluation evaluate_one(const motor::Motor& motor, const robot::Robot& robot, const duty::Duty& duty,
                                    const EvaluateOptions& options = {.samples = 0}) {
  return evaluate(robot, duty, duty.demand(robot, options.seed), std::span(&motor, 1), options).front();
}

/// Winding temperature by the closed form, (9) and (12), for a constant current.
inline double rest_C(double resistance_ohm, double current_A) {
  return thermal::on_off_steady_state({resistance_ohm, kAlpha_per_K, kInner_K_per_W, kOuter_K_per_W}, {current_A, 1.0, 0.0, 25.0})
      .winding_C;
}

inline base::ParameterValue resistance_within_10_percent() {
  base::ParameterValue parameter;
  parameter.value = kResistance_ohm;
  parameter.origin = base::Origin::measured;
  parameter.spread = base::Spread{base::Spread::Kind::tolerance, 0.9 * kResistance_ohm, 1.1 * kResistance_ohm, true};
  return parameter;
}

/// One idle and one loaded wheel.
inline std::vector<duty::WheelDemand> steady_wheels(double torque_Nm, double duration_s) {
  duty::WheelDemand idle{.wheel = "idle", .bins = {duty::constant_bin(duration_s, 0.0, 0.0, 0.0)}, .points = {}};
  duty::WheelDemand busy{.wheel = "busy", .bins = {duty::constant_bin(duration_s, torque_Nm, 0.0, 0.0)}, .points = {}};
  return {idle, busy};
}

}  // namespace heatsoak::select
