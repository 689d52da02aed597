#pragma once
// Effects that a motor of the suite can have beyond its two bodies: those of the catalogue, and laws outside it.
#include <functional>
#include <string>
#include <vector>

#include "motor.h"

namespace heatsoak::suite {

struct EffectKind {
  std::string id;                    ///< name in the catalogue, or of a law outside it
  std::string node;                  ///< winding or stator
  std::string law;                   ///< the equation in words, for truth.json
  std::vector<std::string> family;   ///< names that count as the right family
  std::vector<std::string> signals;  ///< logged signals that the heat depends on
  /// Adds the effect. Strength 1 is the size of a typical motor.
  std::function<void(Motor&, double strength)> add;
};

/// Effects of the catalogue, in several laws. An id can occur more than once.
const std::vector<EffectKind>& catalogue_effects();

/// Heat with a logged signal as input, and a law outside the catalogue.
const std::vector<EffectKind>& outside_effects();

/// Heat of the copper of the winding at its temperature.
double copper_W(const Motor& motor, const Instant& now, std::span<const double> temperature_C);

}  // namespace heatsoak::suite
