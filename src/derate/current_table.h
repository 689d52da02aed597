// The derating table: the current that may flow at a speed, while a winding and a stator have the temperatures that the observer says.
#pragma once

#include <optional>
#include <vector>

#include "derate/observer.h"

namespace heatsoak {

struct TemperatureLimits {
  double winding_C = 0.0;
  std::optional<double> stator_C = {};
};

/// A control barrier (Ames et al., Control barrier function based quadratic programs for safety critical systems, IEEE Trans. Autom.
/// Control 62 (2017)): at the allowed current the winding gets hotter by no more than (limit − T)/approach_s per second, so it comes near
/// its limit and never passes it, in Euler steps up to approach_s too. The stator, which the current reaches through the winding only,
/// has the same with stator_approach_s, looked at one approach_s ahead.
struct BarrierRules {
  TemperatureLimits limits;
  double approach_s = 1.0;
  double stator_approach_s = 10.0;
  double hottest_ambient_C = 40.0;
  double most_current_A = 0.0;        ///< that the driver can let through
  double most_speed_rad_per_s = 0.0;  ///< of the motor
};

/// Ascending axes; between the points straight, below the first of an axis as at it, above the last no current. The winding's last two
/// places are its limit and 1 K above it, where the current has faded out. Whatever law a signal
/// belongs to that a table cannot hold (vehicle, neighbour, age, signs of current and speed), its hottest case counts, and every node but
/// the winding is as hot as the stator's axis says.
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
