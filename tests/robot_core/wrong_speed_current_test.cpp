// Currents and heat of motors whose wheel speed sensors are wrong, in the mode wheel_torque. There the controller adds the back-EMF at the
// sensed speed, so a wrong speed feeds back into the voltage.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "test_robot.h"

namespace heatsoak::test_robot {
namespace {

using robot_core::Config;
using robot_core::Input;
using robot_core::Mode;
using robot_core::Output;
using robot_core::State;

/// A robot that turns with the same torque on every wheel, or with a heading drives along it, with the sign of each half of `period_s`.
class TorqueDrive {
 public:
  TorqueDrive(int wheels, bool are_currents_fitted, float torque_Nm, float period_s, std::optional<float> heading_rad = {})
      : config_(make_config(wheels)), are_currents_fitted_(are_currents_fitted), period_s_(period_s) {
    for (int i = 0; i < wheels; ++i) {
      const robot_core::WheelConfig& wheel = config_.wheel[i];
      torque_Nm_[i] = torque_Nm;
      if (heading_rad) {
        torque_Nm_[i] *= std::cos(*heading_rad) * wheel.rolling_x_share + std::sin(*heading_rad) * wheel.rolling_y_share;
      }
    }
    EXPECT_TRUE(robot_core::start(config_, state_, {.is_rested = true, .body_C = 25.0F}));
  }

  /// Runs one period; `spoil` changes the samples.
  template <class Spoil>
  void step(Spoil&& spoil) {
    Input input = plant_.sense(random_, 0.02F, are_currents_fitted_);
    input.elapsed_s = config_.period_s;
    input.command.mode = Mode::wheel_torque;
    const float time_s = static_cast<float>(steps_++) * config_.period_s;
    for (int i = 0; i < robot_core::kMostWheels; ++i) {
      input.command.wheel_torque_Nm[i] = std::fmod(time_s, period_s_) < 0.5F * period_s_ ? torque_Nm_[i] : -torque_Nm_[i];
    }
    spoil(input);
    out_ = robot_core::step(config_, state_, input);
    plant_.move(out_);
  }

  [[nodiscard]] const Config& config() const { return config_; }
  [[nodiscard]] const State& state() const { return state_; }
  [[nodiscard]] const Plant& plant() const { return plant_; }
  [[nodiscard]] const Output& out() const { return out_; }

 private:
  Config config_;
  State state_;
  Plant plant_{config_, Truth{}};
  Random random_{5};
  Output out_;
  bool are_currents_fitted_;
  robot_core::PerWheel torque_Nm_ = {};
  float period_s_;
  int steps_ = 0;
};

// Some of the dead sensors jumped when they died. Their estimates from the other dead sensors and the gyro must not drive more current.
TEST(WrongSpeedCurrent, DeadSensorsLeaveTheLimpCurrent) {
  for (const int wheels : {4, 3}) {
    for (const float torque_Nm : {0.05F, -0.1F}) {
      TorqueDrive drive(wheels, false, torque_Nm, 1000.0F);
      double most_A = 0.0;
      for (int k = 0; k < 12'000; ++k) {
        drive.step([k](Input& input) {
          if (k >= 1500) {
            std::fill_n(input.wheel_speed_rad_per_s, robot_core::kMostWheels, 0.0F);
          }
        });
        for (int i = 0; i < wheels && k >= 3000; ++i) {
          most_A = std::max(most_A, std::abs(drive.plant().current_A(i)));
        }
      }
      const bool is_dead_found = std::any_of(drive.out().reason, drive.out().reason + wheels,
                                             [](robot_core::Reason reason) { return reason == robot_core::Reason::wheel_speeds_dead; });
      EXPECT_TRUE(is_dead_found) << wheels << " wheels, " << torque_Nm << " Nm";
      EXPECT_LE(most_A, 1.02 * static_cast<double>(drive.config().limp_current_A)) << wheels << " wheels, " << torque_Nm << " Nm";
    }
  }
}

// The current without a sensor follows from voltage and speed. At twice the speed it looks much smaller than it is.
TEST(WrongSpeedCurrent, AWrongScaleHidesNoHeat) {
  for (const int wheels : {4, 3}) {
    for (const float period_s : {3.0F, 12.0F}) {
      for (const float scale : {2.0F, 1.6F, 0.5F, -1.0F}) {
        TorqueDrive drive(wheels, false, 0.12F, period_s);
        double hottest_C = 0.0;
        for (int k = 0; k < 120'000; ++k) {
          drive.step([scale](Input& input) { input.wheel_speed_rad_per_s[0] *= scale; });
          hottest_C = std::max(hottest_C, drive.plant().winding_C(0));
        }
        EXPECT_LE(hottest_C, kWindingLimit_C) << wheels << " wheels, scale " << scale << ", " << period_s << " s";
        EXPECT_LE(drive.plant().winding_C(0), static_cast<double>(drive.state().guard[0].state_C[0]) + 1.0)
            << wheels << " wheels, scale " << scale << ", " << period_s << " s";
      }
    }
  }
}

/// Speed of one count per control period: 4096 counts per turn.
constexpr float kEncoderStep_rad_per_s = 1.534F;

// A sensor that reads too much passes the fastest speed, and correct ones are rejected instead of it when their wheels stand. Heat and
// current must then follow from the rejected samples as well.
TEST(WrongSpeedCurrent, ARejectedSampleMayBeTheCorrectOne) {
  double worst_K = -100.0;
  double longest_s = 0.0;
  for (const int wheels : {4, 3}) {
    for (const std::optional<float> heading_rad :
         {std::optional<float>(), std::optional(0.0F), std::optional(0.8F), std::optional(1.57F)}) {
      for (const float torque_Nm : {0.12F, 0.18F}) {
        for (const float scale : {2.0F, 2.5F, -1.0F}) {
          // Three wheels that spin without a gyro in range leave no spare sensor, which no other sample replaces.
          if (wheels == 3 && !heading_rad) {
            continue;
          }
          TorqueDrive drive(wheels, false, torque_Nm, 6.0F, heading_rad);
          double hottest_C = 0.0;
          int above = 0;
          for (int k = 0; k < 120'000; ++k) {
            drive.step([scale](Input& input) {
              for (float& speed_rad_per_s : input.wheel_speed_rad_per_s) {
                speed_rad_per_s = kEncoderStep_rad_per_s * std::round(speed_rad_per_s / kEncoderStep_rad_per_s);
              }
              input.wheel_speed_rad_per_s[0] *= scale;
            });
            bool is_above = false;
            for (int i = 0; i < wheels; ++i) {
              hottest_C = std::max(hottest_C, drive.plant().winding_C(i));
              worst_K = std::max(worst_K, drive.plant().winding_C(i) - static_cast<double>(drive.state().guard[i].state_C[0]));
              is_above =
                  is_above || std::abs(drive.plant().current_A(i)) > 1.2 * static_cast<double>(drive.out().allowed_current_A[i]) + 0.5;
            }
            above += is_above ? 1 : 0;
          }
          longest_s = std::max(longest_s, 1e-3 * above);
          EXPECT_LE(hottest_C, kWindingLimit_C) << wheels << " wheels, scale " << scale << ", " << torque_Nm << " N m";
        }
      }
    }
  }
  EXPECT_LE(worst_K, 3.0);
  EXPECT_LE(longest_s, 5.0);
  std::printf("winding above the guard by at most %.1f K, current above its limit for at most %.1f of 120 s\n", worst_K, longest_s);
}

// With a wrong speed the correct current sensor looks wrong (121). It still opens the bridge.
TEST(WrongSpeedCurrent, ADistrustedCurrentSensorOpensTheBridge) {
  for (const float period_s : {3.0F, 6.0F}) {
    TorqueDrive drive(3, true, 0.12F, period_s);
    int over = 0;
    int longest = 0;
    int distrusted = 0;
    for (int k = 0; k < 30'000; ++k) {
      drive.step([k](Input& input) { input.wheel_speed_rad_per_s[0] *= k > 1000 ? 2.0F : 1.0F; });
      const double far_A =
          1.3 * static_cast<double>(drive.out().allowed_current_A[0]) + static_cast<double>(drive.config().derived.current_margin_A);
      over = std::abs(drive.plant().current_A(0)) > far_A ? over + 1 : 0;
      longest = std::max(longest, over);
      distrusted += drive.state().wheel[0].is_current_distrusted;
    }
    EXPECT_GT(distrusted, 100) << period_s;
    EXPECT_LE(longest, 20) << period_s;
  }
}

}  // namespace
}  // namespace heatsoak::test_robot
