// The derating table: the current that may flow at a speed, while a winding and a stator have the temperatures that the observer says.
#pragma once

#include <optional>
#include <vector>

#include "derate/hot_cases.h"
#include "derate/observer.h"

namespace heatsoak {

/// Beyond the highest speed of the rules the current falls in a straight line, so that a motor that is pushed can still brake and its
/// current does not jump. It has fallen to none at rules.no_current_speed, at this ratio to the highest speed at least.
inline constexpr double kSpeedFadeOut_ratio = 1.1;

/// Ascending axes; between the points straight, below the first of an axis as at it, above the last no current. The last two places of
/// winding and stator are their limits and 1 K above them, where the current has faded out; those of the speed are the rules' highest and
/// that without current. The least of all hot cases stands in it, and every node but the winding is as hot as the stator's axis
/// says. Currents are whole numbers of single precision.
struct CurrentTable {
  std::vector<double> speed_rad_per_s;
  std::vector<double> stator_C;
  std::vector<double> winding_C;
  std::vector<double> current_A;  ///< [speed][stator][winding]

  [[nodiscard]] std::size_t place(std::size_t speed, std::size_t stator, std::size_t winding) const {
    return (speed * stator_C.size() + stator) * winding_C.size() + winding;
  }
  /// What is not a number gives 0.
  template <class Number>
  [[nodiscard]] Number allowed_A(Number speed, Number stator, Number winding) const;
};
extern template float CurrentTable::allowed_A<float>(float, float, float) const;
extern template double CurrentTable::allowed_A<double>(double, double, double) const;

/// The largest current up to which the barrier holds at one place, 0 where it does not even without current.
double barrier_current_A(const Observer& observer, const BarrierRules& rules, double speed_rad_per_s, double stator_C, double winding_C);

/// Between its points too the table allows no more than barrier_current_A(), as far as 27 places in each cell show.
CurrentTable current_table(const Observer& observer, const BarrierRules& rules);

}  // namespace heatsoak
