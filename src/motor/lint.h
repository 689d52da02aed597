// Checks whether the values of a motor are consistent with each other, and how reliable they are.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "motor/lint_clause.h"
#include "motor/motor.h"

namespace heatsoak::motor {

/// Name of the check whose notes list estimated values.
inline constexpr std::string_view kEstimatesCheck = "estimates";

struct LintFinding {
  enum class Level {
    error,    ///< two values contradict each other or physics: one of them is wrong
    warning,  ///< unlikely, or contradicted by an estimate: check the source again
    note      ///< no fault, but relevant to the accuracy of results
  };
  Level level = Level::note;
  std::string check;  ///< name of the check, "constants"
  LintClause what;    ///< finding, expected value and advice
  base::Location at;
  std::string key = {};  ///< dotted path of the value that the finding is about; empty if the check's name states enough
};

std::string_view to_string(LintFinding::Level level);
/// Returns the finding as a sentence.
std::string message_of(const LintFinding& finding);
/// Returns the sentence after the key or, without a key, after the name of the check.
std::string words_of(const LintFinding& finding);

/// Runs all checks; each uses only values that the file gives. A motor passes if there are no errors.
std::vector<LintFinding> lint(const Motor& motor);

/// Returns the warnings of lint() about values: unlikely ones, and those that an estimate contradicts. Commands accept such a file but state
/// them. Missing spreads are not included, because defaults replace them.
std::vector<LintFinding> doubtful_values(const Motor& motor);

/// Adds the errors of lint() to `diagnostics`. If these already contain problems, the file was read incompletely: effects are then not
/// checked, because they may name missing nodes. Not added: missing spreads, which defaults replace, and errors on lines that already have
/// a problem.
void add_lint_errors(const Motor& motor, base::Diagnostics& diagnostics);

/// The nominal operating point according to the thermal network.
struct NominalPointHeat {
  double equivalent_current_A = 0.0;  ///< I_eq = (T_n + K_t·I_0)/K_t: current for nominal torque and drag
  double limit_current_A = 0.0;       ///< current that heats the winding exactly to its limit at nominal speed and 25 °C ambient
};
/// Returns nothing if the file lacks the nominal torque, the nominal speed or a value of the network.
std::optional<NominalPointHeat> nominal_point_heat(const Motor& motor);

}  // namespace heatsoak::motor
