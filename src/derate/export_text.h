// Shared by several exporters: comment lines, checks, and the current conversion for field-oriented control.
#pragma once

#include <numbers>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "derate/ramp.h"

namespace heatsoak::derate {

/// Equivalent DC current per ampere of i_q (amplitude-invariant). For a sinusoidal back-EMF of amplitude E·ω per phase the torque constant
/// is 3·√3/π·E per DC ampere of block commutation and 3/2·E per ampere of i_q.
inline constexpr double kDcPerIq_ratio = std::numbers::sqrt3 * std::numbers::pi / 6.0;

/// Returns program, inputs, limits, confidence, conditions and default tolerances as lines that begin with `comment`. Control characters in
/// a user's text become spaces, so that it cannot end the comment.
std::string provenance_lines(const Derating& derating, std::string_view comment);

/// Returns the promise that the safety factor was selected for: "with 95 % certainty at least 95 % of the motors within their tolerances".
/// The drawn motors show no larger share, because they also selected the factor.
std::string promised_share_text(const Derating& derating);

/// Returns the count of the drawn motors over a limit: "7 of the 400 drawn motors, which determined the
/// safety factor, exceeded a limit".
std::string drawn_motors_text(const Guarantee& checked);

/// Returns the meaning of the confidence and the result of its check as one line: without a sensor `checked` is Derating::guarantee, with
/// one SensorPlan::guarantee.
std::string confidence_text(const Derating& derating, const Guarantee& checked);

/// Returns a line for each reason why values of the motor's file may be wrong: the guarantee holds for the motor that the file describes.
std::vector<std::string> value_warnings(const Derating& derating);

/// Returns the laws of the model with the values of their parameters, and the heat capacities, as lines that begin with `comment`.
std::string law_lines(const Derating& derating, std::string_view comment);

/// Prefix of the names in generated code: the id with each character other than a letter or digit replaced by "_". Begins with "motor_" if
/// the id is empty or begins with a digit.
std::string identifier(std::string_view id);

/// Gives each variable of a generated function a name of its own.
class UniqueNames {
 public:
  /// `reserved`: names that the function uses for something else.
  explicit UniqueNames(std::set<std::string> reserved = {}) : taken_(std::move(reserved)) {}

  /// Returns the name as an identifier(); if it is taken, with a number before its unit: "knot_weight_2_ratio".
  std::string add(std::string_view name);

 private:
  std::set<std::string> taken_;
};

/// Returns a checksum that differs between guards; `form`: form of the generated guard, "" for the C header.
unsigned guard_signature(const Derating& derating, std::string_view form);

/// Returns the losses and the validity of the ramp as lines that begin with `comment`. `phase_per_dc_ratio` is the controller's current per
/// equivalent DC current.
std::string ramp_lines(const Derating& derating, RampSignal signal, const CurrentRamp& ramp, double phase_per_dc_ratio,
                       std::string_view comment);

/// Lists the effects that the motor has beyond the data sheet's, such as "chassis (third_node)"; "no additional effects" if there are none.
std::string own_effects_text(const Derating& derating);

/// Lists the motor's effects of these types; all additional effects if it has none of them.
std::string effects_text(const Derating& derating, const std::set<std::string>& types);

/// Throws Failure (bad_input) if a value that is exported is not finite.
void require_finite(const Derating& derating);

/// Throws Failure (bad_input) for a brushed motor, with the controller's name.
void require_brushless(std::string_view controller, const Derating& derating);

/// Throws Failure (bad_input) with the signal and the effects if a law depends on a signal other than current, speed and air temperature.
void require_three_signals(std::string_view controller, const Derating& derating);

/// Returns the value rounded to 12 significant digits, which drops the last digits of conversions: 0.0082 for 0.008199999999999999.
double rounded_to_12_digits(double value);

/// Returns the current rounded down to 1 mA, so that the limit stays on the safe side.
double rounded_down_A(double current_A);

/// Returns an upper bound rounded up to significant digits, so that "at most" stays true; as base::significant().
std::string significant_above(double value, int digits);

}  // namespace heatsoak::derate
