// A number that records how it was computed. A law written for `double` also runs on it and leaves a formula: straight-line code that can
// be run in single precision or printed as C.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace heatsoak::thermal {

enum class Operation { constant, input, add, subtract, multiply, divide, magnitude, positive_part, square_root, power, exponential };

/// Arithmetic steps in executable order; each uses earlier steps only. Identical steps are stored once.
class Formula {
 public:
  struct Step {
    Operation operation = Operation::constant;
    int left = 0;                   ///< index of a step, or of the input; unused by a constant
    std::optional<int> right = {};  ///< index of a step; empty for operations with one operand
    double value = 0.0;             ///< value of a constant
  };

  [[nodiscard]] std::span<const Step> steps() const { return steps_; }
  [[nodiscard]] std::span<const std::string> inputs() const { return inputs_; }
  /// Returns for each step whether one of `results` (indices of steps) depends on it.
  [[nodiscard]] std::vector<char> needed_for(std::span<const int> results) const;

  int constant(double value);
  int input(std::string name);
  int apply(Operation operation, int left, std::optional<int> right = {});

  /// Names the value of a step for generated code. The first name of a step stays; constants and inputs get none. Steps may share a name.
  void name(int step, std::string name);
  /// Returns the name of a step; empty if it has none.
  [[nodiscard]] std::string_view name_of(int step) const;
  [[nodiscard]] bool has_name(std::string_view name) const;
  /// Starts a law: all later steps belong to it, until the next law starts.
  void begin_law(std::string law) { laws_[static_cast<int>(steps_.size())] = std::move(law); }
  /// Returns the law of a step; empty before the first law.
  [[nodiscard]] std::string_view law_of(int step) const;

 private:
  int place_of(const Step& step);

  std::vector<Step> steps_;
  std::vector<std::string> inputs_;
  std::map<int, std::string> names_;  ///< names by step
  std::map<int, std::string> laws_;   ///< laws by their first step
  std::map<std::tuple<Operation, int, std::optional<int>, std::uint64_t>, int>
      known_;  ///< index of each step by its content; constants by their bits
};

/// Evaluates the steps that some results need, in the precision of Number. run() does not allocate.
template <class Number>
class FormulaRun {
 public:
  FormulaRun(const Formula& formula, std::span<const int> results);

  /// `inputs` in the formula's order, `results` in the order given to the constructor.
  void run(std::span<const Number> inputs, std::span<Number> results);

 private:
  struct Step {
    Operation operation;
    int left;
    int right;  ///< same as `left` for operations with one operand
  };
  std::vector<Step> steps_;     ///< all steps except constants and inputs, with indices into values_
  std::vector<Number> values_;  ///< inputs, constants, then one per step
  std::size_t input_count_ = 0;
  std::size_t first_step_ = 0;
  std::vector<int> result_place_;
};
extern template class FormulaRun<float>;
extern template class FormulaRun<double>;

/// A constant has no formula until it is combined with a number that has one. Operations on constants are evaluated immediately.
class Traced {
 public:
  Traced(double value = 0.0) : value_(value) {}  // NOLINT(google-explicit-constructor): laws mix it with numbers
  Traced(Formula& formula, int step) : formula_(&formula), step_(step) {}

  [[nodiscard]] bool is_constant() const { return formula_ == nullptr; }
  /// Returns the value of a constant; must not be called for a formula.
  [[nodiscard]] double value() const { return value_; }
  /// Returns the formula; null for a constant.
  [[nodiscard]] Formula* formula() const { return formula_; }
  /// Returns the index of its step in the formula; a constant is added to it.
  [[nodiscard]] int step_in(Formula& formula) const { return is_constant() ? formula.constant(value_) : step_; }

  /// Returns the name of a temperature that is an input, without its unit; empty for any other number.
  [[nodiscard]] std::string input_without_unit() const;
  /// Formula::name() of its step with `name` or, if another step has that name, with `otherwise`; no effect for a constant.
  void name(std::string_view name, std::string_view otherwise) const;

  Traced& operator+=(const Traced& other) { return *this = *this + other; }
  Traced& operator-=(const Traced& other) { return *this = *this - other; }
  Traced operator-() const { return 0.0 - *this; }
  friend Traced operator+(const Traced& a, const Traced& b);
  friend Traced operator-(const Traced& a, const Traced& b);
  friend Traced operator*(const Traced& a, const Traced& b);
  friend Traced operator/(const Traced& a, const Traced& b);
  friend Traced applied(Operation operation, const Traced& x);
  friend Traced power(const Traced& base, const Traced& exponent);

 private:
  static Traced joined(Operation operation, const Traced& a, const Traced& b);
  /// Returns x for a number that was computed as 0 − x.
  [[nodiscard]] std::optional<Traced> negated() const;
  [[nodiscard]] bool is(double value) const { return is_constant() && value_ == value; }

  Formula* formula_ = nullptr;
  int step_ = 0;  ///< unused by a constant
  double value_ = 0.0;
};

Traced operator+(const Traced& a, const Traced& b);
Traced operator-(const Traced& a, const Traced& b);
Traced operator*(const Traced& a, const Traced& b);
Traced operator/(const Traced& a, const Traced& b);
/// Applies an operation with one operand.
Traced applied(Operation operation, const Traced& x);

// The functions of scalar.h.
inline Traced magnitude(const Traced& x) { return applied(Operation::magnitude, x); }
inline Traced positive_part(const Traced& x) { return applied(Operation::positive_part, x); }
inline Traced exponential(const Traced& x) { return applied(Operation::exponential, x); }
inline Traced soft_positive_part(const Traced& x, double width) {
  return 0.5 * (x + applied(Operation::square_root, x * x + width * width));
}
inline Traced soft_step(const Traced& x) { return 1.0 / (1.0 + exponential(-x)); }
Traced power(const Traced& base, const Traced& exponent);
inline const Traced& named(std::string_view name, const Traced& quantity) {
  quantity.name(name, name);
  return quantity;
}
Traced difference_K(const Traced& hot_C, const Traced& cold_C);
/// Throws std::logic_error if the choice is not a constant.
int chosen(const Traced& parameter);

/// Heat as formulas. Moved and generated heat are kept apart, because a safety factor on heat applies to generated heat only.
struct TracedHeat {
  Traced moved_W;
  Traced made_W;
};

}  // namespace heatsoak::thermal
