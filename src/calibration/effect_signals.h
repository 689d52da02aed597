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
  bool needs_all = false;  ///< it does not act if one of them is missing
};

/// Returns the needs of all effects of the network.
std::vector<EffectNeeds> needs_of(const estimation::Model& model);
/// Returns the needs of the effects that the motor file has in addition to the network of every motor.
std::vector<EffectNeeds> needs_of(const motor::Motor& motor);

struct EffectSignals {
  std::vector<thermal::Signal> found;   ///< signals that an effect depends on and at least one recording has
  std::vector<SignalsMissing> missing;  ///< effects, each with the signals that no recording has
};

/// `how`: options that the logs are read with.
EffectSignals effect_signals(std::span<const EffectNeeds> needs, std::span<const recording::Recording> recordings,
                             const estimation::MeasuredRunOptions& how);

/// Adds to how.needed the signals of the file's effects that the recording has, so that rows without a value count as gaps, not as 0.
void need_signals_of_effects(const motor::Motor& motor, const recording::Recording& recording, estimation::MeasuredRunOptions& how);
/// Returns, per recording, the effects of the file whose signals it lacks; without a name of a recording if no recording has them.
std::vector<SignalsMissing> missing_signals(const motor::Motor& motor, std::span<const recording::Recording> recordings,
                                            const estimation::MeasuredRunOptions& how);

}  // namespace heatsoak::calibration
