// The drive core without faults: it follows commands, compensates friction, and keeps its limits and the motors' temperature.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include "robot_core/drive_stages.h"
#include "test_robot.h"

namespace heatsoak::test_robot {
namespace {

using robot_core::Command;
using robot_core::Config;
using robot_core::Input;
using robot_core::Mode;
using robot_core::Output;
using robot_core::Reason;
using robot_core::State;

constexpr double kPeriod_s = 0.001;

/// Drive core with a simulated robot. The loop is ideal except for one period between samples and voltage.
class Loop {
 public:
  explicit Loop(Config config, Truth truth = {}, bool is_rested = true) : config_(config), plant_(config_, truth) {
    robot_core::complete(config_);
    EXPECT_TRUE(robot_core::start(config_, state_, {is_rested, 25.0F}));
  }

  void run(const Command& command, double duration_s, float age_s = 0.0F) {
    for (int i = 0; i < static_cast<int>(std::lround(duration_s / kPeriod_s)); ++i) {
      Input input = plant_.sense(random_, 0.0F, true);
      input.command = command;
      input.command_age_s = age_s;
      input.pose = {static_cast<float>(plant_.x_m()), static_cast<float>(plant_.y_m()), static_cast<float>(plant_.yaw_rad())};
      output_ = robot_core::step(config_, state_, input);
      plant_.move(output_);
      hottest_C_ = std::max(hottest_C_, plant_.winding_C(0));
      largest_A_ = std::max(largest_A_, std::abs(plant_.current_A(0)));
    }
  }

  Plant& plant() { return plant_; }
  const State& state() const { return state_; }
  State& state() { return state_; }
  const Config& config() const { return config_; }
  const Output& output() const { return output_; }
  double hottest_C() const { return hottest_C_; }
  double largest_A() const { return largest_A_; }
  double speed_m_per_s() const { return std::hypot(plant_.x_m_per_s(), plant_.y_m_per_s()); }

 private:
  Config config_;
  Plant plant_;
  State state_;
  Output output_{};
  Random random_{1};
  double hottest_C_ = 0.0;
  double largest_A_ = 0.0;
};

Command velocity(float x_m_per_s, float y_m_per_s, float yaw_rad_per_s = 0.0F) {
  Command command;
  command.mode = Mode::body_velocity;
  command.velocity = {x_m_per_s, y_m_per_s, yaw_rad_per_s};
  return command;
}

TEST(SineCosine, AgreesWithTheLibrary) {
  for (float angle_rad = -1000.0F; angle_rad < 1000.0F; angle_rad += 0.0173F) {
    const robot_core::SineCosine found = robot_core::sine_cosine(angle_rad);
    ASSERT_NEAR(found.sine_ratio, std::sin(static_cast<double>(angle_rad)), 4e-7) << angle_rad;
    ASSERT_NEAR(found.cosine_ratio, std::cos(static_cast<double>(angle_rad)), 4e-7) << angle_rad;
  }
}

// Calculated by hand from equations (2) and (3): d = 0.04 V s/rad, a = 0.3 V, b = 1.2 V, phase 30 degrees, driving left at 1 m/s.
TEST(FeedForward, HasTheVoltageOfThePaper) {
  Config config = make_config(4);
  for (robot_core::WheelConfig& wheel : config.wheel) {
    wheel.damping_V_s_per_rad = 0.04F;
    wheel.sine_V = 0.3F;
    wheel.sign_V = 1.2F;
    wheel.phase_cosine_ratio = 0.8660254F;
    wheel.phase_sine_ratio = 0.5F;
  }
  config.has_friction = true;
  config.friction_smoothing_m_per_s = 0.001F;
  robot_core::complete(config);
  robot_core::Validated validated{};
  validated.mode = Mode::body_velocity;
  robot_core::BodyReference body;
  body.velocity = {0.0F, 1.0F, 0.0F};
  robot_core::WheelReferences wheels;
  for (robot_core::WheelReference& wheel : wheels.wheel) {
    wheel = {20.0F, 0.0F};
  }
  robot_core::WheelVoltages voltage;
  robot_core::feed_forward(config, {}, validated, body, wheels, voltage);
  // theta = 90 degrees: sin(120 degrees) = 0.866025; 0.04*20 + 0.3*0.866025 + 1.2 = 2.259808
  EXPECT_NEAR(voltage.wheel[0].feed_forward_V, 2.259808, 2e-5);
  body.velocity = {0.0F, -1.0F, 0.0F};
  robot_core::feed_forward(config, {}, validated, body, wheels, voltage);
  EXPECT_NEAR(voltage.wheel[0].feed_forward_V, 0.8 - 1.459808, 2e-5);
}

// The accelerating part is a force: the wheel forces of its voltages sum up to m*a along a, without any other component.
TEST(FeedForward, AcceleratesTheBodyAsAsked) {
  Config config = make_config(4);
  config.wheel_inertia_kg_m2 = 1e-9F;
  robot_core::complete(config);
  robot_core::Validated validated{};
  validated.mode = Mode::body_velocity;
  robot_core::BodyReference body;
  body.acceleration = {1.5F, -0.7F, 3.0F};
  robot_core::WheelReferences wheels{};
  robot_core::WheelVoltages voltage;
  robot_core::feed_forward(config, {}, validated, body, wheels, voltage);
  double x_N = 0.0;
  double y_N = 0.0;
  double yaw_Nm = 0.0;
  for (int i = 0; i < 4; ++i) {
    const double torque_Nm = voltage.wheel[i].feed_forward_V / config.resistance_ohm * config.torque_constant_Nm_per_A * config.gear_ratio *
                             config.gear_efficiency;
    const double force_N = torque_Nm / config.wheel_radius_m;
    x_N += config.wheel[i].rolling_x_share * force_N;
    y_N += config.wheel[i].rolling_y_share * force_N;
    yaw_Nm += config.contact_radius_m * force_N;
  }
  EXPECT_NEAR(x_N, config.mass_kg * 1.5, 1e-4 * config.mass_kg);
  EXPECT_NEAR(y_N, config.mass_kg * -0.7, 1e-4 * config.mass_kg);
  EXPECT_NEAR(yaw_Nm, config.yaw_inertia_kg_m2 * 3.0, 1e-4 * config.yaw_inertia_kg_m2);
}

class Wheels : public testing::TestWithParam<int> {};

TEST_P(Wheels, ReachTheCommandedVelocityInEveryDirection) {
  for (int direction = 0; direction < 12; ++direction) {
    const double angle_rad = direction * std::numbers::pi / 6.0;
    Loop loop(make_config(GetParam()));
    const auto x_m_per_s = static_cast<float>(0.8 * std::cos(angle_rad));
    const auto y_m_per_s = static_cast<float>(0.8 * std::sin(angle_rad));
    loop.run(velocity(x_m_per_s, y_m_per_s, 1.0F), 2.0);
    EXPECT_NEAR(loop.plant().yaw_rad_per_s(), 1.0, 0.05);
    EXPECT_NEAR(loop.speed_m_per_s(), 0.8, 0.04) << direction;
  }
}

TEST_P(Wheels, StopAndHold) {
  Loop loop(make_config(GetParam()));
  loop.run(velocity(1.0F, 0.5F), 1.5);
  loop.run(velocity(0.0F, 0.0F), 1.5);
  EXPECT_LT(loop.speed_m_per_s(), 0.005);
  EXPECT_LT(std::abs(loop.plant().yaw_rad_per_s()), 0.02);
}

TEST_P(Wheels, ReachAPose) {
  Config config = make_config(GetParam());
  config.plan_step = &robot_core::plan_to_pose;
  Loop loop(config);
  Command command;
  command.mode = Mode::pose_target;
  command.pose = {1.2F, -0.6F, 1.0F};
  loop.run(command, 4.0);
  EXPECT_NEAR(loop.plant().x_m(), 1.2, 0.01);
  EXPECT_NEAR(loop.plant().y_m(), -0.6, 0.01);
  EXPECT_NEAR(loop.plant().yaw_rad(), 1.0, 0.02);
  EXPECT_LT(loop.speed_m_per_s(), 0.02);
}

TEST_P(Wheels, TurnAtTheirOwnSpeed) {
  Loop loop(make_config(GetParam()));
  Command command;
  command.mode = Mode::wheel_speed;
  std::fill_n(command.wheel_speed_rad_per_s, robot_core::kMostWheels, 15.0F);
  loop.run(command, 1.5);
  EXPECT_NEAR(loop.plant().wheel_speed_rad_per_s(0), 15.0, 0.5);
}

INSTANTIATE_TEST_SUITE_P(Robots, Wheels, testing::Values(3, 4));

/// Returns the velocity error after braking from a saturated drive. A long tracking time means an integrator that ignores the limits.
double error_after_saturation_m_per_s(float tracking_time_s) {
  Config config = make_config(4);
  config.voltage_limit_V = 2.5F;
  config.tracking_time_s = tracking_time_s;
  Loop loop(config);
  loop.run(velocity(2.0F, 0.0F), 4.0);
  EXPECT_LT(loop.speed_m_per_s(), 1.9) << "2.5 V must not reach the speed";
  loop.run(velocity(0.5F, 0.0F), 1.0);
  return std::abs(loop.speed_m_per_s() - 0.5);
}

TEST(SpeedControl, DoesNotWindUp) {
  const double with_back_calculation = error_after_saturation_m_per_s(0.05F);
  const double without = error_after_saturation_m_per_s(1e6F);
  EXPECT_LT(with_back_calculation, 0.1);
  EXPECT_LT(with_back_calculation, 0.3 * without);
}

/// Config with high acceleration and all the current that the driver gives.
Config quick(Config config) {
  config.traction_ratio = 0.0F;
  config.acceleration_limit_m_per_s2 = 6.0F;
  return config;
}

/// Drives to and fro with the largest acceleration, which heats most, and returns the highest temperature.
double hottest_after_shuttling_C(Loop& loop, int times) {
  for (int i = 0; i < times; ++i) {
    loop.run(velocity(i % 2 == 0 ? 2.0F : -2.0F, 0.0F), 0.8);
  }
  return loop.hottest_C();
}

/// Dirty wheels in hot air: the guard knows the air temperature, and the current shows the extra load of the wheels.
Truth badly_cooled() {
  Truth truth;
  truth.bearing_Nm = 0.16;
  truth.air_C = 70.0;
  return truth;
}

// The observer counts 1.3 times the heat, so the nominal motor's winding stays below the limit. Without the guard it does not.
TEST(Guard, KeepsTheWindingBelowItsLimit) {
  Loop unguarded(quick(make_config(4, false)), badly_cooled());
  unguarded.plant().warm_up(120.0);
  Loop guarded(quick(make_config(4)), badly_cooled());
  guarded.plant().warm_up(120.0);
  ASSERT_TRUE(robot_core::start(guarded.config(), guarded.state(), {true, 120.0F}));
  const double without_C = hottest_after_shuttling_C(unguarded, 200);
  const double with_C = hottest_after_shuttling_C(guarded, 200);
  EXPECT_GT(without_C, kWindingLimit_C);
  EXPECT_LE(with_C, kWindingLimit_C + 0.5);
  const float hot_A = guarded.state().wheel[0].allowed_A;
  guarded.run(Command{}, 60.0);
  EXPECT_GT(guarded.state().wheel[0].allowed_A, hot_A + 1.0F) << "after a rest the guard must allow more";
}

TEST(Guard, LeavesCurrentForBrakingWhereItLeavesNoneForDriving) {
  Config config = make_config(4);
  config.braking_reserve_K = 10.0F;
  robot_core::complete(config);
  const auto hot_C = static_cast<float>(kWindingLimit_C - 2.0);
  Loop loop(config);
  ASSERT_TRUE(robot_core::start(loop.config(), loop.state(), {true, hot_C}));
  loop.plant().warm_up(hot_C);
  loop.plant().set_velocity(1.5, 0.0, 0.0);
  loop.run(velocity(1.5F, 0.0F), 0.05);
  for (const robot_core::WheelState& wheel : loop.state().wheel) {
    EXPECT_GT(wheel.allowed_braking_A, wheel.allowed_A + 0.3F);
  }
  const double start_m = loop.plant().x_m();
  loop.run(velocity(0.0F, 0.0F), 2.0);
  const double braked_m = loop.plant().x_m() - start_m;

  Loop coasting(config);
  coasting.plant().set_velocity(1.5, 0.0, 0.0);
  coasting.run(Command{}, 2.0);
  EXPECT_LT(braked_m, 0.7 * coasting.plant().x_m());
  EXPECT_LE(loop.plant().winding_C(0), kWindingLimit_C);
}

TEST(Guard, CountsInShadowModeAndChangesNothing) {
  Config shadow = make_config(4);
  shadow.shadow_mode = true;
  Loop counted(shadow, badly_cooled());
  ASSERT_TRUE(robot_core::start(counted.config(), counted.state(), {true, 150.0F}));
  counted.plant().warm_up(150.0);
  Loop free(make_config(4, false), badly_cooled());
  free.plant().warm_up(150.0);
  for (int i = 0; i < 20; ++i) {
    counted.run(velocity(i % 2 == 0 ? 2.0F : -2.0F, 0.0F), 0.5);
    free.run(velocity(i % 2 == 0 ? 2.0F : -2.0F, 0.0F), 0.5);
    ASSERT_EQ(counted.output().pwm_ratio[0], free.output().pwm_ratio[0]);
  }
  EXPECT_GT(counted.state().shadow_steps, 0U);
  EXPECT_GT(counted.state().shadow_deficit_A_s, 0.0F);
}

// A steady load that the table allows at first: the guard warns and later limits, when the winding is warm.
TEST(Guard, WarnsBeforeItLimits) {
  Config config = make_config(4);
  config.traction_ratio = 0.0F;
  config.warning_time_s = 10.0F;
  Truth truth = badly_cooled();
  truth.bearing_Nm = 0.11;
  Loop loop(config, truth);
  double warned_s = -1.0;
  double limited_s = -1.0;
  for (double time_s = 0.0; time_s < 400.0 && limited_s < 0.0; time_s += 0.5) {
    loop.run(velocity(0.5F, 0.0F), 0.5);
    warned_s = warned_s < 0.0 && loop.output().is_warning ? time_s : warned_s;
    limited_s = loop.output().reason[0] == Reason::guard ? time_s : limited_s;
  }
  ASSERT_GT(limited_s, 10.0) << "the load is not one that the cold motor bears and the warm one does not";
  ASSERT_GE(warned_s, 0.0);
  EXPECT_LT(warned_s, limited_s);
  EXPECT_GT(warned_s, limited_s - 30.0) << "a warning long before says nothing";
}

TEST(Guard, AllowsNothingAfterAnUnknownRest) {
  Loop loop(make_config(4), {}, false);
  loop.run(velocity(1.0F, 0.0F), 0.2);
  EXPECT_EQ(loop.output().reason[0], Reason::guard_unknown);
  EXPECT_LT(loop.largest_A(), 0.1);
}

TEST(Limits, KeepTheBatteryAboveItsLowestVoltage) {
  Config config = make_config(4);
  config.battery_resistance_ohm = 2.0F;  // high resistance, as of a bad battery
  config.mass_kg = 12.0F;
  config.traction_ratio = 0.0F;
  config.acceleration_limit_m_per_s2 = 20.0F;
  Truth truth;
  truth.battery_V = config.battery_lowest_V + 1.0;
  Loop loop(config, truth);
  loop.run(velocity(2.0F, 0.0F), 0.3);
  bool has_sagged = false;
  for (const Reason reason : loop.output().reason) {
    has_sagged = has_sagged || reason == Reason::battery_sag;
  }
  EXPECT_TRUE(has_sagged);
}

TEST(Commands, ThatStopComingLetTheRobotRollOut) {
  Loop loop(make_config(4));
  loop.run(velocity(1.0F, 0.0F), 1.0);
  const double driven_m_per_s = loop.speed_m_per_s();
  loop.run(velocity(1.0F, 0.0F), 2.0, 0.5F);
  EXPECT_EQ(loop.output().robot_reason, Reason::command_stale);
  EXPECT_LT(loop.speed_m_per_s(), driven_m_per_s);
  EXPECT_TRUE(loop.output().is_open[0]);
}

// At any time a gap clears with the next step: the robot's motion during the gap raises no sensor fault.
TEST(TimeJump, LeavesNoFaultBehind) {
  for (int phase = 0; phase < 16; ++phase) {
    Loop loop(make_config(4));
    loop.run(velocity(1.0F, 0.5F, 2.0F), 0.3 + phase * kPeriod_s);
    Random random(1);
    Input input = loop.plant().sense(random, 0.0F, true);
    input.command = velocity(-1.0F, 0.5F, -2.0F);
    input.elapsed_s = 0.05F;
    EXPECT_EQ(robot_core::step(loop.config(), loop.state(), input).robot_reason, Reason::time_jump);
    loop.run(velocity(-1.0F, 0.5F, -2.0F), 0.5);
    for (const robot_core::WheelState& wheel : loop.state().wheel) {
      EXPECT_EQ(wheel.speed_fault, 0) << phase;
    }
  }
}

// A timer with a wrong prescaler must not let the observer cool down.
TEST(ShortPeriod, OpensTheBridges) {
  Loop loop(make_config(4));
  Random random(1);
  Input input = loop.plant().sense(random, 0.0F, true);
  input.command = velocity(1.0F, 0.0F);
  input.elapsed_s = 1e-6F;
  const Output output = robot_core::step(loop.config(), loop.state(), input);
  EXPECT_EQ(output.robot_reason, Reason::period_invalid);
  EXPECT_TRUE(output.is_open[0]);
}

/// Winding of the guard after 20 s of a constant measured current, with a loop period of this multiple of Config::period_s.
float guarded_winding_C(float period_ratio) {
  const Config config = make_config(4);
  State state;
  EXPECT_TRUE(robot_core::start(config, state, {.is_rested = true, .body_C = 25.0F}));
  Input input;
  input.battery_V = 24.0F;
  input.ambient_C = 25.0F;
  input.elapsed_s = period_ratio * config.period_s;
  std::ranges::fill(input.motor_current_A, 4.0F);
  const auto steps = static_cast<int>(20.0F / input.elapsed_s);
  for (int k = 0; k < steps; ++k) {
    robot_core::step(config, state, input);
  }
  return state.guard[0].state_C[0];
}

// Small delays are no fault, but all of their heat counts.
TEST(LatePeriod, LosesNoHeat) {
  const float punctual_C = guarded_winding_C(1.0F);
  EXPECT_GT(punctual_C, 60.0F);
  for (const float ratio : {1.05F, 1.09F, 1.5F, 2.0F, 2.9F}) {
    EXPECT_GT(guarded_winding_C(ratio), punctual_C - 0.01F * (punctual_C - 25.0F)) << ratio;
  }
}

/// Stop of a robot that drives diagonally, with motors and guard at `body_C`.
struct Stop {
  double way_m = 0.0;
  int periods = 0;
  int without_current = 0;  ///< periods in which the robot is fast and no motor carries current
};

Stop stop_from_diagonal(double body_C) {
  Loop loop(make_config(4));
  loop.plant().set_velocity(1.3, 0.7, 0.0);
  loop.plant().warm_up(body_C);
  EXPECT_TRUE(robot_core::start(loop.config(), loop.state(), {.is_rested = true, .body_C = static_cast<float>(body_C)}));
  Command brake;
  brake.mode = Mode::brake;
  Stop stop;
  for (; loop.speed_m_per_s() > 0.1 && stop.periods < 3000; ++stop.periods) {
    loop.run(brake, kPeriod_s);
    double sum_A = 0.0;
    for (int i = 0; i < 4; ++i) {
      sum_A += std::abs(loop.plant().current_A(i));
    }
    stop.without_current += loop.speed_m_per_s() > 0.3 && sum_A < 0.05 ? 1 : 0;
  }
  stop.way_m = std::hypot(loop.plant().x_m(), loop.plant().y_m());
  return stop;
}

// At 154 degC no current is left for driving. A wheel that is pulled along briefly must not take the brakes from the others.
TEST(Guard, KeepsBrakingAuthorityInEveryDirection) {
  const Stop cold = stop_from_diagonal(25.0);
  const Stop hot = stop_from_diagonal(154.0);
  EXPECT_EQ(cold.without_current, 0);
  EXPECT_LE(hot.without_current, hot.periods / 20);
  EXPECT_LT(hot.periods, 3000);
  RecordProperty("cold_way_m", std::to_string(cold.way_m));
  RecordProperty("hot_way_m", std::to_string(hot.way_m));
  std::printf("stop from 1.5 m/s: cold %.2f m in %d ms, at 154 degC %.2f m in %d ms, %d of them without current\n", cold.way_m,
              cold.periods, hot.way_m, hot.periods, hot.without_current);
}

// A charging kicker takes a tenth of the voltage. That is no fault, and the robot keeps driving.
TEST(Battery, UnknownLoadIsNoFault) {
  Loop loop(make_config(4));
  loop.run(velocity(1.0F, 0.3F), 1.0);
  loop.plant().set_battery_V(0.9 * 24.0);
  double slowest_m_per_s = 2.0;
  for (int i = 0; i < 1000; ++i) {
    loop.run(velocity(1.0F, 0.3F), kPeriod_s);
    EXPECT_EQ(loop.output().robot_reason, Reason::none);
    slowest_m_per_s = std::min(slowest_m_per_s, loop.speed_m_per_s());
  }
  EXPECT_GT(slowest_m_per_s, 0.9 * std::hypot(1.0, 0.3));
  // A first sample that was too high must not make later ones faulty.
  Loop other(make_config(4));
  other.plant().set_battery_V(25.2);
  other.run(velocity(0.0F, 0.0F), kPeriod_s);
  other.plant().set_battery_V(22.0);
  other.run(velocity(1.0F, 0.3F), 1.5);
  EXPECT_EQ(other.output().robot_reason, Reason::none);
  EXPECT_GT(other.speed_m_per_s(), 0.9 * std::hypot(1.0, 0.3));
}

}  // namespace
}  // namespace heatsoak::test_robot
