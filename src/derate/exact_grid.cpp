#include "derate/exact_grid.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace heatsoak::derate {
namespace {

/// The winding's axis ends this far above the limit, because the barrier allows current to a winding that cools fast enough.
constexpr double kAboveLimit_K = 3.0;

/// True if the exact current changes with the speed at any of nine pairs of temperatures.
bool depends_on_speed(Barrier& barrier, const BarrierRules& rules) {
  constexpr double kSame_ratio = 1e-6;
  const double span_K = rules.limits.winding_C - rules.hottest_ambient_C;
  for (const double stator_share : {0.1, 0.45, 0.95}) {
    for (const double winding_share : {0.15, 0.6, 0.99}) {
      const double stator_C = rules.hottest_ambient_C + stator_share * span_K;
      const double winding_C = rules.hottest_ambient_C + winding_share * span_K;
      const double standing_A2 = barrier.square_A2(0.0, stator_C, winding_C);
      for (const double speed_share : {0.13, 0.37, 0.5, 0.81, 1.0}) {
        const double square_A2 = barrier.square_A2(speed_share * rules.most_speed_rad_per_s, stator_C, winding_C);
        if (std::abs(square_A2 - standing_A2) > kSame_ratio * std::abs(standing_A2)) {
          return true;
        }
      }
    }
  }
  return false;
}

/// Returns points from `low` to `high` in about `steps` equal steps; inner points are rounded to multiples of 0.5.
std::vector<double> rounded_steps(double low, double high, int steps) {
  std::vector<double> points = evenly(low, high, steps + 1);
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    points[i] = 0.5 * std::round(2.0 * points[i]);
  }
  points.erase(std::unique(points.begin(), points.end()), points.end());
  std::erase_if(points, [&](double point) { return point < low || point > high; });
  return points;
}

void add_near_end(std::vector<double>& points, std::initializer_list<double> below_K) {
  const double end = points.back();
  for (const double each_K : below_K) {
    if (end - each_K > points.front()) {
      points.push_back(end - each_K);
    }
  }
  std::ranges::sort(points);
  points.erase(std::unique(points.begin(), points.end()), points.end());
}

}  // namespace

ExactGrid exact_grid(const CurrentTable& table, Barrier& barrier, const BarrierRules& rules) {
  constexpr int kSpeedSteps = 10;
  constexpr int kStatorSteps = 16;
  constexpr int kWindingSteps = 40;
  const double limit_C = rules.limits.winding_C;
  const double coldest_C = std::min(rules.hottest_ambient_C, limit_C - 1.0);
  ExactGrid grid;
  grid.points[speed] = depends_on_speed(barrier, rules) ? rounded_steps(0.0, rules.most_speed_rad_per_s, kSpeedSteps) : std::vector{0.0};
  const double last_stator_C = std::min(limit_C, rules.limits.stator_C.value_or(limit_C));
  grid.points[stator] = rounded_steps(std::min(coldest_C, last_stator_C - 1.0), last_stator_C, kStatorSteps);
  grid.points[winding] = rounded_steps(coldest_C, limit_C, kWindingSteps);
  // Near the limits the current is small, so its relative error is large.
  add_near_end(grid.points[stator], {3.0, 1.0});
  add_near_end(grid.points[winding], {2.0, 1.0, 0.5});
  grid.limit = grid.points[winding].size() - 1;
  grid.points[winding].push_back(limit_C + kAboveLimit_K);
  for (const double winding_C : grid.points[winding]) {
    grid.square_per_heat_ratio.push_back(1.0 / table.resistance_ratio(winding_C));
  }
  for (const double speed_rad_per_s : grid.points[speed]) {
    for (const double stator_C : grid.points[stator]) {
      for (const double winding_C : grid.points[winding]) {
        const double square_A2 = barrier.square_A2(speed_rad_per_s, stator_C, winding_C);
        grid.heat_A2.push_back((winding_C > limit_C ? std::min(square_A2, 0.0) : square_A2) * table.resistance_ratio(winding_C));
      }
    }
  }
  return grid;
}

}  // namespace heatsoak::derate
