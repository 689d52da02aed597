// The robot that is driven: the plant, and the windings and stators that its currents heat.
#pragma once

#include <memory>
#include <optional>

#include "motor/motor.h"
#include "robot/plant.h"

namespace heatsoak::simulate {

/// Where energy went since the start. battery = losses + kinetic − external, all as integrals of the plant's powers but
/// `battery_J`, which is what the charge has lost, and `kinetic_J`, which follows from the state.
struct EnergyAccount {
  double battery_J = 0.0;
  double battery_loss_J = 0.0;
  double copper_J = 0.0;
  double driver_J = 0.0;
  double motor_drag_J = 0.0;
  double gear_J = 0.0;
  double rolling_J = 0.0;
  double friction_J = 0.0;
  double slip_J = 0.0;
  double roller_J = 0.0;
  double kinetic_J = 0.0;   ///< gained
  double external_J = 0.0;  ///< done on the robot from outside

  [[nodiscard]] double heat_J() const {
    return battery_loss_J + copper_J + driver_J + motor_drag_J + gear_J + rolling_J + friction_J + slip_J + roller_J;
  }
  /// What is not accounted for: the error of the method.
  [[nodiscard]] double residual_J() const { return battery_J + external_J - heat_J() - kinetic_J; }
};

/// One motor per wheel, all alike. Starts at rest with a full battery, all motors at one temperature.
/// R and K_t follow winding and stator (the magnets are taken to be as warm as the stator); both are computed by the
/// motor's thermal network, which gets the means of the currents every kThermalPeriod_s.
class SimulatedRobot {
 public:
  static constexpr double kPeriod_s = 0.001;
  static constexpr double kThermalPeriod_s = 0.01;

  /// Motors start at `start_C`, or at ambient temperature without it. Throws Failure (bad_input) that names what the robot's or
  /// the motor's file lacks.
  SimulatedRobot(const robot::Robot& robot, const motor::Motor& motor, double ambient_C, std::optional<double> start_C = {});
  ~SimulatedRobot();
  SimulatedRobot(const SimulatedRobot&) = delete;
  SimulatedRobot& operator=(const SimulatedRobot&) = delete;

  /// One period of the plant. `external` acts on the body from outside at the height of its centre of gravity, local axes.
  const robot::PlantOutput& advance(const std::array<robot::MotorCommand, robot::kMostWheels>& command, const robot::Wrench& external);

  [[nodiscard]] double ambient_C() const { return ambient_C_; }
  [[nodiscard]] const robot::PlantConfig& plant() const { return plant_; }
  [[nodiscard]] const robot::PlantState& state() const { return state_; }
  [[nodiscard]] robot::BodyVelocity velocity_global() const { return robot::to_global(state_.velocity, state_.pose.yaw_rad); }
  [[nodiscard]] int wheel_count() const { return plant_.body.kinematics.wheel_count; }
  [[nodiscard]] double winding_C(int wheel) const { return body_C(kWinding, wheel); }
  [[nodiscard]] double stator_C(int wheel) const { return body_C(kStator, wheel); }
  /// Of the state of that place in the motor's network.
  [[nodiscard]] double body_C(std::size_t state, int wheel) const;
  [[nodiscard]] double winding_peak_C(int wheel) const { return peak_C(kWinding, wheel); }
  [[nodiscard]] double stator_peak_C(int wheel) const { return peak_C(kStator, wheel); }
  [[nodiscard]] EnergyAccount energy() const;

 private:
  static constexpr std::size_t kWinding = 0;
  static constexpr std::size_t kStator = 1;
  /// Powers summed over time and the motors' networks; in the .cpp file because they need Eigen.
  struct Heating;

  [[nodiscard]] double peak_C(std::size_t state, int wheel) const;
  void book();
  void warm_up();

  robot::PlantConfig plant_;
  robot::PlantState state_;
  robot::PlantInput input_;
  robot::PlantOutput output_;
  double ambient_C_;
  std::unique_ptr<Heating> heating_;
};

}  // namespace heatsoak::simulate
