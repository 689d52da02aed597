// The one evaluation of a network: the drive stage, then every law, for all scalar types.
#pragma once

#include <limits>
#include <type_traits>

#include "thermal/law.h"
#include "thermal/network.h"

namespace heatsoak::thermal {

/// Returns whether a headroom can limit the current. The guard's motors have none, and a division takes longer than this comparison.
inline bool has_limit(double headroom_V) { return headroom_V < std::numeric_limits<double>::infinity(); }
inline bool has_limit(const Lanes& headroom_V) { return (headroom_V < std::numeric_limits<double>::infinity()).any(); }

/// Books the heat of one effect. `node_index` has the place of each role in `temperature_C`: EffectInPlace::node_index for temperatures of
/// the network's nodes.
template <class S>
void book(const EffectInPlace& effect, const OperatingPoint<S>& at, const S* parameters, const S* temperature_C, const int* node_index,
          HeatBook<S>& heat) {
  effect.type->laws->book(Situation<S>(at, parameters, effect.parameter_index.data(), temperature_C, node_index), heat);
}

template <class S, class Visit>
void Network::evaluate(OperatingPoint<S>& at, const S* parameters, const S* temperature_C, const Visit& visit) const {
  const S given_A = at.current_rms_A;
  const S given_W = at.copper_loss_W;
  if (drive_) {
    // Formulas and derivatives are those of a current without a limit.
    if constexpr (std::is_same_v<S, double> || std::is_same_v<S, Lanes>) {
      if (has_limit(at.resistive_headroom_V)) {
        at.current_rms_A = drive_->current_A(at, parameters, temperature_C);
      }
    }
    at.copper_loss_W = drive_->copper_loss_W(at.current_rms_A, parameters, temperature_C);
  }
  for (const EffectInPlace& effect : effects_) {
    visit(effect, at);
  }
  at.current_rms_A = given_A;
  at.copper_loss_W = given_W;
}

}  // namespace heatsoak::thermal
