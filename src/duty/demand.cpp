#include "duty/demand.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace heatsoak::duty {
namespace {

double direction_of(double speed_rad_per_s) {
  return std::abs(speed_rad_per_s) < kStandstill_rad_per_s ? 0.0 : std::copysign(1.0, speed_rad_per_s);
}

/// Returns the value in steps, rounded up. It avoids std::ceil, which is a function call on processors without SSE4.1.
int cell_of(double value, double step) {
  const double steps = value / step;
  const int whole = static_cast<int>(steps);
  return whole + (steps > whole ? 1 : 0);
}

}  // namespace

double WheelDemand::duration_s() const {
  return std::accumulate(bins.begin(), bins.end(), 0.0, [](double sum_s, const LoadBin& bin) { return sum_s + bin.duration_s; });
}

WheelDemand hardest(std::vector<WheelDemand> wheels) {
  const auto effort_Nm2_s = [](const WheelDemand& wheel) {
    return std::accumulate(wheel.bins.begin(), wheel.bins.end(), 0.0, [](double sum_Nm2_s, const LoadBin& bin) {
      return sum_Nm2_s + bin.torque_rms_Nm * bin.torque_rms_Nm * bin.duration_s;
    });
  };
  return std::move(*std::ranges::max_element(wheels, {}, effort_Nm2_s));
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
          .current_along_motion_A = current_A * direction,
          .current_mean_A = current_A,
          .power_mean_W = torque_Nm * speed_rad_per_s};
}

void LoadMeans::add(double duration_s, double torque_Nm, double speed_rad_per_s, double current_A) {
  const double direction = direction_of(speed_rad_per_s);
  const std::array<double, current> now{1.0,
                                        torque_Nm,
                                        torque_Nm * torque_Nm,
                                        torque_Nm * direction,
                                        std::abs(direction),
                                        speed_rad_per_s,
                                        std::abs(speed_rad_per_s),
                                        speed_rad_per_s * speed_rad_per_s,
                                        torque_Nm * speed_rad_per_s};
  for (std::size_t i = 0; i < now.size(); ++i) {
    integrals_[i] += duration_s * now[i];
  }
  if (current_A != 0.0) {
    integrals_[current] += duration_s * current_A;
    integrals_[current_squared] += duration_s * (current_A * current_A);
    integrals_[current_along_motion] += duration_s * (current_A * direction);
  }
  travelled_rad_per_s_ += std::abs(speed_rad_per_s - last_speed_rad_per_s_.value_or(speed_rad_per_s));
  last_speed_rad_per_s_ = speed_rad_per_s;
}

LoadBin LoadMeans::close() {
  const double time_s = integrals_[time];
  const auto mean = [&](Integral which) { return integrals_[which] / time_s; };
  const LoadBin bin{.duration_s = time_s,
                    .torque_rms_Nm = std::sqrt(mean(torque_squared)),
                    .torque_along_motion_Nm = mean(torque_along_motion),
                    .moving_share = mean(moving),
                    .speed_mean_rad_per_s = mean(speed),
                    .speed_rms_rad_per_s = std::sqrt(mean(speed_squared)),
                    .torque_mean_Nm = mean(torque),
                    .velocity_mean_rad_per_s = mean(velocity),
                    .current_rms_A = std::sqrt(mean(current_squared)),
                    .current_along_motion_A = mean(current_along_motion),
                    .current_mean_A = mean(current),
                    .power_mean_W = mean(power),
                    .acceleration_rad_per_s2 = travelled_rad_per_s_ / time_s};
  integrals_ = {};
  travelled_rad_per_s_ = 0.0;
  return bin;
}

std::size_t DemandGatherer::CellHash::operator()(const Cell& cell) const {
  constexpr std::size_t kSpread = 0x9e3779b97f4a7c15U;
  std::size_t hash = 0;
  for (const int step : cell) {
    hash = hash * kSpread + static_cast<std::size_t>(step);
  }
  return hash;
}

DemandGatherer::DemandGatherer(std::string wheel, double bin_s, Grid grid)
    : bin_s_(bin_s), step_{grid.torque_step_Nm, grid.speed_step_rad_per_s, grid.current_step_A} {
  demand_.wheel = std::move(wheel);
}

void DemandGatherer::add(double duration_s, double torque_Nm, double speed_rad_per_s, double current_A) {
  means_.add(duration_s, torque_Nm, speed_rad_per_s, current_A);
  const std::array<double, axis_count> size{std::abs(torque_Nm), std::abs(speed_rad_per_s), std::abs(current_A)};
  for (const Axis axis : {torque, speed, current}) {
    while (size[axis] > kMostSteps * step_[axis]) {
      coarsen(axis);
    }
  }
  // Values are rounded away from zero, so that the load of a cell is at least that of each moment in it.
  Cell cell{cell_of(size[torque], step_[torque]), cell_of(size[speed], step_[speed]),
            current_A == 0.0 ? 0 : cell_of(size[current], step_[current])};
  const double direction = direction_of(speed_rad_per_s);
  cell[torque] *= torque_Nm * direction < 0.0 ? -1 : 1;
  cell[current] *= current_A * direction < 0.0 ? -1 : 1;
  if (cell != cell_) {
    close_stay();
    cell_ = cell;
    if (time_at_s_.size() > kMostCells) {
      coarsen_the_finest();
    }
  }
  stay_s_ += duration_s;
  if (means_.time_s() >= bin_s_ * (1.0 - 1e-9)) {
    close_bin();
  }
}

void DemandGatherer::add_alone(double duration_s, double torque_Nm, double speed_rad_per_s, double current_A) {
  close_bin();
  means_.cut();
  demand_.bins.push_back(constant_bin(duration_s, torque_Nm, speed_rad_per_s, current_A));
  const double direction = speed_rad_per_s < 0.0 ? -1.0 : 1.0;
  demand_.points.push_back({direction * torque_Nm, std::abs(speed_rad_per_s), direction * current_A, duration_s});
}

void DemandGatherer::close_stay() {
  if (stay_s_ > 0.0) {
    time_at_s_[cell_] += std::exchange(stay_s_, 0.0);
  }
}

/// Merges two cells into one, rounded to its edge with the larger load.
void DemandGatherer::coarsen(Axis axis) {
  const auto halved = [axis](Cell cell) {
    cell[axis] = (cell[axis] + (cell[axis] > 0 ? 1 : -1)) / 2;
    return cell;
  };
  step_[axis] *= 2.0;
  cell_ = halved(cell_);
  // The cells are sorted, so that the sums do not depend on the order in the hash table.
  const std::map<Cell, double> fine(time_at_s_.begin(), time_at_s_.end());
  time_at_s_.clear();
  for (const auto& [cell, time_s] : fine) {
    time_at_s_[halved(cell)] += time_s;
  }
}

void DemandGatherer::coarsen_the_finest() {
  Cell most{};
  for (const auto& [cell, time_s] : time_at_s_) {
    for (const Axis axis : {torque, speed, current}) {
      most[axis] = std::max(most[axis], std::abs(cell[axis]));
    }
  }
  coarsen(static_cast<Axis>(std::ranges::max_element(most) - most.begin()));
}

void DemandGatherer::close_bin() {
  if (means_.time_s() > 0.0) {
    demand_.bins.push_back(means_.close());
  }
}

WheelDemand DemandGatherer::finish() {
  close_bin();
  close_stay();
  // The cells are sorted, so that equal loads give equal points.
  for (const auto& [cell, time_s] : std::map<Cell, double>(time_at_s_.begin(), time_at_s_.end())) {
    demand_.points.push_back({cell[torque] * step_[torque], cell[speed] * step_[speed], cell[current] * step_[current], time_s});
  }
  return std::move(demand_);
}

}  // namespace heatsoak::duty
