// The derating table: the current that may flow at a speed, while a winding and a stator have the temperatures that the observer says.
#pragma once

#include <cstddef>
#include <vector>

#include "derate/hot_cases.h"
#include "derate/observer.h"

namespace heatsoak {

/// Beyond the highest speed of the rules the current falls in a straight line, so that a motor that is pushed can still brake and its
/// current does not jump. It has fallen to none at rules.no_current_speed, at this ratio to the highest speed at least.
inline constexpr double kSpeedFadeOut_ratio = 1.1;

/// What holds of a table, against the exact answer (Barrier) on points that are not its own.
struct TableBound {
  /// From CurrentTable::straight_below_A up the table is never above the exact current and at most this share below it.
  double shortfall_ratio = 0.0;
  // Largest change of the allowed current with one quantity, the others fixed: bounds from the table's own lines.
  double winding_slope_A_per_K = 0.0;
  double stator_slope_A_per_K = 0.0;
  double speed_slope_A_s_per_rad = 0.0;
};

/// Squares of the allowed current over speed, stator and winding, straight between the places, because copper heats with the square: an
/// axis with one place does not matter. Below the first place of an axis the first one counts. A stator above its last place counts
/// winding_per_stator_K times as a hotter winding, above the last place of the winding no current may flow. Every node but the winding is
/// as hot as the stator's axis says. Squares are negative where not even no current is enough. They are whole numbers of single precision.
struct CurrentTable {
  std::vector<double> speed_rad_per_s;
  std::vector<double> stator_C;
  std::vector<double> winding_C;
  std::vector<double> square_A2;  ///< [speed][stator][winding]
  double most_current_A = 0.0;
  /// A current below this is square/straight_below instead of the root, so that it falls to 0 with a finite slope.
  double straight_below_A = 1.0;
  double most_speed_rad_per_s = 0.0;        ///< from here on the current falls in a straight line
  double no_current_speed_rad_per_s = 0.0;  ///< to none here
  double winding_per_stator_K = 1.0;
  TableBound bound = {};

  [[nodiscard]] std::size_t place(std::size_t speed, std::size_t stator, std::size_t winding) const {
    return (speed * stator_C.size() + stator) * winding_C.size() + winding;
  }
  /// Single-precision numbers on the controller: places and squares, 4 bytes each.
  [[nodiscard]] std::size_t size_bytes() const {
    return sizeof(float) * (speed_rad_per_s.size() + stator_C.size() + winding_C.size() + square_A2.size());
  }
  /// From 0 to most_current_A, continuous in all three. What is not a number gives 0. In single precision it has the bits of
  /// robot_core/current_table.h.
  template <class Number>
  [[nodiscard]] Number allowed_A(Number speed, Number stator, Number winding) const;
  /// The current of a square up to most_current_A, before what a speed above the highest takes away.
  template <class Number>
  [[nodiscard]] Number current_of_A(Number square) const;
};
extern template float CurrentTable::allowed_A<float>(float, float, float) const;
extern template double CurrentTable::allowed_A<double>(double, double, double) const;

/// What a table should be: as small as the shortfall allows, or as exact as the size allows. With both, the size wins.
struct TableGoal {
  double shortfall_ratio = 0.01;  ///< 0 < … < 1
  std::size_t most_bytes = 8192;  ///< of the single-precision numbers
};

/// Places are added one by one where they lessen the largest shortfall most, on the axis where they do, and taken out again where they are
/// not needed. Squares are lowered until no point of a fine grid and of an independent set lies above the exact answer.
CurrentTable current_table(const Observer& observer, const BarrierRules& rules, const TableGoal& goal = {});

}  // namespace heatsoak
