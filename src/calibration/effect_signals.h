// Signals of the logs that the effects of a motor's model depend on.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "calibration/assumptions.h"
#include "calibration/motor_model.h"
#include "recording/recording.h"

namespace heatsoak::calibration {

/// An effect and the signals that it depends on.
struct EffectNeeds {
  std::string effect;
  std::vector<thermal::Signal> signals;
};

/// Returns the needs of all effects of the network. If the input power is the heat, no effect needs the current, because the input power
/// contains the copper loss.
std::vector<EffectNeeds> needs_of(const estimation::Model& model, HeatInput heat);
/// Returns the needs of the effects that the motor file has in addition to the network of every motor; `heat` as above.
std::vector<EffectNeeds> needs_of(const motor::Motor& motor, HeatInput heat);

struct EffectSignals {
  std::vector<thermal::Signal> found;   ///< signals that an effect depends on and at least one recording has
  std::vector<SignalsMissing> missing;  ///< effects, each with the signals that no recording has
};

/// `torque`: constants from which signals may follow, see estimation::signals_of().
EffectSignals effect_signals(std::span<const EffectNeeds> needs, std::span<const recording::Recording> recordings,
                             const estimation::ShaftTorque& torque);

/// Adds to how.needed the signals of the file's effects that the recording has, so that rows without a value count as gaps, not as 0.
void need_signals_of_effects(const motor::Motor& motor, HeatInput heat, const recording::Recording& recording,
                             estimation::MeasuredRunOptions& how);

}  // namespace heatsoak::calibration
