#include "firmware/core_config.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/copper.h"
#include "motor/datasheet_network.h"
#include "motor/default_spread.h"
#include "robot/assumed_friction.h"
#include "robot/driver.h"

namespace heatsoak::firmware {
namespace {

constexpr double kPushed = 1.1;

float single(double value) { return static_cast<float>(value); }

/// Adds every value of the robot's file that the drive core lacks.
void add_missing_values(const robot::Robot& robot, base::Diagnostics& diagnostics) {
  constexpr std::array<std::string_view, 6> kTables{"body", "wheels", "drive", "battery", "traction", "limits"};
  std::vector<std::string_view> tables(kTables.begin(), kTables.end());
  if (robot::has_friction(robot)) {
    tables.emplace_back("friction");
  }
  try {
    robot::require_parameters(robot, tables);
  } catch (const base::Failure& failure) {
    for (const base::Diagnostic& each : failure.diagnostics()) {
      diagnostics.add(each.at, each.key, each.message);
    }
  }
}

/// Adds the value of the motor's file that the drive core lacks, if it lacks it. `file` may be empty.
void add_missing_values(const std::string& file, const motor::MotorValues& motor, base::Diagnostics& diagnostics) {
  if (!motor.rotor_inertia_kg_m2) {
    diagnostics.add({file}, "figures.rotor_inertia", "is missing in the motor file: it is needed for the acceleration of a wheel");
  }
}

void require_all(const robot::Robot& robot, const motor::MotorValues& motor) {
  base::Diagnostics diagnostics;
  add_missing_values(robot, diagnostics);
  add_missing_values({}, motor, diagnostics);
  diagnostics.throw_if_any();
}

void set_geometry(const robot::Robot& robot, const robot::BodyConfig& body, robot_core::Config& config) {
  const robot::Kinematics& kinematics = body.kinematics;
  config.wheel_count = kinematics.wheel_count;
  config.wheel_radius_m = single(kinematics.wheel_radius_m);
  config.contact_radius_m = single(kinematics.contact_radius_m);
  config.mass_kg = single(body.weight.mass_kg);
  config.yaw_inertia_kg_m2 = single(body.yaw_inertia_kg_m2);
  config.wheel_inertia_kg_m2 = single(body.wheel_inertia_kg_m2);
  for (int i = 0; i < kinematics.wheel_count; ++i) {
    robot_core::WheelConfig& wheel = config.wheel[i];
    wheel.rolling_x_share = single(kinematics.wheels[i].rolling_x_share);
    wheel.rolling_y_share = single(kinematics.wheels[i].rolling_y_share);
    wheel.inverse_x_factor = single(kinematics.inverse_x_factor[i]);
    wheel.inverse_y_factor = single(kinematics.inverse_y_factor[i]);
    wheel.inverse_yaw_per_m = single(kinematics.inverse_yaw_per_m[i]);
    wheel.level_load_share = single(body.weight.level_share[i]);
    wheel.slip_factor = robot.wheels.slip_factor.empty() ? 1.0F : single(robot.wheels.slip_factor[static_cast<std::size_t>(i)]);
  }
}

void set_friction(const robot::Robot& robot, const motor::MotorValues& motor, const robot::BodyConfig& body, robot_core::Config& config) {
  const FrictionVoltage friction = friction_voltage(robot, motor);
  config.has_friction = friction.is_known;
  config.rotation_friction_V = single(friction.rotation_V);
  config.friction_smoothing_m_per_s = single(body.friction.smoothing_rad_per_s * body.kinematics.wheel_radius_m);
  for (int i = 0; i < config.wheel_count; ++i) {
    robot_core::WheelConfig& wheel = config.wheel[i];
    wheel.damping_V_s_per_rad = single(friction.damping_V_s_per_rad);
    wheel.sine_V = single(friction.sine_V[i]);
    wheel.sign_V = single(friction.sign_V[i]);
    wheel.phase_cosine_ratio = single(std::cos(friction.phase_rad[i]));
    wheel.phase_sine_ratio = single(std::sin(friction.phase_rad[i]));
  }
}

double lowest_resistance_ohm(const robot::Robot& robot, const motor::MotorValues& motor, const CoreOptions& options) {
  const robot::MotorElectrics electrics = robot::make_electrics(robot, motor);
  const double cold_ratio = base::resistance_ratio(electrics.resistance_rise_per_K, options.coldest_ambient_C);
  return electrics.heating_factor * electrics.resistance_25C_ohm * options.lowest_resistance_ratio * cold_ratio +
         robot.series_resistance_ohm();
}

double current_limit_A(const robot::Robot& robot, double geared_V_s_per_rad, double fastest_rad_per_s, double lowest_ohm) {
  const double most_V = robot.drive.limited_V(robot.battery.full_V.value()) + geared_V_s_per_rad * fastest_rad_per_s;
  return robot.drive.limited_A(most_V / lowest_ohm);
}

void set_drive(const robot::Robot& robot, const motor::MotorValues& motor, const robot::BodyConfig& body, const CoreOptions& options,
               robot_core::Config& config) {
  const robot::DriveConstants drive = robot::drive_constants(robot, motor);
  const double geared = drive.torque_constant_Nm_per_A * drive.gear_ratio;
  const double efficiency = drive.gear_efficiency * body.rolling_efficiency;
  const double lowest_ohm = lowest_resistance_ohm(robot, motor, options);
  const double fastest_rad_per_s = kPushed * robot.battery.full_V.value() / geared;
  const double most_A = current_limit_A(robot, geared, fastest_rad_per_s, lowest_ohm);
  config.torque_constant_Nm_per_A = single(drive.torque_constant_Nm_per_A);
  config.resistance_ohm = single(drive.resistance_ohm);
  const robot::MotorElectrics electrics = robot::make_electrics(robot, motor);
  config.resistance_rise_per_K =
      single(electrics.resistance_rise_per_K * electrics.heating_factor * electrics.resistance_25C_ohm / drive.resistance_ohm);
  config.lowest_resistance_ohm = single(lowest_ohm);
  config.gear_ratio = single(drive.gear_ratio);
  config.gear_efficiency = single(efficiency);
  config.fastest_wheel_rad_per_s = single(fastest_rad_per_s);
  config.largest_acceleration_rad_per_s2 = single(geared * most_A / (drive.gear_efficiency * body.wheel_inertia_kg_m2));
  config.battery_full_V = single(robot.battery.full_V.value());
  config.battery_lowest_V = single(robot.battery.empty_V.value());
  config.battery_resistance_ohm = single(robot.battery.resistance_ohm.value());
  config.voltage_limit_V = single(robot.drive.limited_V(robot.battery.full_V.value()));
  config.current_limit_A = single(most_A);
}

void set_gains(const WheelLoopGains& gains, robot_core::Config& config) {
  config.body_gain_per_s = single(gains.body_gain_per_s);
  config.yaw_gain_per_s = single(gains.yaw_gain_per_s);
  config.yaw_integral_per_s2 = single(gains.yaw_integral_per_s2);
  config.wheel_gain_V_s_per_rad = single(gains.wheel_gain_V_s_per_rad);
  config.wheel_integral_V_per_rad = single(gains.wheel_integral_V_per_rad);
  config.tracking_time_s = single(gains.tracking_time_s);
}

void set_limits(const robot::Robot& robot, const robot::BodyConfig& body, robot_core::Config& config) {
  config.speed_limit_m_per_s = single(robot.limits.speed_m_per_s.value());
  config.yaw_rate_limit_rad_per_s = single(robot.limits.yaw_rate_rad_per_s.value());
  config.acceleration_limit_m_per_s2 = single(robot.limits.acceleration_m_per_s2.value());
  config.yaw_acceleration_limit_rad_per_s2 = single(robot.limits.yaw_acceleration_rad_per_s2.value());
  config.jerk_limit_m_per_s3 = single(robot.limits.jerk_m_per_s3.value());
  const double mu = body.traction.traction_ratio;
  const double c = body.traction.roller_drag_ratio;
  config.traction_ratio = single(std::sqrt(std::max(0.0, mu * mu - c * c)));
}

/// Returns the configuration with its check sum. Throws Failure (bad_input) if the drive core would refuse it.
robot_core::Config finished(robot_core::Config config) {
  robot_core::complete(config);
  if (!robot_core::is_possible(config)) {
    throw base::Failure(base::ExitCode::bad_input,
                        "the drive core refuses the values of this robot and motor: expected finite values, three or four "
                        "wheels and an empty battery below the full one");
  }
  robot_core::complete(config);
  return config;
}

/// Full stop of one wheel: its largest current, and the motor's speed at its beginning.
struct Stop {
  double current_A = 0.0;
  double speed_rad_per_s = 0.0;
  double duration_s = 0.0;
};

/// Returns the hardest full stop of a wheel for each direction of travel: that with the larger current, for equal currents the faster
/// motor.
std::vector<Stop> stops(const robot::Robot& robot, const robot::DriveConstants& drive, const robot::BodyConfig& body) {
  constexpr int kHeadings = 72;
  const double most_A =
      current_limit_A(robot, drive.torque_constant_Nm_per_A * drive.gear_ratio,
                      kPushed * robot.battery.full_V.value() / (drive.torque_constant_Nm_per_A * drive.gear_ratio), drive.resistance_ohm);
  std::vector<Stop> all;
  for (int h = 0; h < kHeadings; ++h) {
    const double heading_rad = 2.0 * std::numbers::pi * h / kHeadings;
    const robot::Direction along = robot::Direction::of(heading_rad);
    const double a_m_per_s2 = robot.limits.braking_m_per_s2.value();
    const double v_m_per_s = robot.limits.speed_m_per_s.value();
    const robot::Wrench wrench =
        robot::wrench_of_acceleration(body, 0.0, {a_m_per_s2 * along.cosine_ratio, a_m_per_s2 * along.sine_ratio, 0.0});
    const robot::PerWheel force_N = robot::rolling_forces_N(body.kinematics, wrench);
    const robot::PerWheel per_s2 =
        robot::wheel_speeds_rad_per_s(body.kinematics, {a_m_per_s2 * along.cosine_ratio, a_m_per_s2 * along.sine_ratio, 0.0});
    for (int i = 0; i < body.kinematics.wheel_count; ++i) {
      const double torque_Nm = force_N[i] * body.kinematics.wheel_radius_m + body.wheel_inertia_kg_m2 * per_s2[i];
      const double current_A = std::abs(torque_Nm) / (drive.torque_constant_Nm_per_A * drive.gear_ratio);
      all.push_back({std::min(current_A, most_A), std::abs(per_s2[i]) * v_m_per_s / a_m_per_s2 * drive.gear_ratio, v_m_per_s / a_m_per_s2});
    }
  }
  return all;
}

}  // namespace

namespace {

/// Limp current of a core without guard: in air of 40 °C its copper loss takes half of the heat that the winding may have, which leaves
/// the other half to friction, iron and tolerances.
double limp_current_without_guard_A(const motor::MotorValues& motor) {
  constexpr double kHotAir_C = 40.0;
  constexpr double kCopper_share = 0.5;
  const double rise_K = std::max(0.0, motor.winding_limit_C - kHotAir_C);
  const double resistance_ohm =
      motor.terminal_resistance_ohm * base::resistance_ratio(motor.temperature_coefficient_per_K, motor.winding_limit_C);
  return std::sqrt(kCopper_share * rise_K /
                   ((motor.thermal_resistance_winding_stator_K_per_W + motor.thermal_resistance_stator_ambient_K_per_W) * resistance_ohm));
}

}  // namespace

CoreOptions with_tolerance(CoreOptions options, const motor::Motor& motor) {
  if (const std::optional<base::Spread> spread = motor::spread_or_default(motor, "terminal_resistance")) {
    options.lowest_resistance_ratio = spread->low / motor.nominal.terminal_resistance_ohm;
  }
  return options;
}

void require_drive_values(const robot::Robot& robot, std::span<const motor::Motor> motors) {
  base::Diagnostics diagnostics;
  add_missing_values(robot, diagnostics);
  for (const motor::Motor& motor : motors) {
    add_missing_values(motor.file.string(), motor.nominal, diagnostics);
  }
  diagnostics.throw_if_any();
}

robot_core::Config make_core_config(const robot::Robot& robot, const motor::MotorValues& motor, const CoreOptions& options) {
  require_all(robot, motor);
  const robot::BodyConfig body = make_body_with_known_friction(robot, motor);
  robot_core::Config config;
  config.period_s = single(options.period_s);
  set_geometry(robot, body, config);
  set_drive(robot, motor, body, options, config);
  set_friction(robot, motor, body, config);
  set_gains(wheel_loop_gains(wheel_loop_plant(body, robot::drive_constants(robot, motor)), options.period_s), config);
  set_limits(robot, body, config);
  config.limp_current_A = single(std::min(limp_current_without_guard_A(motor), double{config.current_limit_A}));
  config.plan_step = options.has_pose_targets ? &robot_core::plan_to_pose : nullptr;
  config.predict_pose = options.has_pose_targets ? &robot_core::predict_pose : nullptr;
  config.shadow_mode = options.shadow_mode;
  return finished(config);
}

namespace {

/// A guard gets the temperature of the hottest body of the other wheels' guards, which can be far below their windings.
void require_neighbours_at_bodies(const motor::Motor& motor) {
  for (const motor::MotorEffect& effect : motor.effects) {
    if (effect.type->name == "neighbour_coupling" && effect.nodes.front() == "winding") {
      throw base::Failure(
          base::ExitCode::bad_input,
          fmt::format("{}: effects.{} couples the winding with that of the neighbour; expected node = \"stator\" or another "
                      "body, because the guard of the drive core does not use the windings of its neighbours",
                      motor.id, effect.name));
    }
  }
}

}  // namespace

robot_core::Config make_core_config(const robot::Robot& robot, const motor::Motor& motor, const CoreOptions& options,
                                    const derate::Derating& derating, const HostGuard& guard) {
  require_neighbours_at_bodies(motor);
  CoreOptions with_cold = with_tolerance(options, motor);
  with_cold.coldest_ambient_C = derating.options.coldest_ambient_C;
  const double periods = derating.options.period_s / options.period_s;
  if (std::round(periods) < 1.0 || std::abs(periods - std::round(periods)) > 1e-3 * periods) {
    throw base::Failure(base::ExitCode::bad_input, fmt::format("the guard's period of {:.6g} ms is not a whole number of control periods "
                                                               "of {:.6g} ms: choose a multiple of the control period",
                                                               1e3 * derating.options.period_s, 1e3 * options.period_s));
  }
  robot_core::Config config = make_core_config(robot, motor.nominal, with_cold);
  config.guard = &guard.model();
  config.limp_current_A = single(std::min(derate::limp_current_A(derating), double{config.current_limit_A}));
  config.braking_reserve_K = single(braking_reserve_K(robot, motor.nominal, derating));
  return finished(config);
}

void require_driving_current(const robot::Robot& robot, const motor::Motor& motor, const derate::Derating& derating,
                             const robot_core::Config& config) {
  const double reserve_K = config.braking_reserve_K;
  const double hottest_C = derating.rules.hottest_ambient_C;
  const double limit_C = derating.rules.limits.winding_C;
  const float allowed_A = robot_core::allowed_current_A(*config.guard, 0.0F, single(hottest_C), single(hottest_C + reserve_K));
  if (reserve_K < limit_C - hottest_C && allowed_A > 0.0F) {
    return;
  }
  throw base::Failure(
      base::ExitCode::bad_input,
      fmt::format("{} in {}: one full stop from {:.3g} m/s at {:.3g} m/s2 heats the winding by {:.0f} K; expected less than the {:.0f} K "
                  "between air of {:.0f} degC and the limit of {:.0f} degC. Otherwise the thermal guard never lets the robot drive. Lower "
                  "limits.speed or limits.braking in the robot file, or choose a stronger motor or a gear",
                  motor.id, robot.id, robot.limits.speed_m_per_s.value(), robot.limits.braking_m_per_s2.value(), reserve_K,
                  limit_C - hottest_C, hottest_C, limit_C));
}

double braking_reserve_K(const robot::Robot& robot, const motor::MotorValues& motor, const derate::Derating& derating) {
  require_all(robot, motor);
  const robot::BodyConfig body = make_body_with_known_friction(robot, motor);
  thermal::FormulaRun<double> law(derating.observer.formula(), derating.observer.rate_steps());
  std::vector<double> inputs(derate::observed::kSignalCount + derating.observer.state_count(), derating.rules.limits.winding_C);
  std::vector<double> rate_K_per_s(derating.observer.state_count());
  double most_K = 0.0;
  for (const derate::HotCase& around : derate::hot_cases(derating.observer, derating.rules)) {
    for (const Stop& stop : stops(robot, robot::drive_constants(robot, motor), body)) {
      constexpr int kSteps = 16;
      double heating_K = 0.0;
      for (int step = 0; step < kSteps; ++step) {
        // Midpoints: the speed falls evenly, the current stays.
        const double speed_rad_per_s = stop.speed_rad_per_s * (step + 0.5) / kSteps;
        derate::Signals signals = around.signals(derating.rules, stop.current_A, speed_rad_per_s);
        signals[derate::observed::current] = -stop.current_A;
        signals[derate::observed::speed] = speed_rad_per_s;
        signals[derate::observed::ambient] = derating.rules.limits.winding_C;
        std::ranges::copy(signals, inputs.begin());
        law.run(inputs, rate_K_per_s);
        heating_K += std::max(0.0, rate_K_per_s[motor::states::winding]) * stop.duration_s / kSteps;
      }
      most_K = std::max(most_K, heating_K);
    }
  }
  return most_K;
}

}  // namespace heatsoak::firmware
