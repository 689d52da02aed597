// Each reason of the drive core: configuration, time, command, pose, supply and temperatures.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <set>
#include <vector>

#include "fault_cases.h"
#include "test_robot.h"

namespace heatsoak::test_robot {
namespace {

TEST(FaultTable, config_invalid) {
  Config config = make_config(4);
  State state;
  const Input input = Plant(config, {}).sense(*std::make_unique<Random>(1), 0.0F, true);
  for (const auto& spoil : {std::function<void(Config&)>([](Config& c) { c.mass_kg += 0.1F; }), std::function<void(Config&)>([](Config& c) {
                              c.resistance_ohm = kNone;
                              robot_core::complete(c);
                            }),
                            std::function<void(Config&)>([](Config& c) {
                              c.period_s = 2e-7F;  // a guard would wait for more periods than 16 bits count
                              robot_core::complete(c);
                            }),
                            std::function<void(Config&)>([](Config& c) {
                              c.wheel_count = 5;
                              c.check_sum = robot_core::config_check_sum(c);
                            })}) {
    Config bad = config;
    spoil(bad);
    EXPECT_FALSE(robot_core::start(bad, state, {.is_rested = true, .body_C = 25.0F}));
    const Output out = robot_core::step(bad, state, input);
    EXPECT_EQ(out.robot_reason, Reason::config_invalid);
    EXPECT_TRUE(std::ranges::all_of(out.is_open, [](bool open) { return open; }));
    EXPECT_TRUE(std::ranges::all_of(out.pwm_ratio, [](float pwm) { return pwm == 0.0F; }));
  }
  EXPECT_TRUE(robot_core::start(config, state, {.is_rested = true, .body_C = 25.0F}));
  EXPECT_EQ(robot_core::step(config, state, input).robot_reason, Reason::none);
}

TEST(FaultTable, state_corrupted) {
  const Record record = check(
      {.code = Reason::state_corrupted, .periods = 1, .spoil = [](Input&, State& state, int) { state.wheel[2].integral_V += 1.0F; }}, 0, 0);
  EXPECT_TRUE(record.was_open_at_end);
  EXPECT_GE(record.hottest_guard_C, kWindingLimit_C - 1.0);
}

// Only start() checks the Config, which takes longer than a step may.
TEST(FaultTable, state_corrupted_without_a_start_stays_open) {
  const Config config = make_config(4);
  const Plant plant(config, {});
  Random random(5);
  for (const int fill : {0x00, 0x5a, 0xff}) {
    State state;
    std::memset(static_cast<void*>(&state), fill, sizeof(state));
    for (int k = 0; k < 20; ++k) {
      const Output out = robot_core::step(config, state, plant.sense(random, 0.3F, true));
      EXPECT_EQ(out.robot_reason, Reason::state_corrupted) << k;
      for (int i = 0; i < config.wheel_count; ++i) {
        EXPECT_TRUE(out.is_open[i]);
        EXPECT_EQ(out.winding_C[i], 0.0F);
      }
    }
    ASSERT_TRUE(robot_core::start(config, state, {.is_rested = true, .body_C = 25.0F}));
    EXPECT_EQ(robot_core::step(config, state, plant.sense(random, 0.3F, true)).robot_reason, Reason::none);
  }
}

TEST(FaultTable, period_invalid) {
  for (const float elapsed_s : {0.0F, -0.001F, kInfinite, -kInfinite, kNone}) {
    const Record record = check(
        {.code = Reason::period_invalid, .periods = 30, .spoil = [=](Input& input, State&, int) { input.elapsed_s = elapsed_s; }}, 0, 0);
    EXPECT_TRUE(record.was_open_at_end);
    EXPECT_EQ(record.peak_A, 0.0);
  }
}

// The reference of a robot with open bridges follows the robot, so that it does not have to catch up with the command at once.
TEST(FaultTable, period_invalid_ends_as_a_start_from_rest_does) {
  const auto peak_A = [](int invalid_periods) {
    const Config config = make_config(4);
    Plant plant(config, {});
    State state;
    Random random(9);
    EXPECT_TRUE(robot_core::start(config, state, {.is_rested = true, .body_C = 25.0F}));
    double most_A = 0.0;
    for (int k = 0; k < invalid_periods + 200; ++k) {
      Input input = plant.sense(random, 0.3F, true);
      input.command.mode = Mode::body_velocity;
      input.command.velocity = {2.0F, 0.0F, 0.0F};
      input.elapsed_s = k < invalid_periods ? kNone : input.elapsed_s;
      const Output out = robot_core::step(config, state, input);
      for (int i = 0; i < config.wheel_count; ++i) {
        most_A = std::max(most_A, std::abs(plant.coldest_current_A(out, i)));
      }
      plant.move(out);
    }
    return most_A;
  };
  EXPECT_LE(peak_A(500), peak_A(0) + fault_margin_A(make_config(4)));
}

// An invalid time may hide a gap up to the watchdog's time; further ones find the bridges open.
TEST(FaultTable, period_invalid_counts_the_gap_that_it_may_hide) {
  const auto heated_K = [](int invalid_periods, bool is_open) {
    const Config config = make_config(4);
    State state;
    Random random(4);
    EXPECT_TRUE(robot_core::start(config, state, {.is_rested = true, .body_C = 60.0F}));
    const Plant plant(config, {});
    Output out;
    for (int k = 0; k < 60; ++k) {
      Input input = plant.sense(random, 0.0F, true);
      input.command.mode = is_open ? Mode::coast : Mode::brake;
      input.elapsed_s = k >= 30 && k < 30 + invalid_periods ? kNone : input.elapsed_s;
      out = robot_core::step(config, state, input);
    }
    return static_cast<double>(out.winding_C[kWheel]) - 60.0;
  };
  const double least_K = heated_K(0, false);
  // 14 A for 20 ms heat 6 J/K by (1.3·14²·1.14 ohm)·0.02 s/6 = 0.97 K.
  EXPECT_NEAR(heated_K(1, false) - least_K, 0.97, 0.15);
  EXPECT_NEAR(heated_K(20, false), heated_K(1, false), 0.05);
  EXPECT_NEAR(heated_K(1, true), least_K, 0.05);
}

TEST(FaultTable, time_jump) {
  // Each guard counts the gap in its next step, at most one guard period and one control period later.
  const Case test{.code = Reason::time_jump, .periods = 11, .spoil = [](Input& input, State&, int k) {
                    input.elapsed_s = k == 0 ? 0.05F : input.elapsed_s;
                  }};
  const Record record = check(test, 0, 0);
  // 14 A for 50 ms heat 6 J/K by (1.3·14²·1 ohm)·0.05 s/6 = 2.1 K, independent of the true current.
  EXPECT_GT(record.hottest_guard_C, run(test, true).hottest_guard_C + 1.5);
}

TEST(FaultTable, command_invalid) {
  for (const auto& spoil :
       {std::function<void(Input&, State&, int)>([](Input&in, State&, int) { in.command.velocity.y = kNone; }),
        std::function<void(Input&, State&, int)>([](Input&in, State&, int) { in.command.push.x = kInfinite; }),
        std::function<void(Input&, State&, int)>([](Input&in, State&, int) {
          in.command.velocity = {1e30F, -1e30F, 0};
        }),
        std::function<void(Input&, State&, int)>([](Input&in, State&, int) { in.command.mode = static_cast<Mode>(77); })}) {
    const Record record = check({.code = Reason::command_invalid, .periods = 1500, .spoil = spoil}, 0, 0);
    EXPECT_TRUE(record.was_open_at_end);
    EXPECT_EQ(record.peak_A, 0.0);
  }
}

TEST(FaultTable, command_stale) {
  for (const float age_s : {0.21F, kNone, -1.0F, kInfinite}) {
    const Record record = check(
        {.code = Reason::command_stale, .periods = 1500, .spoil = [=](Input& input, State&, int) { input.command_age_s = age_s; }}, 0, 0);
    EXPECT_TRUE(record.was_open_at_end);
    EXPECT_EQ(record.peak_A, 0.0);
  }
}

TEST(FaultTable, pose_invalid) {
  std::vector<std::function<void(Input&)>> poses{[](Input& input) { input.pose.x = kNone; }};
  for (const float age_s : {0.21F, kNone, -1.0F, kInfinite}) {
    poses.emplace_back([=](Input& input) { input.pose_age_s = age_s; });
  }
  for (const auto& set : poses) {
    const Record record = check(
        {.code = Reason::pose_invalid, .periods = 1500, .spoil = [&](Input& input, State&, int) { set(input); }, .mode = Mode::pose_target},
        0, 0);
    EXPECT_TRUE(record.was_open_at_end);
    EXPECT_EQ(record.peak_A, 0.0);
  }
  Config config = make_config(4);
  config.plan_step = nullptr;
  State state;
  Random random(1);
  ASSERT_TRUE(robot_core::start(config, state, {.is_rested = true, .body_C = 25.0F}));
  Input input = Plant(config, {}).sense(random, 0.0F, true);
  input.command.mode = Mode::pose_target;
  EXPECT_EQ(robot_core::step(config, state, input).robot_reason, Reason::pose_invalid);
}

TEST(FaultTable, current_missing) {
  for (const float sample : {kNone, kInfinite, -500.0F}) {
    check({.code = Reason::current_missing, .spoil = [=](Input& input, State&, int) { input.motor_current_A[kWheel] = sample; }}, 0, 0);
  }
}

TEST(FaultTable, current_implausible) {
  const Case test{.code = Reason::current_implausible, .spoil = [](Input& input, State&, int) { input.motor_current_A[kWheel] = 9.0F; }};
  const Record record = check(test, 80, kSteadyAgain + 60);
  EXPECT_GT(record.hottest_guard_C, run(test, true).hottest_guard_C);
}

TEST(FaultTable, battery_voltage_missing) {
  for (const float sample_V : {kNone, kInfinite, 0.0F, 8.0F, 40.0F}) {
    check({.code = Reason::battery_voltage_missing, .spoil = [=](Input& input, State&, int) { input.battery_V = sample_V; }}, 0, 0);
  }
}

// A converter that is not ready yet: without a sample the battery may be full, so a low sample that comes later proves nothing.
TEST(BatteryVoltage, MissingAtTheStartIsThatOfAFullBattery) {
  const Config config = make_config(4);
  constexpr float kTrue_V = 20.0F;
  for (const int missing : {0, 1, 10, 30}) {
    State state;
    ASSERT_TRUE(robot_core::start(config, state, {.is_rested = true, .body_C = 25.0F}));
    for (int k = 0; k < 100; ++k) {
      Input input;
      const float noise = 0.01F * static_cast<float>(k % 3);
      std::fill_n(input.wheel_speed_rad_per_s, 4, noise);
      input.yaw_rate_rad_per_s = 0.1F * noise;
      input.battery_V = k < missing ? kNone : k == 50 ? 13.0F : kTrue_V;
      input.elapsed_s = config.period_s;
      input.command.mode = Mode::body_velocity;
      input.command.velocity.x = 2.0F;
      const Output out = robot_core::step(config, state, input);
      for (int i = 0; i < 4; ++i) {
        constexpr float kTolerance_ratio = 1.03F;
        EXPECT_LE(std::abs(out.pwm_ratio[i]) * kTrue_V, kTolerance_ratio * std::abs(out.voltage_V[i])) << missing << ", period " << k;
      }
    }
  }
}

TEST(FaultTable, yaw_rate_missing) {
  for (const float sample : {kNone, kInfinite, 100.0F, -40.0F}) {
    check({.code = Reason::yaw_rate_missing, .spoil = [=](Input& input, State&, int) { input.yaw_rate_rad_per_s = sample; }}, 0,
          kSteadyAgain);
  }
}

TEST(FaultTable, yaw_rate_stuck) {
  float held = 0.0F;
  check({.code = Reason::yaw_rate_stuck,
         .spoil =
             [&](Input& input, State&, int k) {
               held = k == 0 ? input.yaw_rate_rad_per_s : held;
               input.yaw_rate_rad_per_s = held;
             }},
        400, kSteadyAgain);
}

TEST(FaultTable, ambient_missing) {
  for (const float sample_C : {kNone, 0.0F, 300.0F, -200.0F}) {
    const Case test{.code = Reason::ambient_missing, .spoil = [=](Input& input, State&, int) { input.ambient_C = sample_C; }};
    const Record record = check(test, 0, 0);
    EXPECT_GE(record.hottest_guard_C, run(test, true).hottest_guard_C);
  }
}

TEST(FaultTable, stator_missing) {
  for (const float sample_C : {kNone, kInfinite, -100.0F, 900.0F}) {
    // The sample is checked when the guard is stepped, every 10 periods.
    check({.code = Reason::stator_missing, .spoil = [=](Input& input, State&, int) { input.stator_C[kWheel] = sample_C; }}, 10, 10);
  }
}

TEST(FaultTable, guard_unknown) {
  const Record record = run({.code = Reason::guard_unknown,
                             .periods = 20,
                             .spoil = [](Input&, State& state, int k) { state.guard[kWheel].state_C[0] -= k == 0 ? 3.0F : 0.0F; }},
                            false);
  EXPECT_GE(record.first_period, kFrom);
  EXPECT_LE(record.first_period, kFrom + 10);
  EXPECT_GE(record.hottest_guard_C, kWindingLimit_C - 1.0);
  // After a power loss of unknown duration the guard starts at its limit, until it has cooled down.
  const Config config = make_config(4);
  const Plant plant(config, {});
  State state;
  Random random(3);
  ASSERT_TRUE(robot_core::start(config, state, {}));
  double cleared_C = 0.0;
  for (int k = 0; k < 600000 && cleared_C == 0.0; ++k) {
    const Output out = robot_core::step(config, state, plant.sense(random, 0.3F, true));
    EXPECT_TRUE(k > 0 || out.reason[0] == Reason::guard_unknown);
    EXPECT_TRUE(k > 0 || out.allowed_current_A[0] < 0.5F);
    cleared_C = out.reason[0] == Reason::guard_unknown ? 0.0 : static_cast<double>(out.winding_C[0]);
  }
  EXPECT_GT(cleared_C, 30.0);
  EXPECT_LT(cleared_C, 100.0);
}

TEST(Limits, AreReasonsButNoFaults) {
  for (const Reason limit :
       {Reason::voltage, Reason::driver_current, Reason::battery_sag, Reason::traction, Reason::guard, Reason::other_wheel}) {
    EXPECT_FALSE(is_fault(limit));
  }
  std::set<Reason> seen;
  for (const double body_C : {25.0, 150.0}) {
    for (const Mode mode : {Mode::body_velocity, Mode::wheel_torque, Mode::wheel_speed}) {
      const Config config = make_config(4);
      Plant plant(config, {});
      plant.warm_up(body_C);
      State state;
      Random random(2);
      ASSERT_TRUE(robot_core::start(config, state, {.is_rested = true, .body_C = static_cast<float>(body_C)}));
      for (int k = 0; k < 300; ++k) {
        Input input = plant.sense(random, 0.3F, true);
        input.command.mode = mode;
        input.command.velocity = {3.0F, 0.5F, 0.0F};
        std::ranges::fill(input.command.wheel_torque_Nm, 0.5F);
        std::ranges::fill(input.command.wheel_speed_rad_per_s, 420.0F);
        const Output out = robot_core::step(config, state, input);
        seen.insert(out.reason, out.reason + 4);
        EXPECT_EQ(out.robot_reason, Reason::none);
        plant.move(out);
      }
    }
  }
  for (const Reason limit : {Reason::voltage, Reason::driver_current, Reason::traction, Reason::guard, Reason::other_wheel}) {
    EXPECT_EQ(seen.count(limit), 1U) << static_cast<int>(limit);
  }
  EXPECT_TRUE(std::ranges::none_of(seen, is_fault));
}

TEST(DriveHome, ThreeMetresWithoutASpeedSensor) {
  for (const int wheels : {4, 3}) {
    for (const bool are_currents_fitted : {true, false}) {
      for (int lost = 0; lost < wheels; ++lost) {
        const Config config = make_config(wheels);
        Plant plant(config, {});
        State state;
        Random random(7);
        ASSERT_TRUE(robot_core::start(config, state, {.is_rested = true, .body_C = 25.0F}));
        int k = 0;
        double peak_A = 0.0;
        for (; k < 20000 && std::hypot(plant.x_m(), plant.y_m()) < 3.0; ++k) {
          Input input = plant.sense(random, 0.3F, are_currents_fitted);
          input.wheel_speed_rad_per_s[lost] = kNone;
          input.command.mode = Mode::body_velocity;
          input.command.velocity = {0.5F, 0.0F, 0.0F};
          const Output out = robot_core::step(config, state, input);
          peak_A = std::max(peak_A, std::abs(plant.coldest_current_A(out, lost)));
          plant.move(out);
        }
        EXPECT_LT(k, 20000) << wheels << " wheels, without that of wheel " << lost;
        EXPECT_LE(peak_A, static_cast<double>(config.limp_current_A) + fault_margin_A(config));
        EXPECT_NEAR(plant.y_m(), 0.0, wheels == 4 ? 0.5 : 1.0) << wheels << " wheels, without that of wheel " << lost;
      }
    }
  }
}

}  // namespace
}  // namespace heatsoak::test_robot
