#include "simulate/simulated_robot.h"

#include <algorithm>
#include <cmath>

#include "base/copper.h"
#include "motor/datasheet_network.h"

namespace heatsoak {
namespace {

const int kPeriodsPerThermal = static_cast<int>(std::lround(SimulatedRobot::kThermalPeriod_s / SimulatedRobot::kPeriod_s));

std::vector<Lanes> same_in_all_lanes(const std::vector<double>& values) {
  std::vector<Lanes> lanes;
  for (const double value : values) {
    lanes.emplace_back(Lanes::Constant(value));
  }
  return lanes;
}

/// Cooling by speed makes a network fast, and heat by current does: the step that suits rest and the utmost of both.
double shortest_of_longest_steps_s(const PlantConfig& plant, const Network& network, std::span<const Lanes> parameters, double ambient_C) {
  OperatingPoint<Lanes> rest;
  rest.ambient_C = Lanes::Constant(ambient_C);
  OperatingPoint<Lanes> utmost = rest;
  utmost.current_rms_A = Lanes::Constant(plant.battery.full_V / plant.motor.resistance_25C_ohm);
  utmost.speed_mean_rad_per_s = Lanes::Constant(plant.battery.full_V / plant.motor.torque_constant_25C_Nm_per_A);
  utmost.speed_rms_rad_per_s = utmost.speed_mean_rad_per_s;
  return std::min(longest_step_s(network, parameters, rest), longest_step_s(network, parameters, utmost));
}

}  // namespace

SimulatedRobot::SimulatedRobot(const Robot& robot, const Motor& motor, double ambient_C, double start_C)
    : plant_(make_plant(robot, motor.nominal, kPeriod_s)),
      state_(plant_at_rest(plant_)),
      ambient_C_(ambient_C),
      network_(datasheet_network(motor, nominal_sample(motor))),
      parameters_(same_in_all_lanes(network_.values())),
      thermal_(
          network_, parameters_,
          std::vector<Lanes>(static_cast<std::size_t>(network_.state_count()), Lanes::Constant(std::isnan(start_C) ? ambient_C : start_C))),
      longest_step_s_(shortest_of_longest_steps_s(plant_, network_, parameters_, ambient_C)) {
  static_assert(kMostWheels <= kLanes);
  heating_.ambient_C = Lanes::Constant(ambient_C);
  input_.winding_C.fill(winding_C(0));
  input_.magnet_C.fill(stator_C(0));
  input_.external_height_m = plant_.body.weight.center_of_gravity_height_m;
}

const PlantOutput& SimulatedRobot::advance(const std::array<MotorCommand, kMostWheels>& command, const Wrench& external) {
  input_.command = command;
  input_.external = external;
  step(plant_, state_, input_, output_);
  book();
  if (++periods_ == kPeriodsPerThermal) {
    warm_up();
  }
  return output_;
}

void SimulatedRobot::book() {
  sums_.copper_W += as_wheels(output_.copper_W);
  sums_.driver_W += as_wheels(output_.driver_W);
  sums_.motor_drag_W += as_wheels(output_.motor_drag_W);
  sums_.gear_W += as_wheels(output_.gear_W);
  sums_.rolling_W += as_wheels(output_.rolling_W);
  sums_.friction_W += as_wheels(output_.friction_W);
  sums_.slip_W += as_wheels(output_.slip_W);
  sums_.roller_W += as_wheels(output_.roller_W);
  sums_.battery_loss_W += output_.battery_loss_W;
  sums_.external_W += output_.external_W;
  const Wheels speed_rad_per_s = as_wheels(output_.motor_speed_rad_per_s);
  copper_W_ += as_wheels(output_.copper_W);
  speed_rad_per_s_ += speed_rad_per_s.abs();
  speed_squared_rad2_per_s2_ += speed_rad_per_s.square();
}

void SimulatedRobot::warm_up() {
  // The plant's copper loss as the current that makes it, so that the network gets that heat.
  const Wheels resistance_ohm = plant_.motor.resistance_25C_ohm *
                                resistance_ratio<Wheels>(Wheels::Constant(plant_.motor.resistance_rise_per_K), as_wheels(input_.winding_C));
  heating_.current_rms_A.head<kMostWheels>() = (copper_W_ / periods_ / resistance_ohm).sqrt();
  heating_.speed_mean_rad_per_s.head<kMostWheels>() = speed_rad_per_s_ / periods_;
  heating_.speed_rms_rad_per_s.head<kMostWheels>() = (speed_squared_rad2_per_s2_ / periods_).sqrt();
  thermal_.over(kPeriod_s * periods_, heating_, longest_step_s_);
  for (int i = 0; i < wheel_count(); ++i) {
    input_.winding_C[i] = winding_C(i);
    input_.magnet_C[i] = stator_C(i);
  }
  copper_W_.setZero();
  speed_rad_per_s_.setZero();
  speed_squared_rad2_per_s2_.setZero();
  periods_ = 0;
}

EnergyAccount SimulatedRobot::energy() const {
  EnergyAccount account;
  account.battery_loss_J = sums_.battery_loss_W * kPeriod_s;
  account.copper_J = sums_.copper_W.sum() * kPeriod_s;
  account.driver_J = sums_.driver_W.sum() * kPeriod_s;
  account.motor_drag_J = sums_.motor_drag_W.sum() * kPeriod_s;
  account.gear_J = sums_.gear_W.sum() * kPeriod_s;
  account.rolling_J = sums_.rolling_W.sum() * kPeriod_s;
  account.friction_J = sums_.friction_W.sum() * kPeriod_s;
  account.slip_J = sums_.slip_W.sum() * kPeriod_s;
  account.roller_J = sums_.roller_W.sum() * kPeriod_s;
  account.external_J = sums_.external_W * kPeriod_s;
  account.battery_J =
      stored_energy_J(plant_.battery, plant_.battery.capacity_A_s) - stored_energy_J(plant_.battery, state_.battery_charge_A_s);
  account.kinetic_J = kinetic_energy_J(plant_.body, state_.velocity, state_.wheel_speed_rad_per_s);
  return account;
}

}  // namespace heatsoak
