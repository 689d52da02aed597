// The configured core in closed loop: on blocks, where the wheels drive only their own inertia, and on the ground.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "firmware/core_config.h"
#include "robot/plant.h"
#include "support/shipped.h"

namespace heatsoak::firmware {
namespace {

constexpr double kPeriod_s = 0.001;

struct Case {
  const char* robot;
  const char* motor;
};
constexpr Case kCases[] = {{"roboteam_twente_v2024", "maxon_ecx_flat_32l_48v"}, {"tigers_v2020", "nanotec_df45l024048_a2"}};

/// The wheels of a robot on blocks: each drives its own inertia against the drag of motor and bearing.
class Blocks {
 public:
  Blocks(const robot::Robot& robot, const motor::MotorValues& motor, double inertia_share)
      : drive_(robot::drive_constants(robot, motor)),
        inertia_kg_m2_(inertia_share * robot::make_body(robot, motor).wheel_inertia_kg_m2),
        drag_Nm_(drive_.drag_torque_Nm * drive_.gear_ratio + robot.friction.wheel_torque_Nm.value()),
        battery_V_(robot.battery.nominal_V) {}

  /// Simulates one period; the computed voltage acts one period later.
  robot_core::Output step(const robot_core::Config& config, robot_core::State& state, const robot_core::Command& command) {
    robot_core::Input input;
    input.elapsed_s = config.period_s;
    input.command = command;
    input.battery_V = static_cast<float>(battery_V_);
    input.ambient_C = 25.0F;
    for (std::size_t i = 0; i < 4; ++i) {
      input.wheel_speed_rad_per_s[i] = static_cast<float>(advance(i));
    }
    const robot_core::Output out = robot_core::step(config, state, input);
    for (std::size_t i = 0; i < 4; ++i) {
      voltage_V_[i] = std::exchange(next_V_[i], out.pwm_ratio[i] * battery_V_);
      is_open_[i] = std::exchange(is_open_next_[i], out.is_open[i]);
    }
    return out;
  }
  [[nodiscard]] double speed_rad_per_s(std::size_t wheel) const { return speed_rad_per_s_[wheel]; }

 private:
  /// Returns the mean speed over the period, as an encoder measures it.
  double advance(std::size_t i) {
    constexpr int kSteps = 20;
    const double geared = drive_.torque_constant_Nm_per_A * drive_.gear_ratio;
    double mean_rad_per_s = 0.0;
    for (int s = 0; s < kSteps; ++s) {
      double& speed = speed_rad_per_s_[i];
      const double current_A = is_open_[i] ? 0.0 : (voltage_V_[i] - geared * speed) / drive_.resistance_ohm;
      const double torque_Nm = geared * current_A - drag_Nm_ * speed / std::hypot(speed, 1.0);
      speed += torque_Nm / inertia_kg_m2_ * kPeriod_s / kSteps;
      mean_rad_per_s += speed / kSteps;
    }
    return mean_rad_per_s;
  }

  robot::DriveConstants drive_;
  double inertia_kg_m2_;
  double drag_Nm_;
  double battery_V_;
  std::array<double, 4> speed_rad_per_s_{};
  std::array<double, 4> voltage_V_{};
  std::array<double, 4> next_V_{};
  std::array<bool, 4> is_open_{true, true, true, true};
  std::array<bool, 4> is_open_next_{true, true, true, true};
};

// On blocks the loop gain is many times higher than on the ground. Oscillating wheels would heat the motors and wear the gears.
TEST(CoreLoop, DoesNotShakeOnBlocks) {
  for (const Case& each : kCases) {
    const robot::Robot robot = shipped_robot(each.robot);
    const motor::MotorValues motor = shipped_motor(each.motor).nominal;
    const robot_core::Config config = make_core_config(robot, motor, {});
    for (const double inertia_share : {0.75, 1.0}) {
      for (const double heading_rad : {0.0, 0.7, 1.57, 2.6}) {
        Blocks blocks(robot, motor, inertia_share);
        robot_core::State state;
        ASSERT_TRUE(robot_core::start(config, state, {.is_rested = true, .body_C = 25.0F}));
        robot_core::Command command;
        command.mode = robot_core::Mode::body_velocity;
        command.velocity = {static_cast<float>(std::cos(heading_rad)), static_cast<float>(std::sin(heading_rad)), 0.0F};
        std::array<double, 4> least{1e9, 1e9, 1e9, 1e9};
        std::array<double, 4> most{-1e9, -1e9, -1e9, -1e9};
        for (int k = 0; k < 4000; ++k) {
          blocks.step(config, state, command);
          for (std::size_t i = 0; i < 4 && k >= 3500; ++i) {
            least[i] = std::min(least[i], blocks.speed_rad_per_s(i));
            most[i] = std::max(most[i], blocks.speed_rad_per_s(i));
          }
        }
        robot::PerWheel mean_rad_per_s{};
        for (std::size_t i = 0; i < 4; ++i) {
          EXPECT_LT(most[i] - least[i], 0.5) << each.robot << ", wheel " << i << ", " << heading_rad;
          mean_rad_per_s[i] = 0.5 * (most[i] + least[i]);
        }
        // The yaw rate is not checked, because a gyro measures none on blocks.
        const robot::BodyVelocity shown = robot::body_velocity(robot::make_kinematics(robot), mean_rad_per_s);
        EXPECT_NEAR(shown.x_m_per_s, std::cos(heading_rad), 0.01) << each.robot << ", " << heading_rad;
        EXPECT_NEAR(shown.y_m_per_s, std::sin(heading_rad), 0.01) << each.robot << ", " << heading_rad;
      }
    }
  }
}

// Acceleration to 1 m/s and cruise: the feed-forward drives the robot, the loop corrects the rest.
TEST(CoreLoop, ReachesItsSpeedOnTheGround) {
  for (const Case& each : kCases) {
    const robot::Robot robot = shipped_robot(each.robot);
    const motor::MotorValues motor = shipped_motor(each.motor).nominal;
    const robot_core::Config config = make_core_config(robot, motor, {});
    const robot::PlantConfig plant = robot::make_plant(robot, motor, kPeriod_s);
    for (const double heading_rad : {0.0, 0.7, 1.57}) {
      robot::PlantState at = robot::plant_at_rest(plant);
      robot::PlantInput command_V;
      robot::PlantOutput measured;
      measured.battery_V = robot.battery.full_V.value();
      robot_core::State state;
      ASSERT_TRUE(robot_core::start(config, state, {.is_rested = true, .body_C = 25.0F}));
      double worst_m_per_s = 0.0;
      for (int k = 0; k < 3000; ++k) {
        robot_core::Input input;
        input.elapsed_s = config.period_s;
        input.battery_V = static_cast<float>(measured.battery_V);
        input.ambient_C = 25.0F;
        input.yaw_rate_rad_per_s = static_cast<float>(at.velocity.yaw_rad_per_s);
        for (std::size_t i = 0; i < 4; ++i) {
          input.wheel_speed_rad_per_s[i] = static_cast<float>(at.wheel_speed_rad_per_s[i]);
        }
        const double time_s = k * kPeriod_s;
        const double asked_m_per_s = std::min(1.0, 1.5 * time_s);
        const double asked_m_per_s2 = asked_m_per_s < 1.0 ? 1.5 : 0.0;
        const double x = std::cos(heading_rad);
        const double y = std::sin(heading_rad);
        input.command.mode = robot_core::Mode::body_velocity;
        input.command.velocity = {static_cast<float>(asked_m_per_s * x), static_cast<float>(asked_m_per_s * y), 0.0F};
        input.command.acceleration = {static_cast<float>(asked_m_per_s2 * x), static_cast<float>(asked_m_per_s2 * y), 0.0F};
        const robot_core::Output out = robot_core::step(config, state, input);
        measured = robot::step(plant, at, command_V);
        for (std::size_t i = 0; i < 4; ++i) {
          command_V.command[i] = {out.is_open[i] ? robot::MotorCommand::Kind::open : robot::MotorCommand::Kind::voltage,
                                  double{out.pwm_ratio[i]} * measured.battery_V};
        }
        if (k >= 2500) {
          worst_m_per_s = std::max(worst_m_per_s, std::hypot(at.velocity.x_m_per_s - x, at.velocity.y_m_per_s - y));
        }
      }
      EXPECT_LT(worst_m_per_s, 0.05) << each.robot << ", " << heading_rad;
      EXPECT_LT(std::abs(at.velocity.yaw_rad_per_s), 0.05) << each.robot << ", " << heading_rad;
    }
  }
}

}  // namespace
}  // namespace heatsoak::firmware
