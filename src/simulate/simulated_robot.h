// Simulated robot: the plant and the thermal networks of its motors.
#pragma once

#include <memory>
#include <optional>

#include "motor/motor.h"
#include "robot/plant.h"

namespace heatsoak::simulate {

/// Energy balance since the start: battery = losses + kinetic − external. Losses and external_J are integrals of the plant's powers,
/// battery_J follows from the charge, and kinetic_J from the state.
struct EnergyAccount {
  double battery_J = 0.0;  ///< energy taken from the charge
  double battery_loss_J = 0.0;
  double copper_J = 0.0;
  double driver_J = 0.0;
  double motor_drag_J = 0.0;
  double gear_J = 0.0;
  double rolling_J = 0.0;
  double friction_J = 0.0;
  double slip_J = 0.0;
  double roller_J = 0.0;
  double kinetic_J = 0.0;   ///< increase of the kinetic energy
  double external_J = 0.0;  ///< work of external forces on the robot

  [[nodiscard]] double heat_J() const {
    return battery_loss_J + copper_J + driver_J + motor_drag_J + gear_J + rolling_J + friction_J + slip_J + roller_J;
  }
  /// Returns the residual of the balance, which is the error of the integration method.
  [[nodiscard]] double residual_J() const { return battery_J + external_J - heat_J() - kinetic_J; }
};

/// One motor per wheel, all of the same type. The robot starts at rest with a full battery and all motors at one temperature. R follows the
/// winding temperature and K_t the stator temperature, which the magnets are assumed to have. The motor's thermal network advances every
/// kThermalPeriod_s with the mean load of this period. An effect neighbour_coupling exchanges heat with the motors of the two wheels beside
/// it, at the same node of all three.
class SimulatedRobot {
 public:
  static constexpr double kPeriod_s = 0.001;
  static constexpr double kThermalPeriod_s = 0.01;

  /// Motors start at `start_C`; if it is empty, at ambient temperature. Throws Failure (bad_input) that names the values missing from the
  /// robot or motor file, or effects neighbour_coupling at several nodes.
  SimulatedRobot(const robot::Robot& robot, const motor::Motor& motor, double ambient_C, std::optional<double> start_C = {});
  ~SimulatedRobot();
  SimulatedRobot(const SimulatedRobot&) = delete;
  SimulatedRobot& operator=(const SimulatedRobot&) = delete;

  /// Advances by one plant period. The force `external` acts at the height of the centre of gravity, local frame.
  const robot::PlantOutput& advance(const std::array<robot::MotorCommand, robot::kMostWheels>& command, const robot::Wrench& external);

  [[nodiscard]] double ambient_C() const { return ambient_C_; }
  [[nodiscard]] const robot::PlantConfig& plant() const { return plant_; }
  [[nodiscard]] const robot::PlantState& state() const { return state_; }
  [[nodiscard]] robot::BodyVelocity velocity_global() const { return robot::to_global(state_.velocity, state_.pose.yaw_rad); }
  [[nodiscard]] int wheel_count() const { return plant_.body.kinematics.wheel_count; }
  [[nodiscard]] double winding_C(int wheel) const { return body_C(kWinding, wheel); }
  [[nodiscard]] double stator_C(int wheel) const { return body_C(kStator, wheel); }
  /// Returns the temperature of network state `state` at `wheel` in °C.
  [[nodiscard]] double body_C(std::size_t state, int wheel) const;
  [[nodiscard]] double winding_peak_C(int wheel) const { return peak_C(kWinding, wheel); }
  [[nodiscard]] double stator_peak_C(int wheel) const { return peak_C(kStator, wheel); }
  [[nodiscard]] EnergyAccount energy() const;

 private:
  static constexpr std::size_t kWinding = 0;
  static constexpr std::size_t kStator = 1;
  /// Sums of powers and the motors' networks. Defined in the .cpp file because they need Eigen.
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
