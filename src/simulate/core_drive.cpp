#include "simulate/core_drive.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/diagnostic.h"

namespace heatsoak::simulate {
namespace {

std::int64_t plant_periods(double period_s) {
  const std::int64_t count = std::llround(period_s / SimulatedRobot::kPeriod_s);
  if (count < 1 || std::abs(static_cast<double>(count) * SimulatedRobot::kPeriod_s - period_s) > 1e-6 * period_s) {
    throw base::bad_input(
        {}, "control period",
        fmt::format("is {} s; expected a multiple of the simulation's period of {} s", period_s, SimulatedRobot::kPeriod_s));
  }
  return count;
}

}  // namespace

DriveOptions real_drive(const robot::Robot& robot, std::uint64_t seed) { return {sensing_of(robot), radio_of(robot), seed}; }
DriveOptions ideal_drive() { return {ideal_sensing(), ideal_radio(), 1}; }

CoreDrive::CoreDrive(const robot_core::Config& config, const SimulatedRobot& robot, const DriveOptions& options)
    : config_(config),
      off_board_(options.radio, options.seed),
      sensing_(options.sensing, robot, static_cast<double>(config.period_s), options.seed),
      is_delayed_(options.sensing.delay_periods_count > 0.5),
      ambient_C_(robot.ambient_C()),
      battery_V_(robot::open_circuit_V(robot.plant().battery, robot.state().battery_charge_A_s)),
      periods_per_step_(plant_periods(static_cast<double>(config.period_s))) {
  input_.elapsed_s = config.period_s;
  double hottest_C = robot.winding_C(0);
  for (int i = 1; i < robot.wheel_count(); ++i) {
    hottest_C = std::max(hottest_C, robot.winding_C(i));
  }
  if (!robot_core::start(config_, state_, {true, static_cast<float>(hottest_C)})) {
    throw base::Failure(base::ExitCode::bug, "the drive core refuses its configuration");
  }
}

const std::array<robot::MotorCommand, robot::kMostWheels>& CoreDrive::advance(const duty::Follower& plan, const SimulatedRobot& robot,
                                                                              const robot::Wrench& push) {
  const double time_s = static_cast<double>(now_) * SimulatedRobot::kPeriod_s;
  if (const robot_core::Command* const command = off_board_.advance(time_s, plan, robot.state().pose, push)) {
    input_.command = *command;
    received_ = now_;
  }
  if (now_ % periods_per_step_ == 0) {
    sensing_.sample(robot, ambient_C_, input_);
    // Before the first packet the robot coasts, which is the default mode of Command.
    input_.command_age_s = received_ ? static_cast<float>(static_cast<double>(now_ - *received_) * SimulatedRobot::kPeriod_s) : 0.0F;
    output_ = robot_core::step(config_, state_, input_);
    acting_ = is_delayed_ ? waiting_ : output_;
    waiting_ = output_;
  }
  apply(acting_);
  ++now_;
  return commands_;
}

void CoreDrive::apply(const robot_core::Output& output) {
  for (std::size_t i = 0; i < robot::kMostWheels; ++i) {
    if (output.is_open[i]) {
      commands_[i] = {robot::MotorCommand::Kind::open, 0.0};
    } else {
      commands_[i] = {robot::MotorCommand::Kind::voltage, static_cast<double>(output.pwm_ratio[i]) * battery_V_};
    }
  }
}

void CoreDrive::follow(const SimulatedRobot& robot, const robot::PlantOutput& out) {
  sensing_.follow(robot, out);
  battery_V_ = out.battery_V;
}

}  // namespace heatsoak::simulate
