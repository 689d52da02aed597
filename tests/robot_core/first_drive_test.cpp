// First drive on blocks, docs/firmware.md: its three steps accept a robot with correct wiring and refuse every wrong one of the list.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "test_robot.h"

namespace heatsoak::test_robot {
namespace {

using robot_core::Config;
using robot_core::Input;
using robot_core::Mode;
using robot_core::Output;
using robot_core::PerWheel;
using robot_core::State;

constexpr float kOneTurnPerSecond_rad_per_s = 6.2832F;

/// Connections of the core's wheels to motors and encoders. Current sensors are in the leads of the motors.
struct Wiring {
  std::string name = "correct";
  std::array<int, kMostWheels> motor{0, 1, 2, 3};
  std::array<float, kMostWheels> motor_sign{1.0F, 1.0F, 1.0F, 1.0F};
  std::array<int, kMostWheels> encoder{0, 1, 2, 3};
  std::array<float, kMostWheels> encoder_factor{1.0F, 1.0F, 1.0F, 1.0F};

  [[nodiscard]] Output applied(const Output& out) const {
    Output moved = out;
    for (std::size_t i = 0; i < kMostWheels; ++i) {
      const auto to = static_cast<std::size_t>(motor.at(i));
      moved.pwm_ratio[to] = motor_sign.at(i) * out.pwm_ratio[i];
      moved.is_open[to] = out.is_open[i];
    }
    return moved;
  }
  [[nodiscard]] Input sensed(const Input& truth) const {
    Input input = truth;
    for (std::size_t i = 0; i < kMostWheels; ++i) {
      input.wheel_speed_rad_per_s[i] = encoder_factor.at(i) * truth.wheel_speed_rad_per_s[static_cast<std::size_t>(encoder.at(i))];
      input.motor_current_A[i] = motor_sign.at(i) * truth.motor_current_A[static_cast<std::size_t>(motor.at(i))];
    }
    return input;
  }
};

std::vector<Wiring> wrong_wirings(std::size_t wheels) {
  std::vector<Wiring> wrong;
  for (std::size_t i = 0; i < wheels; ++i) {
    const std::string of = std::to_string(i + 1);
    wrong.push_back({.name = "motor " + of + " reversed"});
    wrong.back().motor_sign.at(i) = -1.0F;
    for (const float factor : {-1.0F, 0.5F, 2.0F, 60.0F / 6.2832F}) {
      wrong.push_back({.name = "encoder " + of + " times " + std::to_string(factor)});
      wrong.back().encoder_factor.at(i) = factor;
    }
    for (std::size_t j = 0; j < i; ++j) {
      wrong.push_back({.name = "motors " + of + " and " + std::to_string(j + 1)});
      std::swap(wrong.back().motor.at(i), wrong.back().motor.at(j));
      wrong.push_back({.name = "encoders " + of + " and " + std::to_string(j + 1)});
      std::swap(wrong.back().encoder.at(i), wrong.back().encoder.at(j));
    }
  }
  for (const float factor : {-1.0F, 0.5F, 2.0F, 60.0F / 6.2832F}) {
    wrong.push_back({.name = "all encoders times " + std::to_string(factor)});
    wrong.back().encoder_factor.fill(factor);
  }
  wrong.push_back({.name = "all motors reversed"});
  wrong.back().motor_sign.fill(-1.0F);
  return wrong;
}

/// Speeds at the end of a step, as a person at the robot sees them and as telemetry shows them.
struct Seen {
  std::array<double, kMostWheels> turning_rad_per_s{};
  std::array<double, kMostWheels> sample_rad_per_s{};

  /// Only this wheel turns, in the positive direction, and the samples show the same.
  [[nodiscard]] bool is_only(std::size_t wheel) const {
    constexpr double kStill_rad_per_s = 0.5;
    bool is = true;
    for (std::size_t i = 0; i < kMostWheels; ++i) {
      for (const double speed : {turning_rad_per_s.at(i), sample_rad_per_s.at(i)}) {
        is = is && (i == wheel ? speed > kStill_rad_per_s : std::abs(speed) < kStill_rad_per_s);
      }
    }
    return is;
  }
};

class OnBlocks {
 public:
  OnBlocks(const Config& config, const Wiring& wiring) : config_(config), wiring_(wiring) {}

  [[nodiscard]] Seen turned_by_hand(std::size_t wheel) const {
    Input truth;
    truth.wheel_speed_rad_per_s[wheel] = kOneTurnPerSecond_rad_per_s;
    return seen(truth);
  }

  /// Commands one wheel for `duration_s`, the others 0.
  [[nodiscard]] Seen driven(std::size_t wheel, Mode mode, float value, double duration_s) const {
    Truth in_the_air;
    in_the_air.grip_ratio = 0.0;
    Plant plant(config_, in_the_air);
    Random random(3);
    State state;
    robot_core::start(config_, state, {.is_rested = true, .body_C = 25.0F});
    const auto periods = static_cast<int>(std::lround(duration_s / static_cast<double>(config_.period_s)));
    for (int k = 0; k < periods; ++k) {
      Input input = wiring_.sensed(plant.sense(random, kNoise_rad_per_s, true));
      input.command.mode = mode;
      (mode == Mode::wheel_torque ? input.command.wheel_torque_Nm : input.command.wheel_speed_rad_per_s)[wheel] = value;
      plant.move(wiring_.applied(robot_core::step(config_, state, input)));
    }
    return seen(plant.sense(random, 0.0F, true));
  }

 private:
  [[nodiscard]] Seen seen(const Input& truth) const {
    Seen result;
    const Input input = wiring_.sensed(truth);
    for (std::size_t i = 0; i < kMostWheels; ++i) {
      result.turning_rad_per_s.at(i) = static_cast<double>(truth.wheel_speed_rad_per_s[i]);
      result.sample_rad_per_s.at(i) = static_cast<double>(input.wheel_speed_rad_per_s[i]);
    }
    return result;
  }

  const Config& config_;
  const Wiring& wiring_;
};

/// Returns true if the wiring passes all steps.
bool passes(const Config& config, const Wiring& wiring) {
  const OnBlocks robot(config, wiring);
  bool pass = true;
  for (std::size_t i = 0; pass && i < static_cast<std::size_t>(config.wheel_count); ++i) {
    constexpr float kTorque_Nm = 0.03F;
    pass = robot.turned_by_hand(i).is_only(i) && robot.driven(i, Mode::wheel_torque, kTorque_Nm, 0.2).is_only(i);
    const Seen turning = robot.driven(i, Mode::wheel_speed, kOneTurnPerSecond_rad_per_s, 2.0);
    const double turns_per_s = turning.turning_rad_per_s.at(i) / static_cast<double>(kOneTurnPerSecond_rad_per_s);
    pass = pass && turning.is_only(i) && std::abs(turns_per_s - 1.0) < 0.1;
  }
  return pass;
}

TEST(FirstDrive, AcceptsCorrectWiringAndFindsEveryWrongOne) {
  for (const int wheels : {3, 4}) {
    const Config config = make_config(wheels);
    EXPECT_TRUE(passes(config, {})) << wheels;
    for (const Wiring& wiring : wrong_wirings(static_cast<std::size_t>(wheels))) {
      EXPECT_FALSE(passes(config, wiring)) << wheels << " wheels, " << wiring.name;
    }
  }
}

// The same step finds reversed and swapped motors without the first one: the torque turns the wrong wheel, or the wrong way.
TEST(FirstDrive, TorqueAloneFindsEveryWrongMotor) {
  const Config config = make_config(4);
  for (const Wiring& wiring : wrong_wirings(4)) {
    if (!wiring.name.starts_with("motor")) {
      continue;
    }
    bool pass = true;
    for (std::size_t i = 0; i < 4; ++i) {
      pass = pass && OnBlocks(config, wiring).driven(i, Mode::wheel_torque, 0.03F, 0.2).is_only(i);
    }
    EXPECT_FALSE(pass) << wiring.name;
  }
}

}  // namespace
}  // namespace heatsoak::test_robot
