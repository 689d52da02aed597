// Properties that hold for every input and every Config that the core accepts.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "test_robot.h"

namespace heatsoak::test_robot {
namespace {

using robot_core::Config;
using robot_core::Input;
using robot_core::Mode;
using robot_core::Output;
using robot_core::Reason;
using robot_core::State;

/// Uses the same cases in every run, unless the environment sets others.
[[maybe_unused]] const int fixed_seed = setenv("RC_PARAMS", "seed=1 max_success=300", 0);

/// Returns random bit patterns, or a possible input with some values replaced by random bit patterns.
Input any_input(Random& random, const Input& possible, float share) {
  Input input = possible;
  unsigned char bytes[sizeof(Input)];
  std::memcpy(bytes, &input, sizeof(Input));
  for (std::size_t at = 0; at + sizeof(float) <= sizeof(Input); at += sizeof(float)) {
    const float value = random.any_float();
    if (random.happens(share)) {
      std::memcpy(bytes + at, &value, sizeof(float));
    }
  }
  std::memcpy(&input, bytes, sizeof(Input));
  input.command.mode = random.happens(0.1F) ? static_cast<Mode>(random.below(256)) : static_cast<Mode>(random.below(6));
  return input;
}

/// Changes values of a Config by up to a factor of ten, or to any bit pattern, until the core accepts the Config.
Config any_config(Random& random) {
  for (int attempt = 0; attempt < 1000; ++attempt) {
    Config config = make_config(3 + random.below(2), random.happens(0.7F));
    float* const values[] = {&config.mass_kg,
                             &config.resistance_ohm,
                             &config.battery_lowest_V,
                             &config.current_limit_A,
                             &config.voltage_limit_V,
                             &config.body_gain_per_s,
                             &config.yaw_gain_per_s,
                             &config.wheel_gain_V_s_per_rad,
                             &config.speed_limit_m_per_s,
                             &config.traction_ratio,
                             &config.limp_current_A,
                             &config.battery_resistance_ohm,
                             &config.wheel_integral_V_per_rad,
                             &config.tracking_time_s,
                             &config.wheel[1].slip_factor};
    for (float* const value : values) {
      *value *= random.happens(0.5F) ? std::exp(random.between(-2.3F, 2.3F)) : 1.0F;
      *value = random.happens(0.01F) ? random.any_float() : *value;
    }
    config.lowest_resistance_ohm = config.resistance_ohm * random.between(0.5F, 1.0F);
    robot_core::complete(config);
    if (robot_core::is_possible(config)) {
      return config;
    }
  }
  return make_config(4);
}

/// Checks one output. `before` and `after`: a sensor that is accepted again at the end of the step was not yet at its beginning.
void check_output(const Config& config, const Input& input, const State& before, const State& after, const Output& out) {
  for (int i = 0; i < kMostWheels; ++i) {
    RC_ASSERT(std::isfinite(out.pwm_ratio[i]) && std::abs(out.pwm_ratio[i]) <= 1.0F);
    RC_ASSERT(std::isfinite(out.voltage_V[i]) && std::isfinite(out.allowed_current_A[i]) && std::isfinite(out.winding_C[i]));
    RC_ASSERT(out.allowed_current_A[i] >= 0.0F);
    RC_ASSERT(!out.is_open[i] || (out.voltage_V[i] == 0.0F && out.pwm_ratio[i] == 0.0F));
  }
  RC_ASSERT(std::isfinite(out.time_to_guard_limit_s));
  for (int i = 0; i < config.wheel_count; ++i) {
    const bool is_sensed = !out.is_open[i] && before.wheel[i].speed_fault == 0 && after.wheel[i].speed_fault == 0;
    const float back_V = config.derived.geared_constant_V_s_per_rad * input.wheel_speed_rad_per_s[i];
    const float current_A = (out.voltage_V[i] - back_V) / config.lowest_resistance_ohm;
    const float rounding_A = 2e-4F * (std::abs(back_V) + std::abs(out.voltage_V[i])) / config.lowest_resistance_ohm;
    RC_ASSERT(!is_sensed || std::abs(current_A) <= 1.001F * out.allowed_current_A[i] + rounding_A);
  }
}

RC_GTEST_PROP(DriveProperties, EveryInputGivesAPossibleOutput, (std::uint64_t seed)) {
  Random random(seed);
  const Config config = any_config(random);
  const Plant plant(config, {});
  State state;
  RC_ASSERT(robot_core::start(config, state, {.is_rested = random.happens(0.8F), .body_C = random.between(20.0F, 150.0F)}));
  const float share = random.happens(0.3F) ? 1.0F : random.between(0.0F, 0.2F);
  for (int k = 0; k < 200; ++k) {
    const Input input = any_input(random, plant.sense(random, kNoise_rad_per_s, true), share);
    const State before = state;
    const Output out = robot_core::step(config, state, input);
    // The State stays valid until the next step: no corruption is reported without a flipped bit.
    RC_ASSERT(out.robot_reason != Reason::state_corrupted);
    check_output(config, input, before, state, out);
  }
}

RC_GTEST_PROP(DriveProperties, UnusedWheelHasNoEffect, (std::uint64_t seed)) {
  Random random(seed);
  const Config config = make_config(3);
  const Plant plant(config, {});
  State a;
  State b;
  robot_core::start(config, a, {.is_rested = true, .body_C = 25.0F});
  robot_core::start(config, b, {.is_rested = true, .body_C = 25.0F});
  for (int k = 0; k < 100; ++k) {
    const Input input = any_input(random, plant.sense(random, kNoise_rad_per_s, true), 0.05F);
    Input other = input;
    other.wheel_speed_rad_per_s[3] = random.any_float();
    other.motor_current_A[3] = random.any_float();
    other.stator_C[3] = random.any_float();
    other.command.wheel_speed_rad_per_s[3] = random.any_float();
    other.command.wheel_torque_Nm[3] = random.any_float();
    const Output of_a = robot_core::step(config, a, input);
    const Output of_b = robot_core::step(config, b, other);
    for (int i = 0; i < kMostWheels; ++i) {
      RC_ASSERT(of_a.pwm_ratio[i] == of_b.pwm_ratio[i] && of_a.reason[i] == of_b.reason[i] && of_a.is_open[i] == of_b.is_open[i]);
    }
    RC_ASSERT(of_a.robot_reason == of_b.robot_reason);
  }
}

Input mirrored(const Config& config, const Input& input) {
  Input mirror = input;
  for (int i = 0; i < config.wheel_count; ++i) {
    const int from = mirror_of(config.wheel_count, i);
    mirror.wheel_speed_rad_per_s[i] = -input.wheel_speed_rad_per_s[from];
    mirror.motor_current_A[i] = -input.motor_current_A[from];
    mirror.stator_C[i] = input.stator_C[from];
  }
  mirror.yaw_rate_rad_per_s = -input.yaw_rate_rad_per_s;
  const robot_core::Command& command = input.command;
  mirror.command.velocity = {command.velocity.x, -command.velocity.y, -command.velocity.yaw};
  mirror.command.acceleration = {command.acceleration.x, -command.acceleration.y, -command.acceleration.yaw};
  mirror.command.push = {command.push.x, -command.push.y, -command.push.yaw};
  return mirror;
}

/// Without the guard, because its wheels are stepped in turn.
RC_GTEST_PROP(DriveProperties, MirroredInputsGiveMirroredOutputs, (std::uint64_t seed)) {
  Random random(seed);
  const Config config = make_config(3 + random.below(2), false);
  Plant plant(config, {});
  State a;
  State b;
  robot_core::start(config, a, {.is_rested = true, .body_C = 25.0F});
  robot_core::start(config, b, {.is_rested = true, .body_C = 25.0F});
  robot_core::Command command;
  command.mode = Mode::body_velocity;
  command.velocity = {random.between(-3.0F, 3.0F), random.between(-3.0F, 3.0F), random.between(-8.0F, 8.0F)};
  command.push = {random.between(-5.0F, 5.0F), random.between(-5.0F, 5.0F), 0.0F};
  for (int k = 0; k < 200; ++k) {
    Input input = plant.sense(random, kNoise_rad_per_s, true);
    input.command = command;
    const Output out = robot_core::step(config, a, input);
    const Output of_mirror = robot_core::step(config, b, mirrored(config, input));
    for (int i = 0; i < config.wheel_count; ++i) {
      const int from = mirror_of(config.wheel_count, i);
      RC_ASSERT(std::abs(of_mirror.voltage_V[i] + out.voltage_V[from]) < 2e-3F);
    }
    plant.move(out);
  }
}

struct Wrench {
  double x = 0.0;
  double y = 0.0;
  double moment = 0.0;  ///< divided by the contact radius
};

/// Angle between two wrenches.
double apart_rad(const Wrench& a, const Wrench& b) {
  const double dot = a.x * b.x + a.y * b.y + a.moment * b.moment;
  const double lengths = std::sqrt((a.x * a.x + a.y * a.y + a.moment * a.moment) * (b.x * b.x + b.y * b.y + b.moment * b.moment));
  return lengths > 0.0 ? std::acos(std::clamp(dot / lengths, -1.0, 1.0)) : 0.0;
}

Wrench wrench_of(const Config& config, const double* current_A) {
  Wrench wrench;
  for (int i = 0; i < config.wheel_count; ++i) {
    wrench.x += static_cast<double>(config.wheel[i].rolling_x_share) * current_A[i];
    wrench.y += static_cast<double>(config.wheel[i].rolling_y_share) * current_A[i];
    wrench.moment += current_A[i];
  }
  return wrench;
}

/// Starts at rest with one hot motor. The wanted currents come from a core without limits; the comparison limits each wheel alone.
RC_GTEST_PROP(DriveProperties, ForceKeepsItsDirectionWhereOneWheelIsLimited, (std::uint64_t seed)) {
  Random random(seed);
  const Config config = make_config(4);
  Config free = config;
  free.guard = nullptr;
  free.traction_ratio = 0.0F;
  free.current_limit_A = 1000.0F;
  free.voltage_limit_V = 25.0F;
  free.battery_resistance_ohm = 0.0F;
  robot_core::complete(free);
  const Plant plant(config, {});
  Input input = plant.sense(random, 0.0F, false);
  const float heading_rad = random.between(-3.14F, 3.14F);
  input.command.mode = Mode::body_velocity;
  input.command.velocity = {3.0F * std::cos(heading_rad), 3.0F * std::sin(heading_rad), 0.0F};
  State state;
  State free_state;
  robot_core::start(config, state, {.is_rested = true, .body_C = 25.0F});
  robot_core::start(free, free_state, {.is_rested = true, .body_C = 25.0F});
  const Output out = robot_core::step(config, state, input);
  const Output wanted = robot_core::step(free, free_state, input);
  double wanted_A[kMostWheels] = {};
  double given_A[kMostWheels] = {};
  double rival_A[kMostWheels] = {};
  bool is_limited = false;
  for (int i = 0; i < config.wheel_count; ++i) {
    const auto most_A = static_cast<double>(out.allowed_current_A[i]);
    wanted_A[i] = static_cast<double>(wanted.voltage_V[i] / config.lowest_resistance_ohm);
    given_A[i] = static_cast<double>(out.voltage_V[i] / config.lowest_resistance_ohm);
    rival_A[i] = std::clamp(wanted_A[i], -most_A, most_A);
    is_limited = is_limited || rival_A[i] != wanted_A[i];
  }
  const double error_rad = apart_rad(wrench_of(config, given_A), wrench_of(config, wanted_A));
  const double rival_rad = apart_rad(wrench_of(config, rival_A), wrench_of(config, wanted_A));
  RC_CLASSIFY(is_limited);
  RC_ASSERT(error_rad < 2e-3);
  RC_ASSERT(!is_limited || error_rad <= rival_rad + 1e-3);
}

/// Flips all bits of the State, one at a time.
TEST(StateBits, EveryFlipIsFoundAndDrivesNoMoreCurrent) {
  const Config config = make_config(4);
  Plant plant(config, {});
  State before;
  Random random(11);
  ASSERT_TRUE(robot_core::start(config, before, {.is_rested = true, .body_C = 60.0F}));
  Input input;
  for (int k = 0; k < 200; ++k) {
    input = plant.sense(random, kNoise_rad_per_s, true);
    input.command.mode = Mode::body_velocity;
    input.command.velocity = {1.5F, 0.5F, 1.0F};
    plant.move(robot_core::step(config, before, input));
  }
  input = plant.sense(random, kNoise_rad_per_s, true);
  input.command.mode = Mode::body_velocity;
  input.command.velocity = {1.5F, 0.5F, 1.0F};
  for (std::size_t bit = 0; bit < 8 * sizeof(State); ++bit) {
    State state = before;
    State healthy = before;
    unsigned char bytes[sizeof(State)];
    std::memcpy(bytes, &state, sizeof(State));
    bytes[bit / 8] = static_cast<unsigned char>(bytes[bit / 8] ^ (1U << (bit % 8)));
    std::memcpy(&state, bytes, sizeof(State));
    bool is_found = false;
    // Comparisons and guards verify their check sums when they are used: within 16 and 10 periods.
    for (int k = 0; k < 17 && !is_found; ++k) {
      const Output out = robot_core::step(config, state, input);
      const Output of_healthy = robot_core::step(config, healthy, input);
      is_found = out.robot_reason == Reason::state_corrupted;
      for (int i = 0; i < config.wheel_count; ++i) {
        is_found = is_found || out.reason[i] == Reason::guard_unknown;
        ASSERT_LE(std::abs(plant.coldest_current_A(out, i)), std::abs(plant.coldest_current_A(of_healthy, i)) + 1e-3) << "bit " << bit;
        ASSERT_TRUE(!is_found || out.winding_C[i] >= of_healthy.winding_C[i] - 0.1F) << "bit " << bit;
      }
    }
    ASSERT_TRUE(is_found) << "bit " << bit << ", byte " << bit / 8;
  }
}

}  // namespace
}  // namespace heatsoak::test_robot
