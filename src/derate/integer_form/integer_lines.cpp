#include "derate/integer_form/integer_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <set>

#include "base/diagnostic.h"
#include "base/unit_names.h"
#include "derate/c_header/c_text.h"
#include "derate/export_text.h"
#include "derate/plausible_range.h"

namespace heatsoak::derate::integer_form {
namespace {

constexpr int kNumberBits = 30;  ///< bits of a magnitude, so that the sum of two fits in 32 bits
constexpr int kMostBits = 44;    ///< most fraction bits, so that no shift of a product exceeds 62

double unit(int bits) { return std::ldexp(1.0, -bits); }

int bits_for(double low, double high) {
  const double most = std::max(std::abs(low), std::abs(high));
  return most > 0.0 ? std::min(kMostBits, kNumberBits - 1 - static_cast<int>(std::floor(std::log2(most)))) : kMostBits;
}

/// Writes the statements in one pass over the steps of a formula.
class Writer {
 public:
  Writer(const Derating& derating, const std::string& prefix)
      : derating_(derating),
        prefix_(prefix),
        formula_(derating.observer.formula()),
        unique_({"input", "state_C", "change"}),
        values_(formula_.steps().size()) {}

  IntegerLines write() {
    const Observer& observer = derating_.observer;
    const std::vector<char> needed = formula_.needed_for(observer.rate_steps());
    require_integer_functions(needed);
    for (std::size_t i = 0; i < needed.size(); ++i) {
      if (needed[i] != 0) {
        add_step(static_cast<int>(i));
      }
    }
    for (const int place : observer.rate_steps()) {
      lines_.rates.push_back(text(place));
      lines_.rate_K_per_s.push_back(values_[static_cast<std::size_t>(place)]);
    }
    return std::move(lines_);
  }

 private:
  /// Text of a step: its name, or its expression if it has no name.
  struct Text {
    std::string text;
    bool is_joined = false;  ///< needs parentheses beside an operator
  };

  [[nodiscard]] const std::string& text(int place) const { return written_.at(place).text; }
  [[nodiscard]] std::string operand(int place) const {
    return written_.at(place).is_joined ? fmt::format("({})", text(place)) : text(place);
  }
  [[nodiscard]] const FixedPoint& value(int place) const { return values_[static_cast<std::size_t>(place)]; }

  [[nodiscard]] base::Failure refusal(const std::set<std::string>& laws, std::string_view what) const {
    return {base::ExitCode::bad_input,
            fmt::format("c_header_q15 cannot express {}: {}; use --to c_header", effects_text(derating_, laws), what)};
  }
  [[nodiscard]] base::Failure refusal(int place, std::string_view what) const {
    return refusal({std::string(formula_.law_of(place))}, what);
  }

  /// Throws refusal() with every effect that needs a function without an integer implementation.
  void require_integer_functions(const std::vector<char>& needed) const {
    std::set<std::string> laws;
    for (std::size_t i = 0; i < needed.size(); ++i) {
      const thermal::Operation operation = formula_.steps()[i].operation;
      if (needed[i] != 0 && (operation == thermal::Operation::square_root || operation == thermal::Operation::power ||
                             operation == thermal::Operation::exponential)) {
        laws.emplace(formula_.law_of(static_cast<int>(i)));
      }
    }
    if (!laws.empty()) {
      throw refusal(laws, "its law needs a square root, a power or an exponential");
    }
  }

  /// Writes a line for a quantity with a name. Any other step stands where it is used.
  void set(int place, const FixedPoint& made, const Text& written) {
    values_[static_cast<std::size_t>(place)] = made;
    const thermal::Formula::Step& step = formula_.steps()[static_cast<std::size_t>(place)];
    const std::string_view given =
        step.operation == thermal::Operation::input ? formula_.inputs()[static_cast<std::size_t>(step.left)] : formula_.name_of(place);
    if (given.empty()) {
      written_[place] = written;
      return;
    }
    const std::string name = unique_.add(given);
    const std::optional<base::UnitOfName> unit = base::unit_of_name(name);
    lines_.text += fmt::format("  const int32_t {} = {}; /* 2^{}{} */\n", name, written.text, -made.bits,
                               unit && !unit->unit.empty() ? " " + unit->unit : "");
    written_[place] = {name, false};
  }

  void add_step(int place) {
    const thermal::Formula::Step& step = formula_.steps()[static_cast<std::size_t>(place)];
    switch (step.operation) {
      case thermal::Operation::constant:
        return add_constant(place, step.value);
      case thermal::Operation::input:
        return add_input(place, static_cast<std::size_t>(step.left));
      case thermal::Operation::add:
        return add_sum(place, step, 1.0);
      case thermal::Operation::subtract:
        return add_sum(place, step, -1.0);
      case thermal::Operation::multiply:
        return add_product(place, step);
      case thermal::Operation::divide:
        return add_quotient(place, step);
      case thermal::Operation::magnitude:
        return add_magnitude(place, step);
      case thermal::Operation::positive_part:
        return add_positive_part(place, step);
      default:
        return;  // refused by require_integer_functions()
    }
  }

  void add_constant(int place, double number) {
    FixedPoint made{.low = number, .high = number, .bits = bits_for(number, number), .most_error = 0.0};
    made.most_error = 0.5 * unit(made.bits);
    set(place, made, {constant_text(number, std::llround(std::ldexp(number, made.bits))), number < 0.0});
  }

  void add_input(int place, std::size_t input) {
    if (input >= observed::kSignalCount) {
      const double coldest_C = derating_.options.coldest_ambient_C - 1.0;
      return set(place, {.low = coldest_C, .high = double{kMostState_C}, .bits = kStateBits, .most_error = unit(kStateBits)},
                 {fmt::format("state_C[{}]", input - observed::kSignalCount), false});
    }
    const auto signal = static_cast<observed::Signal>(input);
    const PlausibleRange validated = plausible_range(derating_, signal);
    FixedPoint made{.low = validated.low, .high = validated.high, .bits = bits_for(validated.low, validated.high), .most_error = 0.0};
    // The factor 2^bits/1000 has 30 bits, which are those of kOneThousandth, and its own shift.
    const double per_thousandth = std::ldexp(1.0 / kThousandths_ratio, made.bits);
    const int shift = bits_for(per_thousandth, per_thousandth);
    made.most_error = unit(made.bits) + std::max(std::abs(made.low), std::abs(made.high)) * std::ldexp(1.0, -kNumberBits);
    set(place, made,
        {fmt::format("{}_product(input->{}, {}_ONE_THOUSANDTH, {})", prefix_, integer_name(signal), c_header::in_capitals(prefix_),
                     power_of_two(shift)),
         false});
  }

  [[nodiscard]] static std::string_view integer_name(observed::Signal signal) {
    return signal == observed::current ? "current_mA" : signal == observed::speed ? "speed_mrad_per_s" : "ambient_mC";
  }

  [[nodiscard]] static std::string power_of_two(int exponent) { return fmt::format("INT64_C({})", std::int64_t{1} << exponent); }

  [[nodiscard]] static std::string constant_text(double number, std::int64_t stored) {
    return fmt::format("{} /* {:.6g} */", stored, number);
  }

  [[nodiscard]] std::string shifted(int place, int to_bits) const {
    const int shift = value(place).bits - to_bits;
    if (shift == 0) {
      return operand(place);
    }
    const thermal::Formula::Step& step = formula_.steps()[static_cast<std::size_t>(place)];
    const std::int64_t stored = std::llround(std::ldexp(step.value, value(place).bits));
    if (step.operation == thermal::Operation::constant && stored >= 0 && stored % (std::int64_t{1} << shift) == 0) {
      return constant_text(step.value, stored >> shift);
    }
    return fmt::format("{}_product({}, 1, {})", prefix_, text(place), power_of_two(shift));
  }

  void add_sum(int place, const thermal::Formula::Step& step, double sign) {
    const FixedPoint& a = value(step.left);
    const FixedPoint& b = value(*step.right);
    FixedPoint made{.low = sign > 0.0 ? a.low + b.low : a.low - b.high,
                    .high = sign > 0.0 ? a.high + b.high : a.high - b.low,
                    .bits = 0,
                    .most_error = 0.0};
    made.bits = std::min({a.bits, b.bits, bits_for(made.low, made.high)});
    made.most_error =
        a.most_error + b.most_error + (a.bits > made.bits ? unit(made.bits) : 0.0) + (b.bits > made.bits ? unit(made.bits) : 0.0);
    set(place, made,
        {fmt::format("{} {} {}", shifted(step.left, made.bits), sign > 0.0 ? "+" : "-", shifted(*step.right, made.bits)), true});
  }

  void add_product(int place, const thermal::Formula::Step& step) {
    const FixedPoint& a = value(step.left);
    const FixedPoint& b = value(*step.right);
    const auto corners = {a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high};
    FixedPoint made{.low = std::min(corners), .high = std::max(corners), .bits = 0, .most_error = 0.0};
    if (step.left == step.right) {
      made.low = 0.0;
    }
    made.bits = std::min(bits_for(made.low, made.high), a.bits + b.bits);
    const double most_a = std::max(std::abs(a.low), std::abs(a.high));
    const double most_b = std::max(std::abs(b.low), std::abs(b.high));
    made.most_error = most_a * b.most_error + most_b * a.most_error + a.most_error * b.most_error + unit(made.bits);
    set(place, made,
        {fmt::format("{}_product({}, {}, {})", prefix_, text(step.left), text(*step.right), power_of_two(a.bits + b.bits - made.bits)),
         false});
  }

  void add_quotient(int place, const thermal::Formula::Step& step) {
    const FixedPoint& a = value(step.left);
    const FixedPoint& b = value(*step.right);
    const double least = std::min(std::abs(b.low), std::abs(b.high)) - b.most_error;
    if (b.low * b.high <= 0.0 || least <= 0.0) {
      throw refusal(place, "its law divides by a quantity that may be 0");
    }
    const auto corners = {a.low / b.low, a.low / b.high, a.high / b.low, a.high / b.high};
    FixedPoint made{.low = std::min(corners), .high = std::max(corners), .bits = 0, .most_error = 0.0};
    const double most = std::max(std::abs(made.low), std::abs(made.high));
    made.bits = std::min(bits_for(made.low, made.high), a.bits - b.bits + kNumberBits);
    const int shift = made.bits + b.bits - a.bits;
    if (shift < 0) {
      throw refusal(place, "its law divides numbers of too different sizes");
    }
    made.most_error = (a.most_error + most * b.most_error) / least + unit(made.bits);
    set(place, made, {fmt::format("{}_quotient({}, {}, {})", prefix_, text(step.left), text(*step.right), power_of_two(shift)), false});
  }

  void add_magnitude(int place, const thermal::Formula::Step& step) {
    FixedPoint made = value(step.left);
    made.high = std::max(std::abs(made.low), std::abs(made.high));
    made.low = 0.0;
    set(place, made, {fmt::format("({0} < 0) ? -{0} : {0}", operand(step.left)), true});
  }

  void add_positive_part(int place, const thermal::Formula::Step& step) {
    FixedPoint made = value(step.left);
    made.high = std::max(made.high, 0.0);
    made.low = std::max(made.low, 0.0);
    set(place, made, {fmt::format("({0} > 0) ? {0} : 0", operand(step.left)), true});
  }

  const Derating& derating_;
  const std::string& prefix_;
  const thermal::Formula& formula_;
  UniqueNames unique_;
  std::map<int, Text> written_;  ///< text of each step as an operand
  std::vector<FixedPoint> values_;
  IntegerLines lines_;
};

}  // namespace

IntegerLines integer_lines(const Derating& derating, const std::string& prefix) { return Writer(derating, prefix).write(); }

}  // namespace heatsoak::derate::integer_form
