// A linear ramp of current over one temperature, as motor controllers have it, fitted below the derating table.
#pragma once

#include "derate/derating.h"

namespace heatsoak {

/// The temperature that a controller's ramp acts on.
enum class RampSignal {
  stator,  ///< a thermistor at the stator; winding and speed are unknown to the controller
  winding  ///< the observer's winding; stator and speed are known to the observer, but not to the ramp
};

/// Full current up to `start_C`, none from `end_C` on, a straight line between. Whole degrees, because VESC stores one byte each.
struct CurrentRamp {
  double start_C = 0.0;
  double end_C = 0.0;
  double most_current_A = 0.0;  ///< equivalent DC current
  double full_beyond_K = 0.0;   ///< a controller may give the full current until this far beyond the start

  /// NaN gives 0.
  [[nodiscard]] double current_A(double signal_C) const;
};

/// The most that any ramp may allow at a temperature of its signal: the smallest current of the table over all speeds up to
/// rules.most_speed and over every value of what the ramp does not see.
/// stator: over every winding temperature up to its limit. The smallest current is that of a winding at its limit, at which the winding
/// does not get warmer (Nagumo 1942): so a ramp below it keeps the limit whatever the winding did before. A held current meets the same
/// bound, because its winding settles long before the stator does. Only short peaks of a cold winding are lost.
/// winding: over every stator temperature up to the winding's limit.
/// 0 above the table; below its first temperature as at it.
double ramp_bound_A(const Derating& derating, RampSignal signal, double signal_C);

/// The ramp of whole degrees that stays below ramp_bound_A() everywhere and has the largest mean current from the hottest declared air to
/// the winding's limit. The search is exhaustive. Its current is 0 if the bound is 0 in the hottest air.
CurrentRamp fit_ramp(const Derating& derating, RampSignal signal, double full_beyond_K = 0.0);

/// What the ramp gives away, over the signal's temperatures from the hottest declared air to the winding's limit.
struct RampLoss {
  double from_C = 0.0;
  double to_C = 0.0;
  double bound_mean_A = 0.0;  ///< of ramp_bound_A()
  double ramp_mean_A = 0.0;
  double most_A = 0.0;  ///< largest distance between both
  double most_at_C = 0.0;
  double peak_A = 0.0;  ///< allowed by the table at standstill to a motor as warm as the hottest air

  [[nodiscard]] double mean_A() const { return bound_mean_A - ramp_mean_A; }
  [[nodiscard]] double mean_percent() const { return bound_mean_A > 0.0 ? 100.0 * mean_A() / bound_mean_A : 0.0; }
};
RampLoss ramp_loss(const Derating& derating, RampSignal signal, const CurrentRamp& ramp);

/// A fitted ramp for a controller of that name. Throws Failure (bad_input), with the names of controller and effect, if the ramp cannot
/// protect the motor: a speed at which the motor exceeds its limit without current; a node other than the stator that heats the winding,
/// which no sensor of the controller sees; a limit of the stator, which a ramp over the winding does not see; no current in the hottest
/// air.
CurrentRamp ramp_for(std::string_view controller, const Derating& derating, RampSignal signal, double full_beyond_K = 0.0);

}  // namespace heatsoak
