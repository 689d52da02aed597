#include "derate/rate_lines.h"

#include <fmt/format.h>

#include <algorithm>

namespace heatsoak::derate {
namespace {

/// Longest expression, in characters, that is written where it is used; a longer one gets a line of its own.
constexpr std::size_t kLongestInlined = 80;

bool is_arithmetic(thermal::Operation operation) {
  return operation == thermal::Operation::add || operation == thermal::Operation::subtract || operation == thermal::Operation::multiply ||
         operation == thermal::Operation::divide;
}

/// Returns whether the text of the operation contains its operand twice; the operand must then be a name.
bool repeats_its_operand(thermal::Operation operation) {
  return operation == thermal::Operation::magnitude || operation == thermal::Operation::positive_part;
}

}  // namespace

RateLines::RateLines(const Observer& observer, std::span<const int> rate_steps, const LineStyle& style)
    : observer_(observer), style_(style), uses_(observer.formula().steps().size(), 0), names_(observer) {
  const thermal::Formula& formula = observer.formula();
  const std::vector<char> needed = formula.needed_for(rate_steps);
  for (std::size_t i = 0; i < needed.size(); ++i) {
    const thermal::Formula::Step& step = formula.steps()[i];
    if (needed[i] == 0 || step.operation == thermal::Operation::constant || step.operation == thermal::Operation::input) {
      continue;
    }
    const int times = repeats_its_operand(step.operation) ? 2 : 1;
    uses_[static_cast<std::size_t>(step.left)] += times;
    if (step.right) {
      ++uses_[static_cast<std::size_t>(*step.right)];
    }
  }
  for (std::size_t i = 0; i < needed.size(); ++i) {
    const thermal::Formula::Step& step = formula.steps()[i];
    if (needed[i] == 0) {
      continue;
    }
    const int place = static_cast<int>(i);
    Text text = expression(step);
    if (step.operation != thermal::Operation::constant && step.operation != thermal::Operation::input &&
        (is_variable(place) || text.text.size() > kLongestInlined) && std::ranges::find(rate_steps, place) == rate_steps.end()) {
      const std::string name = names_.name_for(place);
      text_ += fmt::format("  const {} {} = {};\n", style_.number, name, text.text);
      text = {name, false};
    }
    written_[place] = text;
  }
  for (std::size_t node = 0; node < observer.state_count(); ++node) {
    text_ += fmt::format("  rate_K_per_s[{}] = {};\n", node, written_.at(rate_steps[node]).text);
  }
}

bool RateLines::is_variable(int place) const {
  const thermal::Formula& formula = observer_.formula();
  return uses_[static_cast<std::size_t>(place)] > 1 || !formula.name_of(place).empty() ||
         repeats_its_operand(formula.steps()[static_cast<std::size_t>(place)].operation);
}

std::string RateLines::operand(int place) const {
  const Text& text = written_.at(place);
  return text.is_joined ? fmt::format("({})", text.text) : text.text;
}

RateLines::Text RateLines::expression(const thermal::Formula::Step& step) {
  if (step.operation == thermal::Operation::constant) {
    return {style_.literal(step.value), false};
  }
  if (step.operation == thermal::Operation::input) {
    const auto input = static_cast<std::size_t>(step.left);
    return {input < observed::kSignalCount ? style_.signal(static_cast<observed::Signal>(input))
                                           : fmt::format("state_C[{}]", input - observed::kSignalCount),
            false};
  }
  const std::string left = written_.at(step.left).text;
  const std::string zero = style_.literal(0.0);
  const auto thermal_math = [&](std::string_view function) -> Text {
    calls_thermal_math_ = true;
    return {step.right ? fmt::format("{}({}, {})", function, left, written_.at(*step.right).text) : fmt::format("{}({})", function, left),
            false};
  };
  if (is_arithmetic(step.operation)) {
    const char sign = step.operation == thermal::Operation::add        ? '+'
                      : step.operation == thermal::Operation::subtract ? '-'
                      : step.operation == thermal::Operation::multiply ? '*'
                                                                       : '/';
    return {fmt::format("{} {} {}", operand(step.left), sign, operand(*step.right)), true};
  }
  switch (step.operation) {
    case thermal::Operation::magnitude:
      return {fmt::format("({0} < {1}) ? -{0} : {0}", left, zero), true};
    case thermal::Operation::positive_part:
      return {fmt::format("({0} > {1}) ? {0} : {1}", left, zero), true};
    case thermal::Operation::square_root:
      calls_square_root_ = true;
      return {fmt::format("{}({})", style_.square_root, left), false};
    case thermal::Operation::power:
      return thermal_math(style_.power);
    default:
      return thermal_math(style_.exponential);
  }
}

}  // namespace heatsoak::derate
