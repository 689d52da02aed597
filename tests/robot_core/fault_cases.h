// Runs of the drive core with one fault, compared with the same run without it.
#pragma once

// Tests every row of the fault table in robot_core/reason.h on a driving robot: condition, reaction, reason code and how it clears.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <set>

#include "fault_table_rows.h"
#include "test_robot.h"

namespace heatsoak::test_robot {

using robot_core::Config;
using robot_core::Input;
using robot_core::is_fault;
using robot_core::Mode;
using robot_core::Output;
using robot_core::Reason;
using robot_core::State;

inline constexpr float kInfinite = std::numeric_limits<float>::infinity();
inline constexpr int kFrom = 300;  ///< first period of the fault; the command reverses a little later
inline constexpr int kReversal = 320;
inline constexpr int kWheel = 1;

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

inline bool is_reported(const Output& out, Reason code, char letter) {
  return letter == 'R' ? out.robot_reason == code : std::ranges::find(out.reason, code) != std::end(out.reason);
}

inline Record run(const Case& test, bool is_healthy) {
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
inline double fault_margin_A(const Config& config) {
  return static_cast<double>(config.derived.geared_constant_V_s_per_rad) * (Plant(config, {}).contact_change_rad_per_s() + 2.0) /
         static_cast<double>(config.lowest_resistance_ohm);
}

/// Checks that the fault is reported within `delay` periods and at most `lag` periods after its end, alone, without a higher current.
inline Record check(const Case& test, int delay, int lag) {
  const Record healthy = run(test, true);
  const Record faulty = run(test, false);
  EXPECT_EQ(healthy.first_period, -1);
  EXPECT_TRUE(healthy.others.empty());
  EXPECT_GE(faulty.first_period, test.from);
  EXPECT_LE(faulty.first_period, test.from + delay);
  EXPECT_LE(faulty.last_period, test.from + test.periods - 1 + lag);
  EXPECT_LE(faulty.peak_A, healthy.peak_A + fault_margin_A(make_config(test.wheel_count)));
  for (const Reason other : faulty.others) {
    if (test.code == Reason::state_corrupted && other == Reason::guard_unknown) {
      continue;  // the guard starts at its temperature limit
    }
    ADD_FAILURE() << "also reported: " << static_cast<int>(other);
  }
  return faulty;
}

inline constexpr int kSteadyAgain = static_cast<int>(1e3F * robot_core::kSteadyAgain_s) + 100;  // comparisons run every 16 periods

}  // namespace heatsoak::test_robot
