// The derating table: allowed current over speed, stator temperature and winding temperature, as estimated by the observer.
#pragma once

#include <cstddef>
#include <vector>

#include "derate/hot_cases.h"
#include "derate/observer.h"

namespace heatsoak::derate {

/// Above the highest speed of the rules the allowed current falls linearly, so that a motor that is driven from outside can still brake and
/// its current has no step. It reaches 0 at rules.no_current_speed_rad_per_s, at least at this ratio to the highest speed.
inline constexpr double kSpeedFadeOut_ratio = 1.1;

/// Bounds of a table relative to the exact current (Barrier), verified at points that are not breakpoints of the table.
struct TableBound {
  /// Above CurrentTable::straight_below_A the table lies below the exact current by at most this share of it; never above it. From 0 to 1.
  double shortfall_ratio = 0.0;
  bool is_limited_by_size = false;  ///< the permitted size is too small for the target at the grid points that the search may choose
  // Upper bounds of the slope of the allowed current with respect to one quantity, computed from the table's own segments.
  double winding_slope_A_per_K = 0.0;
  double stator_slope_A_per_K = 0.0;
  double speed_slope_A_s_per_rad = 0.0;
};

/// Copper heat of the allowed current over speed, stator and winding temperature, interpolated linearly: per ohm of the resistance at
/// 25 °C, so I²·(1 + α·(T_winding − 25 °C)). For the network of a data sheet it is linear in both temperatures, so that the table is exact.
/// An axis with one breakpoint has no influence. Below the first breakpoint of an axis its value is held. Each kelvin of the stator above
/// its last breakpoint counts as winding_per_stator_K of the winding; above the winding's last breakpoint the current is 0. The stator axis
/// stands for all nodes except the winding. A heat is negative if the barrier is violated even without current. All heats and the
/// resistance ratio's two constants are exactly representable in single precision.
struct CurrentTable {
  std::vector<double> speed_rad_per_s;
  std::vector<double> stator_C;
  std::vector<double> winding_C;
  std::vector<double> heat_per_ohm_A2;  ///< [speed][stator][winding]
  double resistance_at_0C_ratio = 1.0;  ///< resistance of the winding at 0 °C, as a ratio to that at 25 °C
  double resistance_ratio_per_K = 0.0;
  double most_current_A = 0.0;
  /// Below this current the table returns square/straight_below_A instead of the root, so that the current reaches 0 with a finite slope.
  double straight_below_A = 1.0;
  double most_speed_rad_per_s = 0.0;        ///< above this speed the current falls linearly
  double no_current_speed_rad_per_s = 0.0;  ///< at this speed it reaches 0
  double winding_per_stator_K = 1.0;
  TableBound bound = {};

  [[nodiscard]] std::size_t place(std::size_t speed, std::size_t stator, std::size_t winding) const {
    return (speed * stator_C.size() + stator) * winding_C.size() + winding;
  }
  /// Memory on the controller: breakpoints and heats as single-precision numbers, 4 bytes each.
  [[nodiscard]] std::size_t size_bytes() const {
    return sizeof(float) * (speed_rad_per_s.size() + stator_C.size() + winding_C.size() + heat_per_ohm_A2.size());
  }
  /// Resistance of the winding as a ratio to that at 25 °C; above 0 from the first breakpoint on.
  template <class Number>
  [[nodiscard]] Number resistance_ratio(Number winding) const {
    return static_cast<Number>(resistance_at_0C_ratio) + static_cast<Number>(resistance_ratio_per_K) * winding;
  }
  /// Squared current in A² at a breakpoint, given by its place(); negative where the heat is.
  [[nodiscard]] double square_A2(std::size_t place) const {
    return heat_per_ohm_A2[place] / resistance_ratio(winding_C[place % winding_C.size()]);
  }
  /// Largest current in A that the table allows anywhere.
  [[nodiscard]] double largest_A() const;
  /// Returns the allowed current in A, from 0 to most_current_A, continuous in all three arguments (rad/s, °C, °C). Any NaN gives 0. In
  /// single precision the result is bit-identical to robot_core/current_table.h.
  template <class Number>
  [[nodiscard]] Number allowed_A(Number speed, Number stator, Number winding) const;
  /// Returns the current in A for a squared current in A², at most most_current_A. Does not include the reduction above
  /// most_speed_rad_per_s.
  template <class Number>
  [[nodiscard]] Number current_of_A(Number square) const;
};
extern template float CurrentTable::allowed_A<float>(float, float, float) const;
extern template double CurrentTable::allowed_A<double>(double, double, double) const;

/// Target of a table: the smallest table within the shortfall and the size. If both cannot be met, the size is kept.
struct TableGoal {
  double shortfall_ratio = 0.01;  ///< 0 < … < 1
  std::size_t most_bytes = 8192;  ///< largest size of the single-precision numbers
};

/// Computes a table for the goal. Adds breakpoints one by one, each on the axis where it reduces the largest shortfall most, and removes
/// those that turn out to be unnecessary. A table that misses the shortfall keeps no breakpoint without which it would miss it by no more.
/// Lowers heats until no point of a fine grid and of an independent set exceeds the exact current.
CurrentTable current_table(const Observer& observer, const BarrierRules& rules, const TableGoal& goal = {});

}  // namespace heatsoak::derate
