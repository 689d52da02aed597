#include "derate/rate_lines.h"

#include <fmt/format.h>

#include <vector>

namespace heatsoak {

RateLines::RateLines(const Observer& observer, std::span<const int> rate_steps, const LineStyle& style) : style_(style) {
  const Formula& formula = observer.formula();
  const std::vector<char> needed = formula.needed_for(rate_steps);
  for (std::size_t i = 0; i < needed.size(); ++i) {
    const Formula::Step& step = formula.steps()[i];
    if (needed[i] != 0 && step.operation != Operation::constant && step.operation != Operation::input) {
      text_ += fmt::format("  const {} t{} = {};\n", style_.number, i, expression(formula, step));
    }
  }
  for (std::size_t node = 0; node < observer.state_count(); ++node) {
    text_ += fmt::format("  rate_K_per_s[{}] = {};\n", node, operand(formula, rate_steps[node]));
  }
}

std::string RateLines::operand(const Formula& formula, int place) const {
  const Formula::Step& step = formula.steps()[static_cast<std::size_t>(place)];
  if (step.operation == Operation::constant) {
    return style_.literal(step.value);
  }
  if (step.operation != Operation::input) {
    return fmt::format("t{}", place);
  }
  const auto input = static_cast<std::size_t>(step.left);
  return input < firmware::kSignalCount ? style_.signal(static_cast<firmware::Signal>(input))
                                        : fmt::format("state_C[{}]", input - firmware::kSignalCount);
}

std::string RateLines::expression(const Formula& formula, const Formula::Step& step) {
  const std::string left = operand(formula, step.left);
  const std::string right = step.right < 0 ? "" : operand(formula, step.right);
  const std::string zero = style_.literal(0.0);
  const auto thermal_math = [&](std::string_view function) {
    calls_thermal_math_ = true;
    return step.right < 0 ? fmt::format("{}({})", function, left) : fmt::format("{}({}, {})", function, left, right);
  };
  switch (step.operation) {
    case Operation::add:
      return left + " + " + right;
    case Operation::subtract:
      return left + " - " + right;
    case Operation::multiply:
      return left + " * " + right;
    case Operation::divide:
      return left + " / " + right;
    case Operation::magnitude:
      return fmt::format("{0} < {1} ? -{0} : {0}", left, zero);
    case Operation::positive_part:
      return fmt::format("{0} > {1} ? {0} : {1}", left, zero);
    case Operation::square_root:
      calls_square_root_ = true;
      return fmt::format("{}({})", style_.square_root, left);
    case Operation::power:
      return thermal_math(style_.power);
    default:
      return thermal_math(style_.exponential);
  }
}

}  // namespace heatsoak
