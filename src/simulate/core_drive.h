// The drive core in its place: between the team's computer and the motors of a simulated robot.
#pragma once

#include <array>

#include "simulate/radio.h"
#include "simulate/sensing.h"

namespace heatsoak::simulate {

struct DriveOptions {
  SensingConfig sensing;
  RadioConfig radio;
  std::uint64_t seed = 1;
};

/// Robot's own sensors and link, or exact ones.
DriveOptions real_drive(const robot::Robot& robot, std::uint64_t seed);
DriveOptions ideal_drive();

/// Runs robot_core::step() every Config::period_s, which is a whole number of the plant's periods. The motors get pwm_ratio times the
/// true battery voltage of the period before, or are open.
class CoreDrive {
 public:
  /// The robot has rested at `robot`'s present winding temperatures. Throws Failure: bad_input where a number of `options` is out of range
  /// or the period does not fit, bug where the core refuses the Config. `config` and what it points to must live as long as this.
  CoreDrive(const robot_core::Config& config, const SimulatedRobot& robot, const DriveOptions& options);

  /// Begins a period of the plant: radio, sensors and the core where they are due. Returns what the drivers do in this period. `push` is
  /// the force on another robot, field frame.
  const std::array<robot::MotorCommand, robot::kMostWheels>& advance(const duty::Follower& plan, const SimulatedRobot& robot,
                                                                     const robot::Wrench& push);
  /// Ends it.
  void follow(const SimulatedRobot& robot, const robot::PlantOutput& out);

  [[nodiscard]] const robot_core::Config& config() const { return config_; }
  [[nodiscard]] const robot_core::State& state() const { return state_; }
  /// Of the newest step.
  [[nodiscard]] const robot_core::Output& output() const { return output_; }
  [[nodiscard]] const robot_core::Input& input() const { return input_; }
  /// Of the present period of the plant.
  [[nodiscard]] const std::array<robot::MotorCommand, robot::kMostWheels>& commands() const { return commands_; }
  [[nodiscard]] const OffBoard& off_board() const { return off_board_; }

 private:
  void apply(const robot_core::Output& output);

  robot_core::Config config_;
  robot_core::State state_{};
  robot_core::Input input_;
  robot_core::Output output_;
  robot_core::Output waiting_;  ///< computed, not yet in the PWM registers
  robot_core::Output acting_;
  OffBoard off_board_;
  Sensing sensing_;
  bool is_delayed_;
  double ambient_C_;
  double battery_V_;
  std::array<robot::MotorCommand, robot::kMostWheels> commands_{};
  std::int64_t periods_per_step_;
  std::int64_t now_ = 0;
  std::int64_t received_ = -1;  ///< period in which the command came; < 0: none yet
};

}  // namespace heatsoak::simulate
