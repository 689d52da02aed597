#include "select/trace.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "motor/datasheet_network.h"

namespace heatsoak::select {
namespace {

using motor::states::stator;
using motor::states::winding;

/// Returns the same demand in bins no longer than `every_s`.
duty::WheelDemand subdivided(const duty::WheelDemand& demand, double every_s) {
  duty::WheelDemand fine{.wheel = demand.wheel, .bins = {}, .points = {}};
  for (const duty::LoadBin& bin : demand.bins) {
    const double parts = std::max(1.0, std::ceil(bin.duration_s / every_s - 1e-9));
    duty::LoadBin part = bin;
    part.duration_s = bin.duration_s / parts;
    fine.bins.insert(fine.bins.end(), static_cast<std::size_t>(parts), part);
  }
  return fine;
}

/// Returns speed, current and torque of a bin for a heating current. Signs are those of the bin's means.
robot::DrivePoint point_of(const motor::MotorValues& motor, const robot::Robot& robot, const duty::LoadBin& bin, double heating_A) {
  robot::DrivePoint point;
  point.motor_speed_rad_per_s = bin.velocity_mean_rad_per_s * robot.drive.gear_ratio;
  const double direction = bin.torque_mean_Nm != 0.0   ? bin.torque_mean_Nm
                           : bin.current_mean_A != 0.0 ? bin.current_mean_A
                                                       : bin.velocity_mean_rad_per_s;
  point.current_A = std::copysign(heating_A / robot::heating_factor(robot), direction);
  const double drag_Nm =
      bin.velocity_mean_rad_per_s == 0.0 ? 0.0 : std::copysign(motor::drag_torque_Nm(motor), bin.velocity_mean_rad_per_s);
  point.motor_torque_Nm = motor.torque_constant_Nm_per_A * point.current_A - drag_Nm;
  return point;
}

/// Simulates the readings of sensors with stated faults during a run.
class FaultySensors {
 public:
  FaultySensors(const motor::Motor& motor, double start_C) {
    for (const auto& [node, name] : {std::pair(winding, "winding"), std::pair(stator, "stator")}) {
      if (std::vector<motor::SensorFault> faults = motor::faults_of(motor, fmt::format("{}_C", name)); !faults.empty()) {
        names.emplace_back(name);
        nodes_.push_back(static_cast<std::size_t>(node));
        readings_.emplace_back(std::move(faults), start_C);
      }
    }
  }

  void advance(const thermal::TransientMoment& moment) {
    for (std::size_t i = 0; i < readings_.size(); ++i) {
      readings_[i].advance(moment.time_s - time_s_, moment.state_C[nodes_[i]]);
    }
    time_s_ = moment.time_s;
  }

  [[nodiscard]] std::vector<double> sensor_C() const {
    std::vector<double> all_C;
    std::ranges::transform(readings_, std::back_inserter(all_C), &motor::Reading::sensor_C);
    return all_C;
  }

  std::vector<std::string> names;

 private:
  std::vector<std::size_t> nodes_;
  std::vector<motor::Reading> readings_;
  double time_s_ = 0.0;
};

std::vector<BookedHeat> balance(const thermal::Network& network, const thermal::TransientResult& result) {
  std::vector<BookedHeat> booked;
  const auto nodes = static_cast<std::size_t>(network.node_count());
  for (std::size_t e = 0; e < network.effects().size(); ++e) {
    // An effect may act on one node in several roles.
    const std::set<int> of_effect(network.effects()[e].node_index.begin(), network.effects()[e].node_index.end());
    for (const int node : of_effect) {
      booked.push_back({network.effects()[e].name, std::string(network.node_name(node)),
                        result.heat_J[e * nodes + static_cast<std::size_t>(node)] / result.end_s});
    }
  }
  return booked;
}

}  // namespace

Trace run_trace(const robot::Robot& robot, const duty::Duty& duty, const duty::WheelDemand& wheel, const motor::Motor& motor,
                double every_s) {
  const motor::MotorSample sample = motor::nominal_sample(motor);
  const DutySample demand = nominal_sample(duty);
  const thermal::Network network = motor::datasheet_network(motor, sample);
  const std::vector<double> parameters = network.values();
  const duty::WheelDemand fine = subdivided(wheel, every_s);
  const std::vector<thermal::Interval> all = intervals(sample.values, robot, duty.kind, fine, demand);
  thermal::TransientOptions options;
  options.with_ledger = true;
  const double end_s = wheel.duration_s() * (1.0 - 1e-12);
  Trace trace;
  for (int node = motor::states::first_own; node < network.state_count(); ++node) {
    trace.own_nodes.emplace_back(network.node_name(node));
  }
  FaultySensors sensors(motor, demand.ambient_C);
  trace.shown_at = sensors.names;
  const auto add_row = [&](const thermal::TransientMoment& moment) {
    sensors.advance(moment);
    if (!moment.begins_interval && moment.time_s < end_s) {
      return;
    }
    const double flows_A = network.flowing_A(all[moment.interval].at, parameters.data(), moment.state_C.data());
    const robot::DrivePoint point = point_of(sample.values, robot, fine.bins[moment.interval], flows_A);
    TraceRow row{.time_s = moment.time_s,
                 .winding_C = moment.state_C[winding],
                 .stator_C = moment.state_C[stator],
                 .ambient_C = demand.ambient_C,
                 .current_A = point.current_A,
                 .speed_rad_per_s = point.motor_speed_rad_per_s,
                 .torque_Nm = point.motor_torque_Nm,
                 .motor_V = robot::terminal_voltage_V(sample.values, point, moment.state_C[winding])};
    row.power_in_W = row.motor_V * row.current_A;
    row.sensor_C = sensors.sensor_C();
    row.own_C.assign(moment.state_C.begin() + motor::states::first_own, moment.state_C.end());
    trace.rows.push_back(row);
  };
  const thermal::TransientResult result = thermal::run_transient(network, parameters, all, options, add_row);
  trace.balance = balance(network, result);
  for (int node = 0; node < network.state_count(); ++node) {
    const double capacity_J_per_K = parameters[static_cast<std::size_t>(network.capacity_index(node))];
    trace.stored_W += capacity_J_per_K * (result.end_C[static_cast<std::size_t>(node)] - demand.ambient_C) / result.end_s;
  }
  return trace;
}

std::string to_csv(const Trace& trace) {
  std::string text = "time_s,winding_C,stator_C,ambient_C,";
  const auto out = std::back_inserter(text);
  for (const std::string& node : trace.own_nodes) {
    fmt::format_to(out, "{}_C,", node);
  }
  for (const std::string& node : trace.shown_at) {
    fmt::format_to(out, "{}_shown_C,", node);
  }
  text += "current_A,speed_rad_per_s,torque_Nm,motor_V,power_in_W\n";
  for (const TraceRow& row : trace.rows) {
    fmt::format_to(out, "{:.10g},{:.4f},{:.4f},{:.2f},", row.time_s, row.winding_C, row.stator_C, row.ambient_C);
    for (const std::vector<double>* const more_C : {&row.own_C, &row.sensor_C}) {
      for (const double each_C : *more_C) {
        fmt::format_to(out, "{:.4f},", each_C);
      }
    }
    fmt::format_to(out, "{:.6g},{:.6g},{:.6g},{:.5g},{:.6g}\n", row.current_A, row.speed_rad_per_s, row.torque_Nm, row.motor_V,
                   row.power_in_W);
  }
  return text;
}

}  // namespace heatsoak::select
