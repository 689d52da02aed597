// The closed loop, compared with conservation laws, with the independent inverse dynamics, and with its own limits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <sstream>

#include "firmware/core_config.h"
#include "jump_energy.h"
#include "robot/inverse_dynamics.h"
#include "simulate/match_run.h"
#include "simulate/match_trace.h"
#include "support/shipped.h"

namespace heatsoak::simulate {
namespace {

/// Twente's robot with three wheels at equal angles, and with roller drag instead of the measured curve of four wheels.
robot::Robot three_wheels() {
  robot::Robot robot = twente();
  robot.wheels.axis_rad = {-std::numbers::pi / 3.0, std::numbers::pi / 3.0, std::numbers::pi};
  robot.friction.heading.constant_Nm.reset();
  return robot;
}

duty::ScheduledCommand go(double time_s, double x_m, double y_m, double yaw_rad) {
  return {time_s, duty::Phase::running, {.duration_s = 0.0, .stand = false, .x_m = x_m, .y_m = y_m, .yaw_rad = yaw_rad}};
}

duty::ScheduledCommand push(double time_s, double direction_rad, double share) {
  duty::MotionCommand command;
  command.stand = true;
  command.duel = true;
  command.push_direction_rad = direction_rad;
  command.push_share = share;
  return {time_s, duty::Phase::running, command};
}

/// Commands: drive away, return before arrival, turn, and a duel from 5 s on.
std::vector<duty::ScheduledCommand> lively() {
  return {go(0.0, 1.5, 0.5, 0.5), go(1.1, -0.5, 0.2, 2.0), go(3.0, 0.3, 0.3, 2.5), push(5.0, 2.6, 0.6)};
}
constexpr double kLively_s = 7.0;

struct Driven {
  DriveScore score;
  std::string csv;
  double heat_to_air_J = 0.0;  ///< sum over all stators
  double stored_J = 0.0;       ///< sum over all windings and stators
  double peak_of_rows_C = 0.0;
};

Driven drive(const robot::Robot& robot, const motor::Motor& motor, const std::vector<duty::ScheduledCommand>& script, double end_s,
             duty::Planner planner = duty::Planner::jerk_limited, const LoopObserver& observer = {},
             const DriveOptions& options = ideal_drive()) {
  constexpr double kAmbient_C = 25.0;
  SimulatedRobot simulated(robot, motor, kAmbient_C);
  CoreDrive core(firmware::make_core_config(robot, motor.nominal, {}), simulated, options);
  const auto plan = duty::ideal_tracking(robot, 1.0, planner);
  const int wheels = simulated.wheel_count();
  Driven driven;
  DriveScorer scorer;
  const MatchAdditions added = additions_of(motor);
  MatchRows rows(0.1, kAmbient_C, added, [&](const MatchRow& row) { append_csv(driven.csv, row, wheels, kAmbient_C, added); });
  MatchRows coarse_rows(2.0, kAmbient_C, {}, [&](const MatchRow& row) {
    driven.peak_of_rows_C = std::max(driven.peak_of_rows_C, *std::ranges::max_element(row.winding_peak_C));
  });
  const motor::MotorValues& values = motor.nominal;
  drive_script(simulated, core, *plan, script, end_s, [&](const LoopMoment& moment) {
    scorer.take(moment);
    rows.take(moment);
    coarse_rows.take(moment);
    for (int i = 0; i < wheels; ++i) {
      driven.heat_to_air_J +=
          SimulatedRobot::kPeriod_s * (simulated.stator_C(i) - kAmbient_C) / values.thermal_resistance_stator_ambient_K_per_W;
    }
    if (observer) {
      observer(moment);
    }
  });
  for (int i = 0; i < wheels; ++i) {
    const double winding_J_per_K = values.thermal_time_constant_winding_s / values.thermal_resistance_winding_stator_K_per_W;
    const double stator_J_per_K = values.thermal_time_constant_stator_s / values.thermal_resistance_stator_ambient_K_per_W;
    driven.stored_J += winding_J_per_K * (simulated.winding_C(i) - kAmbient_C) + stator_J_per_K * (simulated.stator_C(i) - kAmbient_C);
  }
  coarse_rows.finish();
  driven.score = scorer.finish();
  return driven;
}

TEST(ClosedLoop, what_the_battery_gives_is_heat_and_motion) {
  for (const auto& [robot, motor] : {std::pair(twente(), ecx_32()), std::pair(three_wheels(), ecx_32()),
                                     std::pair(shipped_robot("tigers_v2020"), shipped_motor("nanotec_df45l024048_a2"))}) {
    for (const duty::Planner planner : {duty::Planner::jerk_limited, duty::Planner::bang_bang}) {
      JumpEnergy jumps(robot, motor);
      const auto see = [&](const LoopMoment& moment) { jumps.take(*moment.out); };
      const EnergyAccount energy = drive(robot, motor, lively(), kLively_s, planner, see).score.energy;
      EXPECT_GT(energy.battery_J, 50.0);
      EXPECT_NEAR(energy.residual_J(), 0.0, 1e-4 * energy.battery_J + jumps.unresolved_J()) << robot.id;
      for (const double loss_J : {energy.copper_J, energy.driver_J, energy.motor_drag_J, energy.slip_J, energy.battery_loss_J}) {
        EXPECT_GT(loss_J, 0.0);
      }
    }
  }
}

/// Returns the cell of a column in the last row of a table.
double last_cell(const std::string& header, const std::string& rows, const std::string& column) {
  std::istringstream names(header), cells(rows.substr(rows.rfind('\n', rows.size() - 2) + 1));
  for (std::string name, cell; std::getline(names, name, ',') && std::getline(cells, cell, ',');) {
    if (name == column) {
      return std::stod(cell);
    }
  }
  ADD_FAILURE() << "no column " << column;
  return 0.0;
}

// The lag must act in each period. A row of a tenth of a second would be too coarse for a fast winding.
TEST(ClosedLoop, a_late_sensor_shows_in_columns_of_its_own) {
  motor::Motor motor = ecx_32();
  const std::string bare = csv_header(4, additions_of(motor));
  EXPECT_EQ(bare.find("shown"), std::string::npos);
  base::ParameterValue lag;
  lag.value = 1.5;
  motor.sensors.push_back({"late", motor::find_sensor_effect("sensor_lag_winding"), lag});
  std::vector<double> sensor_C{25.0};  // value after each period
  std::vector<double> true_C{25.0};
  const Driven driven = drive(twente(), motor, lively(), kLively_s, duty::Planner::jerk_limited, [&](const LoopMoment& moment) {
    true_C.push_back(moment.robot->winding_C(2));
    const double mean_C = 0.5 * (true_C.back() + true_C[true_C.size() - 2]);
    sensor_C.push_back(sensor_C.back() + SimulatedRobot::kPeriod_s / 1.5 * (mean_C - sensor_C.back()));
  });
  const std::string header = csv_header(4, additions_of(motor));
  EXPECT_EQ(header.find("stator_shown"), std::string::npos);
  const auto period = static_cast<std::size_t>(std::lround(last_cell(header, driven.csv, "time_s") / SimulatedRobot::kPeriod_s));
  EXPECT_NEAR(last_cell(header, driven.csv, "winding_3_C"), true_C.at(period), 1e-4);
  EXPECT_NEAR(last_cell(header, driven.csv, "winding_shown_3_C"), sensor_C.at(period), 2e-3);
  EXPECT_GT(std::abs(true_C.at(period) - sensor_C.at(period)), 0.05);
}

// Reference: a mount of 4 J/K with 0.8 W/K to the stator and 0.4 W/K to the air, driven by the stator's temperature alone.
TEST(ClosedLoop, a_body_of_the_motors_file_has_its_temperature_in_the_trace) {
  motor::Motor motor = ecx_32();
  EXPECT_EQ(csv_header(4, additions_of(motor)).find("mount"), std::string::npos);
  std::vector<base::ParameterValue> parameters(3);
  parameters[0].value = 0.8;
  parameters[1].value = 0.5;
  parameters[2].value = 4.0;
  motor.effects.push_back({"mount", thermal::find_effect("third_node"), {"stator", "mount", "ambient"}, parameters});
  std::vector<double> mount_C{25.0};  // value after each period
  double stator_C = 25.0;
  const Driven driven = drive(twente(), motor, lively(), kLively_s, duty::Planner::jerk_limited, [&](const LoopMoment& moment) {
    const double mean_C = 0.5 * (stator_C + moment.robot->stator_C(2));
    stator_C = moment.robot->stator_C(2);
    const double heat_W = 0.8 * (mean_C - mount_C.back()) - 0.4 * (mount_C.back() - 25.0);
    mount_C.push_back(mount_C.back() + SimulatedRobot::kPeriod_s * heat_W / 4.0);
  });
  const std::string header = csv_header(4, additions_of(motor));
  const auto period = static_cast<std::size_t>(std::lround(last_cell(header, driven.csv, "time_s") / SimulatedRobot::kPeriod_s));
  EXPECT_NEAR(last_cell(header, driven.csv, "mount_3_C"), mount_C.at(period), 2e-3);
  EXPECT_GT(mount_C.at(period), 25.05);
  EXPECT_LT(mount_C.at(period), last_cell(header, driven.csv, "stator_3_C"));
}

// The plant's losses must arrive in the thermal network, either stored or given off to the air.
TEST(ClosedLoop, the_motors_losses_warm_windings_and_stators) {
  const Driven driven = drive(twente(), ecx_32(), lively(), kLively_s);
  const double lost_J = driven.score.energy.copper_J + driven.score.energy.motor_drag_J;
  EXPECT_NEAR(driven.stored_J + driven.heat_to_air_J, lost_J, 2e-3 * lost_J);
  EXPECT_GT(driven.score.winding_peak_C, 25.5);
  EXPECT_NEAR(driven.peak_of_rows_C, driven.score.winding_peak_C, 1e-2);
}

// Without temperature coefficient, drag and rotor inertia, the currents must match the inverse dynamics of the executed motion. That motion
// is the plan plus corrections.
TEST(ClosedLoop, heats_as_the_inverse_dynamics_says) {
  robot::Robot robot = twente();
  motor::Motor motor = ecx_32();
  motor.nominal.temperature_coefficient_per_K = 0.0;
  motor.nominal.no_load_current_A = 1e-6;
  motor.nominal.rotor_inertia_kg_m2 = 0.0;
  const robot::BodyConfig body = robot::make_body(robot, motor.nominal);
  double expected_J = 0.0;
  robot::BodyVelocity before;
  const Driven driven = drive(
      robot, motor, {go(0.0, 1.5, 0.7, 1.0), go(2.5, 0.0, 0.0, 0.0)}, 5.0, duty::Planner::jerk_limited, [&](const LoopMoment& moment) {
        const robot::BodyVelocity now = moment.robot->velocity_global();
        const robot::BodyVelocity mean{0.5 * (before.x_m_per_s + now.x_m_per_s), 0.5 * (before.y_m_per_s + now.y_m_per_s),
                                       0.5 * (before.yaw_rad_per_s + now.yaw_rad_per_s)};
        const robot::BodyAcceleration acceleration{(now.x_m_per_s - before.x_m_per_s) / SimulatedRobot::kPeriod_s,
                                                   (now.y_m_per_s - before.y_m_per_s) / SimulatedRobot::kPeriod_s,
                                                   (now.yaw_rad_per_s - before.yaw_rad_per_s) / SimulatedRobot::kPeriod_s};
        before = now;
        const robot::WheelDemands wheels =
            robot::inverse_dynamics(body, robot::local_motion(body, moment.robot->state().pose, mean, acceleration));
        for (const double torque_Nm : wheels.torque_Nm) {
          const double current_A = torque_Nm / motor.nominal.torque_constant_Nm_per_A;
          expected_J += motor.nominal.terminal_resistance_ohm * current_A * current_A * SimulatedRobot::kPeriod_s;
        }
      });
  EXPECT_NEAR(driven.score.energy.copper_J, expected_J, 0.03 * expected_J);
  EXPECT_LT(driven.score.tracking_most_m, 0.01);
}

TEST(ClosedLoop, a_duel_pushes_at_stall) {
  const robot::Robot robot = twente();
  const motor::Motor motor = ecx_32();
  const robot::BodyConfig body = robot::make_body(robot, motor.nominal);
  constexpr double kShare = 0.5;  // closer to the limit, creep distributes the forces among the wheels instead of the least Σf²
  robot::BodyMotion stall;
  stall.external_height_m = body.weight.center_of_gravity_height_m;
  const double asked_N = kShare * robot::largest_push_N(body, 0.0, stall.external_height_m);
  robot::PerWheel current_A{};
  robot::PerWheel drag_Nm{};
  double force_N = 0.0;
  double fastest_rad_per_s = 0.0;
  constexpr double kFrom_s = 2.0;
  constexpr double kEnd_s = 3.0;
  const double share = SimulatedRobot::kPeriod_s / (kEnd_s - kFrom_s);
  drive(robot, motor, {push(0.0, 0.0, kShare)}, kEnd_s, duty::Planner::jerk_limited, [&](const LoopMoment& moment) {
    ASSERT_TRUE(moment.pushes);
    if (moment.time_s > kFrom_s) {
      force_N += share * robot::wrench_of_rolling_forces(body.kinematics, moment.out->rolling_force_N).x_N;
      for (int i = 0; i < 4; ++i) {
        current_A[i] += share * moment.out->current_A[i];
        drag_Nm[i] += share * (moment.out->current_A[i] * motor.nominal.torque_constant_Nm_per_A - moment.out->motor_torque_Nm[i] +
                               moment.out->friction_W[i] / moment.robot->state().wheel_speed_rad_per_s[i]);
        fastest_rad_per_s = std::max(fastest_rad_per_s, std::abs(moment.robot->state().wheel_speed_rad_per_s[i]));
      }
    }
  });
  // Friction uses a part of the torque for the push, and the core does not know the creep of the wheels. The bounds allow for both.
  EXPECT_GT(force_N, 0.7 * asked_N);
  EXPECT_LT(force_N, 1.05 * asked_N);
  stall.external = {-force_N, 0.0, 0.0};
  const robot::WheelDemands expected = robot::inverse_dynamics(body, stall);
  for (int i = 0; i < 4; ++i) {
    const double expected_A = (expected.torque_Nm[i] + drag_Nm[i]) / motor.nominal.torque_constant_Nm_per_A;
    EXPECT_NEAR(current_A[i], expected_A, 0.1 * std::abs(expected_A)) << i;
  }
  // Loaded contacts creep: s = s_0·x/√(1 − x²), where x is the used share of the grip.
  EXPECT_LT(fastest_rad_per_s * robot.wheels.radius_m, 2.0 * robot.traction.slip_speed_m_per_s.value());
}

// The acceleration is limited to 1.2 m/s², because two of three wheels carry all of it. At Twente's own 2 m/s² the core's traction limit
// would act.
TEST(ClosedLoop, three_wheels_follow_as_well) {
  robot::Robot robot = three_wheels();
  robot.limits.acceleration_m_per_s2 = robot.limits.braking_m_per_s2 = 1.2;
  const DriveScore score = drive(robot, ecx_32(), {go(0.0, 1.0, 0.6, 1.0)}, 4.0).score;
  EXPECT_LT(score.tracking_most_m, 0.02);
  EXPECT_EQ(score.arrivals_count, 1.0);
}

// A new start must be identical to the last bit. Hotter air must change the result.
TEST(ClosedLoop, is_repeatable) {
  const Driven once = drive(twente(), ecx_32(), lively(), kLively_s);
  EXPECT_EQ(once.csv, drive(twente(), ecx_32(), lively(), kLively_s).csv);
  EXPECT_NE(once.csv, drive(twente(), ecx_32(), lively(), kLively_s, duty::Planner::bang_bang).csv);
}

// Rows are means over their time span, so their heat equals the total.
TEST(ClosedLoop, rows_hold_the_heat) {
  const Driven driven = drive(twente(), ecx_32(), lively(), kLively_s);
  std::istringstream lines(driven.csv);
  double copper_J = 0.0;
  int rows = 0;
  for (std::string line; std::getline(lines, line); ++rows) {
    std::vector<std::string> cells;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) {
      cells.push_back(cell);
    }
    // Without a guard the last cell, the temperature of its observer, is empty, and std::getline does not return it.
    ASSERT_EQ(cells.size(), 16U + 9U * 4U + 1U + 3U * 4U - 1U);
    EXPECT_TRUE(line.ends_with(','));
    for (std::size_t i = 0; i < 4; ++i) {
      copper_J += 0.1 * std::stod(cells[16 + 9 * i + 8]);
    }
  }
  EXPECT_EQ(rows, 70);
  EXPECT_NEAR(copper_J, driven.score.energy.copper_J, 1e-4 * driven.score.energy.copper_J);
}

}  // namespace
}  // namespace heatsoak::simulate
