// current_table(): computes the breakpoints, then verifies the table at points that are not its own.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/copper.h"
#include "derate/table_places.h"

namespace heatsoak::derate {
namespace {

/// Rounds down to single precision. Includes a margin for the rounding of the controller's interpolation.
double rounded_down(double value, double largest_A2) {
  constexpr double kInterpolation_ratio = 5e-7;
  const double safe = value - kInterpolation_ratio * largest_A2;
  const auto single = static_cast<float>(safe);
  return single > safe ? std::nextafter(single, std::numeric_limits<float>::lowest()) : single;
}

void round_down(CurrentTable& table) {
  double largest_A2 = 0.0;
  for (const double heat_A2 : table.heat_per_ohm_A2) {
    largest_A2 = std::max(largest_A2, std::abs(heat_A2));
  }
  std::ranges::transform(table.heat_per_ohm_A2, table.heat_per_ohm_A2.begin(), [&](double each) { return rounded_down(each, largest_A2); });
}

struct CheckPoint {
  double speed_rad_per_s;
  double stator_C;
  double winding_C;
};

/// Adds quasi-random points that fill the axes evenly (Roberts 2018, the R3 sequence). A third of them lies within 8 K and a third within
/// 1.5 K of the limits, where the relative error is largest.
void add_scattered(std::vector<CheckPoint>& points, const CurrentTable& table, const BarrierRules& rules) {
  constexpr int kPoints = 4500;
  constexpr double kStep[] = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
  constexpr double kNear_K[] = {1000.0, 8.0, 1.5};
  for (int i = 1; i <= kPoints; ++i) {
    const auto share = [&](std::size_t axis) { return std::fmod(0.5 + i * kStep[axis], 1.0); };
    const auto from_C = [&](double end_C) { return std::max(rules.hottest_ambient_C, end_C - kNear_K[i % 3]); };
    points.push_back({share(0) * rules.most_speed_rad_per_s, std::lerp(from_C(table.stator_C.back()), table.stator_C.back(), share(1)),
                      std::lerp(from_C(rules.limits.winding_C), rules.limits.winding_C, share(2))});
  }
}

/// Returns three points at 1/4, 1/2 and 3/4 of every segment of an axis, limited to `most`.
std::vector<double> inside_of(const std::vector<double>& axis, double most) {
  std::vector<double> places;
  if (axis.size() == 1) {
    return {0.5 * (axis.front() + most)};
  }
  for (std::size_t i = 0; i + 1 < axis.size() && axis[i] < most; ++i) {
    for (const double share : {0.25, 0.5, 0.75}) {
      places.push_back(std::min(most, std::lerp(axis[i], axis[i + 1], share)));
    }
  }
  return places;
}

/// Returns scattered points, 27 points in every cell, and points every 0.25 K of the winding at the cold and hot end of the stator's axis.
std::vector<CheckPoint> check_points(const CurrentTable& table, const BarrierRules& rules) {
  std::vector<CheckPoint> points;
  add_scattered(points, table, rules);
  for (const double speed_rad_per_s : inside_of(table.speed_rad_per_s, rules.most_speed_rad_per_s)) {
    for (const double stator_C : inside_of(table.stator_C, table.stator_C.back())) {
      for (const double winding_C : inside_of(table.winding_C, rules.limits.winding_C)) {
        points.push_back({speed_rad_per_s, stator_C, winding_C});
      }
    }
  }
  constexpr double kStep_K = 0.25;
  for (const double speed_rad_per_s : {0.0, rules.most_speed_rad_per_s}) {
    for (const double stator_C : {table.stator_C.front(), table.stator_C.back()}) {
      for (double winding_C = rules.limits.winding_C; winding_C > rules.hottest_ambient_C; winding_C -= kStep_K) {
        points.push_back({speed_rad_per_s, stator_C, winding_C});
      }
    }
  }
  return points;
}

std::size_t segment_of(const std::vector<double>& axis, double x) {
  std::size_t below = 0;
  while (below + 2 < axis.size() && x > axis[below + 1]) {
    ++below;
  }
  return below;
}

/// A cell of the table, given by the lower of its two breakpoints on every axis.
struct Cell {
  std::size_t speed = 0;
  std::size_t stator = 0;
  std::size_t winding = 0;
};

/// Returns the indices of the heats at the corners of a cell; fewer than eight if an axis has one breakpoint.
std::vector<std::size_t> corners(const CurrentTable& table, const Cell& cell) {
  std::vector<std::size_t> places;
  for (std::size_t i = cell.speed; i < std::min(cell.speed + 2, table.speed_rad_per_s.size()); ++i) {
    for (std::size_t j = cell.stator; j < std::min(cell.stator + 2, table.stator_C.size()); ++j) {
      for (std::size_t k = cell.winding; k < std::min(cell.winding + 2, table.winding_C.size()); ++k) {
        places.push_back(table.place(i, j, k));
      }
    }
  }
  return places;
}

/// Inverse of CurrentTable::current_of_A() below most_current_A.
double square_of_A2(const CurrentTable& table, double current_A) {
  return current_A < table.straight_below_A ? current_A * table.straight_below_A : current_A * current_A;
}

/// Lowers cells that exceed the exact current at one of the points, whose squared exact currents are `exact_A2`. Returns the largest
/// relative shortfall at points where the exact current is at least straight_below_A.
double check_table(CurrentTable& table, const std::vector<CheckPoint>& points, const std::vector<double>& exact_A2) {
  const auto exact_A = [&](std::size_t i) { return std::min(table.most_current_A, std::sqrt(std::max(0.0, exact_A2[i]))); };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const CheckPoint& at = points[i];
    const double shown_A = table.allowed_A(at.speed_rad_per_s, at.stator_C, at.winding_C);
    if (shown_A > exact_A(i)) {
      const Cell cell{segment_of(table.speed_rad_per_s, at.speed_rad_per_s), segment_of(table.stator_C, at.stator_C),
                      segment_of(table.winding_C, at.winding_C)};
      const double excess_A2 = (square_of_A2(table, shown_A) - square_of_A2(table, exact_A(i))) *
                               table.resistance_ratio(std::max(at.winding_C, table.winding_C.front()));
      for (const std::size_t corner : corners(table, cell)) {
        table.heat_per_ohm_A2[corner] -= excess_A2;
      }
    }
  }
  double shortfall_ratio = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (exact_A(i) >= table.straight_below_A) {
      const CheckPoint& at = points[i];
      shortfall_ratio = std::max(shortfall_ratio, 1.0 - table.allowed_A(at.speed_rad_per_s, at.stator_C, at.winding_C) / exact_A(i));
    }
  }
  return shortfall_ratio;
}

/// Lowers and rounds down the heats of a table from HeatPlaces until it keeps the exact current at all check points, and sets its
/// shortfall.
void verify(CurrentTable& table, Barrier& barrier, const BarrierRules& rules) {
  const std::vector<CheckPoint> points = check_points(table, rules);
  std::vector<double> exact_A2;
  for (const CheckPoint& at : points) {
    exact_A2.push_back(barrier.square_A2(at.speed_rad_per_s, at.stator_C, at.winding_C));
  }
  check_table(table, points, exact_A2);
  round_down(table);
  table.bound.shortfall_ratio = std::max(table.bound.shortfall_ratio, check_table(table, points, exact_A2));
}

/// Returns how many kelvins of the winding one kelvin of a stator above its axis must count as, so that the barrier holds: a power of 2, up
/// to 32.
double winding_per_stator_K(CurrentTable table, Barrier& barrier, const BarrierRules& rules) {
  constexpr double kMost_K = 32.0;
  constexpr int kWindings = 24;
  const auto holds = [&](double stator_C, double speed_rad_per_s) {
    for (int i = 0; i <= kWindings; ++i) {
      const double winding_C = std::lerp(rules.hottest_ambient_C, rules.limits.winding_C, static_cast<double>(i) / kWindings);
      const double shown_A = table.allowed_A(speed_rad_per_s, stator_C, winding_C);
      constexpr double kRounding = 1e-6;
      if (shown_A > (1.0 + kRounding) * barrier.current_A(speed_rad_per_s, stator_C, winding_C)) {
        return false;
      }
    }
    return true;
  };
  for (table.winding_per_stator_K = 1.0; table.winding_per_stator_K < kMost_K; table.winding_per_stator_K *= 2.0) {
    bool all_hold = true;
    for (const double above_K : {0.1, 0.5, 2.0, 5.0, 10.0}) {
      for (const double speed_share : {0.0, 0.5, 1.0}) {
        all_hold = all_hold && holds(table.stator_C.back() + above_K, speed_share * rules.most_speed_rad_per_s);
      }
    }
    if (all_hold) {
      break;
    }
  }
  return table.winding_per_stator_K;
}

/// Raises the bounds to the slopes inside of a cell. The steepest segment, evaluated at the smallest current, is an upper bound: along the
/// winding a square is a quotient of two linear functions, whose slope is steepest where the resistance is lowest.
void add_slopes(TableBound& bound, const CurrentTable& table, const Cell& cell) {
  const std::vector<std::size_t> places = corners(table, cell);
  double least_A2 = table.square_A2(places.front());
  double most_A2 = least_A2;
  for (const std::size_t place : places) {
    least_A2 = std::min(least_A2, table.square_A2(place));
    most_A2 = std::max(most_A2, table.square_A2(place));
  }
  if (most_A2 <= 0.0 || least_A2 >= table.most_current_A * table.most_current_A) {
    return;
  }
  const double straight_A2 = table.straight_below_A * table.straight_below_A;
  const double per_square_A = least_A2 < straight_A2 ? 1.0 / table.straight_below_A : 0.5 / std::sqrt(least_A2);
  const std::size_t windings = table.winding_C.size();
  const auto add = [&](double& slope_A, const std::vector<double>& axis, std::size_t first, std::size_t apart) {
    for (const std::size_t place : places) {
      if (axis.size() > 1 && place / apart % axis.size() == first) {
        const double ratio = table.resistance_ratio(table.winding_C[place % windings]);
        const double falling_per_K = apart == 1 ? table.resistance_ratio_per_K * table.square_A2(place) : 0.0;
        const double heat_slope_A2 =
            (table.heat_per_ohm_A2[place + apart] - table.heat_per_ohm_A2[place]) / (axis[first + 1] - axis[first]);
        slope_A = std::max(slope_A, per_square_A * std::abs(heat_slope_A2 - falling_per_K) / ratio);
      }
    }
  };
  add(bound.winding_slope_A_per_K, table.winding_C, cell.winding, 1);
  add(bound.stator_slope_A_per_K, table.stator_C, cell.stator, table.winding_C.size());
  add(bound.speed_slope_A_s_per_rad, table.speed_rad_per_s, cell.speed, table.winding_C.size() * table.stator_C.size());
}

void find_slopes(CurrentTable& table) {
  const auto cells = [](const std::vector<double>& axis) { return std::max<std::size_t>(1, axis.size() - 1); };
  TableBound& bound = table.bound;
  for (std::size_t i = 0; i < cells(table.speed_rad_per_s); ++i) {
    for (std::size_t j = 0; j < cells(table.stator_C); ++j) {
      for (std::size_t k = 0; k < cells(table.winding_C); ++k) {
        add_slopes(bound, table, {i, j, k});
      }
    }
  }
  bound.stator_slope_A_per_K = std::max(bound.stator_slope_A_per_K, table.winding_per_stator_K * bound.winding_slope_A_per_K);
  bound.speed_slope_A_s_per_rad =
      std::max(bound.speed_slope_A_s_per_rad, table.largest_A() / (table.no_current_speed_rad_per_s - table.most_speed_rad_per_s));
}

}  // namespace

CurrentTable current_table(const Observer& observer, const BarrierRules& rules, const TableGoal& goal) {
  Barrier barrier(observer, rules);
  CurrentTable table;
  table.resistance_ratio_per_K = static_cast<float>(observer.resistance_rise_per_K());
  table.resistance_at_0C_ratio = static_cast<float>(base::resistance_ratio(observer.resistance_rise_per_K(), 0.0));
  table.most_current_A = static_cast<float>(rules.most_current_A);
  table.most_speed_rad_per_s = rules.most_speed_rad_per_s;
  table.no_current_speed_rad_per_s =
      std::max(kSpeedFadeOut_ratio * rules.most_speed_rad_per_s, rules.no_current_speed_rad_per_s.value_or(0.0));
  // Points between those of the fine grid show a slightly larger shortfall, so each attempt tightens the goal on the grid.
  constexpr int kMostTries = 6;
  constexpr double kBetter = 0.75;
  const HeatPlaces places(table, barrier, rules);
  double grid_goal = 0.97 * goal.shortfall_ratio;
  std::optional<CurrentTable> best;
  for (int i = 0; i < kMostTries; ++i, grid_goal *= kBetter) {
    places.place(table, {grid_goal, goal.most_bytes});
    table.bound.is_limited_by_size = table.bound.shortfall_ratio > grid_goal;
    verify(table, barrier, rules);
    if (!best || table.bound.shortfall_ratio < best->bound.shortfall_ratio) {
      best = table;
    }
    if (table.bound.shortfall_ratio <= goal.shortfall_ratio) {
      break;
    }
  }
  table = *best;
  if (const double reached_ratio = table.bound.shortfall_ratio; reached_ratio > goal.shortfall_ratio) {
    places.remove(table, [&](CurrentTable& smaller) {
      verify(smaller, barrier, rules);
      return smaller.bound.shortfall_ratio <= reached_ratio;
    });
  }
  constexpr double kPerMillion = 1e6;
  table.bound.shortfall_ratio = std::ceil(kPerMillion * table.bound.shortfall_ratio) / kPerMillion;
  table.winding_per_stator_K = winding_per_stator_K(table, barrier, rules);
  find_slopes(table);
  return table;
}

}  // namespace heatsoak::derate
