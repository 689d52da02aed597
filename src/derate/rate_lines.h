// Generates the observer's rates as straight-line statements of a C-like language.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "derate/observer.h"

namespace heatsoak {

/// Syntax of the target language.
struct LineStyle {
  std::string (*literal)(double value) = nullptr;            ///< in the precision of `number`; in parentheses where negative
  std::string (*signal)(firmware::Signal signal) = nullptr;  ///< an input
  std::string_view square_root;                              ///< function of one number
  std::string_view number = "float";                         ///< type of the steps
  std::string_view exponential = "heatsoak_exp";             ///< function of one number
  std::string_view power = "heatsoak_pow";                   ///< of a base and an exponent; 0 for a base that is not positive
};

/// One line per step that the rates depend on, "  const float t7 = …;", then one per node, "  rate_K_per_s[node] = …;". Temperatures are
/// state_C[node]. In single precision without contraction (FMA) the results are bit-identical to FormulaRun<float>.
class RateLines {
 public:
  /// `rate_steps`: one of the observer's sets, one step per state.
  RateLines(const Observer& observer, std::span<const int> rate_steps, const LineStyle& style);

  [[nodiscard]] const std::string& text() const { return text_; }
  /// True if a law uses the square root, which IEEE 754 rounds correctly and is therefore bit-identical everywhere.
  [[nodiscard]] bool calls_square_root() const { return calls_square_root_; }
  /// True if a law uses the exponential or the power of robot_core/thermal_math.h.
  [[nodiscard]] bool calls_thermal_math() const { return calls_thermal_math_; }

 private:
  [[nodiscard]] std::string operand(const Formula& formula, int place) const;
  std::string expression(const Formula& formula, const Formula::Step& step);

  LineStyle style_;
  std::string text_;
  bool calls_square_root_ = false;
  bool calls_thermal_math_ = false;
};

}  // namespace heatsoak
