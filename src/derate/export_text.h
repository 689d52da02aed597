// What several exporters share: comment lines, checks, and the current of field-oriented control.
#pragma once

#include <numbers>
#include <string>
#include <string_view>

#include "derate/ramp.h"

namespace heatsoak {

/// Equivalent DC current per ampere of i_q (amplitude-invariant). For a sinusoidal back-EMF of amplitude E·ω per phase the torque constant
/// is 3·√3/π·E per DC ampere of block commutation and 3/2·E per ampere of i_q.
inline constexpr double kDcPerIq_ratio = std::numbers::sqrt3 * std::numbers::pi / 6.0;

/// Program, inputs, limit, confidence, conditions and assumed spreads as lines that begin with `comment`. No text of a user ends a line.
std::string provenance_lines(const Derating& derating, std::string_view comment);

/// What the confidence means and what showed it, as one sentence without a line break.
std::string confidence_text(const Derating& derating);

/// Prefix of the names in generated code: the id with every other character than letters and digits replaced by "_".
std::string identifier(std::string_view id);

/// What the ramp gives away and where it is valid, as lines that begin with `comment`. `phase_per_dc_ratio`: the controller's current per
/// equivalent DC current.
std::string ramp_lines(const Derating& derating, RampSignal signal, const CurrentRamp& ramp, double phase_per_dc_ratio,
                       std::string_view comment);

/// Effects that are not of the data sheet, "chassis (third_node)"; "no own effects" without any.
std::string own_effects_text(const Derating& derating);

/// Throws Failure (bad_input) if a value that is exported is not finite.
void require_finite(const Derating& derating);

/// Throws Failure (bad_input) for a brushed motor, with the controller's name.
void require_brushless(std::string_view controller, const Derating& derating);

/// Throws Failure (bad_input) with the signal and the effects if a law depends on a signal other than current, speed and air temperature.
void require_three_signals(std::string_view controller, const Derating& derating);

/// A current of the controller, rounded down to 1 mA, so that the limit stays on the safe side.
double rounded_down_A(double current_A);

}  // namespace heatsoak
