// Inputs of the drive core from a robot with faulty sensors.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <random>

#include "robot_core/drive_core.h"

namespace heatsoak {

/// Simple robot that follows the core and exercises every mode and most faults.
class FaultyDrive {
 public:
  explicit FaultyDrive(const robot_core::Config& config) : config_(config) {
    robot_core::start(config_, state_, {.is_rested = true, .body_C = 25.0F});
  }

  /// Returns the next input; take_step() applies the core's answer.
  const robot_core::Input& next() {
    if (step_ % 40 == 0) {
      command();
    }
    if (step_ % 500 == 0) {
      fault_ = step_ > 5000 ? static_cast<int>(uniform() * 12.0F) : 0;
    }
    input_.command_age_s = 0.001F * static_cast<float>(step_ % 40);
    for (int i = 0; i < config_.wheel_count; ++i) {
      input_.wheel_speed_rad_per_s[i] = speed_rad_per_s_[i] + 0.2F * (uniform() - 0.5F);
      input_.motor_current_A[i] = current_A_[i] + 0.1F * (uniform() - 0.5F);
      input_.stator_C[i] = 30.0F + 5.0F * uniform();
    }
    input_.battery_V = 23.0F + uniform();
    input_.ambient_C = 22.0F + uniform();
    input_.yaw_rate_rad_per_s = yaw_rate_rad_per_s_ + 0.02F * (uniform() - 0.5F);
    input_.elapsed_s = 0.001F;
    input_.pose = {pose_m_, 0.5F * pose_m_, 0.1F};
    break_sensor();
    ++step_;
    return input_;
  }

  robot_core::Output take_step() {
    const robot_core::Output out = robot_core::step(config_, state_, input_);
    yaw_rate_rad_per_s_ = 0.0F;
    for (int i = 0; i < config_.wheel_count; ++i) {
      const float back_V = config_.torque_constant_Nm_per_A * speed_rad_per_s_[i];
      current_A_[i] = out.is_open[i] ? 0.0F : (out.voltage_V[i] - back_V) / config_.resistance_ohm;
      const float torque_Nm = config_.torque_constant_Nm_per_A * current_A_[i] - 1e-4F * speed_rad_per_s_[i];
      speed_rad_per_s_[i] += 0.001F * torque_Nm / 5e-4F;
      yaw_rate_rad_per_s_ += config_.wheel[i].inverse_yaw_per_m * config_.wheel_radius_m * speed_rad_per_s_[i];
    }
    pose_m_ += 1e-5F * speed_rad_per_s_[0];
    return out;
  }

  [[nodiscard]] std::uint64_t digest() const {
    std::uint64_t sum = 14695981039346656037U;
    for (const auto byte : std::bit_cast<std::array<unsigned char, sizeof(robot_core::State)>>(state_)) {
      sum = (sum ^ byte) * 1099511628211U;
    }
    return sum;
  }

 private:
  float uniform() { return std::uniform_real_distribution<float>()(engine_); }

  void command() {
    constexpr robot_core::Mode kModes[] = {
        robot_core::Mode::body_velocity, robot_core::Mode::body_velocity, robot_core::Mode::body_velocity, robot_core::Mode::wheel_speed,
        robot_core::Mode::wheel_torque,  robot_core::Mode::pose_target,   robot_core::Mode::brake,         robot_core::Mode::coast};
    if (uniform() < 0.3F) {
      input_.command.mode = kModes[static_cast<std::size_t>(uniform() * 7.99F)];
    }
    input_.command.velocity = {4.0F * (uniform() - 0.5F), 4.0F * (uniform() - 0.5F), 12.0F * (uniform() - 0.5F)};
    input_.command.acceleration = {2.0F * (uniform() - 0.5F), 2.0F * (uniform() - 0.5F), 0.0F};
    input_.command.pose = {pose_m_ + uniform(), uniform() - 0.5F, 2.0F * (uniform() - 0.5F)};
    for (int i = 0; i < config_.wheel_count; ++i) {
      input_.command.wheel_speed_rad_per_s[i] = 60.0F * (uniform() - 0.5F);
      input_.command.wheel_torque_Nm[i] = 0.2F * (uniform() - 0.5F);
    }
  }

  void break_sensor() {
    const auto wheel = static_cast<std::size_t>(step_ / 500 % config_.wheel_count);
    const float none = robot_core::kNoSample;
    float* const values[] = {nullptr,
                             &input_.wheel_speed_rad_per_s[wheel],
                             &input_.motor_current_A[wheel],
                             &input_.battery_V,
                             &input_.yaw_rate_rad_per_s,
                             &input_.ambient_C,
                             &input_.stator_C[wheel],
                             &input_.command.velocity.x,
                             nullptr,
                             nullptr,
                             nullptr,
                             nullptr};
    if (values[fault_] != nullptr) {
      *values[fault_] = none;
    } else if (fault_ == 8) {
      input_.command_age_s = 1.0F;
    } else if (fault_ == 9) {
      input_.wheel_speed_rad_per_s[wheel] = 17.0F;
    } else if (fault_ == 10 && step_ % 500 == 7) {
      input_.elapsed_s = 0.01F;
    }
  }

  const robot_core::Config& config_;
  robot_core::State state_;
  robot_core::Input input_{};
  std::mt19937 engine_{7};
  int step_ = 0;
  int fault_ = 0;
  float speed_rad_per_s_[robot_core::kMostWheels] = {};
  float current_A_[robot_core::kMostWheels] = {};
  float yaw_rate_rad_per_s_ = 0.0F;
  float pose_m_ = 0.0F;
};

}  // namespace heatsoak
