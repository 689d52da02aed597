#include "derate/step_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/quantity.h"
#include "derate/export_text.h"
#include "derate/unit_suffix.h"

namespace heatsoak::derate {
namespace {

using thermal::Operation;

/// Returns a number as a part of a name: "0_5" for 0.5, "minus_2" for -2.
std::string in_name(double value) {
  return (value < 0.0 ? "minus_" : "") + identifier(fmt::format("x{}", base::significant(std::abs(value), 6))).substr(1);
}

bool has_operands(Operation operation) { return operation != Operation::constant && operation != Operation::input; }
bool is_sum(Operation operation) { return operation == Operation::add || operation == Operation::subtract; }

}  // namespace

StepNames::StepNames(const Observer& observer, std::span<const int> rate_steps, std::set<std::string> reserved)
    : observer_(observer), names_(std::move(reserved)) {
  const thermal::Formula& formula = observer.formula();
  const std::vector<char> needed = formula.needed_for(rate_steps);
  for (std::size_t i = 0; i < needed.size(); ++i) {
    if (needed[i] != 0 && has_operands(formula.steps()[i].operation)) {
      ++uses_[formula.steps()[i].left];
      if (formula.steps()[i].right) {
        ++uses_[*formula.steps()[i].right];
      }
    }
  }
  name_rates(rate_steps);
  // Twice: an operand that gets its name from its user can give one to the other operand.
  for (int pass = 0; pass < 2; ++pass) {
    for (std::size_t i = 0; i < needed.size(); ++i) {
      if (needed[i] != 0) {
        name_from_operands(static_cast<int>(i), pass > 0);
      }
    }
    for (std::size_t i = needed.size(); i-- > 0;) {
      if (needed[i] != 0 && has_operands(formula.steps()[i].operation)) {
        name_operands_of(static_cast<int>(i));
      }
    }
  }
}

const thermal::Formula::Step& StepNames::step(int place) const { return observer_.formula().steps()[static_cast<std::size_t>(place)]; }

bool StepNames::is_constant(int place) const { return step(place).operation == Operation::constant; }

bool StepNames::is_one(int place) const { return is_constant(place) && step(place).value == 1.0; }

std::string StepNames::known(int place) const {
  if (step(place).operation == Operation::input) {
    return observer_.formula().inputs()[static_cast<std::size_t>(step(place).left)];
  }
  const std::string_view named = observer_.formula().name_of(place);
  if (!named.empty()) {
    return std::string(named);
  }
  const auto derived = derived_.find(place);
  return derived == derived_.end() ? std::string() : derived->second;
}

void StepNames::suggest(int place, const std::string& name) {
  if (!name.empty() && known(place).empty()) {
    derived_.emplace(place, name);
  }
}

/// A step with several users has a meaning of its own, which no single one of them states.
void StepNames::suggest_by_user(int place, const std::string& name) {
  if (uses_[place] == 1) {
    suggest(place, name);
  }
}

/// A rate is a node's heat divided by its heat capacity; the heat is its losses times the safety factor, plus the heat that flows in.
void StepNames::name_rates(std::span<const int> rate_steps) {
  for (std::size_t node = 0; node < rate_steps.size(); ++node) {
    const int rate = rate_steps[node];
    const std::string& name = observer_.state_names()[node];
    derived_.insert_or_assign(rate, fmt::format("{}_rate_K_per_s", name));
    if (step(rate).operation != Operation::multiply) {
      continue;
    }
    const int heat = is_constant(step(rate).left) ? *step(rate).right : step(rate).left;
    suggest(heat, fmt::format("{}_heat_W", name));
    suggest(heat == step(rate).left ? *step(rate).right : step(rate).left, fmt::format("{}_rate_K_per_J", name));
    for (const int part : {step(heat).left, step(heat).right.value_or(step(heat).left)}) {
      if (!is_sum(step(heat).operation) || !known(part).empty()) {
        continue;
      }
      const bool is_guarded = step(part).operation == Operation::multiply && is_constant(step(part).left) &&
                              step(step(part).left).value == observer_.heat_safety_factor();
      if (is_guarded) {
        derived_.insert_or_assign(step(part).left, "heat_safety_factor_ratio");  // one step for all nodes
        suggest(*step(part).right, fmt::format("{}_losses_W", name));
        suggest(part, fmt::format("guarded_{}", known(*step(part).right)));
      } else if (part == step(heat).right.value_or(-1)) {
        suggest(part, fmt::format("{}_{}_W", name, step(heat).operation == Operation::add ? "inflow" : "outflow"));
      }
    }
  }
}

void StepNames::name_from_operands(int place, bool is_last) {
  const thermal::Formula::Step& here = step(place);
  if (here.operation == Operation::constant || here.operation == Operation::input || !known(place).empty()) {
    return;
  }
  const NameWithUnit left = split_name(known(here.left));
  const NameWithUnit right = here.right ? split_name(known(*here.right)) : NameWithUnit();
  const auto is_temperature = [](const NameWithUnit& name) {
    return name.dividend == std::vector<std::string>{"C"} && name.divisor.empty();
  };
  if (here.operation == Operation::subtract && is_temperature(left) && is_constant(*here.right)) {
    const std::string reference = in_name(step(*here.right).value);
    suggest(place, fmt::format("{}_above_{}C_K", left.stem, reference));
    suggest(*here.right, fmt::format("temperature_{}_C", reference));
  } else if (here.operation == Operation::subtract && is_temperature(left) && is_temperature(right)) {
    suggest(place, fmt::format("{}_above_{}_K", left.stem, right.stem));
  } else if (here.operation == Operation::multiply && here.left == *here.right && left.has_unit) {
    suggest(place, squared_name(left));
  } else if (here.operation == Operation::magnitude && left.has_unit) {
    suggest(place, with_word(left, "magnitude"));
  } else if (here.operation == Operation::positive_part && left.has_unit) {
    suggest(place, with_word(left, "if_positive"));
  } else if (is_last && here.operation == Operation::multiply && (is_constant(here.left) || is_constant(*here.right))) {
    // Without a unit, because that of the constant is not known.
    const NameWithUnit& other = is_constant(here.left) ? right : left;
    suggest(place, other.has_unit ? fmt::format("{}_scaled", other.stem) : std::string());
  }
}

void StepNames::name_operands_of(int place) {
  const thermal::Formula::Step& here = step(place);
  const NameWithUnit name = split_name(known(place));
  if (!name.has_unit) {
    return;
  }
  switch (here.operation) {
    case Operation::add:
    case Operation::subtract:
      return name_addends(place, name);
    case Operation::multiply:
      return name_factors(place, name);
    case Operation::divide:
      suggest_by_user(here.left, name_of_quotient(name, split_name(known(*here.right)), true));
      return suggest_by_user(*here.right, name_of_quotient(split_name(known(here.left)), name));
    case Operation::square_root:
      return suggest_by_user(here.left, squared_name(name));
    case Operation::magnitude:
    case Operation::positive_part:
      return suggest_by_user(here.left, with_word(name, "signed"));
    default:
      return;
  }
}

void StepNames::name_addends(int place, const NameWithUnit& sum) {
  const int left = step(place).left;
  const int right = *step(place).right;
  const bool is_around_one = is_one(left) || is_one(right);
  // Parts of a part are parts of the whole.
  NameWithUnit whole = sum;
  if (whole.stem.ends_with("_part")) {
    whole.stem.resize(whole.stem.size() - std::string_view("_part").size());
  }
  for (const int part : {left, right}) {
    if (!is_one(part)) {
      suggest_by_user(part, with_word(whole, is_around_one ? "change" : "part"));
    }
  }
}

void StepNames::name_factors(int place, const NameWithUnit& product) {
  const int left = step(place).left;
  const int right = *step(place).right;
  for (const auto& [factor, other] : {std::pair(left, right), std::pair(right, left)}) {
    const bool is_around_one = is_sum(step(factor).operation) && (is_one(step(factor).left) || is_one(*step(factor).right));
    if (is_around_one) {
      suggest_by_user(factor, fmt::format("{}_ratio", product.stem));
    }
    const NameWithUnit known_other = split_name(known(other));
    const bool is_pure = known_other.has_unit && known_other.dividend.empty() && known_other.divisor.empty();
    suggest_by_user(factor, !is_pure              ? name_of_quotient(product, known_other)
                            : is_constant(factor) ? with_word(product, "scale")
                                                  : std::string());
  }
}

std::string StepNames::fallback_name(int place) const {
  const thermal::Formula& formula = observer_.formula();
  if (!is_constant(place)) {
    const std::string_view law = formula.law_of(place);
    return fmt::format("{}_{}", law.empty() ? "operating_point" : law,
                       step(place).operation == Operation::exponential || step(place).operation == Operation::power ? "power" : "operand");
  }
  // Equal constants are one step, so one that several laws use has no meaning of its own.
  const double value = step(place).value;
  return value == 1.0   ? "one"
         : value == 2.0 ? "two"
         : value == 0.5 ? "half"
         : value == 0.0 ? "zero"
                        : fmt::format("number_{}", in_name(value));
}

std::string StepNames::name_for(int place) {
  std::string name = known(place);
  name = identifier(name.empty() ? fallback_name(place) : name);
  std::string unique = name;
  const NameWithUnit split = split_name(name);
  for (int next = 2; !names_.insert(unique).second; ++next) {
    unique = with_word(split, std::to_string(next));
  }
  return unique;
}

}  // namespace heatsoak::derate
