// Connects the drive core to the team's computer and to the motors of a simulated robot.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "simulate/radio.h"
#include "simulate/sensing.h"

namespace heatsoak::simulate {

struct DriveOptions {
  SensingConfig sensing;
  RadioConfig radio;
  std::uint64_t seed = 1;
};

/// Returns options with the errors and delays of the robot's sensors and radio link.
DriveOptions real_drive(const robot::Robot& robot, std::uint64_t seed);
/// Returns options with exact sensors and an ideal link.
DriveOptions ideal_drive();

/// Runs robot_core::step() every Config::period_s, a whole number of plant periods. A motor gets pwm_ratio times the true battery voltage
/// of the previous plant period, or is open.
class CoreDrive {
 public:
  /// Starts the core with the hottest winding temperature of `robot`. Throws Failure: bad_input if a number of `options` is out of range or
  /// the period does not fit, bug if the core rejects the Config. The objects that `config` points to must outlive this object.
  CoreDrive(const robot_core::Config& config, const SimulatedRobot& robot, const DriveOptions& options);

  /// Begins a plant period: runs radio, sensors and core if they are due. Returns the motor commands of this period. `push` is the force on
  /// another robot, field frame.
  const std::array<robot::MotorCommand, robot::kMostWheels>& advance(const duty::Follower& plan, const SimulatedRobot& robot,
                                                                     const robot::Wrench& push);
  /// Ends the plant period with the plant's output.
  void follow(const SimulatedRobot& robot, const robot::PlantOutput& out);

  [[nodiscard]] const robot_core::Config& config() const { return config_; }
  [[nodiscard]] const robot_core::State& state() const { return state_; }
  /// Output of the last step of the core.
  [[nodiscard]] const robot_core::Output& output() const { return output_; }
  [[nodiscard]] const robot_core::Input& input() const { return input_; }
  /// Motor commands of the present plant period.
  [[nodiscard]] const std::array<robot::MotorCommand, robot::kMostWheels>& commands() const { return commands_; }
  [[nodiscard]] const OffBoard& off_board() const { return off_board_; }

 private:
  void apply(const robot_core::Output& output);

  robot_core::Config config_;
  robot_core::State state_{};
  robot_core::Input input_;
  robot_core::Output output_;
  robot_core::Output waiting_;  ///< computed in the last step, not yet in the PWM registers
  robot_core::Output acting_;   ///< in the PWM registers
  OffBoard off_board_;
  Sensing sensing_;
  bool is_delayed_;
  double ambient_C_;
  double battery_V_;
  std::array<robot::MotorCommand, robot::kMostWheels> commands_{};
  std::int64_t periods_per_step_;
  std::int64_t now_ = 0;                  ///< index of the plant period
  std::optional<std::int64_t> received_;  ///< plant period in which the last command arrived; empty before the first
};

}  // namespace heatsoak::simulate
