// Worst-case conditions for a given current and speed: their directions, and signals that are not measured, such as neighbour and age.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "derate/observer.h"

namespace heatsoak::derate {

/// Temperature limits of a motor; a motor may have no stator limit.
struct TemperatureLimits {
  double winding_C = 0.0;
  std::optional<double> stator_C = {};
};

/// Parameters of a control barrier (Ames et al., Control barrier function based quadratic programs for safety critical systems, IEEE Trans.
/// Autom. Control 62 (2017)). At the allowed current the winding heats by at most (limit − T)/approach_s, in K/s. It approaches its limit
/// without exceeding it, also with Euler steps up to approach_s. The same holds for the stator with stator_approach_s; its rate is
/// evaluated one approach_s ahead, because the current heats it only through the winding.
struct BarrierRules {
  TemperatureLimits limits;
  double approach_s = 0.5;
  double stator_approach_s = 10.0;
  double hottest_ambient_C = 40.0;
  double most_current_A = 0.0;        ///< current limit of the motor driver
  double most_speed_rad_per_s = 0.0;  ///< highest speed of the motor up to which the limits are kept
  /// Lower bound of the speed at which the allowed current reaches 0. It is at least kSpeedFadeOut_ratio times the highest speed.
  std::optional<double> no_current_speed_rad_per_s = {};
  double most_vehicle_speed_m_per_s = 0.0;
};

/// Returns `count` ≥ 2 equidistant values from `low` to `high`, both included.
std::vector<double> evenly(double low, double high, int count);

using Signals = std::array<double, observed::kSignalCount>;

/// One combination of the signs of current and speed and of the signals that are not axes of the table.
struct HotCase {
  double current_sign = 1.0;
  double speed_sign = 1.0;
  Signals held{};  ///< signals that are no axes: wind, neighbour, age, …; current, speed and ambient stay 0

  bool operator==(const HotCase&) const = default;
  /// Returns all signals, with the hottest declared air, for magnitudes of current and speed.
  [[nodiscard]] Signals signals(const BarrierRules& rules, double current_A, double speed_rad_per_s) const;
};

/// Returns the case of a new motor that drives in still air beside a neighbour at air temperature.
HotCase plain_case(const BarrierRules& rules);

/// Returns the plain case first: driving, no wind, a new motor whose neighbour is at air temperature. Then those that differ from it under
/// the motor's laws: other directions, and the values of each signal that heat the winding most and the bodies most, found by a scan.
std::vector<HotCase> hot_cases(const Observer& observer, const BarrierRules& rules);

/// Returns candidate values of an unknown signal, ascending: samples of its range, including the values that heat winding and bodies most.
/// A value is left out if another one heats every node at least as much. Current and speed range over both directions up to the maxima of
/// the rules; the air is always the hottest declared.
std::vector<double> values_if_unknown(const Observer& observer, const BarrierRules& rules, observed::Signal signal);

/// Returns the highest speed in rad/s at which the motor keeps its limits without current. At this speed, in every hot case, there are
/// temperatures of the bodies within the limits at which no node heats any further. Beyond it the motor overheats even without current. At
/// most rules.most_speed_rad_per_s; 0 if this fails at rest.
double sustainable_speed_rad_per_s(const Observer& observer, const BarrierRules& rules);

}  // namespace heatsoak::derate
