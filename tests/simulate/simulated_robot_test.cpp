// Effects of a motor's file act on the motors of the simulated robot, with the signals that each effect needs.
#include "simulate/simulated_robot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "derate/guarded_motor.h"
#include "support/shipped.h"

namespace heatsoak::simulate {
namespace {

constexpr int kFirst = 0;
constexpr int kSecond = 1;
constexpr int kDriven_s = 2;
constexpr int kBraked_s = 1;
constexpr double kForward[robot::kMostWheels] = {1.0, -1.0, -1.0, 1.0};  ///< signs of the wheel speeds straight ahead

std::string effect(const std::string& type, const std::vector<std::pair<std::string, std::string>>& values) {
  std::string text = "[effects.added]\ntype = \"" + type + "\"\n";
  for (const auto& [key, value] : values) {
    text += key + " = { value = \"" + value + "\", origin = \"estimated\", derivation = \"a test\" }\n";
  }
  return text;
}

/// Powers of the first motor, integrated, and temperatures at the end.
struct Drive {
  double shaft_J = 0.0;    ///< integral of the magnitude
  double braking_J = 0.0;  ///< energy that the shaft puts into the motor
  double losses_J = 0.0;   ///< copper, iron and bearing losses
  double ripple_J = 0.0;   ///< 4·D·(1 − D)·(V/24 V)² with the modulation D
  double stator_C = 0.0;
  double travelled_m = 0.0;
};

/// The robot accelerates straight ahead, then brakes against a small voltage.
Drive drive(const motor::Motor& motor, double start_C) {
  SimulatedRobot robot(twente(), motor, 25.0, start_C);
  Drive sums;
  std::array<robot::MotorCommand, robot::kMostWheels> command;
  for (int k = 0; k < 1000 * (kDriven_s + kBraked_s); ++k) {
    const double volt = k < 1000 * kDriven_s ? 6.0 : 1.0;
    for (int i = 0; i < robot::kMostWheels; ++i) {
      command[i] = {robot::MotorCommand::Kind::voltage, kForward[i] * volt};
    }
    const robot::PlantOutput& out = robot.advance(command, {});
    const double shaft_W = out.motor_torque_Nm[kFirst] * out.motor_speed_rad_per_s[kFirst];
    const double modulation = volt / out.battery_V;
    sums.shaft_J += std::abs(shaft_W) * SimulatedRobot::kPeriod_s;
    sums.braking_J += std::max(0.0, -shaft_W) * SimulatedRobot::kPeriod_s;
    sums.losses_J += (out.copper_W[kFirst] + out.motor_drag_W[kFirst]) * SimulatedRobot::kPeriod_s;
    sums.ripple_J += 4.0 * modulation * (1.0 - modulation) * std::pow(out.battery_V / 24.0, 2) * SimulatedRobot::kPeriod_s;
    sums.travelled_m += std::hypot(robot.state().velocity.x_m_per_s, robot.state().velocity.y_m_per_s) * SimulatedRobot::kPeriod_s;
  }
  sums.stator_C = robot.stator_C(kFirst);
  return sums;
}

/// Heat that an effect adds to the stator of the first motor. In 3 s about 4 % of it flows on to the air (2 s of 80 s) and into the winding
/// (2 s of 12 s, with a ninth of the heat capacity).
double added_J(const std::string& lines) {
  constexpr double kStator_J_per_K = 80.0 / 2.8;
  return (drive(derate::ecx_32_with(lines), 25.0).stator_C - drive(ecx_32(), 25.0).stator_C) * kStator_J_per_K;
}

TEST(SimulatedRobot, EffectsOfPowerAndVoltageHeatAsMuchAsTheirLawsSay) {
  const Drive plain = drive(ecx_32(), 25.0);
  ASSERT_GT(plain.shaft_J, 5.0);
  ASSERT_GT(plain.braking_J, 0.5);
  const auto expect_near = [](double added_J, double expected_J) { EXPECT_NEAR(added_J, 0.96 * expected_J, 0.03 * expected_J); };
  expect_near(added_J(effect("load_friction", {{"share", "0.5"}})), 0.5 * plain.shaft_J);
  expect_near(added_J(effect("braking_heat", {{"share", "1"}})), plain.braking_J);
  expect_near(added_J(effect("input_power_loss", {{"share", "0.5"}})), 0.5 * plain.losses_J);
  expect_near(added_J(effect("pwm_ripple_loss", {{"loss", "2 W"}, {"stator_share", "1"}})), 2.0 * plain.ripple_J);
}

TEST(SimulatedRobot, MotionCools) {
  const std::string wind = effect("vehicle_airflow", {{"conductance", "0.2 W/K"}, {"exponent", "1"}});
  const Drive still = drive(ecx_32(), 100.0);
  ASSERT_GT(still.travelled_m, 1.0);
  // 0.2 W/K at 1 m/s take 0.2 J per metre and kelvin from 28.6 J/K.
  const double cooled_K = still.stator_C - drive(derate::ecx_32_with(wind), 100.0).stator_C;
  EXPECT_NEAR(cooled_K, 0.2 * still.travelled_m * (still.stator_C - 25.0) / 28.6, 0.1 * cooled_K);
}

/// State after a drive in which only the first motor is driven, to and fro.
struct Warmed {
  double stored_J = 0.0;  ///< heat of all motors above 25 °C
  double second_stator_C = 0.0;
};
Warmed warmed(const motor::Motor& motor) {
  SimulatedRobot robot(twente(), motor, 25.0, 25.0);
  std::array<robot::MotorCommand, robot::kMostWheels> command;
  command.fill({robot::MotorCommand::Kind::open, 0.0});
  for (int k = 0; k < 4000; ++k) {
    command[kFirst] = {robot::MotorCommand::Kind::voltage, k % 200 < 100 ? 12.0 : -12.0};
    robot.advance(command, {});
  }
  const motor::MotorValues& values = motor.nominal;
  double sum_J = 0.0;
  for (int wheel = 0; wheel < robot.wheel_count(); ++wheel) {
    sum_J += values.thermal_time_constant_winding_s / values.thermal_resistance_winding_stator_K_per_W * (robot.winding_C(wheel) - 25.0);
    sum_J += values.thermal_time_constant_stator_s / values.thermal_resistance_stator_ambient_K_per_W * (robot.stator_C(wheel) - 25.0);
  }
  return {sum_J, robot.stator_C(kSecond)};
}

// Without heat to the air, all motors together store what the first one loses, wherever the heat flows between them.
TEST(SimulatedRobot, NeighboursExchangeHeatWithoutGainOrLoss) {
  const auto insulated = [](const std::string& lines) {
    motor::Motor motor = derate::ecx_32_with(lines);
    constexpr double kInsulation = 1e6;
    motor.nominal.thermal_resistance_stator_ambient_K_per_W *= kInsulation;
    motor.nominal.thermal_time_constant_stator_s *= kInsulation;  // the same heat capacity
    return motor;
  };
  const std::string at_winding = "node = \"winding\"\n";
  const Warmed alone = warmed(insulated(""));
  ASSERT_GT(alone.stored_J, 20.0);
  for (const std::string& node : {std::string(), at_winding}) {
    const Warmed coupled = warmed(insulated(effect("neighbour_coupling", {{"conductance", "0.5 W/K"}}) + node));
    // The first winding stays cooler, so that it takes a little more or less current; a lost exchange would change the sum by tens of
    // percent.
    EXPECT_NEAR(coupled.stored_J, alone.stored_J, 0.02 * alone.stored_J) << node;
    EXPECT_GT(coupled.second_stator_C, alone.second_stator_C + 0.01) << node;
  }
}

TEST(SimulatedRobot, NeighboursAtTwoNodesAreRefused) {
  const std::string at_stator = effect("neighbour_coupling", {{"conductance", "0.5 W/K"}});
  std::string at_winding = at_stator + "node = \"winding\"\n";
  at_winding.replace(at_winding.find("added"), 5, "other");
  try {
    SimulatedRobot(twente(), derate::ecx_32_with(at_stator + at_winding), 25.0);
    FAIL() << "not refused";
  } catch (const base::Failure& failure) {
    EXPECT_EQ(failure.code(), base::ExitCode::bad_input);
    EXPECT_NE(std::string(failure.what()).find("effects.other couples the winding"), std::string::npos) << failure.what();
  }
}

}  // namespace
}  // namespace heatsoak::simulate
