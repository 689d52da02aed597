// What else a motor may meet while it carries a current at a speed: directions, neighbours, age, what nobody can promise.
#pragma once

#include <array>
#include <optional>
#include <span>
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
  double approach_s = 0.5;
  double stator_approach_s = 10.0;
  double hottest_ambient_C = 40.0;
  double most_current_A = 0.0;        ///< current limit of the motor driver
  double most_speed_rad_per_s = 0.0;  ///< of the motor: up to here limits are kept for good
  /// Where the allowed current has fallen to none, more than the highest speed; 0: as near to it as the table lets (current_table.h).
  double no_current_speed_rad_per_s = 0.0;
  double most_vehicle_speed_m_per_s = 0.0;
};

/// Both ends and what lies between at equal distances; two or more.
std::vector<double> evenly(double low, double high, int count);

using Signals = std::array<double, firmware::kSignalCount>;

/// Directions of current and speed, and the signals that no table has an axis for.
struct HotCase {
  double current_sign = 1.0;
  double speed_sign = 1.0;
  double vehicle_speed_m_per_s = 0.0;
  double neighbour_C = 0.0;
  double age_h = 0.0;
  double acceleration_rad_per_s2 = 0.0;

  /// In air as hot as declared; magnitudes of current and speed.
  [[nodiscard]] Signals signals(const BarrierRules& rules, double current_A, double speed_rad_per_s) const;
};

/// The plain case first (driving, no wind, a new motor beside one as cold as the air), then those that the laws can tell from it: other
/// directions, and of each signal what heats the winding most and what heats the bodies most, found by a scan over all it may be.
std::vector<HotCase> hot_cases(const Observer& observer, const BarrierRules& rules);

/// What a signal may be where nothing is known of it, over all its range and with what heats the most; currents and speeds in both
/// directions up to the rules' most.
std::vector<double> values_if_unknown(const Observer& observer, const BarrierRules& rules, firmware::Signal signal);

/// The speed up to which, in every case, a winding at its limit cools without current and the bodies it heats stay below a temperature
/// towards which it does; beyond it no table can help. At most the rules' most speed, 0 where it is so at rest.
double bearable_speed_rad_per_s(const Observer& observer, const BarrierRules& rules);

}  // namespace heatsoak
