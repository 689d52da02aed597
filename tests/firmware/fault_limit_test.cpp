// Limits of the current with and without a fault, in cores of the shipped robots: no fault may raise one.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "firmware/core_config.h"
#include "firmware/host_guard.h"
#include "support/shipped.h"

namespace heatsoak::firmware {
namespace {

constexpr float kNone = robot_core::kNoSample;

struct Fault {
  const char* name;
  void (*spoil)(robot_core::Input& input, robot_core::State& state);
};

/// One fault per group of the table in robot_core/reason.h. Those of commands are absent: they open the bridges.
constexpr Fault kFaults[] = {
    {"one wheel speed lost", [](robot_core::Input& input, robot_core::State&) { input.wheel_speed_rad_per_s[0] = kNone; }},
    {"three wheel speeds lost",
     [](robot_core::Input& input, robot_core::State&) {
       input.wheel_speed_rad_per_s[0] = input.wheel_speed_rad_per_s[1] = input.wheel_speed_rad_per_s[2] = kNone;
     }},
    {"gyro and two wheel speeds lost",
     [](robot_core::Input& input, robot_core::State&) {
       input.yaw_rate_rad_per_s = input.wheel_speed_rad_per_s[0] = input.wheel_speed_rad_per_s[2] = kNone;
     }},
    {"currents lost",
     [](robot_core::Input& input, robot_core::State&) {
       for (float& each : input.motor_current_A) {
         each = kNone;
       }
     }},
    {"battery lost", [](robot_core::Input& input, robot_core::State&) { input.battery_V = kNone; }},
    {"air lost", [](robot_core::Input& input, robot_core::State&) { input.ambient_C = kNone; }},
    {"timer lost", [](robot_core::Input& input, robot_core::State&) { input.elapsed_s = kNone; }},
    {"gap of time", [](robot_core::Input& input, robot_core::State&) { input.elapsed_s = 0.05F; }},
    {"bit flip in a guard", [](robot_core::Input&, robot_core::State& state) { state.guard[1].state_C[0] -= 1.0F; }},
    {"bit flip in the State", [](robot_core::Input&, robot_core::State& state) { state.wheel[1].allowed_A += 1.0F; }},
};

/// Sensors of a robot that is pushed along x, so that no voltage acts: limits differ by the faults only.
robot_core::Input pushed_input(const robot_core::Config& config, float motor_rad_per_s, int step) {
  robot_core::Input input;
  // Smallest noise that no sensor counts as stuck.
  const float noise = step % 2 == 0 ? 0.01F : -0.01F;
  float most_share = 0.0F;
  for (int i = 0; i < config.wheel_count; ++i) {
    most_share = std::max(most_share, std::abs(config.wheel[i].rolling_x_share));
  }
  for (int i = 0; i < config.wheel_count; ++i) {
    input.wheel_speed_rad_per_s[i] = motor_rad_per_s / config.gear_ratio * config.wheel[i].rolling_x_share / most_share + noise;
    input.motor_current_A[i] = noise;
  }
  input.battery_V = config.battery_full_V;
  input.yaw_rate_rad_per_s = 0.1F * noise;
  input.ambient_C = 30.0F;
  input.elapsed_s = config.period_s;
  input.command.mode = robot_core::Mode::coast;
  return input;
}

/// Counts the wheels and steps in which a fault raises a limit.
int raised_limits(const robot_core::Config& config, const robot_core::State& before, float motor_rad_per_s, const Fault& fault) {
  robot_core::State healthy = before;
  robot_core::State faulty = before;
  int raised = 0;
  for (int step = 0; step < 100; ++step) {
    const robot_core::Input truth = pushed_input(config, motor_rad_per_s, step);
    robot_core::Input shown = truth;
    fault.spoil(shown, faulty);
    robot_core::step(config, healthy, truth);
    robot_core::step(config, faulty, shown);
    for (int i = 0; i < config.wheel_count; ++i) {
      // Digits of a temperature in single precision.
      constexpr float kRounding_ratio = 1.001F;
      raised += faulty.wheel[i].allowed_A > kRounding_ratio * healthy.wheel[i].allowed_A ? 1 : 0;
      raised += faulty.wheel[i].allowed_braking_A > kRounding_ratio * healthy.wheel[i].allowed_braking_A ? 1 : 0;
    }
  }
  return raised;
}

TEST(FaultLimit, NoFaultRaisesALimitOfARobotAtAnyTemperatureAndSpeed) {
  for (const char* const id : {"roboteam_twente_v2024", "roboteam_twente_v2025", "tigers_v2020"}) {
    const robot::Robot robot = shipped_robot(id);
    const motor::Motor motor = shipped_motor(robot.drive.motor);
    derate::DerateOptions options;
    options.guarantee.required_share = 0.9;
    options.guarantee.samples = 32;
    const derate::Derating derating = derate::derate(motor, robot, options);
    const HostGuard guard(derating);
    const robot_core::Config config = make_core_config(robot, motor, {}, derating, guard);
    robot_core::State state;
    ASSERT_TRUE(robot_core::start(config, state, {})) << "the rest is unknown: the motors start at their limit";
    const auto table_rad_per_s = static_cast<float>(derating.rules.most_speed_rad_per_s);
    int step = 0;
    float allowed_A = 0.0F;
    for (const int cooled_s : {1, 3, 6, 9, 14, 20, 40, 90}) {
      for (const auto last = static_cast<int>(static_cast<float>(cooled_s) / config.period_s); step < last; ++step) {
        robot_core::step(config, state, pushed_input(config, 0.0F, step));
      }
      allowed_A = std::max(allowed_A, state.wheel[0].allowed_A);
      for (const float speed_share : {0.0F, 0.4F, 0.9F}) {
        robot_core::State rolling = state;
        constexpr int kSpeedUp = 1000;
        for (int i = 0; i < kSpeedUp + 20; ++i) {
          const float share = std::min(1.0F, static_cast<float>(i) / kSpeedUp);
          const robot_core::Output out = robot_core::step(config, rolling, pushed_input(config, share * speed_share * table_rad_per_s, i));
          ASSERT_TRUE(out.robot_reason == robot_core::Reason::none) << id << ", " << static_cast<int>(out.robot_reason);
          ASSERT_EQ(rolling.wheel[0].speed_fault + rolling.wheel[1].speed_fault + rolling.wheel[2].speed_fault, 0) << id << ", step " << i;
        }
        for (const Fault& fault : kFaults) {
          EXPECT_EQ(raised_limits(config, rolling, speed_share * table_rad_per_s, fault), 0)
              << id << ", " << fault.name << ", " << cooled_s << " s after the limit, " << speed_share << " of the table's speed";
        }
      }
    }
    EXPECT_GT(allowed_A, config.limp_current_A) << "the motors must have cooled";
  }
}

}  // namespace
}  // namespace heatsoak::firmware
