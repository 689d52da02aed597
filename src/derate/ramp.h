// Linear ramp of the current limit over one temperature, as built into motor controllers, fitted below the derating table.
#pragma once

#include "derate/derating.h"

namespace heatsoak::derate {

/// The temperature that a controller's ramp acts on.
enum class RampSignal {
  stator,  ///< a thermistor at the stator; winding and speed are unknown to the controller
  winding  ///< the observer's winding; stator and speed are known to the observer, but not to the ramp
};

/// Full current up to `start_C`, 0 from `end_C` on, linear between. Whole degrees, because VESC stores one byte each.
struct CurrentRamp {
  double start_C = 0.0;
  double end_C = 0.0;
  double most_current_A = 0.0;  ///< equivalent DC current
  double full_beyond_K = 0.0;   ///< a controller may give the full current until this far beyond the start

  /// Returns the current at a temperature; 0 for NaN.
  [[nodiscard]] double current_A(double signal_C) const;
};

/// Returns the largest current in A that any ramp may give at a temperature of its signal. It is the smallest current of the table over all
/// speeds up to rules.most_speed_rad_per_s and over the temperature that the ramp does not measure.
/// stator: over every winding temperature up to the limit. The smallest current occurs with the winding at its limit, where it stops
/// heating (Nagumo 1942), so a ramp below it keeps the limit for any load before. A continuous load loses nothing, because the winding
/// settles long before the stator. Only short peaks of a cold winding are lost.
/// winding: over every stator temperature up to the winding's limit.
/// Returns 0 above the table's last temperature; below its first one the value there is held.
double ramp_bound_A(const Derating& derating, RampSignal signal, double signal_C);

/// Returns the ramp with whole degrees that stays below ramp_bound_A() and has the largest mean current between the hottest declared air
/// and the winding's limit. The search is exhaustive. The current is 0 if the bound is 0 in the hottest air.
CurrentRamp fit_ramp(const Derating& derating, RampSignal signal, double full_beyond_K = 0.0);

/// Current that the ramp loses against ramp_bound_A(), between the hottest declared air and the winding's limit.
struct RampLoss {
  double from_C = 0.0;
  double to_C = 0.0;
  double bound_mean_A = 0.0;  ///< mean of ramp_bound_A()
  double ramp_mean_A = 0.0;
  double most_A = 0.0;  ///< largest difference, bound minus ramp
  double most_at_C = 0.0;
  double peak_A = 0.0;  ///< current that the table allows at standstill with the whole motor at the hottest air temperature

  [[nodiscard]] double mean_A() const { return bound_mean_A - ramp_mean_A; }
  [[nodiscard]] double mean_percent() const { return bound_mean_A > 0.0 ? 100.0 * mean_A() / bound_mean_A : 0.0; }
};
RampLoss ramp_loss(const Derating& derating, RampSignal signal, const CurrentRamp& ramp);

/// Returns the fitted ramp for the named controller. Throws Failure (bad_input) that names controller and effect if no ramp can protect the
/// motor:
/// - the motor exceeds its limit without current at some speed;
/// - a node without a sensor heats the winding (ramp over the stator);
/// - the stator has a limit (ramp over the winding);
/// - no current is allowed in the hottest air.
CurrentRamp ramp_for(std::string_view controller, const Derating& derating, RampSignal signal, double full_beyond_K = 0.0);

}  // namespace heatsoak::derate
