#include "derate/rate_lines.h"

#include <fmt/format.h>

#include <algorithm>

namespace heatsoak::derate {
namespace {

char sign_of(thermal::Operation operation) {
  switch (operation) {
    case thermal::Operation::add:
      return '+';
    case thermal::Operation::subtract:
      return '-';
    case thermal::Operation::multiply:
      return '*';
    case thermal::Operation::divide:
      return '/';
    default:
      return '\0';
  }
}

bool is_arithmetic(thermal::Operation operation) { return sign_of(operation) != '\0'; }

/// Returns whether C writes the operation with operators instead of a function.
bool is_in_place(thermal::Operation operation) {
  return is_arithmetic(operation) || operation == thermal::Operation::magnitude || operation == thermal::Operation::positive_part;
}

}  // namespace

RateLines::RateLines(const Observer& observer, std::span<const int> rate_steps, const LineStyle& style)
    : observer_(observer), style_(style), names_(style.reserved) {
  const thermal::Formula& formula = observer.formula();
  const std::vector<char> needed = formula.needed_for(rate_steps);
  for (std::size_t i = 0; i < needed.size(); ++i) {
    if (needed[i] == 0) {
      continue;
    }
    const int place = static_cast<int>(i);
    Text text = expression(formula.steps()[i]);
    if (!formula.name_of(place).empty() && std::ranges::find(rate_steps, place) == rate_steps.end()) {
      const std::string name = variable(names_.add(formula.name_of(place)));
      text_ += style_.notation == Notation::lisp ? fmt::format("  (var {} {})\n", name, text.text)
                                                 : fmt::format("  const {} {} = {};\n", style_.number, name, text.text);
      text = {name, false};
    }
    written_[place] = text;
  }
  for (std::size_t node = 0; node < observer.state_count(); ++node) {
    const std::string& rate = written_.at(rate_steps[node]).text;
    text_ += style_.notation == Notation::lisp
                 ? fmt::format("  (var {} {})\n", variable(fmt::format("{}_rate_K_per_s", identifier(observer.state_names()[node]))), rate)
                 : fmt::format("  rate_K_per_s[{}] = {};\n", node, rate);
  }
}

std::string lisp_name(std::string_view prefix, std::string name) {
  std::ranges::replace(name, '_', '-');
  return fmt::format("{}{}", prefix, name);
}

std::string RateLines::variable(const std::string& name) const {
  return style_.notation == Notation::lisp ? lisp_name(style_.prefix, name) : name;
}

std::string RateLines::input(std::size_t place) const {
  if (place < observed::kSignalCount) {
    return style_.signal(static_cast<observed::Signal>(place));
  }
  const std::size_t node = place - observed::kSignalCount;
  return style_.notation == Notation::lisp ? variable(fmt::format("{}_C", identifier(observer_.state_names()[node])))
                                           : fmt::format("state_C[{}]", node);
}

std::string RateLines::operand(int place) const {
  const Text& text = written_.at(place);
  return text.is_joined ? fmt::format("({})", text.text) : text.text;
}

RateLines::Text RateLines::expression(const thermal::Formula::Step& step) {
  using thermal::Operation;
  if (step.operation == Operation::constant) {
    return {style_.literal(step.value), false};
  }
  if (step.operation == Operation::input) {
    return {input(static_cast<std::size_t>(step.left)), false};
  }
  calls_square_root_ = calls_square_root_ || step.operation == Operation::square_root;
  calls_thermal_math_ = calls_thermal_math_ || step.operation == Operation::power || step.operation == Operation::exponential;
  const std::string_view function = step.operation == Operation::square_root ? style_.square_root
                                    : step.operation == Operation::power     ? style_.power
                                                                             : style_.exponential;
  const std::string& left = written_.at(step.left).text;
  const std::string right = step.right ? written_.at(*step.right).text : "";
  if (style_.notation == Notation::c) {
    return is_in_place(step.operation) ? infix(step)
           : step.right                ? Text{fmt::format("{}({}, {})", function, left, right), false}
                                       : Text{fmt::format("{}({})", function, left), false};
  }
  if (is_arithmetic(step.operation)) {
    return {fmt::format("({} {} {})", sign_of(step.operation), left, right), false};
  }
  const std::string zero = style_.literal(0.0);
  switch (step.operation) {
    case Operation::magnitude:
      return {fmt::format("(if (< {0} {1}) (- {1} {0}) {0})", left, zero), false};
    case Operation::positive_part:
      return {fmt::format("(if (> {0} {1}) {0} {1})", left, zero), false};
    default:
      return {fmt::format("({} {}{}{})", function, left, step.right ? " " : "", right), false};
  }
}

RateLines::Text RateLines::infix(const thermal::Formula::Step& step) {
  if (is_arithmetic(step.operation)) {
    return {fmt::format("{} {} {}", operand(step.left), sign_of(step.operation), operand(*step.right)), true};
  }
  const std::string left = operand(step.left);
  const std::string zero = style_.literal(0.0);
  return {step.operation == thermal::Operation::magnitude ? fmt::format("({0} < {1}) ? -{0} : {0}", left, zero)
                                                          : fmt::format("({0} > {1}) ? {0} : {1}", left, zero),
          true};
}

}  // namespace heatsoak::derate
