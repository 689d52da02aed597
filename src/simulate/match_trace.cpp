#include "simulate/match_trace.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "motor/datasheet_network.h"

namespace heatsoak::simulate {

MatchAdditions additions_of(const motor::Motor& motor) {
  MatchAdditions added{motor::faults_of(motor, "winding_C"), motor::faults_of(motor, "stator_C"), {}};
  const thermal::Network network = motor::datasheet_network(motor, motor::nominal_sample(motor));
  for (int body = motor::states::first_own; body < network.state_count(); ++body) {
    added.bodies.emplace_back(network.node_name(body));
  }
  return added;
}

MatchRows::MatchRows(double every_s, double ambient_C, const MatchAdditions& added, std::function<void(const MatchRow&)> row)
    : every_s_(every_s), row_(std::move(row)) {
  winding_.fill(motor::Reading(added.winding, ambient_C));
  stator_.fill(motor::Reading(added.stator, ambient_C));
  open_.winding_C.fill(ambient_C);
  open_.winding_peak_C.fill(ambient_C);
  open_.stator_C.fill(ambient_C);
  robot::PerWheel cold_C{};
  cold_C.fill(ambient_C);
  open_.bodies_C.assign(added.bodies.size(), cold_C);
  open_.winding_sensor_C.fill(winding_.front().sensor_C());
  open_.stator_sensor_C.fill(stator_.front().sensor_C());
}

void MatchRows::start(double time_s, const SimulatedRobot& robot, const robot::Pose& plan, duty::Phase phase, bool duel) {
  std::vector<robot::PerWheel> bodies_C = std::move(open_.bodies_C);
  open_ = {};
  open_.bodies_C = std::move(bodies_C);
  open_.time_s = time_s;
  open_.phase = phase;
  open_.duel = duel;
  open_.plan = plan;
  open_.pose = robot.state().pose;
  open_.velocity = robot.velocity_global();
  open_.battery_charge_A_s = robot.state().battery_charge_A_s;
  open_.tracking_error_m = std::hypot(plan.x_m - open_.pose.x_m, plan.y_m - open_.pose.y_m);
  for (int i = 0; i < robot.wheel_count(); ++i) {
    open_.winding_C[i] = robot.winding_C(i);
    open_.winding_peak_C[i] = open_.winding_C[i];
    open_.stator_C[i] = robot.stator_C(i);
    for (std::size_t body = 0; body < open_.bodies_C.size(); ++body) {
      open_.bodies_C[body][static_cast<std::size_t>(i)] = robot.body_C(motor::states::first_own + body, i);
    }
    open_.winding_sensor_C[i] = winding_.at(static_cast<std::size_t>(i)).sensor_C();
    open_.stator_sensor_C[i] = stator_.at(static_cast<std::size_t>(i)).sensor_C();
  }
  current_squared_A2_ = {};
  periods_ = 0;
}

void MatchRows::take_core(const LoopMoment& moment) {
  const robot_core::Output& out = moment.drive->output();
  open_.robot_reason = std::max(open_.robot_reason, out.robot_reason);
  for (int i = 0; i < moment.robot->wheel_count(); ++i) {
    const auto allowed_A = static_cast<double>(out.allowed_current_A[i]);
    open_.reason[static_cast<std::size_t>(i)] = std::max(open_.reason[static_cast<std::size_t>(i)], out.reason[i]);
    open_.allowed_A[i] = periods_ == 0 ? allowed_A : std::min(open_.allowed_A[i], allowed_A);
    if (moment.drive->config().guard != nullptr) {
      robot::PerWheel& highest_C = open_.guard_winding_C ? *open_.guard_winding_C : open_.guard_winding_C.emplace();
      highest_C[i] = std::max(highest_C[i], static_cast<double>(out.winding_C[i]));
    }
  }
}

void MatchRows::take(const LoopMoment& moment) {
  const robot::PlantOutput& out = *moment.out;
  if (!begun_) {
    begun_ = true;
    open_.phase = moment.command->phase;
    open_.battery_charge_A_s = moment.robot->plant().battery.capacity_A_s;
  }
  for (std::size_t i = 0; i < robot::kMostWheels; ++i) {
    open_.current_A[i] += out.current_A[i];
    current_squared_A2_[i] += out.current_A[i] * out.current_A[i];
    open_.motor_V[i] += out.terminal_V[i];
    open_.speed_rad_per_s[i] += out.motor_speed_rad_per_s[i];
    open_.torque_Nm[i] += out.motor_torque_Nm[i];
    open_.slip_m_per_s[i] += out.slip_m_per_s[i];
    open_.normal_N[i] += out.normal_force_N[i];
    open_.copper_W[i] += out.copper_W[i];
  }
  for (int i = 0; i < moment.robot->wheel_count(); ++i) {
    open_.winding_peak_C[i] = std::max(open_.winding_peak_C[i], moment.robot->winding_C(i));
    winding_.at(static_cast<std::size_t>(i)).advance(SimulatedRobot::kPeriod_s, moment.robot->winding_C(i));
    stator_.at(static_cast<std::size_t>(i)).advance(SimulatedRobot::kPeriod_s, moment.robot->stator_C(i));
  }
  take_core(moment);
  open_.battery_V += out.battery_V;
  open_.battery_A += out.battery_current_A;
  ++periods_;
  // Rows end at whole plant periods; half a period covers rounding errors.
  if (moment.time_s - open_.time_s > every_s_ - 0.5 * SimulatedRobot::kPeriod_s) {
    finish();
    start(moment.time_s, *moment.robot, moment.plan->pose(), moment.command->phase, moment.pushes);
  }
}

void MatchRows::finish() {
  if (periods_ == 0) {
    return;
  }
  const double count = periods_;
  for (robot::PerWheel MatchRow::*const mean : {&MatchRow::motor_V, &MatchRow::speed_rad_per_s, &MatchRow::torque_Nm,
                                                &MatchRow::slip_m_per_s, &MatchRow::normal_N, &MatchRow::copper_W}) {
    for (double& each : open_.*mean) {
      each /= count;
    }
  }
  for (std::size_t i = 0; i < robot::kMostWheels; ++i) {
    open_.current_A[i] = std::copysign(std::sqrt(current_squared_A2_[i] / count), open_.current_A[i]);
  }
  open_.battery_V /= count;
  open_.battery_A /= count;
  row_(open_);
  periods_ = 0;
}

std::string csv_header(int wheel_count, const MatchAdditions& added) {
  std::string text =
      "time_s,phase,duel,plan_x_m,plan_y_m,plan_yaw_rad,x_m,y_m,yaw_rad,velocity_x_m_per_s,velocity_y_m_per_s,yaw_rate_rad_per_s,"
      "battery_V,battery_A,battery_charge_A_s,ambient_C";
  for (int i = 1; i <= wheel_count; ++i) {
    fmt::format_to(std::back_inserter(text),
                   ",winding_{0}_C,stator_{0}_C,current_{0}_A,motor_{0}_V,speed_{0}_rad_per_s,torque_{0}_Nm,slip_{0}_m_per_s,normal_{0}_N,"
                   "copper_{0}_W",
                   i);
    for (const std::string& body : added.bodies) {
      text += fmt::format(",{}_{}_C", body, i);
    }
    text += added.winding.empty() ? "" : fmt::format(",winding_shown_{}_C", i);
    text += added.stator.empty() ? "" : fmt::format(",stator_shown_{}_C", i);
  }
  text += ",robot_reason";
  for (int i = 1; i <= wheel_count; ++i) {
    text += fmt::format(",reason_{0},allowed_{0}_A,guard_winding_{0}_C", i);
  }
  return text + "\n";
}

void append_csv(std::string& text, const MatchRow& row, int wheel_count, double ambient_C, const MatchAdditions& added) {
  const auto to = std::back_inserter(text);
  fmt::format_to(to, "{:.10g},{},{:d},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.2f},{:.2f}",
                 row.time_s, duty::kPhaseNames.at(static_cast<std::size_t>(row.phase)), row.duel, row.plan.x_m, row.plan.y_m,
                 row.plan.yaw_rad, row.pose.x_m, row.pose.y_m, row.pose.yaw_rad, row.velocity.x_m_per_s, row.velocity.y_m_per_s,
                 row.velocity.yaw_rad_per_s, row.battery_V, row.battery_A, row.battery_charge_A_s, ambient_C);
  for (int i = 0; i < wheel_count; ++i) {
    fmt::format_to(to, ",{:.4f},{:.4f},{:.5g},{:.5g},{:.5g},{:.5g},{:.5g},{:.5g},{:.5g}", row.winding_C[i], row.stator_C[i],
                   row.current_A[i], row.motor_V[i], row.speed_rad_per_s[i], row.torque_Nm[i], row.slip_m_per_s[i], row.normal_N[i],
                   row.copper_W[i]);
    for (const robot::PerWheel& body_C : row.bodies_C) {
      fmt::format_to(to, ",{:.4f}", body_C[static_cast<std::size_t>(i)]);
    }
    if (!added.winding.empty()) {
      fmt::format_to(to, ",{:.4f}", row.winding_sensor_C[i]);
    }
    if (!added.stator.empty()) {
      fmt::format_to(to, ",{:.4f}", row.stator_sensor_C[i]);
    }
  }
  fmt::format_to(to, ",{}", static_cast<int>(row.robot_reason));
  for (int i = 0; i < wheel_count; ++i) {
    fmt::format_to(to, ",{},{:.4f},{}", static_cast<int>(row.reason[static_cast<std::size_t>(i)]), row.allowed_A[i],
                   row.guard_winding_C ? fmt::format("{:.3f}", (*row.guard_winding_C)[i]) : "");
  }
  text += "\n";
}

}  // namespace heatsoak::simulate
