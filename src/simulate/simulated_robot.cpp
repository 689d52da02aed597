#include "simulate/simulated_robot.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "motor/datasheet_network.h"
#include "thermal/copper.h"

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

double sum_W(const PerWheel& powers_W) { return std::accumulate(powers_W.begin(), powers_W.end(), 0.0); }

}  // namespace

SimulatedRobot::SimulatedRobot(const Robot& robot, const Motor& motor, double ambient_C)
    : plant_(make_plant(robot, motor.nominal, kPeriod_s)),
      state_(plant_at_rest(plant_)),
      ambient_C_(ambient_C),
      network_(datasheet_network(motor, nominal_sample(motor))),
      parameters_(same_in_all_lanes(network_.values())),
      thermal_(network_, parameters_, std::vector<Lanes>(static_cast<std::size_t>(network_.state_count()), Lanes::Constant(ambient_C))),
      longest_step_s_(shortest_of_longest_steps_s(plant_, network_, parameters_, ambient_C)) {
  static_assert(kMostWheels <= kLanes);
  input_.winding_C.fill(ambient_C);
  input_.magnet_C.fill(ambient_C);
  input_.external_height_m = plant_.body.weight.center_of_gravity_height_m;
}

const PlantOutput& SimulatedRobot::advance(const std::array<MotorCommand, kMostWheels>& command, const Wrench& external) {
  input_.command = command;
  input_.external = external;
  output_ = step(plant_, state_, input_);
  book(output_);
  for (int i = 0; i < wheel_count(); ++i) {
    const double speed_rad_per_s = output_.motor_speed_rad_per_s[i];
    copper_J_[i] += output_.copper_W[i] * kPeriod_s;
    speed_rad_[i] += std::abs(speed_rad_per_s) * kPeriod_s;
    speed_squared_rad2_per_s_[i] += speed_rad_per_s * speed_rad_per_s * kPeriod_s;
  }
  if (++periods_ == kPeriodsPerThermal) {
    warm_up();
  }
  return output_;
}

void SimulatedRobot::book(const PlantOutput& out) {
  account_.battery_loss_J += out.battery_loss_W * kPeriod_s;
  account_.copper_J += sum_W(out.copper_W) * kPeriod_s;
  account_.driver_J += sum_W(out.driver_W) * kPeriod_s;
  account_.motor_drag_J += sum_W(out.motor_drag_W) * kPeriod_s;
  account_.gear_J += sum_W(out.gear_W) * kPeriod_s;
  account_.rolling_J += sum_W(out.rolling_W) * kPeriod_s;
  account_.friction_J += sum_W(out.friction_W) * kPeriod_s;
  account_.slip_J += sum_W(out.slip_W) * kPeriod_s;
  account_.roller_J += sum_W(out.roller_W) * kPeriod_s;
  account_.external_J += out.external_W * kPeriod_s;
}

void SimulatedRobot::warm_up() {
  const double time_s = kPeriod_s * periods_;
  OperatingPoint<Lanes> at;
  for (int i = 0; i < wheel_count(); ++i) {
    // The plant's copper loss as the current that makes it, so that the network gets that heat.
    const double resistance_ohm =
        plant_.motor.resistance_25C_ohm * resistance_ratio(plant_.motor.resistance_rise_per_K, input_.winding_C[i]);
    at.current_rms_A[i] = std::sqrt(copper_J_[i] / resistance_ohm / time_s);
  }
  at.speed_mean_rad_per_s = speed_rad_ / time_s;
  at.speed_rms_rad_per_s = (speed_squared_rad2_per_s_ / time_s).sqrt();
  at.ambient_C = Lanes::Constant(ambient_C_);
  thermal_.over(time_s, at, longest_step_s_);
  for (int i = 0; i < wheel_count(); ++i) {
    input_.winding_C[i] = winding_C(i);
    input_.magnet_C[i] = stator_C(i);
  }
  copper_J_.setZero();
  speed_rad_.setZero();
  speed_squared_rad2_per_s_.setZero();
  periods_ = 0;
}

EnergyAccount SimulatedRobot::energy() const {
  EnergyAccount account = account_;
  account.battery_J =
      stored_energy_J(plant_.battery, plant_.battery.capacity_A_s) - stored_energy_J(plant_.battery, state_.battery_charge_A_s);
  account.kinetic_J = kinetic_energy_J(plant_.body, state_.velocity, state_.wheel_speed_rad_per_s);
  return account;
}

}  // namespace heatsoak
