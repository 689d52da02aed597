// Current and air sensors that read too low for minutes: the guard must not lose the heat.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>

#include "robot_core/guard_memory.h"
#include "test_robot.h"

namespace heatsoak::test_robot {
namespace {

using robot_core::Config;
using robot_core::Input;
using robot_core::Mode;
using robot_core::Output;
using robot_core::State;

constexpr double kDuration_s = 120.0;

/// Returns torques of four wheels that cancel as force and as moment on the body: the null space of the rows t_x, t_y, 1.
std::array<float, 4> torques_against_each_other(const Config& config) {
  const auto minor = [&](int left_out) {
    std::array<std::array<double, 3>, 3> m{};
    std::size_t at = 0;
    for (int i = 0; i < 4; ++i) {
      if (i != left_out) {
        m.at(at++) = {static_cast<double>(config.wheel[i].rolling_x_share), static_cast<double>(config.wheel[i].rolling_y_share), 1.0};
      }
    }
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  };
  std::array<double, 4> torque{};
  double most = 0.0;
  for (int i = 0; i < 4; ++i) {
    torque.at(static_cast<std::size_t>(i)) = (i % 2 == 0 ? 1.0 : -1.0) * minor(i);
    most = std::max(most, std::abs(torque.at(static_cast<std::size_t>(i))));
  }
  std::array<float, 4> result{};
  std::ranges::transform(torque, result.begin(), [&](double each) { return static_cast<float>(each / most); });
  return result;
}

struct Heat {
  double hottest_C = 0.0;
  double above_guard_K = -1e9;  ///< largest difference between a winding and its guard
  double limited_s = 0.0;       ///< time in which the guard limits a wheel
};

/// Truth of a robot on rubber.
Truth on_rubber(double air_C = 25.0) {
  Truth truth;
  truth.air_C = air_C;
  truth.grip_ratio = 2.0;
  return truth;
}

/// Wheels that work against each other with up to `torque_Nm`. `change` gets each input and its step.
Heat drive(const Config& config, const Truth& truth, double duration_s, float torque_Nm, const std::function<void(Input&, int)>& change) {
  Plant plant(config, truth);
  State state;
  Random random(3);
  EXPECT_TRUE(robot_core::start(config, state, {.is_rested = true, .body_C = 25.0F}));
  const std::array<float, 4> torque = torques_against_each_other(config);
  Heat heat;
  for (int k = 0; k < static_cast<int>(duration_s / static_cast<double>(config.period_s)); ++k) {
    Input input = plant.sense(random, 0.3F, true);
    input.ambient_C = static_cast<float>(truth.air_C);
    input.command.mode = Mode::wheel_torque;
    for (std::size_t i = 0; i < 4; ++i) {
      input.command.wheel_torque_Nm[i] = torque_Nm * torque.at(i);
    }
    change(input, k);
    const robot_core::Output out = robot_core::step(config, state, input);
    plant.move(out);
    bool is_limited = false;
    for (int i = 0; i < 4; ++i) {
      heat.hottest_C = std::max(heat.hottest_C, plant.winding_C(i));
      heat.above_guard_K = std::max(heat.above_guard_K, plant.winding_C(i) - static_cast<double>(out.winding_C[i]));
      is_limited = is_limited || out.reason[i] == robot_core::Reason::guard;
    }
    heat.limited_s += is_limited ? static_cast<double>(config.period_s) : 0.0;
  }
  return heat;
}

/// Largest difference between a winding and its guard in 10 s in which the controller restarts every `periods`, from the State of the step
/// before. Each restart takes `off_s` with open bridges.
double most_above_guard_with_restarts_K(const Config& config, int periods, double off_s, bool has_current_sensors) {
  Plant plant(config, on_rubber());
  State state;
  Random random(3);
  EXPECT_TRUE(robot_core::start(config, state, {.is_rested = true, .body_C = 25.0F}));
  const std::array<float, 4> torque = torques_against_each_other(config);
  double most_K = -1e9;
  for (int k = 1; k <= 10000; ++k) {
    if (k % periods == 0) {
      for (double time_s = 0.0; time_s < off_s; time_s += static_cast<double>(config.period_s)) {
        plant.move(Output{});
      }
      const State saved = state;
      robot_core::start(config, state, {});
      robot_core::restore(config, state, saved, static_cast<float>(off_s), 25.0F);
    }
    Input input = plant.sense(random, 0.3F, has_current_sensors);
    input.command.mode = Mode::wheel_torque;
    for (std::size_t i = 0; i < 4; ++i) {
      input.command.wheel_torque_Nm[i] = 0.3F * torque.at(i);
    }
    const Output out = robot_core::step(config, state, input);
    plant.move(out);
    for (int i = 0; i < 4; ++i) {
      most_K = std::max(most_K, plant.winding_C(i) - static_cast<double>(out.winding_C[i]));
    }
  }
  return most_K;
}

/// Two minutes with up to 0.21 N m. `spoil` changes the inputs from 5 s on.
Heat push(const Config& config, const std::function<void(Input&)>& spoil, double air_C = 25.0) {
  return drive(config, on_rubber(air_C), kDuration_s, 0.21F, [&](Input& input, int k) {
    if (k > 5000) {
      spoil(input);
    }
  });
}

// The winding is at most as hot as without a sensor, where the guard uses the current from voltage and speed.
TEST(SensorHeat, CurrentSensorThatReadsTooLittleHidesNoHeat) {
  for (const float driver_limit_A : {12.0F, 45.0F}) {
    Config config = make_config(4);
    config.current_limit_A = driver_limit_A;
    robot_core::complete(config);
    const std::array<float, 4> torque = torques_against_each_other(config);
    const auto hardest = std::ranges::max_element(torque, {}, [](float each) { return std::abs(each); }) - torque.begin();
    const Heat truthful = push(config, [](Input&) {});
    const Heat without = push(config, [](Input& input) { std::ranges::fill(input.motor_current_A, robot_core::kNoSample); });
    EXPECT_GT(truthful.limited_s, 5.0) << "the push is no test of the guard";
    EXPECT_LT(without.hottest_C, kWindingLimit_C);
    const double most_C = std::max(truthful.hottest_C, without.hottest_C) + 1.0;
    for (const float gain : {0.0F, 0.3F, 0.5F, 0.7F, 0.9F, -1.0F}) {
      const Heat one = push(config, [&](Input& input) { input.motor_current_A[hardest] *= gain; });
      const Heat all = push(config, [&](Input& input) {
        for (float& each : input.motor_current_A) {
          each *= gain;
        }
      });
      std::printf("driver limit %.0f A, gain %.1f: one %.1f C, all %.1f C; truthful %.1f C, no sensor %.1f C\n",
                  static_cast<double>(driver_limit_A), static_cast<double>(gain), one.hottest_C, all.hottest_C, truthful.hottest_C,
                  without.hottest_C);
      EXPECT_LT(one.hottest_C, most_C) << gain;
      EXPECT_LT(all.hottest_C, most_C) << gain;
    }
    EXPECT_LT(push(config, [&](Input& input) { input.motor_current_A[hardest] = 0.2F; }).hottest_C, most_C);
  }
}

/// Largest difference between a winding and its guard within 10 s with up to 0.3 N m.
double most_above_guard_K(const Config& config, const std::function<void(Input&, int)>& change, const Truth& truth = on_rubber()) {
  return drive(config, truth, 10.0, 0.3F, change).above_guard_K;
}

// An ADC that the control loop shares may fail in step with it. The sensors are compared with each other in some of the steps only.
TEST(SensorHeat, CurrentSensorThatFailsInStepHidesNoHeat) {
  const Config config = make_config(4);
  for (const int period : {2, 4, 8, 15, 16, 17, 32}) {
    double valid_in_one_K = -1e9;
    double without_torque_in_one_K = -1e9;
    for (int phase = 0; phase < period; ++phase) {
      const auto is_chosen = [&](int k) { return k % period == phase; };
      valid_in_one_K = std::max(valid_in_one_K, most_above_guard_K(config, [&](Input& input, int k) {
                                  if (!is_chosen(k)) {
                                    std::ranges::fill(input.motor_current_A, 0.0F);
                                  }
                                }));
      without_torque_in_one_K = std::max(without_torque_in_one_K, most_above_guard_K(config, [&](Input& input, int k) {
                                           std::ranges::fill(input.motor_current_A, 0.0F);
                                           if (is_chosen(k)) {
                                             std::ranges::fill(input.command.wheel_torque_Nm, 0.0F);
                                           }
                                         }));
    }
    std::printf("period %d: valid in one step %.1f K above the guard; always 0, torque except in one step %.1f K\n", period, valid_in_one_K,
                without_torque_in_one_K);
    EXPECT_LT(valid_in_one_K, 3.0) << period;
    EXPECT_LT(without_torque_in_one_K, 3.0) << period;
  }
}

// The guard replaces an implausible current. Only what it counts may be set off against the heat that a sensor hides.
TEST(SensorHeat, ImplausibleSpikesOfAFailingSensorHideNoHeat) {
  const Config config = make_config(4);
  const float implausible_A = 2.0F * config.guard->plausible_range[robot_core::guard_current_A].most;
  // The sample of the comparison is correct, and spikes as long as a guard period come in step with it or at any time.
  for (const int steps_between : {496, 311}) {
    double most_K = -1e9;
    for (const int phase : {0, 8}) {
      most_K = std::max(most_K, most_above_guard_K(config, [&](Input& input, int k) {
                          if (k % 16 != phase) {
                            std::ranges::fill(input.motor_current_A, k % steps_between < 16 ? implausible_A : 0.0F);
                          }
                        }));
    }
    std::printf("spikes every %d steps: %.1f K above the guard\n", steps_between, most_K);
    EXPECT_LT(most_K, 3.0) << steps_between;
  }
}

// Without current sensors the guard calculates the currents from the wheel speeds. Four of them and the gyro contradict a wrong one in
// every step, not only in those that compare the sensors.
TEST(SensorHeat, WheelSpeedThatFailsInStepHidesNoHeatWithoutCurrentSensors) {
  const Config config = make_config(4);
  const float slope_rad_per_s = 0.8F * config.derived.jump_rad_per_s;  // a larger one would be found as a jump
  for (const int period : {2, 4, 8, 15, 16, 17, 32}) {
    double most_K = -1e9;
    for (int phase = 0; phase < period; ++phase) {
      for (const float sign : {1.0F, -1.0F}) {
        most_K = std::max(most_K, most_above_guard_K(config, [&](Input& input, int k) {
                            std::ranges::fill(input.motor_current_A, robot_core::kNoSample);
                            const int since = (k + phase) % period;
                            const auto from_valid = static_cast<float>(std::min(since, period - since));
                            input.wheel_speed_rad_per_s[0] += k > 1000 ? sign * slope_rad_per_s * from_valid : 0.0F;
                          }));
      }
    }
    std::printf("triangle, period %d: %.1f K above the guard\n", period, most_K);
    EXPECT_LT(most_K, 3.0) << period;
  }
}

TEST(SensorHeat, WheelSpeedWithAWrongScaleOrOffsetHidesNoHeatWithoutCurrentSensors) {
  const Config config = make_config(4);
  struct Error {
    float scale;
    float offset_rad_per_s;
  };
  for (const Error& error : {Error{1.0F, 9.0F}, Error{1.0F, 28.0F}, Error{1.0F, 100.0F}, Error{0.5F, 0.0F}, Error{-1.0F, 0.0F},
                             Error{1.5F, 40.0F}, Error{2.0F, 9.0F}}) {
    double most_K = -1e9;
    for (int which = 0; which < 16; ++which) {
      const int wheel = which % 4;
      const float sign = which / 4 % 2 == 0 ? 1.0F : -1.0F;
      const auto change = [&](Input& input, int k) {
        std::ranges::fill(input.motor_current_A, robot_core::kNoSample);
        float& sample = input.wheel_speed_rad_per_s[wheel];
        const float wrong_rad_per_s = error.scale * sample + sign * error.offset_rad_per_s;
        sample = std::lerp(sample, wrong_rad_per_s, std::clamp(0.02F * static_cast<float>(k - 1000), 0.0F, 1.0F));
      };
      most_K = std::max(most_K, most_above_guard_K(config, change, which < 8 ? on_rubber() : Truth{}));
    }
    std::printf("scale %.1f, offset %.0f rad/s: %.1f K above the guard\n", static_cast<double>(error.scale),
                static_cast<double>(error.offset_rad_per_s), most_K);
    EXPECT_LT(most_K, 3.0) << error.scale << " " << error.offset_rad_per_s;
  }
}

// A guard counts the current of its period at the end. A restart within the period must not lose it.
TEST(SensorHeat, RestartsWithACopyOfTheStateHideNoHeat) {
  const Config config = make_config(4);
  for (const int periods : {1, 2, 3, 5, 9, 10, 11, 15, 30, 100}) {
    for (const double off_s : {0.0, 0.003, 0.02}) {
      const double with_K = most_above_guard_with_restarts_K(config, periods, off_s, true);
      const double without_K = most_above_guard_with_restarts_K(config, periods, off_s, false);
      std::printf("restart every %d periods, off for %.0f ms: %.1f K above the guard, without current sensors %.1f K\n", periods,
                  1000.0 * off_s, with_K, without_K);
      EXPECT_LT(with_K, 1.0) << periods << " " << off_s;
      EXPECT_LT(without_K, 1.0) << periods << " " << off_s;
    }
  }
}

TEST(SensorHeat, AirSensorThatBecomesColdHidesNoHeat) {
  const Config config = make_config(4);
  const Heat truthful = push(
      config, [](Input&) {}, 40.0);
  const Heat lied = push(
      config, [](Input& input) { input.ambient_C = 1.0F; }, 40.0);
  std::printf("air 40 C, shown as 1 C: %.1f C, truthful %.1f C\n", lied.hottest_C, truthful.hottest_C);
  EXPECT_LT(lied.hottest_C, truthful.hottest_C + 3.0);
  EXPECT_LT(lied.hottest_C, kWindingLimit_C);
}

// A motor whose resistance is below its tolerance draws more than the motor equation says. Only the current sensor shows it.
TEST(CurrentSensor, HoldsTheLimitOfAMotorWithTooLowAResistance) {
  const Config config = make_config(4);
  Truth truth;
  truth.winding_ohm = 0.8;
  Plant plant(config, truth);
  Random random(5);
  State state;
  ASSERT_TRUE(robot_core::start(config, state, {.is_rested = true, .body_C = 25.0F}));
  double most_excess_A = -1e9;
  double most_A = 0.0;
  for (int k = 0; k < 4000; ++k) {
    Input input = plant.sense(random, 0.3F, true);
    input.command.mode = Mode::wheel_torque;
    for (float& torque_Nm : input.command.wheel_torque_Nm) {
      torque_Nm = k / 150 % 2 == 0 ? 2.0F : -2.0F;
    }
    const Output out = robot_core::step(config, state, input);
    for (int i = 0; i < 4; ++i) {
      const double current_A = std::abs(plant.true_current_A(out, i));
      most_A = std::max(most_A, current_A);
      // The first samples are the first evidence.
      most_excess_A = k < 20 ? most_excess_A : std::max(most_excess_A, current_A - static_cast<double>(out.allowed_current_A[i]));
    }
    plant.move(out);
  }
  // A change of voltage within the period still acts on the lower resistance.
  EXPECT_LT(most_excess_A, 0.03 * static_cast<double>(config.current_limit_A));
  EXPECT_GT(most_A, 0.95 * static_cast<double>(config.current_limit_A));
}

}  // namespace
}  // namespace heatsoak::test_robot
