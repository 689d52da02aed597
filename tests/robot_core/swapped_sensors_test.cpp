// Two wheel sensors swapped by a wiring error: time until the core finds them, and current before that.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "test_robot.h"

namespace heatsoak::test_robot {
namespace {

using robot_core::Config;
using robot_core::Input;
using robot_core::Mode;
using robot_core::Output;
using robot_core::Reason;
using robot_core::State;

/// Drives as on the field: starts, stops and turns, with a new velocity every 0.2 to 0.8 s.
class Drive {
 public:
  Drive(const Config& config, bool are_currents_fitted, unsigned seed)
      : config_(config), are_currents_fitted_(are_currents_fitted), random_(seed), plant_(config, {}) {
    robot_core::start(config, state_, {.is_rested = true, .body_C = 25.0F});
  }

  const Output& period(int a, int b) {
    const robot_core::Vector3& velocity = command_.next(random_);
    Input input = plant_.sense(random_, 0.3F, are_currents_fitted_);
    if (--until_push_ <= 0) {
      until_push_ = 100 + random_.below(900);
      const bool is_pushed = is_pushed_ && random_.happens(0.5F);
      const auto force_N = [&](float most_N) { return is_pushed ? static_cast<double>(random_.between(-most_N, most_N)) : 0.0; };
      plant_.set_push(force_N(15.0F), force_N(15.0F), force_N(0.5F));
    }
    std::swap(input.wheel_speed_rad_per_s[a], input.wheel_speed_rad_per_s[b]);
    input.command.mode = Mode::body_velocity;
    input.command.velocity = is_standing_ ? robot_core::Vector3{} : velocity;
    output_ = robot_core::step(config_, state_, input);
    for (int i = 0; i < config_.wheel_count; ++i) {
      largest_A_ = std::max(largest_A_, std::abs(plant_.coldest_current_A(output_, i)));
    }
    plant_.move(output_);
    return output_;
  }
  /// Drives for some periods without swapped sensors and counts those with bridges that are open because of a runaway.
  void run(int periods, int& open) {
    for (int k = 0; k < periods; ++k) {
      open += period(0, 0).robot_reason == Reason::runaway ? 1 : 0;
    }
  }
  bool is_open() const { return output_.robot_reason == Reason::runaway; }
  bool is_checked() const { return state_.comparison.is_checked != 0; }
  /// Random forces and moments on the body.
  void push(bool is_pushed) { is_pushed_ = is_pushed; }
  void stand(bool is_standing) { is_standing_ = is_standing; }
  bool is_any_swap_reported() const {
    return std::ranges::any_of(state_.wheel, [](const robot_core::WheelState& each) {
      return each.speed_fault == static_cast<std::uint8_t>(Reason::wheel_speed_swapped);
    });
  }
  bool is_swap_reported(int i) const { return output_.reason[i] == Reason::wheel_speed_swapped; }
  double largest_A() const { return largest_A_; }
  double fastest_rim_m_per_s() const {
    double fastest_rad_per_s = 0.0;
    for (int i = 0; i < config_.wheel_count; ++i) {
      fastest_rad_per_s = std::max(fastest_rad_per_s, std::abs(plant_.wheel_speed_rad_per_s(i)));
    }
    return fastest_rad_per_s * static_cast<double>(config_.wheel_radius_m);
  }

 private:
  const Config& config_;
  bool are_currents_fitted_;
  Random random_;
  Plant plant_;
  State state_;
  Output output_;
  ChangingVelocity command_;
  int until_push_ = 0;
  bool is_pushed_ = false;
  bool is_standing_ = false;
  double largest_A_ = 0.0;
};

/// The thresholds of the core were chosen with the drives 100 to 139.
constexpr unsigned kFirstSeed = 5000;

struct Times {
  double mean_s = 0.0;
  double worst_s = 0.0;
  int never = 0;
  int wrong = 0;  ///< drives in which other wheels than the swapped ones were reported
  double largest_A = 0.0;
  int over = 0;  ///< drives with a current more than 15 % above the limit
};

Times find_times(const Config& config, bool are_currents_fitted, int a, int b, int runs, int last) {
  Times times;
  for (int seed = 0; seed < runs; ++seed) {
    Drive drive(config, are_currents_fitted, kFirstSeed + static_cast<unsigned>(seed));
    int k = 0;
    bool is_found = false;
    for (; k < last && !is_found; ++k) {
      drive.period(a, b);
      for (int i = 0; i < config.wheel_count; ++i) {
        is_found = is_found || drive.is_swap_reported(i);
      }
    }
    bool is_right = a != b;
    for (int i = 0; i < config.wheel_count; ++i) {
      is_right = is_right && drive.is_swap_reported(i) == (i == a || i == b);
    }
    times.never += is_found ? 0 : 1;
    times.wrong += is_found && !is_right ? 1 : 0;
    times.mean_s += 1e-3 * k / runs;
    times.worst_s = std::max(times.worst_s, 1e-3 * k);
    times.largest_A = std::max(times.largest_A, drive.largest_A());
    times.over += drive.largest_A() > 1.15 * static_cast<double>(config.wheel[0].body_limit_A) ? 1 : 0;
  }
  return times;
}

constexpr int kRuns = 200;

/// A swap of two wheels whose speeds a drive does not separate is found in a later manoeuvre.
TEST(SwappedSensors, AreFoundWhileLittleCurrentFlows) {
  std::printf("wheels | currents | pair | mean s | worst s | never | wrong | largest A | limit A\n");
  int drives = 0;
  int never = 0;
  int over = 0;
  for (const int wheels : {4, 3}) {
    const Config config = make_config(wheels);
    const auto limit_A = static_cast<double>(config.wheel[0].body_limit_A);
    for (const bool are_currents_fitted : {true, false}) {
      for (int a = 0; a < wheels; ++a) {
        for (int b = a + 1; b < wheels; ++b) {
          const Times times = find_times(config, are_currents_fitted, a, b, kRuns, 4000);
          std::printf("%d | %-6s | %d %d | %.3f | %.3f | %d | %d | %.2f | %.2f\n", wheels, are_currents_fitted ? "sensed" : "none", a, b,
                      times.mean_s, times.worst_s, times.never, times.wrong, times.largest_A, limit_A);
          EXPECT_LT(times.mean_s, 0.5);
          EXPECT_LE(times.wrong, kRuns / 10);
          drives += kRuns;
          never += times.never;
          over += times.over;
        }
      }
    }
  }
  std::printf("%d drives, %d not found within 4 s, %d with a current more than 15 %% above the limit\n", drives, never, over);
  EXPECT_LE(never, drives / 100);
  EXPECT_LE(over, drives / 100);
}

TEST(SwappedSensors, AreNotReportedWhereNoneAreSwapped) {
  for (const int wheels : {4, 3}) {
    const Config config = make_config(wheels);
    for (const bool are_currents_fitted : {true, false}) {
      const Times times = find_times(config, are_currents_fitted, 0, 0, kRuns, 10000);
      EXPECT_EQ(times.never, kRuns);
    }
  }
}

/// Share of robots without swapped sensors that report some, in per cent.
struct Alarms {
  int robots = 0;
  int reported = 0;

  double share_pct() const { return 100.0 * reported / robots; }
};

constexpr unsigned kPushedSeeds = 150;

// A robot that is pushed before it has driven may open its bridges, and drives on from the speed at which it rolls then. Shows with 95 %
// confidence that fewer than 1 in 200 such robots report swapped sensors (no report of 600: Clopper and Pearson, 1934).
TEST(SwappedSensors, AreNotReportedOfAPushedRobotThatShouldStand) {
  Alarms alarms;
  int open = 0;
  int rolling = 0;  // robots that roll with open bridges when they start to drive
  for (const int wheels : {4, 3}) {
    const Config config = make_config(wheels);
    for (const bool are_currents_fitted : {true, false}) {
      for (unsigned seed = 0; seed < kPushedSeeds; ++seed) {
        Drive drive(config, are_currents_fitted, kFirstSeed + seed);
        drive.stand(true);
        drive.push(true);
        drive.run(4000, open);
        drive.push(false);
        // The last push ends within 1 s.
        int open_at_rest = 0;
        drive.run(1000 + 10 * static_cast<int>(seed), open_at_rest);
        rolling += drive.is_open() ? 1 : 0;
        drive.stand(false);
        int open_while_driving = 0;
        drive.run(4000, open_while_driving);
        EXPECT_LE(open_while_driving, 16);  // until the next comparison
        ++alarms.robots;
        alarms.reported += drive.is_any_swap_reported() ? 1 : 0;
      }
    }
  }
  std::printf(
      "pushed for 4 s at rest: %d of %d robots report swapped sensors; bridges open for %.1f %% of the time; %d roll when they start\n",
      alarms.reported, alarms.robots, open / (40.0 * alarms.robots), rolling);
  EXPECT_GT(rolling, alarms.robots / 50);
  EXPECT_EQ(alarms.reported, 0);
}

// Pushes of up to 15 N, three quarters of the grip, for half of the time. Without current sensors only the reaction of the wheels
// distinguishes a push from a swap. The drives 30000 to 30599 gave the bounds: 2.8 % and 24.8 % of 1200 robots.
TEST(SwappedSensors, AreSeldomReportedOfARobotThatIsPushedOnItsFirstDrive) {
  for (const bool are_currents_fitted : {true, false}) {
    Alarms alarms;
    for (const int wheels : {4, 3}) {
      const Config config = make_config(wheels);
      for (unsigned seed = 0; seed < kPushedSeeds; ++seed) {
        Drive drive(config, are_currents_fitted, kFirstSeed + seed);
        drive.push(true);
        int open = 0;
        drive.run(10000, open);
        ++alarms.robots;
        alarms.reported += drive.is_any_swap_reported() ? 1 : 0;
      }
    }
    std::printf("pushed for half of the first 10 s, current sensors %s: %.1f %% of %d robots report swapped sensors\n",
                are_currents_fitted ? "fitted" : "not fitted", alarms.share_pct(), alarms.robots);
    EXPECT_LE(alarms.share_pct(), are_currents_fitted ? 5.0 : 33.0);
  }
}

TEST(SwappedSensors, AreNotSuspectedOfAPushedRobotThatHasDriven) {
  int driven = 0;
  int open = 0;
  for (const int wheels : {4, 3}) {
    const Config config = make_config(wheels);
    for (unsigned seed = 0; seed < 50; ++seed) {
      Drive drive(config, seed % 2 == 0, kFirstSeed + seed);
      drive.run(20000, open);
      driven += drive.is_checked() ? 1 : 0;
      drive.stand(true);
      drive.push(true);
      drive.run(4000, open);
      EXPECT_FALSE(drive.is_any_swap_reported());
    }
  }
  EXPECT_EQ(driven, 100);
  EXPECT_EQ(open, 0);
}

// Swapped sensors of a robot that should stand: a short push makes it run away, until the bridges open and it rolls out.
TEST(SwappedSensors, DoNotLetARobotRunAwayThatShouldStand) {
  for (const int wheels : {4, 3}) {
    const Config config = make_config(wheels);
    int open = 0;
    int running = 0;
    for (int a = 0; a < wheels; ++a) {
      for (int b = a + 1; b < wheels; ++b) {
        for (unsigned seed = 0; seed < 20; ++seed) {
          Drive drive(config, true, kFirstSeed + seed);
          drive.stand(true);
          int periods_at_speed = 0;
          for (int k = 0; k < 10000; ++k) {
            drive.push(k > 100 && k < 400);
            open += drive.period(a, b).robot_reason == Reason::runaway ? 1 : 0;
            periods_at_speed = drive.fastest_rim_m_per_s() > 0.3 ? periods_at_speed + 1 : 0;
            running = std::max(running, periods_at_speed);
          }
        }
      }
    }
    std::printf("%d wheels: bridges open for %d periods; wheels turn faster than 0.3 m/s for %.1f s at a time\n", wheels, open,
                1e-3 * running);
    EXPECT_GT(open, 0);
    EXPECT_LT(running, 4000);
  }
}

}  // namespace
}  // namespace heatsoak::test_robot
