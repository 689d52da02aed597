// Tests every row of the fault table in robot_core/reason.h on a driving robot: condition, reaction, reason code and how it clears.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "fault_table_rows.h"
#include "test_robot.h"

namespace heatsoak::test_robot {
namespace {

using robot_core::Config;
using robot_core::Input;
using robot_core::is_fault;
using robot_core::Mode;
using robot_core::Output;
using robot_core::Reason;
using robot_core::State;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kFrom = 300;  ///< first period of the fault; the command reverses a little later
constexpr int kReversal = 320;
constexpr int kWheel = 1;

/// Record of a run from kFrom to the end of the fault, and afterwards.
struct Record {
  double peak_A = 0.0;           ///< largest current of the coldest motor during the fault
  double peak_of_wheel_A = 0.0;  ///< largest current of kWheel alone
  int first_period = -1;         ///< first period with the code, after kFrom
  int last_period = -1;
  std::set<Reason> others;      ///< codes of other faults
  bool was_open_at_end = true;  ///< true if all bridges were open in the last period of the fault
  double speed_at_end_m_per_s = 0.0;
  double hottest_guard_C = 0.0;  ///< temperature of kWheel at the end of the fault
};

struct Case {
  Reason code = Reason::none;
  int wheel_count = 4;
  bool are_currents_fitted = true;
  int periods = 400;                               ///< duration of the fault
  std::function<void(Input&, State&, int)> spoil;  ///< injects the fault; the last argument is the period since kFrom
  int until = 3000;
  int from = kFrom;
  Mode mode = Mode::body_velocity;
};

bool is_reported(const Output& out, Reason code, char letter) {
  return letter == 'R' ? out.robot_reason == code : std::ranges::find(out.reason, code) != std::end(out.reason);
}

Record run(const Case& test, bool is_healthy) {
  const Config config = make_config(test.wheel_count);
  const char letter = table_rows()[static_cast<int>(test.code)];
  Plant plant(config, {});
  State state;
  Random random(5);
  Record record;
  EXPECT_TRUE(robot_core::start(config, state, {.is_rested = true, .body_C = 25.0F}));
  for (int k = 0; k < test.until; ++k) {
    Input input = plant.sense(random, 0.3F, test.are_currents_fitted);
    input.command.mode = test.mode;
    const float way = k < kReversal || k > kReversal + 400 ? 1.0F : -1.0F;
    input.command.velocity = {1.2F * way, 0.4F * way, 2.0F * way};
    input.command.pose = {2.0F * way, 1.0F, 0.0F};
    const bool is_during = k >= test.from && k < test.from + test.periods;
    if (is_during && !is_healthy) {
      test.spoil(input, state, k - test.from);
    }
    const Output out = robot_core::step(config, state, input);
    if (is_during) {
      record.was_open_at_end = std::ranges::all_of(out.is_open, [](bool open) { return open; });
      record.speed_at_end_m_per_s = std::hypot(plant.x_m_per_s(), plant.y_m_per_s());
      record.hottest_guard_C = static_cast<double>(out.winding_C[kWheel]);
      for (int i = 0; i < config.wheel_count; ++i) {
        record.peak_A = std::max(record.peak_A, std::abs(plant.coldest_current_A(out, i)));
      }
      record.peak_of_wheel_A = std::max(record.peak_of_wheel_A, std::abs(plant.coldest_current_A(out, kWheel)));
    }
    if (is_reported(out, test.code, letter)) {
      record.first_period = record.first_period < 0 ? k : record.first_period;
      record.last_period = k;
    }
    record.others.insert(out.robot_reason);
    record.others.insert(out.reason, out.reason + config.wheel_count);
    plant.move(out);
  }
  std::erase_if(record.others, [&](Reason reason) { return reason == test.code || !is_fault(reason); });
  return record;
}

/// Noise of 0.3 rad/s, slip within the grip and one period of the contact's largest force.
double margin_A(const Config& config) {
  return static_cast<double>(config.derived.geared_constant_V_s_per_rad) * (Plant(config, {}).contact_change_rad_per_s() + 2.0) /
         static_cast<double>(config.lowest_resistance_ohm);
}

/// Checks that the fault is reported within `delay` periods and at most `lag` periods after its end, alone, without a higher current.
Record check(const Case& test, int delay, int lag) {
  const Record healthy = run(test, true);
  const Record faulty = run(test, false);
  EXPECT_EQ(healthy.first_period, -1);
  EXPECT_TRUE(healthy.others.empty());
  EXPECT_GE(faulty.first_period, test.from);
  EXPECT_LE(faulty.first_period, test.from + delay);
  EXPECT_LE(faulty.last_period, test.from + test.periods - 1 + lag);
  EXPECT_LE(faulty.peak_A, healthy.peak_A + margin_A(make_config(test.wheel_count)));
  for (const Reason other : faulty.others) {
    if (test.code == Reason::state_corrupted && other == Reason::guard_unknown) {
      continue;  // the guard starts at its temperature limit
    }
    ADD_FAILURE() << "also reported: " << static_cast<int>(other);
  }
  return faulty;
}

constexpr int kSteadyAgain = static_cast<int>(1e3F * robot_core::kSteadyAgain_s) + 100;  // comparisons run every 16 periods

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

TEST(FaultTable, period_invalid) {
  for (const float elapsed_s : {0.0F, -0.001F, kInfinity, -kInfinity, kNone}) {
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
  EXPECT_LE(peak_A(500), peak_A(0) + margin_A(make_config(4)));
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
        std::function<void(Input&, State&, int)>([](Input&in, State&, int) { in.command.push.x = kInfinity; }),
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
  for (const float age_s : {0.21F, kNone, -1.0F, kInfinity}) {
    const Record record = check(
        {.code = Reason::command_stale, .periods = 1500, .spoil = [=](Input& input, State&, int) { input.command_age_s = age_s; }}, 0, 0);
    EXPECT_TRUE(record.was_open_at_end);
    EXPECT_EQ(record.peak_A, 0.0);
  }
}

TEST(FaultTable, pose_invalid) {
  std::vector<std::function<void(Input&)>> poses{[](Input& input) { input.pose.x = kNone; }};
  for (const float age_s : {0.21F, kNone, -1.0F, kInfinity}) {
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

TEST(FaultTable, wheel_speed_missing) {
  for (const int wheels : {4, 3}) {
    for (const float sample : {kNone, kInfinity, 1000.0F}) {
      const Record record = check({.code = Reason::wheel_speed_missing,
                                   .wheel_count = wheels,
                                   .spoil = [=](Input& input, State&, int) { input.wheel_speed_rad_per_s[kWheel] = sample; }},
                                  0, kSteadyAgain);
      const Config config = make_config(wheels);
      EXPECT_LE(record.peak_of_wheel_A, static_cast<double>(config.limp_current_A) + margin_A(config));
    }
  }
}

TEST(FaultTable, wheel_speed_jump) {
  const Record record =
      check({.code = Reason::wheel_speed_jump, .spoil = [](Input& input, State&, int) { input.wheel_speed_rad_per_s[kWheel] += 150.0F; }},
            0, kSteadyAgain);
  EXPECT_LE(record.peak_of_wheel_A, 1.5 + margin_A(make_config(4)));
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
    EXPECT_LE(record.peak_A, run(test, true).peak_A + margin_A(make_config(4)));
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
    Record record = run({.code = Reason::wheel_speed_unknown,
                         .are_currents_fitted = are_currents_fitted,
                         .spoil = [](Input& input, State&, int) { std::fill_n(input.wheel_speed_rad_per_s, 3, kNone); }},
                        false);
    EXPECT_EQ(record.first_period, kFrom);
    // All wheels agree again, so all are accepted again, although for a while none was.
    EXPECT_LE(record.last_period, kFrom + 400 + 2 * kSteadyAgain);
    EXPECT_EQ(record.others, std::set<Reason>{Reason::wheel_speed_missing});
    EXPECT_LE(record.peak_of_wheel_A, are_currents_fitted ? 4.6 : 0.0);
  }
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

TEST(FaultTable, current_missing) {
  for (const float sample : {kNone, kInfinity, -500.0F}) {
    check({.code = Reason::current_missing, .spoil = [=](Input& input, State&, int) { input.motor_current_A[kWheel] = sample; }}, 0, 0);
  }
}

TEST(FaultTable, current_implausible) {
  const Case test{.code = Reason::current_implausible, .spoil = [](Input& input, State&, int) { input.motor_current_A[kWheel] = 9.0F; }};
  const Record record = check(test, 80, kSteadyAgain + 60);
  EXPECT_GT(record.hottest_guard_C, run(test, true).hottest_guard_C);
}

TEST(FaultTable, battery_voltage_missing) {
  for (const float sample_V : {kNone, kInfinity, 0.0F, 8.0F, 40.0F}) {
    check({.code = Reason::battery_voltage_missing, .spoil = [=](Input& input, State&, int) { input.battery_V = sample_V; }}, 0, 0);
  }
}

TEST(FaultTable, yaw_rate_missing) {
  for (const float sample : {kNone, kInfinity, 100.0F, -40.0F}) {
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
  for (const float sample_C : {kNone, kInfinity, -100.0F, 900.0F}) {
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
        EXPECT_LE(peak_A, static_cast<double>(config.limp_current_A) + margin_A(config));
        EXPECT_NEAR(plant.y_m(), 0.0, wheels == 4 ? 0.5 : 1.0) << wheels << " wheels, without that of wheel " << lost;
      }
    }
  }
}

}  // namespace
}  // namespace heatsoak::test_robot
