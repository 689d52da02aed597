// Each reason of the drive core about wheel speeds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "fault_cases.h"
#include "test_robot.h"

namespace heatsoak::test_robot {
namespace {

TEST(FaultTable, wheel_speed_missing) {
  for (const int wheels : {4, 3}) {
    for (const float sample : {kNone, kInfinite, 1000.0F}) {
      const Record record = check({.code = Reason::wheel_speed_missing,
                                   .wheel_count = wheels,
                                   .spoil = [=](Input& input, State&, int) { input.wheel_speed_rad_per_s[kWheel] = sample; }},
                                  0, kSteadyAgain);
      const Config config = make_config(wheels);
      EXPECT_LE(record.peak_of_wheel_A, static_cast<double>(config.limp_current_A) + fault_margin_A(config));
    }
  }
}

TEST(FaultTable, wheel_speed_jump) {
  const Record record =
      check({.code = Reason::wheel_speed_jump, .spoil = [](Input& input, State&, int) { input.wheel_speed_rad_per_s[kWheel] += 150.0F; }},
            0, kSteadyAgain);
  EXPECT_LE(record.peak_of_wheel_A, 1.5 + fault_margin_A(make_config(4)));
}

TEST(FaultTable, wheel_speed_stuck) {
  for (const bool are_currents_fitted : {true, false}) {
    float held = 0.0F;
    check({.code = Reason::wheel_speed_stuck,
           .are_currents_fitted = are_currents_fitted,
           .periods = 700,
           .spoil =
               [&](Input& input, State&, int k) {
                 held = k == 0 ? input.wheel_speed_rad_per_s[kWheel] : held;
                 input.wheel_speed_rad_per_s[kWheel] = held;
               }},
          700, kSteadyAgain);
  }
}

TEST(FaultTable, wheel_speed_wrong) {
  for (const bool are_currents_fitted : {true, false}) {
    const Case test{.code = Reason::wheel_speed_wrong,
                    .are_currents_fitted = are_currents_fitted,
                    .periods = 2500,
                    .spoil = [](Input& input, State&, int) { input.wheel_speed_rad_per_s[kWheel] *= -1.0F; },
                    .until = 4500};
    const Record record = run(test, false);
    EXPECT_EQ(run(test, true).first_period, -1);
    EXPECT_GE(record.first_period, kFrom + 1000);
    EXPECT_LE(record.first_period, kFrom + 2000);
    EXPECT_LE(record.last_period, kFrom + test.periods + kSteadyAgain + 100);
    EXPECT_LE(record.peak_A, run(test, true).peak_A + fault_margin_A(make_config(4)));
    // The fault begins with a jump of the sample.
    EXPECT_EQ(record.others, std::set<Reason>{Reason::wheel_speed_jump});
  }
}

TEST(FaultTable, wheel_speed_swapped) {
  const Case test{.code = Reason::wheel_speed_swapped,
                  .periods = 3000,
                  .spoil = [](Input& input, State&, int) { std::swap(input.wheel_speed_rad_per_s[1], input.wheel_speed_rad_per_s[3]); },
                  .from = 0};
  const Record record = check(test, 500, 0);
  EXPECT_EQ(record.last_period, test.until - 1);
  // Only start() clears this fault.
  const Record after = run({.code = test.code, .periods = 1000, .spoil = test.spoil, .from = 0}, false);
  EXPECT_EQ(after.last_period, test.until - 1);
}

TEST(FaultTable, wheel_speed_unknown) {
  for (const bool are_currents_fitted : {true, false}) {
    const Case test{.code = Reason::wheel_speed_unknown,
                    .are_currents_fitted = are_currents_fitted,
                    .spoil = [](Input& input, State&, int) { std::fill_n(input.wheel_speed_rad_per_s, 3, kNone); }};
    const Record record = run(test, false);
    EXPECT_EQ(record.first_period, kFrom);
    // All wheels agree again, so all are accepted again, although for a while none was.
    EXPECT_LE(record.last_period, kFrom + 400 + 2 * kSteadyAgain);
    EXPECT_EQ(record.others, std::set<Reason>{Reason::wheel_speed_missing});
    const Config config = make_config(4);
    // A sensed current above this opens the bridge.
    const double limp_A = 1.3 * static_cast<double>(config.limp_current_A) + fault_margin_A(config);
    EXPECT_LE(record.peak_of_wheel_A, are_currents_fitted ? limp_A : 0.0);
    EXPECT_LE(record.peak_A, run(test, true).peak_A + fault_margin_A(config));
  }
}

// The table of this motor falls with the speed, and the speed of the wheel is unknown.
TEST(LimpCurrent, IsNoMoreThanAHotMotorMayGetAtAnySpeed) {
  const Config config = make_config(4);
  const robot_core::GuardModel& model = *config.guard;
  ASSERT_GT(model.table.speed_rad_per_s.count, 1);
  int reduced = 0;
  for (float body_C = 40.0F; body_C < 155.0F; body_C += 2.0F) {
    State state;
    ASSERT_TRUE(robot_core::start(config, state, {.is_rested = true, .body_C = body_C}));
    Plant plant(config, {});
    Random random(1);
    for (int k = 0; k < 100; ++k) {
      Input input = plant.sense(random, kNoise_rad_per_s, true);
      std::fill_n(input.wheel_speed_rad_per_s, 3, kNone);
      input.command.mode = Mode::coast;
      robot_core::step(config, state, input);
    }
    const robot_core::GuardState& guard = state.guard[0];
    for (const float share : {0.0F, 0.3F, 0.6F, 1.0F}) {
      const float speed_rad_per_s = share * model.table.most_speed_rad_per_s;
      const float winding_C = guard.state_C[0] + config.braking_reserve_K;
      EXPECT_LE(state.wheel[0].allowed_A, robot_core::allowed_current_A(model, speed_rad_per_s, guard.state_C[1], winding_C) + 1e-3F)
          << body_C << " degC, " << share;
    }
    EXPECT_LE(state.wheel[0].allowed_A, config.limp_current_A);
    reduced += state.wheel[0].allowed_A > 0.0F && state.wheel[0].allowed_A < config.limp_current_A ? 1 : 0;
  }
  EXPECT_GT(reduced, 1);
}

// Swapped sensors of opposite wheels: a push of 0.3 s may make a robot spin that should stand.
TEST(FaultTable, runaway) {
  const Config config = make_config(4);
  int runaways = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    State state;
    Random random(seed);
    ASSERT_TRUE(robot_core::start(config, state, {.is_rested = true, .body_C = 25.0F}));
    Plant plant(config, {});
    const double x_N = random.between(-8.0F, 8.0F);
    const double y_N = random.between(-8.0F, 8.0F);
    int first = -1;
    int last = -1;
    for (int k = 0; k < 8000; ++k) {
      plant.set_push(k > 100 && k < 400 ? x_N : 0.0, k > 100 && k < 400 ? y_N : 0.0, 0.0);
      Input input = plant.sense(random, kNoise_rad_per_s, true);
      std::swap(input.wheel_speed_rad_per_s[0], input.wheel_speed_rad_per_s[2]);
      input.command.mode = Mode::body_velocity;
      const Output output = robot_core::step(config, state, input);
      plant.move(output);
      if (output.robot_reason == Reason::runaway) {
        EXPECT_EQ(std::ranges::count(output.is_open, true), 4);
        EXPECT_TRUE(last < 0 || last == k - 1) << "reported twice";
        first = first < 0 ? k : first;
        last = k;
      }
    }
    if (first >= 0) {
      ++runaways;
      EXPECT_GT(first, 1000);
      EXPECT_LT(first, 4000);
      EXPECT_LT(last, 7000);
    }
    for (int i = 0; i < 4; ++i) {
      EXPECT_LT(std::abs(plant.wheel_speed_rad_per_s(i)) * static_cast<double>(config.wheel_radius_m), 0.05);
    }
  }
  EXPECT_GT(runaways, 0);
}

TEST(FaultTable, wheel_speeds_dead) {
  const auto all_zero = [](Input& input, State&, int) { std::fill_n(input.wheel_speed_rad_per_s, 4, 0.0F); };
  const Case test{
      .code = Reason::wheel_speeds_dead, .are_currents_fitted = false, .periods = 3000, .spoil = all_zero, .until = 4000, .from = 0};
  const Record record = run(test, false);
  EXPECT_GE(record.first_period, 300);
  EXPECT_LE(record.first_period, 400);
  EXPECT_LE(record.last_period, 3000 + 16);
  // A runaway motor at the limp current's voltage reaches the speed of its back-EMF. Rolling wheels are at most as fast as the robot.
  const Config config = make_config(4);
  const float limp_rad_per_s = config.limp_current_A * config.lowest_resistance_ohm / config.derived.geared_constant_V_s_per_rad;
  EXPECT_LE(record.speed_at_end_m_per_s, 1.5 * static_cast<double>(limp_rad_per_s * config.wheel_radius_m));
  // A robot at rest, then held: 0.3 s of pushing, then the limp current.
  EXPECT_LT(record.peak_of_wheel_A, 12.0);
  // A gap in time or a flipped bit every 250 ms does not make the dead sensors count as working.
  for (const bool is_gap : {true, false}) {
    Case upset = test;
    upset.spoil = [&](Input& input, State& state, int k) {
      all_zero(input, state, k);
      if (k > 1000 && k % 250 == 0) {
        input.elapsed_s = is_gap ? 3.5F * config.period_s : input.elapsed_s;
        state.comparison.standing_s += is_gap ? 0.0F : 1e-3F;
      }
    };
    EXPECT_LE(run(upset, false).speed_at_end_m_per_s, 1.5 * static_cast<double>(limp_rad_per_s * config.wheel_radius_m)) << is_gap;
  }
}

}  // namespace
}  // namespace heatsoak::test_robot
