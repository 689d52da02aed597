#include "simulate/simulated_robot.h"

#include <algorithm>
#include <cmath>

#include "base/copper.h"
#include "motor/datasheet_network.h"
#include "robot/wheels.h"
#include "thermal/ensemble.h"

namespace heatsoak::simulate {
namespace {

const int kPeriodsPerThermal = static_cast<int>(std::lround(SimulatedRobot::kThermalPeriod_s / SimulatedRobot::kPeriod_s));

std::vector<thermal::Lanes> same_in_all_lanes(const std::vector<double>& values) {
  std::vector<thermal::Lanes> lanes;
  for (const double value : values) {
    lanes.emplace_back(thermal::Lanes::Constant(value));
  }
  return lanes;
}

/// Returns the step that suits both rest and the highest current and speed. Cooling by speed and heating by current make a network fast.
double shortest_of_longest_steps_s(const robot::PlantConfig& plant, const thermal::Network& network,
                                   std::span<const thermal::Lanes> parameters, double ambient_C) {
  thermal::OperatingPoint<thermal::Lanes> rest;
  rest.ambient_C = thermal::Lanes::Constant(ambient_C);
  thermal::OperatingPoint<thermal::Lanes> utmost = rest;
  utmost.current_rms_A = thermal::Lanes::Constant(plant.battery.full_V / plant.motor.resistance_25C_ohm);
  utmost.speed_mean_rad_per_s = thermal::Lanes::Constant(plant.battery.full_V / plant.motor.torque_constant_25C_Nm_per_A);
  utmost.speed_rms_rad_per_s = utmost.speed_mean_rad_per_s;
  return std::min(thermal::longest_step_s(network, parameters, rest), thermal::longest_step_s(network, parameters, utmost));
}

}  // namespace

struct SimulatedRobot::Heating {
  /// Sums of the plant's powers over all periods. Multiplied by kPeriod_s they are energies.
  struct Sums {
    robot::Wheels copper_W = robot::Wheels::Zero();
    robot::Wheels driver_W = robot::Wheels::Zero();
    robot::Wheels motor_drag_W = robot::Wheels::Zero();
    robot::Wheels gear_W = robot::Wheels::Zero();
    robot::Wheels rolling_W = robot::Wheels::Zero();
    robot::Wheels friction_W = robot::Wheels::Zero();
    robot::Wheels slip_W = robot::Wheels::Zero();
    robot::Wheels roller_W = robot::Wheels::Zero();
    double battery_loss_W = 0.0;
    double external_W = 0.0;
  };

  Heating(const robot::PlantConfig& plant, const motor::Motor& motor, double ambient_C, double start_C)
      : network(motor::datasheet_network(motor, motor::nominal_sample(motor))),
        parameters(same_in_all_lanes(network.values())),
        thermal(network, parameters,
                std::vector<thermal::Lanes>(static_cast<std::size_t>(network.state_count()), thermal::Lanes::Constant(start_C))),
        longest_step_s(shortest_of_longest_steps_s(plant, network, parameters, ambient_C)) {
    static_assert(robot::kMostWheels <= base::kLanes);
    means.ambient_C = thermal::Lanes::Constant(ambient_C);
  }

  Sums sums;
  thermal::Network network;
  std::vector<thermal::Lanes> parameters;
  thermal::EnsembleRun thermal;  ///< one wheel per lane
  double longest_step_s;
  thermal::OperatingPoint<thermal::Lanes> means;  ///< means over the last kThermalPeriod_s
  // Sums over the periods since the network was last advanced.
  robot::Wheels copper_W = robot::Wheels::Zero();
  robot::Wheels speed_rad_per_s = robot::Wheels::Zero();
  robot::Wheels speed_squared_rad2_per_s2 = robot::Wheels::Zero();
  int periods = 0;
};

SimulatedRobot::SimulatedRobot(const robot::Robot& robot, const motor::Motor& motor, double ambient_C, std::optional<double> start_C)
    : plant_(robot::make_plant(robot, motor.nominal, kPeriod_s)),
      state_(robot::plant_at_rest(plant_)),
      ambient_C_(ambient_C),
      heating_(std::make_unique<Heating>(plant_, motor, ambient_C, start_C.value_or(ambient_C))) {
  input_.winding_C.fill(winding_C(0));
  input_.magnet_C.fill(stator_C(0));
  input_.external_height_m = plant_.body.weight.center_of_gravity_height_m;
}

SimulatedRobot::~SimulatedRobot() = default;

double SimulatedRobot::body_C(std::size_t state, int wheel) const { return heating_->thermal.state_C()[state][wheel]; }

double SimulatedRobot::peak_C(std::size_t state, int wheel) const { return heating_->thermal.peak_C()[state][wheel]; }

const robot::PlantOutput& SimulatedRobot::advance(const std::array<robot::MotorCommand, robot::kMostWheels>& command,
                                                  const robot::Wrench& external) {
  input_.command = command;
  input_.external = external;
  robot::step(plant_, state_, input_, output_);
  book();
  if (++heating_->periods == kPeriodsPerThermal) {
    warm_up();
  }
  return output_;
}

void SimulatedRobot::book() {
  Heating::Sums& sums = heating_->sums;
  sums.copper_W += robot::as_wheels(output_.copper_W);
  sums.driver_W += robot::as_wheels(output_.driver_W);
  sums.motor_drag_W += robot::as_wheels(output_.motor_drag_W);
  sums.gear_W += robot::as_wheels(output_.gear_W);
  sums.rolling_W += robot::as_wheels(output_.rolling_W);
  sums.friction_W += robot::as_wheels(output_.friction_W);
  sums.slip_W += robot::as_wheels(output_.slip_W);
  sums.roller_W += robot::as_wheels(output_.roller_W);
  sums.battery_loss_W += output_.battery_loss_W;
  sums.external_W += output_.external_W;
  const robot::Wheels speed_rad_per_s = robot::as_wheels(output_.motor_speed_rad_per_s);
  heating_->copper_W += robot::as_wheels(output_.copper_W);
  heating_->speed_rad_per_s += speed_rad_per_s.abs();
  heating_->speed_squared_rad2_per_s2 += speed_rad_per_s.square();
}

void SimulatedRobot::warm_up() {
  Heating& heat = *heating_;
  // The current is calculated from the plant's copper loss, so that the network receives exactly this heat.
  const robot::Wheels resistance_ohm =
      plant_.motor.resistance_25C_ohm * base::resistance_ratio<robot::Wheels>(robot::Wheels::Constant(plant_.motor.resistance_rise_per_K),
                                                                              robot::as_wheels(input_.winding_C));
  heat.means.current_rms_A.head<robot::kMostWheels>() = (heat.copper_W / heat.periods / resistance_ohm).sqrt();
  heat.means.speed_mean_rad_per_s.head<robot::kMostWheels>() = heat.speed_rad_per_s / heat.periods;
  heat.means.speed_rms_rad_per_s.head<robot::kMostWheels>() = (heat.speed_squared_rad2_per_s2 / heat.periods).sqrt();
  heat.thermal.over(kPeriod_s * heat.periods, heat.means, heat.longest_step_s);
  for (int i = 0; i < wheel_count(); ++i) {
    input_.winding_C[i] = winding_C(i);
    input_.magnet_C[i] = stator_C(i);
  }
  heat.copper_W.setZero();
  heat.speed_rad_per_s.setZero();
  heat.speed_squared_rad2_per_s2.setZero();
  heat.periods = 0;
}

EnergyAccount SimulatedRobot::energy() const {
  EnergyAccount account;
  const Heating::Sums& sums = heating_->sums;
  account.battery_loss_J = sums.battery_loss_W * kPeriod_s;
  account.copper_J = sums.copper_W.sum() * kPeriod_s;
  account.driver_J = sums.driver_W.sum() * kPeriod_s;
  account.motor_drag_J = sums.motor_drag_W.sum() * kPeriod_s;
  account.gear_J = sums.gear_W.sum() * kPeriod_s;
  account.rolling_J = sums.rolling_W.sum() * kPeriod_s;
  account.friction_J = sums.friction_W.sum() * kPeriod_s;
  account.slip_J = sums.slip_W.sum() * kPeriod_s;
  account.roller_J = sums.roller_W.sum() * kPeriod_s;
  account.external_J = sums.external_W * kPeriod_s;
  account.battery_J = robot::stored_energy_J(plant_.battery, plant_.battery.capacity_A_s) -
                      robot::stored_energy_J(plant_.battery, state_.battery_charge_A_s);
  account.kinetic_J = robot::kinetic_energy_J(plant_.body, state_.velocity, state_.wheel_speed_rad_per_s);
  return account;
}

}  // namespace heatsoak::simulate
