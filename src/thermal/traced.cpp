#include "thermal/traced.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <type_traits>

#include "robot_core/thermal_math.h"
#include "thermal/lanes.h"

namespace heatsoak::thermal {
namespace {

// Single precision uses the functions of the controller, so that host and controller give identical bits.
double exponential_of(double x) { return std::exp(x); }
float exponential_of(float x) { return heatsoak_exp(x); }
double power_of(double base, double exponent) { return base > 0.0 ? std::pow(base, exponent) : 0.0; }
float power_of(float base, float exponent) { return heatsoak_pow(base, exponent); }

// Evaluated lane by lane, because Eigen's own functions differ in the last digit.
Lanes exponential_of(const Lanes& x) { return exponential(x); }
Lanes power_of(const Lanes& base, const Lanes& exponent) { return power(base, exponent); }
SingleLanes exponential_of(const SingleLanes& x) {
  return x.unaryExpr([](float each) { return exponential_of(each); });
}
SingleLanes power_of(const SingleLanes& base, const SingleLanes& exponent) {
  return base.binaryExpr(exponent, [](float b, float e) { return power_of(b, e); });
}

template <class Number>
Number magnitude_of(Number x) {
  return std::abs(x);
}
Lanes magnitude_of(const Lanes& x) { return x.abs(); }
SingleLanes magnitude_of(const SingleLanes& x) { return x.abs(); }
template <class Number>
Number positive_part_of(Number x) {
  return x > Number{0} ? x : Number{0};
}
Lanes positive_part_of(const Lanes& x) { return x.max(0.0); }
SingleLanes positive_part_of(const SingleLanes& x) { return x.max(0.0F); }
template <class Number>
Number square_root_of(Number x) {
  return std::sqrt(x);
}
Lanes square_root_of(const Lanes& x) { return x.sqrt(); }
SingleLanes square_root_of(const SingleLanes& x) { return x.sqrt(); }

template <class Number>
Number constant_of(double value) {
  if constexpr (std::is_same_v<Number, Lanes>) {
    return Lanes::Constant(value);
  } else if constexpr (std::is_same_v<Number, SingleLanes>) {
    return SingleLanes::Constant(static_cast<float>(value));
  } else {
    return static_cast<Number>(value);
  }
}

template <class Number>
Number worked_out(Operation operation, const Number& a, const Number& b) {
  switch (operation) {
    case Operation::add:
      return a + b;
    case Operation::subtract:
      return a - b;
    case Operation::multiply:
      return a * b;
    case Operation::divide:
      return a / b;
    case Operation::magnitude:
      return magnitude_of(a);
    case Operation::positive_part:
      return positive_part_of(a);
    case Operation::square_root:
      return square_root_of(a);
    case Operation::power:
      return power_of(a, b);
    case Operation::exponential:
      return exponential_of(a);
    default:
      throw std::logic_error("no arithmetic");
  }
}

}  // namespace

int Formula::place_of(const Step& step) {
  const auto [found, is_new] = known_.try_emplace({step.operation, step.left, step.right, std::bit_cast<std::uint64_t>(step.value)},
                                                  static_cast<int>(steps_.size()));
  if (is_new) {
    steps_.push_back(step);
  }
  return found->second;
}

int Formula::constant(double value) { return place_of({.operation = Operation::constant, .value = value}); }

int Formula::input(std::string name) {
  inputs_.push_back(std::move(name));
  return place_of({.operation = Operation::input, .left = static_cast<int>(inputs_.size()) - 1});
}

int Formula::apply(Operation operation, int left, std::optional<int> right) { return place_of({operation, left, right}); }

void Formula::name(int step, std::string name) {
  const Operation operation = steps_[static_cast<std::size_t>(step)].operation;
  if (operation != Operation::constant && operation != Operation::input) {
    names_.try_emplace(step, std::move(name));
  }
}

std::string_view Formula::name_of(int step) const {
  const auto found = names_.find(step);
  return found == names_.end() ? std::string_view() : found->second;
}

bool Formula::has_name(std::string_view name) const {
  return std::ranges::any_of(names_, [name](const auto& each) { return each.second == name; });
}

std::string_view Formula::law_of(int step) const {
  const auto after = laws_.upper_bound(step);
  return after == laws_.begin() ? std::string_view() : std::prev(after)->second;
}

std::vector<char> Formula::needed_for(std::span<const int> results) const {
  std::vector<char> needed(steps_.size(), 0);
  for (const int result : results) {
    needed[static_cast<std::size_t>(result)] = 1;
  }
  for (std::size_t place = steps_.size(); place-- > 0;) {
    const Step& step = steps_[place];
    if (needed[place] == 0 || step.operation == Operation::input || step.operation == Operation::constant) {
      continue;
    }
    needed[static_cast<std::size_t>(step.left)] = 1;
    if (step.right) {
      needed[static_cast<std::size_t>(*step.right)] = 1;
    }
  }
  return needed;
}

template <class Number>
FormulaRun<Number>::FormulaRun(const Formula& formula, std::span<const int> results) : input_count_(formula.inputs().size()) {
  const std::vector<char> needed = formula.needed_for(results);
  std::vector<std::optional<int>> place(formula.steps().size());
  values_.resize(input_count_);
  for (std::size_t i = 0; i < place.size(); ++i) {
    const Formula::Step& step = formula.steps()[i];
    if (step.operation == Operation::input) {
      place[i] = step.left;
    } else if (step.operation == Operation::constant && needed[i] != 0) {
      place[i] = static_cast<int>(values_.size());
      values_.push_back(constant_of<Number>(step.value));
    }
  }
  first_step_ = values_.size();
  for (std::size_t i = 0; i < place.size(); ++i) {
    if (needed[i] == 0 || place[i]) {
      continue;
    }
    const Formula::Step& step = formula.steps()[i];
    const auto place_of = [&place](int operand) { return place[static_cast<std::size_t>(operand)].value(); };
    steps_.push_back({step.operation, place_of(step.left), place_of(step.right.value_or(step.left))});
    place[i] = static_cast<int>(values_.size());
    values_.push_back(constant_of<Number>(0.0));
  }
  for (const int result : results) {
    result_place_.push_back(place[static_cast<std::size_t>(result)].value());
  }
}

template <class Number>
void FormulaRun<Number>::run(std::span<const Number> inputs, std::span<Number> results) {
  std::copy_n(inputs.begin(), input_count_, values_.begin());
  std::size_t to = first_step_;
  for (const Step& step : steps_) {
    values_[to++] =
        worked_out<Number>(step.operation, values_[static_cast<std::size_t>(step.left)], values_[static_cast<std::size_t>(step.right)]);
  }
  for (std::size_t i = 0; i < result_place_.size(); ++i) {
    results[i] = values_[static_cast<std::size_t>(result_place_[i])];
  }
}

template class FormulaRun<float>;
template class FormulaRun<double>;
template class FormulaRun<Lanes>;
template class FormulaRun<SingleLanes>;

Traced Traced::joined(Operation operation, const Traced& a, const Traced& b) {
  if (a.is_constant() && b.is_constant()) {
    return {worked_out(operation, a.value_, b.value_)};
  }
  Formula& formula = a.is_constant() ? *b.formula_ : *a.formula_;
  const int left = a.step_in(formula);
  return {formula, formula.apply(operation, left, b.step_in(formula))};
}

void Traced::name(std::string_view name, std::string_view otherwise) const {
  if (!is_constant()) {
    formula_->name(step_, std::string(formula_->has_name(name) ? otherwise : name));
  }
}

std::string Traced::input_without_unit() const {
  if (is_constant() || formula_->steps()[static_cast<std::size_t>(step_)].operation != Operation::input) {
    return {};
  }
  const std::string& name = formula_->inputs()[static_cast<std::size_t>(formula_->steps()[static_cast<std::size_t>(step_)].left)];
  return name.substr(0, name.rfind('_'));
}

std::optional<Traced> Traced::negated() const {
  if (is_constant()) {
    return std::nullopt;
  }
  const std::span<const Formula::Step> steps = formula_->steps();
  const Formula::Step& step = steps[static_cast<std::size_t>(step_)];
  const bool is_negative = step.operation == Operation::subtract &&
                           steps[static_cast<std::size_t>(step.left)].operation == Operation::constant &&
                           steps[static_cast<std::size_t>(step.left)].value == 0.0;
  return is_negative ? std::optional(Traced(*formula_, step.right.value())) : std::nullopt;
}

Traced operator+(const Traced& a, const Traced& b) {
  if (a.is(0.0) || b.is(0.0)) {
    return a.is(0.0) ? b : a;
  }
  if (const std::optional<Traced> taken_off = b.negated()) {
    return Traced::joined(Operation::subtract, a, *taken_off);
  }
  if (const std::optional<Traced> taken_off = a.negated()) {
    return Traced::joined(Operation::subtract, b, *taken_off);
  }
  return Traced::joined(Operation::add, a, b);
}

Traced operator-(const Traced& a, const Traced& b) {
  if (b.is(0.0)) {
    return a;
  }
  // Heat that leaves a node twice: rounding does not depend on the sign.
  const std::optional<Traced> first = a.negated();
  return first ? -(*first + b) : Traced::joined(Operation::subtract, a, b);
}

Traced operator*(const Traced& a, const Traced& b) {
  if (a.is(0.0) || b.is(0.0)) {
    return {0.0};
  }
  return a.is(1.0) ? b : b.is(1.0) ? a : Traced::joined(Operation::multiply, a, b);
}

Traced operator/(const Traced& a, const Traced& b) {
  if (b.is_constant() && !a.is_constant()) {
    return a * Traced(1.0 / b.value_);  // on the controller a division takes 14 cycles, a multiplication one
  }
  return Traced::joined(Operation::divide, a, b);
}

Traced applied(Operation operation, const Traced& x) {
  return x.is_constant() ? Traced(worked_out(operation, x.value_, 0.0)) : Traced(*x.formula_, x.formula_->apply(operation, x.step_));
}

Traced power(const Traced& base, const Traced& exponent) { return Traced::joined(Operation::power, base, exponent); }

Traced difference_K(const Traced& hot_C, const Traced& cold_C) {
  const std::string hot = hot_C.input_without_unit();
  const std::string cold = cold_C.input_without_unit();
  const Traced difference = hot_C - cold_C;
  return hot.empty() || cold.empty() ? difference : named(hot + "_above_" + cold + "_K", difference);
}

int chosen(const Traced& parameter) {
  if (!parameter.is_constant()) {
    throw std::logic_error("a choice is no variable");
  }
  return static_cast<int>(parameter.value());
}

}  // namespace heatsoak::thermal
