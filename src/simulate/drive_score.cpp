#include "simulate/drive_score.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace heatsoak::simulate {

namespace {

constexpr double kStep_s = SimulatedRobot::kPeriod_s;
/// A plan that stays below this speed has no meaningful direction, so its command does not count as an arrival.
constexpr double kLeastSpeed_m_per_s = 0.05;

/// Returns √(x² + y²). std::hypot() takes several times as long, because it avoids overflow.
double length(double x, double y) { return std::sqrt(x * x + y * y); }

}  // namespace

void DriveScorer::take(const LoopMoment& moment) {
  robot_ = moment.robot;
  drive_ = moment.drive;
  follow_core(moment);
  const robot::PlantOutput& out = *moment.out;
  const robot::PlantState& state = moment.robot->state();
  const int wheels = moment.robot->wheel_count();
  const double creep_m_per_s = moment.robot->plant().body.traction.slip_speed_m_per_s;
  bool slides = false;
  for (int i = 0; i < wheels; ++i) {
    const double slip_m_per_s = std::abs(out.slip_m_per_s[i]);
    score_.slip_m += slip_m_per_s * kStep_s / wheels;
    if (slip_m_per_s > creep_m_per_s) {
      score_.sliding_m += (slip_m_per_s - creep_m_per_s) * kStep_s / wheels;
      slides = true;
    }
    score_.peak_current_A = std::max(score_.peak_current_A, std::abs(out.current_A[i]));
    current_squared_A2_s_[i] += out.current_A[i] * out.current_A[i] * kStep_s;
    duel_copper_J_ += moment.pushes ? out.copper_W[i] * kStep_s : 0.0;
  }
  score_.lowest_battery_V = score_.time_s == 0.0 ? out.battery_V : std::min(score_.lowest_battery_V, out.battery_V);
  score_.time_s += kStep_s;
  score_.sliding_s += slides ? kStep_s : 0.0;
  score_.short_s += out.limited || out.undervoltage ? kStep_s : 0.0;
  score_.lifted_s += out.lifted ? kStep_s : 0.0;
  score_.battery_empty_s += state.battery_charge_A_s <= 0.0 ? kStep_s : 0.0;
  if (state.battery_charge_A_s <= 0.0) {
    return;  // the robot is not driven, so its distance from the plan depends on neither planner nor motor
  }
  score_.distance_m += length(state.velocity.x_m_per_s, state.velocity.y_m_per_s) * kStep_s;
  const robot::Pose planned = moment.plan->pose();
  const double error_m = length(planned.x_m - state.pose.x_m, planned.y_m - state.pose.y_m);
  score_.tracking_most_m = std::max(score_.tracking_most_m, error_m);
  if (!moment.planned_at_rest) {
    error_squared_m2_s_ += error_m * error_m * kStep_s;
    planned_moving_s_ += kStep_s;
  }
  follow_command(moment);
}

void DriveScorer::follow_core(const LoopMoment& moment) {
  const robot_core::Output& out = moment.drive->output();
  bool is_fault = robot_core::is_fault(out.robot_reason);
  std::array<bool, kLimits.size()> is_met{};
  for (int i = 0; i < moment.robot->wheel_count(); ++i) {
    is_fault = is_fault || robot_core::is_fault(out.reason[i]);
    if (moment.drive->config().guard != nullptr) {
      score_.guard_winding_peak_C = std::max(score_.guard_winding_peak_C, std::optional(static_cast<double>(out.winding_C[i])));
    }
    for (std::size_t limit = 0; limit < kLimits.size(); ++limit) {
      is_met[limit] = is_met[limit] || out.reason[i] == kLimits[limit];
    }
  }
  score_.fault_s += is_fault ? kStep_s : 0.0;
  for (std::size_t limit = 0; limit < kLimits.size(); ++limit) {
    score_.limited_s[limit] += is_met[limit] ? kStep_s : 0.0;
  }
}

void DriveScorer::follow_command(const LoopMoment& moment) {
  if (moment.command != command_) {
    close_command();
    command_ = moment.command;
  }
  if (!moment.planned_at_rest) {
    const robot::BodyVelocity planned = moment.plan->velocity_global();
    const double speed_m_per_s = length(planned.x_m_per_s, planned.y_m_per_s);
    if (speed_m_per_s > kLeastSpeed_m_per_s) {
      way_x_share_ = planned.x_m_per_s / speed_m_per_s;
      way_y_share_ = planned.y_m_per_s / speed_m_per_s;
      came_from_afar_ = true;
    }
    return;
  }
  const robot::Pose& pose = moment.robot->state().pose;
  const robot::Pose target = moment.plan->pose();
  arrived_ = came_from_afar_;
  beyond_m_ = std::max(beyond_m_, (pose.x_m - target.x_m) * way_x_share_ + (pose.y_m - target.y_m) * way_y_share_);
}

void DriveScorer::close_command() {
  if (arrived_) {
    score_.arrivals_count += 1.0;
    score_.overshoot_mean_m += beyond_m_;
    score_.overshoot_most_m = std::max(score_.overshoot_most_m, beyond_m_);
  }
  arrived_ = false;
  came_from_afar_ = false;
  beyond_m_ = 0.0;
}

DriveScore DriveScorer::finish() {
  close_command();
  if (robot_ == nullptr) {
    return score_;
  }
  score_.tracking_rms_m = planned_moving_s_ > 0.0 ? std::sqrt(error_squared_m2_s_ / planned_moving_s_) : 0.0;
  score_.overshoot_mean_m /= std::max(1.0, score_.arrivals_count);
  score_.energy = robot_->energy();
  const robot_core::Config& core = drive_->config();
  score_.guard_limited_s =
      core.shadow_mode ? static_cast<double>(drive_->state().shadow_steps) * static_cast<double>(core.period_s) : score_.limited_s.back();
  score_.guard_missing_A_s = static_cast<double>(drive_->state().shadow_deficit_A_s);
  const auto sent = static_cast<double>(drive_->off_board().sent());
  score_.lost_packets_share = sent > 0.0 ? static_cast<double>(drive_->off_board().lost()) / sent : 0.0;
  score_.duel_copper_share = score_.energy.copper_J > 0.0 ? duel_copper_J_ / score_.energy.copper_J : 0.0;
  score_.current_rms_A = std::sqrt(*std::ranges::max_element(current_squared_A2_s_) / score_.time_s);
  for (int i = 0; i < robot_->wheel_count(); ++i) {
    if (robot_->winding_peak_C(i) > score_.winding_peak_C) {
      score_.winding_peak_C = robot_->winding_peak_C(i);
      score_.stator_peak_C = robot_->stator_peak_C(i);
      score_.hottest_wheel = i;
    }
  }
  return score_;
}

std::string_view to_string(DriveProblem problem) {
  constexpr std::array<std::string_view, 3> kNames{"battery empty", "tips", "off its plan"};
  return kNames.at(static_cast<std::size_t>(problem));
}

std::optional<DriveProblem> drive_problem(const DriveScore& score) {
  constexpr double kRobot_m = 0.18;
  constexpr double kMostLifted_share = 0.01;
  if (score.battery_empty_s > 0.0) {
    return DriveProblem::battery_empty;
  }
  if (score.lifted_s > kMostLifted_share * score.time_s) {
    return DriveProblem::tips;
  }
  return score.tracking_rms_m > kRobot_m ? std::optional(DriveProblem::off_plan) : std::nullopt;
}

}  // namespace heatsoak::simulate
