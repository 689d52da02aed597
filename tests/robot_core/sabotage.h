// Faults of sensors, radio, timer and memory that the tests inject into the drive core.
#pragma once

#include <array>
#include <string_view>

#include "test_robot.h"

namespace heatsoak::test_robot {

enum class Lie : int {
  none,
  wheel_nan,
  wheel_infinite,
  wheel_garbage,
  wheel_stuck,
  wheel_swapped,
  wheel_jump,
  wheel_flipped,
  wheel_scaled,
  wheel_zero,
  wheel_biased,
  current_nan,
  current_garbage,
  current_stuck,
  current_zero,
  current_flipped,
  current_scaled,
  battery_nan,
  battery_garbage,
  battery_stuck,
  battery_zero,
  battery_jump,
  battery_scaled,
  yaw_nan,
  yaw_garbage,
  yaw_stuck,
  yaw_zero,
  yaw_flipped,
  yaw_scaled,
  yaw_biased,
  ambient_nan,
  ambient_garbage,
  ambient_cold,
  stator_nan,
  stator_garbage,
  stator_cold,
  command_garbage,
  command_stale,
  elapsed_garbage,
  elapsed_scaled,
  state_flipped,
  kinds
};
inline constexpr int kLies = static_cast<int>(Lie::kinds);
std::string_view name_of(Lie lie);

/// One injected fault that acts for a limited time.
class Sabotage {
 public:
  Sabotage(Lie lie, const robot_core::Config& config, Random& random, int first_step, int last_step);
  /// Changes the input or the state of the core at this step.
  void spoil(const robot_core::Config& config, Random& random, int step, robot_core::Input& input, robot_core::State& state);
  Lie lie() const { return lie_; }
  int wheel() const { return wheel_; }

 private:
  void falsify_wheel_speed(robot_core::Input& input, Random& random, bool is_first);
  void spoil_current(robot_core::Input& input, Random& random, bool is_first);
  void spoil_battery(const robot_core::Config& config, robot_core::Input& input, Random& random, bool is_first);
  void falsify_yaw_rate(robot_core::Input& input, Random& random, bool is_first);
  void spoil_temperature(robot_core::Input& input, Random& random);
  void spoil_command(robot_core::Input& input, Random& random);
  void spoil_rest(const robot_core::Config& config, robot_core::Input& input, robot_core::State& state, Random& random);

  Lie lie_;
  int wheel_;
  int other_;
  int first_step_;
  int last_step_;
  float size_;         ///< factor or offset, drawn once per fault
  float held_ = 0.0F;  ///< sample of a stuck sensor
};

}  // namespace heatsoak::test_robot
