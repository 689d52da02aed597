#include "duty/demand.h"

#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace heatsoak {
namespace {

double direction_of(double speed_rad_per_s) {
  return std::abs(speed_rad_per_s) < kStandstill_rad_per_s ? 0.0 : std::copysign(1.0, speed_rad_per_s);
}

/// The number of steps that hold the value; std::ceil is a function call on the plainest processors.
int cell_of(double value, double step) {
  const double steps = value / step;
  const int whole = static_cast<int>(steps);
  return whole + (steps > whole ? 1 : 0);
}

}  // namespace

double WheelDemand::duration_s() const {
  return std::accumulate(bins.begin(), bins.end(), 0.0, [](double sum_s, const LoadBin& bin) { return sum_s + bin.duration_s; });
}

LoadBin constant_bin(double duration_s, double torque_Nm, double speed_rad_per_s, double current_A) {
  const double direction = direction_of(speed_rad_per_s);
  return {.duration_s = duration_s,
          .torque_rms_Nm = std::abs(torque_Nm),
          .torque_along_motion_Nm = torque_Nm * direction,
          .moving_share = std::abs(direction),
          .speed_mean_rad_per_s = std::abs(speed_rad_per_s),
          .speed_rms_rad_per_s = std::abs(speed_rad_per_s),
          .torque_mean_Nm = torque_Nm,
          .velocity_mean_rad_per_s = speed_rad_per_s,
          .current_rms_A = std::abs(current_A),
          .power_mean_W = torque_Nm * speed_rad_per_s};
}

DemandGatherer::DemandGatherer(std::string wheel, double bin_s, Grid grid) : bin_s_(bin_s), grid_(grid) {
  demand_.wheel = std::move(wheel);
}

void DemandGatherer::add(double duration_s, double torque_Nm, double speed_rad_per_s) {
  const double direction = direction_of(speed_rad_per_s);
  const double magnitude_rad_per_s = std::abs(speed_rad_per_s);
  const std::array<double, integral_count> now{1.0,
                                               torque_Nm,
                                               torque_Nm * torque_Nm,
                                               torque_Nm * direction,
                                               std::abs(direction),
                                               speed_rad_per_s,
                                               magnitude_rad_per_s,
                                               speed_rad_per_s * speed_rad_per_s,
                                               torque_Nm * speed_rad_per_s};
  for (std::size_t i = 0; i < now.size(); ++i) {
    integrals_[i] += duration_s * now[i];
  }
  travelled_rad_per_s_ += std::abs(speed_rad_per_s - last_speed_rad_per_s_.value_or(speed_rad_per_s));
  last_speed_rad_per_s_ = speed_rad_per_s;
  const double torque_with_motion_Nm = direction < 0.0 ? -torque_Nm : direction > 0.0 ? torque_Nm : std::abs(torque_Nm);
  // Away from zero, so that a cell asks at least as much as anything in it.
  const int torque_size = cell_of(std::abs(torque_with_motion_Nm), grid_.torque_step_Nm);
  const int torque_cell = torque_with_motion_Nm < 0.0 ? -torque_size : torque_size;
  const int speed_cell = cell_of(magnitude_rad_per_s, grid_.speed_step_rad_per_s);
  if (const std::pair cell{torque_cell, speed_cell}; cell != cell_) {
    close_stay();
    cell_ = cell;
  }
  stay_s_ += duration_s;
  if (integrals_[time] >= bin_s_ * (1.0 - 1e-9)) {
    close_bin();
  }
}

void DemandGatherer::close_stay() {
  if (stay_s_ > 0.0) {
    time_at_s_[cell_] += std::exchange(stay_s_, 0.0);
  }
}

void DemandGatherer::close_bin() {
  const double time_s = integrals_[time];
  const auto mean = [&](Integral which) { return integrals_[which] / time_s; };
  demand_.bins.push_back({.duration_s = time_s,
                          .torque_rms_Nm = std::sqrt(mean(torque_squared)),
                          .torque_along_motion_Nm = mean(torque_along_motion),
                          .moving_share = mean(moving),
                          .speed_mean_rad_per_s = mean(speed),
                          .speed_rms_rad_per_s = std::sqrt(mean(speed_squared)),
                          .torque_mean_Nm = mean(torque),
                          .velocity_mean_rad_per_s = mean(velocity),
                          .power_mean_W = mean(power),
                          .acceleration_rad_per_s2 = travelled_rad_per_s_ / time_s});
  integrals_ = {};
  travelled_rad_per_s_ = 0.0;
}

WheelDemand DemandGatherer::finish() {
  if (integrals_[time] > 0.0) {
    close_bin();
  }
  close_stay();
  // In order, so that the same load gives the same points.
  for (const auto& [cell, time_s] : std::map<std::pair<int, int>, double>(time_at_s_.begin(), time_at_s_.end())) {
    demand_.points.push_back({cell.first * grid_.torque_step_Nm, cell.second * grid_.speed_step_rad_per_s, 0.0, time_s});
  }
  return std::move(demand_);
}

}  // namespace heatsoak
