#include "simulate/simulated_robot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/copper.h"
#include "base/diagnostic.h"
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
  utmost.vehicle_speed_m_per_s = utmost.speed_mean_rad_per_s * (plant.body.kinematics.wheel_radius_m / plant.gear_ratio);
  return std::min(thermal::longest_step_s(network, parameters, rest), thermal::longest_step_s(network, parameters, utmost));
}

/// Returns the node at which the effects neighbour_coupling of the motor act; the stator without such an effect. Throws Failure (bad_input)
/// if they act at several nodes, because a motor has one temperature for its neighbours.
std::size_t node_beside_neighbours(const thermal::Network& network, const motor::Motor& motor) {
  std::optional<int> node;
  for (const thermal::EffectInPlace& each : network.effects()) {
    if (each.type->name != "neighbour_coupling") {
      continue;
    }
    if (node && *node != each.node_index.front()) {
      throw base::Failure(base::ExitCode::bad_input,
                          fmt::format("{}: effects.{} couples the {} with the neighbours, another effect the {}; expected one node for all "
                                      "effects neighbour_coupling in a closed loop",
                                      motor.id, each.name, network.node_name(each.node_index.front()), network.node_name(*node)));
    }
    node = each.node_index.front();
  }
  return static_cast<std::size_t>(node.value_or(motor::states::stator));
}

}  // namespace

struct SimulatedRobot::Heating {
  /// Load of the motors: sums over the periods since the network was last advanced.
  struct Load {
    robot::Wheels copper_W = robot::Wheels::Zero();
    robot::Wheels drag_W = robot::Wheels::Zero();
    robot::Wheels shaft_W = robot::Wheels::Zero();
    robot::Wheels speed_rad_per_s = robot::Wheels::Zero();
    robot::Wheels speed_squared_rad2_per_s2 = robot::Wheels::Zero();
    robot::Wheels velocity_rad_per_s = robot::Wheels::Zero();
    robot::Wheels change_rad_per_s = robot::Wheels::Zero();  ///< magnitude of the change of speed per period
    robot::Wheels modulation_ratio = robot::Wheels::Zero();
    double bus_V = 0.0;
    double vehicle_m_per_s = 0.0;
    int periods = 0;
  };

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
        longest_step_s(shortest_of_longest_steps_s(plant, network, parameters, ambient_C)),
        coupled_node(node_beside_neighbours(network, motor)) {
    static_assert(robot::kMostWheels <= base::kLanes);
    means.ambient_C = thermal::Lanes::Constant(ambient_C);
  }

  /// Temperature of each motor's neighbours: mean of the two wheels beside it, at the node that exchanges heat with them. Then the motors
  /// together neither gain nor lose heat by the exchange.
  void find_neighbours(int wheel_count) {
    const thermal::Lanes& node_C = thermal.state_C()[coupled_node];
    thermal::Lanes neighbour_C = means.neighbour_C;
    for (int i = 0; i < wheel_count; ++i) {
      neighbour_C[i] = 0.5 * (node_C[(i + 1) % wheel_count] + node_C[(i + wheel_count - 1) % wheel_count]);
    }
    thermal::set_quantity(means, kNeighbourRow, neighbour_C);
  }

  static constexpr std::size_t kNeighbourRow = thermal::quantity_row("neighbour_temperature");
  Sums sums;
  thermal::Network network;
  std::vector<thermal::Lanes> parameters;
  thermal::EnsembleRun thermal;  ///< one wheel per lane
  double longest_step_s;
  std::size_t coupled_node;                       ///< node that exchanges heat with the neighbours
  thermal::OperatingPoint<thermal::Lanes> means;  ///< means over the last kThermalPeriod_s
  Load load;
  robot::Wheels last_rad_per_s = robot::Wheels::Zero();
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
  if (++heating_->load.periods == kPeriodsPerThermal) {
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
  Heating::Load& load = heating_->load;
  load.copper_W += robot::as_wheels(output_.copper_W);
  load.drag_W += robot::as_wheels(output_.motor_drag_W);
  load.shaft_W += robot::as_wheels(output_.motor_torque_Nm) * speed_rad_per_s;
  load.speed_rad_per_s += speed_rad_per_s.abs();
  load.speed_squared_rad2_per_s2 += speed_rad_per_s.square();
  load.velocity_rad_per_s += speed_rad_per_s;
  load.change_rad_per_s += (speed_rad_per_s - heating_->last_rad_per_s).abs();
  heating_->last_rad_per_s = speed_rad_per_s;
  const auto is_driven = [&](int i) { return input_.command[i].kind == robot::MotorCommand::Kind::open ? 0.0 : 1.0; };
  const robot::Wheels bridge_V = robot::as_wheels(output_.terminal_V) + plant_.driver.resistance_ohm * robot::as_wheels(output_.current_A);
  load.modulation_ratio +=
      robot::Wheels(is_driven(0), is_driven(1), is_driven(2), is_driven(3)) * (bridge_V.abs() / std::max(output_.battery_V, 1.0)).min(1.0);
  load.bus_V += output_.battery_V;
  const robot::BodyVelocity& velocity = state_.velocity;
  load.vehicle_m_per_s += std::sqrt(velocity.x_m_per_s * velocity.x_m_per_s + velocity.y_m_per_s * velocity.y_m_per_s);
}

void SimulatedRobot::warm_up() {
  Heating& heat = *heating_;
  const Heating::Load& load = heat.load;
  thermal::OperatingPoint<thermal::Lanes>& means = heat.means;
  constexpr int kWheels = robot::kMostWheels;
  const double share = 1.0 / load.periods;
  // The current is calculated from the plant's copper loss, so that the network receives exactly this heat.
  const robot::Wheels resistance_ohm =
      plant_.motor.resistance_25C_ohm * base::resistance_ratio<robot::Wheels>(robot::Wheels::Constant(plant_.motor.resistance_rise_per_K),
                                                                              robot::as_wheels(input_.winding_C));
  means.current_rms_A.head<kWheels>() = (load.copper_W / load.periods / resistance_ohm).sqrt();
  means.speed_mean_rad_per_s.head<kWheels>() = load.speed_rad_per_s / load.periods;
  means.speed_rms_rad_per_s.head<kWheels>() = (load.speed_squared_rad2_per_s2 / load.periods).sqrt();
  means.shaft_power_W.head<kWheels>() = share * load.shaft_W;
  means.input_power_W.head<kWheels>() = share * (load.copper_W + load.drag_W + load.shaft_W);
  means.velocity_rad_per_s.head<kWheels>() = share * load.velocity_rad_per_s;
  means.acceleration_rad_per_s2.head<kWheels>() = (share / kPeriod_s) * load.change_rad_per_s;
  means.modulation_ratio.head<kWheels>() = share * load.modulation_ratio;
  means.bus_V = thermal::Lanes::Constant(share * load.bus_V);
  means.vehicle_speed_m_per_s = thermal::Lanes::Constant(share * load.vehicle_m_per_s);
  heat.find_neighbours(wheel_count());
  heat.thermal.over(kPeriod_s * load.periods, means, heat.longest_step_s);
  for (int i = 0; i < wheel_count(); ++i) {
    input_.winding_C[i] = winding_C(i);
    input_.magnet_C[i] = stator_C(i);
  }
  heat.load = {};
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
