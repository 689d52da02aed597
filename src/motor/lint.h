// Do the figures of a motor agree with each other, and what do they rest on?
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "motor/motor.h"

namespace heatsoak {

struct LintFinding {
  enum class Level {
    error,    ///< two figures contradict each other or nature: one of them is wrong
    warning,  ///< hardly possible, or contradicted by an estimate: look it up again
    note      ///< nothing is wrong, but who relies on the motor should know
  };
  Level level = Level::note;
  std::string check;    ///< name of the check, "constants"
  std::string message;  ///< what was found, what was expected, what to do
  Location at;
};

std::string_view to_string(LintFinding::Level level);

/// Every finding of every check whose figures the file gives. A motor that passes has no errors.
std::vector<LintFinding> lint(const Motor& motor);

/// Adds the errors of lint() to `diagnostics`. Where these hold problems already, the file was read in part only: then the effects, which
/// may name nodes that are missing, are left out of the check. A missing spread does not count, because a default takes its place,
/// nor does an error on a line that has a problem already.
void add_lint_errors(const Motor& motor, Diagnostics& diagnostics);

/// The nominal point seen by the thermal network.
struct NominalPointHeat {
  double equivalent_current_A = 0.0;  ///< I_eq = (T_n + K_t·I_0)/K_t: makes the nominal torque and the drag
  double limit_current_A = 0.0;       ///< brings the winding just to its limit at nominal speed and 25 °C ambient
};
/// Nothing where the file has no nominal torque or speed.
std::optional<NominalPointHeat> nominal_point_heat(const Motor& motor);

}  // namespace heatsoak
