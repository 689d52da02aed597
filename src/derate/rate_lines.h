// Generates the observer's rates as statements of a C-like language.
#pragma once

#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "derate/export_text.h"
#include "derate/observer.h"

namespace heatsoak::derate {

enum class Notation {
  c,    ///< "  const float copper_loss_W = a * b;"; temperatures are state_C[node], results "  rate_K_per_s[node] = …;"
  lisp  ///< "  (var copper-loss-W (* a b))"; temperatures are winding-C, results "  (var winding-rate-K-per-s …)"
};

/// Syntax of the target language.
struct LineStyle {
  std::string (*literal)(double value) = nullptr;            ///< in the precision of `number`; in parentheses if negative
  std::string (*signal)(observed::Signal signal) = nullptr;  ///< expression for an input
  std::string_view square_root;                              ///< function of one number
  std::string_view number = "float";                         ///< type of the steps
  std::string_view exponential = "heatsoak_exp";             ///< function of one number
  std::string_view power = "heatsoak_pow";                   ///< function of a base and an exponent; 0 if the base is not positive
  Notation notation = Notation::c;
  std::string_view prefix = {};         ///< before every name in Lisp
  std::set<std::string> reserved = {};  ///< names that the generated code uses for something else, in the notation of C
};

/// Returns a name in Lisp: "hs-copper-loss-W" for the prefix "hs-" and "copper_loss_W".
std::string lisp_name(std::string_view prefix, std::string name);

/// One line per quantity that the formula names, then one per node. Other steps of the formula stand where they are used. In single
/// precision without contraction (FMA) the results are bit-identical to FormulaRun<float>.
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
  /// Text of a step as an operand: its name, or its expression if it has no name.
  struct Text {
    std::string text;
    bool is_joined = false;  ///< two operands and an operator, which need parentheses inside another expression
  };

  Text expression(const thermal::Formula::Step& step);
  Text infix(const thermal::Formula::Step& step);
  [[nodiscard]] std::string input(std::size_t place) const;
  [[nodiscard]] std::string variable(const std::string& name) const;
  [[nodiscard]] std::string operand(int place) const;

  const Observer& observer_;
  LineStyle style_;
  std::map<int, Text> written_;  ///< text of each step that was written
  UniqueNames names_;
  std::string text_;
  bool calls_square_root_ = false;
  bool calls_thermal_math_ = false;
};

}  // namespace heatsoak::derate
