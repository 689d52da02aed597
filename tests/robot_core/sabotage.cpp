#include "sabotage.h"

#include <cstring>
#include <limits>
#include <utility>

namespace heatsoak::test_robot {
namespace {

using robot_core::Config;
using robot_core::Input;
using robot_core::State;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

constexpr std::array<std::string_view, kLies> kNames{
    "none",          "wheel_nan",       "wheel_infinite", "wheel_garbage",   "wheel_stuck",     "wheel_swapped",   "wheel_jump",
    "wheel_flipped", "wheel_scaled",    "wheel_zero",     "wheel_biased",    "current_nan",     "current_garbage", "current_stuck",
    "current_zero",  "current_flipped", "current_scaled", "battery_nan",     "battery_garbage", "battery_stuck",   "battery_zero",
    "battery_jump",  "battery_scaled",  "yaw_nan",        "yaw_garbage",     "yaw_stuck",       "yaw_zero",        "yaw_flipped",
    "yaw_scaled",    "yaw_biased",      "ambient_nan",    "ambient_garbage", "ambient_cold",    "stator_nan",      "stator_garbage",
    "stator_cold",   "command_garbage", "command_stale",  "elapsed_garbage", "elapsed_scaled",  "state_flipped"};

float drawn_size(Lie lie, Random& random) {
  switch (lie) {
    case Lie::wheel_jump:
      return random.between(-400.0F, 400.0F);
    case Lie::wheel_biased:
      return random.between(-40.0F, 40.0F);
    case Lie::wheel_scaled:
    case Lie::current_scaled:
    case Lie::yaw_scaled:
      return random.between(0.2F, 2.5F);
    case Lie::battery_scaled:
      return random.between(0.75F, 1.05F);
    case Lie::battery_jump:
      return random.between(-6.0F, 1.0F);
    case Lie::yaw_biased:
      return random.between(-12.0F, 12.0F);
    case Lie::elapsed_scaled:
      return random.between(0.05F, 4.0F);
    default:
      return 0.0F;
  }
}

bool is_between(Lie first, Lie lie, Lie last) { return lie >= first && lie <= last; }

}  // namespace

std::string_view name_of(Lie lie) { return kNames.at(static_cast<std::size_t>(lie)); }

Sabotage::Sabotage(Lie lie, const Config& config, Random& random, int first_step, int last_step)
    : lie_(lie), wheel_(random.below(config.wheel_count)), first_step_(first_step), last_step_(last_step), size_(drawn_size(lie, random)) {
  other_ = (wheel_ + 1 + random.below(config.wheel_count - 1)) % config.wheel_count;
}

void Sabotage::falsify_wheel_speed(Input& input, Random& random, bool is_first) {
  float& speed = input.wheel_speed_rad_per_s[wheel_];
  held_ = is_first ? speed : held_;
  switch (lie_) {
    case Lie::wheel_nan:
      speed = kNone;
      break;
    case Lie::wheel_infinite:
      speed = random.happens(0.5F) ? kInfinity : -kInfinity;
      break;
    case Lie::wheel_garbage:
      speed = random.any_float();
      break;
    case Lie::wheel_stuck:
      speed = held_;
      break;
    case Lie::wheel_swapped:
      std::swap(speed, input.wheel_speed_rad_per_s[other_]);
      break;
    case Lie::wheel_jump:
    case Lie::wheel_biased:
      speed += size_;
      break;
    case Lie::wheel_flipped:
      speed = -speed;
      break;
    case Lie::wheel_scaled:
      speed *= size_;
      break;
    default:
      speed = 0.0F;
  }
}

void Sabotage::spoil_current(Input& input, Random& random, bool is_first) {
  float& current = input.motor_current_A[wheel_];
  held_ = is_first ? current : held_;
  switch (lie_) {
    case Lie::current_nan:
      current = kNone;
      break;
    case Lie::current_garbage:
      current = random.any_float();
      break;
    case Lie::current_stuck:
      current = held_;
      break;
    case Lie::current_flipped:
      current = -current;
      break;
    case Lie::current_scaled:
      current *= size_;
      break;
    default:
      current = 0.0F;
  }
}

void Sabotage::spoil_battery(const Config& config, Input& input, Random& random, bool is_first) {
  float& battery = input.battery_V;
  held_ = is_first ? battery : held_;
  switch (lie_) {
    case Lie::battery_nan:
      battery = kNone;
      break;
    case Lie::battery_garbage:
      battery = random.happens(0.5F) ? random.any_float() : random.between(0.0F, 2.0F * config.battery_full_V);
      break;
    case Lie::battery_stuck:
      battery = held_;
      break;
    case Lie::battery_jump:
      battery += size_;
      break;
    case Lie::battery_scaled:
      battery *= size_;
      break;
    default:
      battery = 0.0F;
  }
}

void Sabotage::falsify_yaw_rate(Input& input, Random& random, bool is_first) {
  float& rate = input.yaw_rate_rad_per_s;
  held_ = is_first ? rate : held_;
  switch (lie_) {
    case Lie::yaw_nan:
      rate = kNone;
      break;
    case Lie::yaw_garbage:
      rate = random.any_float();
      break;
    case Lie::yaw_stuck:
      rate = held_;
      break;
    case Lie::yaw_flipped:
      rate = -rate;
      break;
    case Lie::yaw_scaled:
      rate *= size_;
      break;
    case Lie::yaw_biased:
      rate += size_;
      break;
    default:
      rate = 0.0F;
  }
}

void Sabotage::spoil_temperature(Input& input, Random& random) {
  const bool is_ambient = lie_ <= Lie::ambient_cold;
  float& sample = is_ambient ? input.ambient_C : input.stator_C[wheel_];
  if (lie_ == Lie::ambient_nan || lie_ == Lie::stator_nan) {
    sample = kNone;
  } else if (lie_ == Lie::ambient_garbage || lie_ == Lie::stator_garbage) {
    sample = random.any_float();
  } else {
    sample = 10.0F;
  }
}

void Sabotage::spoil_command(Input& input, Random& random) {
  if (lie_ == Lie::command_stale) {
    input.command_age_s = random.happens(0.5F) ? random.between(0.2F, 100.0F) : random.any_float();
    return;
  }
  robot_core::Command& command = input.command;
  float* const values[] = {&command.velocity.x,     &command.velocity.y, &command.velocity.yaw, &command.acceleration.x,
                           &command.acceleration.y, &command.push.x,     &command.push.yaw,     &command.pose.x};
  for (float* const value : values) {
    *value = random.happens(0.3F) ? random.any_float() : *value;
  }
  for (int i = 0; i < kMostWheels; ++i) {
    command.wheel_speed_rad_per_s[i] = random.any_float();
    command.wheel_torque_Nm[i] = random.any_float();
  }
  if (random.happens(0.2F)) {
    command.mode = static_cast<robot_core::Mode>(random.below(256));
  }
}

void Sabotage::spoil_rest(const Config& config, Input& input, State& state, Random& random) {
  if (lie_ == Lie::elapsed_garbage) {
    input.elapsed_s = random.any_float();
  } else if (lie_ == Lie::elapsed_scaled) {
    input.elapsed_s = size_ * config.period_s;
  } else if (random.happens(0.05F)) {
    unsigned char byte = 0;
    const auto at = static_cast<std::size_t>(random.below(static_cast<int>(sizeof(State))));
    auto* const bytes = reinterpret_cast<unsigned char*>(&state);
    std::memcpy(&byte, bytes + at, 1);
    byte = static_cast<unsigned char>(byte ^ (1U << static_cast<unsigned>(random.below(8))));
    std::memcpy(bytes + at, &byte, 1);
  }
}

void Sabotage::spoil(const Config& config, Random& random, int step, Input& input, State& state) {
  if (lie_ == Lie::none || step < first_step_ || step > last_step_) {
    return;
  }
  const bool is_first = step == first_step_;
  if (is_between(Lie::wheel_nan, lie_, Lie::wheel_biased)) {
    falsify_wheel_speed(input, random, is_first);
  } else if (is_between(Lie::current_nan, lie_, Lie::current_scaled)) {
    spoil_current(input, random, is_first);
  } else if (is_between(Lie::battery_nan, lie_, Lie::battery_scaled)) {
    spoil_battery(config, input, random, is_first);
  } else if (is_between(Lie::yaw_nan, lie_, Lie::yaw_biased)) {
    falsify_yaw_rate(input, random, is_first);
  } else if (is_between(Lie::ambient_nan, lie_, Lie::stator_cold)) {
    spoil_temperature(input, random);
  } else if (is_between(Lie::command_garbage, lie_, Lie::command_stale)) {
    spoil_command(input, random);
  } else {
    spoil_rest(config, input, state, random);
  }
}

}  // namespace heatsoak::test_robot
