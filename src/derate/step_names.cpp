#include "derate/step_names.h"

#include <fmt/format.h>

#include <algorithm>

#include "derate/export_text.h"

namespace heatsoak::derate {

std::string StepNames::name_for(int place) {
  const thermal::Formula& formula = observer_.formula();
  const thermal::Formula::Step& step = formula.steps()[static_cast<std::size_t>(place)];
  const auto input_name = [&](int of) {
    const thermal::Formula::Step& input = formula.steps()[static_cast<std::size_t>(of)];
    return input.operation == thermal::Operation::input ? formula.inputs()[static_cast<std::size_t>(input.left)] : std::string();
  };
  const auto without_unit = [](const std::string& name) { return name.substr(0, name.size() - 2); };
  std::string name(formula.name_of(place));
  const auto rate = std::ranges::find(observer_.rate_steps(), place);
  if (rate != observer_.rate_steps().end()) {
    name = fmt::format("{}_rate_K_per_s", observer_.state_names()[static_cast<std::size_t>(rate - observer_.rate_steps().begin())]);
  }
  if (step.operation == thermal::Operation::input) {
    name = input_name(place);
  }
  if (name.empty() && step.operation == thermal::Operation::subtract && input_name(step.left).ends_with("_C") &&
      input_name(*step.right).ends_with("_C")) {
    name = fmt::format("{}_above_{}_K", without_unit(input_name(step.left)), without_unit(input_name(*step.right)));
  }
  if (name.empty()) {
    // Equal constants are stored once, so their law is that of their first use.
    const bool is_constant = step.operation == thermal::Operation::constant;
    const auto uses = [&](const thermal::Formula::Step& other) {
      const bool has_operands = other.operation != thermal::Operation::constant && other.operation != thermal::Operation::input;
      return has_operands && (other.left == place || other.right == place);
    };
    const auto user = std::ranges::find_if(formula.steps(), uses);
    const bool is_used = is_constant && user != formula.steps().end();
    const std::string_view law = formula.law_of(is_used ? static_cast<int>(user - formula.steps().begin()) : place);
    name = fmt::format("{}_{}", law.empty() ? "drive" : law, is_constant ? "constant" : "term");
  }
  name = identifier(name);
  std::string unique = name;
  for (int next = 2; !names_.insert(unique).second; ++next) {
    unique = fmt::format("{}_{}", name, next);
  }
  return unique;
}

}  // namespace heatsoak::derate
