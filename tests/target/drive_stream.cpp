#include "drive_stream.h"

#include <array>
#include <cmath>
#include <limits>
#include <random>

namespace heatsoak::target {
namespace {

using robot_core::Command;
using robot_core::Config;
using robot_core::Input;
using robot_core::kMostWheels;
using robot_core::Mode;
using robot_core::Output;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  float between(float low, float high) { return std::uniform_real_distribution<float>(low, high)(engine_); }
  bool happens(float probability) { return between(0.0F, 1.0F) < probability; }
  int below(int count) { return std::uniform_int_distribution<int>(0, count - 1)(engine_); }

 private:
  std::mt19937 engine_;
};

/// Rigid robot on wheels without slip, with motors without inductance.
class Robot {
 public:
  explicit Robot(const Config& config) : config_(config) {}

  void move(const Output& output, float time_s) {
    std::array<float, 3> force{};
    battery_A_ = 0.0F;
    for (int i = 0; i < config_.wheel_count; ++i) {
      const robot_core::WheelConfig& wheel = config_.wheel[i];
      const float speed = speed_rad_per_s(i);
      const float drag_Nm = 0.01F * std::tanh(speed) + 1.4e-4F * speed;
      current_A_[i] = output.is_open[i] ? 0.0F : (output.voltage_V[i] - config_.torque_constant_Nm_per_A * speed) / config_.resistance_ohm;
      battery_A_ += current_A_[i] * output.pwm_ratio[i];
      const float rim_N = (config_.torque_constant_Nm_per_A * current_A_[i] - drag_Nm) / config_.wheel_radius_m;
      force[0] += wheel.rolling_x_share * rim_N;
      force[1] += wheel.rolling_y_share * rim_N;
      force[2] += config_.contact_radius_m * rim_N;
    }
    // The wheels' inertia is added as if each turned with half of the body's squared speed.
    const float of_wheels_kg = 2.0F * config_.wheel_inertia_kg_m2 / (config_.wheel_radius_m * config_.wheel_radius_m);
    const float inertia_kg_m2 = config_.yaw_inertia_kg_m2 + 2.0F * of_wheels_kg * config_.contact_radius_m * config_.contact_radius_m;
    velocity_[0] += time_s * force[0] / (config_.mass_kg + of_wheels_kg);
    velocity_[1] += time_s * force[1] / (config_.mass_kg + of_wheels_kg);
    velocity_[2] += time_s * force[2] / inertia_kg_m2;
    const float cosine = std::cos(pose_[2]);
    const float sine = std::sin(pose_[2]);
    pose_[0] += time_s * (cosine * velocity_[0] - sine * velocity_[1]);
    pose_[1] += time_s * (sine * velocity_[0] + cosine * velocity_[1]);
    pose_[2] += time_s * velocity_[2];
  }

  void sense(Random& random, Input& input) const {
    for (int i = 0; i < kMostWheels; ++i) {
      input.wheel_speed_rad_per_s[i] = speed_rad_per_s(i) + random.between(-0.5F, 0.5F);
      input.motor_current_A[i] = current_A_[i] + random.between(-0.05F, 0.05F);
    }
    input.battery_V = 24.0F - config_.battery_resistance_ohm * battery_A_ + random.between(-0.05F, 0.05F);
    input.yaw_rate_rad_per_s = velocity_[2] + random.between(-0.02F, 0.02F);
    input.ambient_C = 27.0F;
    input.pose = {pose_[0], pose_[1], pose_[2]};
    input.elapsed_s = config_.period_s * random.between(0.99F, 1.01F);
  }

 private:
  [[nodiscard]] float speed_rad_per_s(int i) const {
    const robot_core::WheelConfig& wheel = config_.wheel[i];
    return (wheel.rolling_x_share * velocity_[0] + wheel.rolling_y_share * velocity_[1] + config_.contact_radius_m * velocity_[2]) /
           config_.wheel_radius_m;
  }

  const Config& config_;
  std::array<float, 3> velocity_{};
  std::array<float, 3> pose_{};
  std::array<float, kMostWheels> current_A_{};
  float battery_A_ = 0.0F;
};

Command random_command(Random& random, bool with_poses) {
  Command command;
  if (with_poses) {
    command.mode = Mode::pose_target;
    command.pose = {random.between(-4.0F, 4.0F), random.between(-3.0F, 3.0F), random.between(-3.0F, 3.0F)};
    return command;
  }
  constexpr Mode kModes[] = {Mode::body_velocity, Mode::body_velocity, Mode::body_velocity, Mode::body_velocity, Mode::body_velocity,
                             Mode::wheel_speed,   Mode::wheel_torque,  Mode::brake,         Mode::coast};
  command.mode = kModes[random.below(static_cast<int>(std::size(kModes)))];
  command.velocity = {random.between(-2.5F, 2.5F), random.between(-2.5F, 2.5F), random.between(-7.0F, 7.0F)};
  command.acceleration = {random.between(-2.0F, 2.0F), random.between(-2.0F, 2.0F), random.between(-10.0F, 10.0F)};
  if (random.happens(0.1F)) {
    command.push = {random.between(-5.0F, 5.0F), random.between(-5.0F, 5.0F), random.between(-0.3F, 0.3F)};
  }
  for (int i = 0; i < kMostWheels; ++i) {
    command.wheel_speed_rad_per_s[i] = random.between(-60.0F, 60.0F);
    command.wheel_torque_Nm[i] = random.between(-0.1F, 0.1F);
  }
  return command;
}

/// Injected fault and the number of periods that it lasts.
struct Fault {
  int kind = -1;
  int wheel = 0;
  int periods = 0;
};
constexpr int kFaultKinds = 14;
constexpr int kSwapped = 3;

void spoil(const Fault& fault, const Input& last, Input& input) {
  constexpr float kNone = robot_core::kNoSample;
  switch (fault.kind) {
    case 0:
      input.wheel_speed_rad_per_s[fault.wheel] = kNone;
      break;
    case 1:
      input.wheel_speed_rad_per_s[fault.wheel] = last.wheel_speed_rad_per_s[fault.wheel];
      break;
    case 2:
      input.wheel_speed_rad_per_s[fault.wheel] += 200.0F;
      break;
    case kSwapped:
      std::swap(input.wheel_speed_rad_per_s[fault.wheel], input.wheel_speed_rad_per_s[(fault.wheel + 1) % kMostWheels]);
      break;
    case 4:
      input.motor_current_A[fault.wheel] = kNone;
      break;
    case 5:
      input.motor_current_A[fault.wheel] = 11.0F;
      break;
    case 6:
      input.battery_V = kInfinity;
      break;
    case 7:
      input.yaw_rate_rad_per_s = kNone;
      break;
    case 8:
      input.yaw_rate_rad_per_s = last.yaw_rate_rad_per_s;
      break;
    case 9:
      input.ambient_C = -273.0F;
      break;
    case 10:
      input.elapsed_s = 0.1F;
      break;
    case 11:
      input.command_age_s = 1.0F;
      break;
    case 12:
      input.command.velocity.x = kNone;
      break;
    case 13:
      // All wheels fail at once, so no speed can be implied from others.
      for (float& speed : input.wheel_speed_rad_per_s) {
        speed = kNone;
      }
      input.ambient_C = kNone;
      break;
    default:
      break;
  }
}

}  // namespace

std::vector<Input> minute_of_play(unsigned seed, Play play) {
  const bool with_poses = play == Play::pose_targets;
  Random random(seed);
  DriveRun run{};
  begin(run);
  Robot robot(run.config);
  const int periods = static_cast<int>(std::lround(60.0F / run.config.period_s));
  std::vector<Input> inputs;
  inputs.reserve(static_cast<std::size_t>(periods));
  Command command;
  Fault fault;
  int until_command = 0;
  float age_s = 0.0F;
  for (int k = 0; k < periods; ++k) {
    if (--until_command <= 0) {
      // One command in ten starts a new manoeuvre, the others repeat the last.
      command = k == 0 || random.happens(with_poses ? 0.01F : 0.1F) ? random_command(random, with_poses) : command;
      until_command = 16;
      age_s = 0.004F;
    }
    Input input;
    input.command = command;
    input.command_age_s = age_s;
    age_s += run.config.period_s;
    robot.sense(random, input);
    if (play == Play::late_steps && random.happens(0.1F)) {
      input.elapsed_s = run.config.period_s * random.between(1.0F, robot_core::kLongestGap_periods);
    }
    const float time_s = input.elapsed_s;
    if (play == Play::lost_wheel_sensor) {
      input.wheel_speed_rad_per_s[3] = 60 * k >= periods ? robot_core::kNoSample : input.wheel_speed_rad_per_s[3];
    } else if (3 * k >= 2 * periods) {
      if (--fault.periods <= 0) {
        fault = {random.happens(0.5F) ? random.below(kFaultKinds) : -1, random.below(kMostWheels), 1 + random.below(300)};
        // Swapped sensors remain a fault until start(), so they appear only near the end.
        fault.kind = fault.kind == kSwapped && 20 * k < 19 * periods ? -1 : fault.kind;
      }
      spoil(fault, inputs.back(), input);
    }
    inputs.push_back(input);
    run.output = robot_core::step(run.config, run.state, input);
    robot.move(run.output, play == Play::late_steps ? time_s : run.config.period_s);
  }
  return inputs;
}

}  // namespace heatsoak::target
