#include "base/unit_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

namespace heatsoak::base {
namespace {

/// Multiplies `product` by the unit to the power of `sign`.
void multiply(SiUnit& product, const SiUnit& unit, int sign) {
  product.kg += sign * unit.kg;
  product.m += sign * unit.m;
  product.s += sign * unit.s;
  product.A += sign * unit.A;
  product.K += sign * unit.K;
  product.rad += sign * unit.rad;
  product.factor *= std::pow(unit.factor, sign);
}

/// Words of a name that are one product of units.
struct Product {
  std::string unit;
  SiUnit si;

  void put_before(const UnitWord& word) {
    unit = unit.empty() ? std::string(word.unit) : fmt::format("{} {}", word.unit, unit);
    multiply(si, word.si, 1);
  }
};

std::string quotient(const std::string& above, const std::string& below) {
  if (below.empty()) {
    return above;
  }
  const bool is_product = below.find(' ') != std::string::npos;
  return fmt::format("{}/{}{}{}", above.empty() ? "1" : above, is_product ? "(" : "", below, is_product ? ")" : "");
}

/// Returns whether text uses this symbol as a unit.
bool is_symbol(std::string_view word) {
  constexpr std::array<std::string_view, 4> kInTextOnly{"Ah", "B", "Wh", "nats"};
  const auto* const known = std::ranges::find(kUnitWords, word, &UnitWord::word);
  return (known != kUnitWords.end() && !known->unit.empty()) || std::ranges::find(kInTextOnly, word) != kInTextOnly.end();
}

}  // namespace

namespace {

std::optional<UnitWord> unit_word(std::string_view word, UnitText unit_text, bool is_first_of_product) {
  const std::optional<std::string_view> text = unit_text != nullptr ? unit_text(word) : std::nullopt;
  if (const auto* const known = std::ranges::find(kUnitWords, word, &UnitWord::word); known != kUnitWords.end()) {
    return UnitWord{word, text.value_or(known->unit), known->si};
  }
  return text && is_first_of_product ? std::optional(UnitWord{word, *text, {}}) : std::nullopt;
}

std::optional<UnitOfName> unit_at_end(std::string_view name, UnitText unit_text) {
  std::string_view rest = name;
  Product current;  // words behind the last "per" that was read
  bool is_complete = false;
  std::string below;
  double offset_K = 0.0;
  UnitOfName result;
  for (std::size_t mark = rest.rfind('_'); mark != std::string_view::npos; mark = rest.rfind('_')) {
    const std::string_view last = rest.substr(mark + 1);
    if (last == "per" && !current.unit.empty()) {
      const Product divisor = std::exchange(current, {});
      below = below.empty() ? divisor.unit : fmt::format("{} {}", divisor.unit, below);
      multiply(result.si, divisor.si, -1);
      offset_K = 0.0;
      is_complete = false;
    } else {
      const std::optional<UnitWord> word = unit_word(last, unit_text, current.unit.empty());
      if (!word || is_complete || (word->unit.empty() && rest.size() < name.size())) {
        break;
      }
      if (word->unit.empty()) {
        return UnitOfName{rest.substr(0, mark), "", {}};
      }
      current.put_before(*word);
      offset_K = rest.size() == name.size() ? word->si.offset_K : 0.0;
      // A product has no unit with an offset: "phase_A_C" is in degC.
      is_complete = word->si.offset_K != 0.0 || std::ranges::find(kUnitWords, last, &UnitWord::word) == kUnitWords.end();
    }
    rest.remove_suffix(rest.size() - mark);
  }
  if (rest.empty() || rest.size() == name.size()) {
    return std::nullopt;
  }
  multiply(result.si, current.si, 1);
  result.si.offset_K = offset_K;
  result.quantity = rest;
  result.unit = quotient(current.unit, below);
  return result;
}

}  // namespace

std::optional<UnitOfName> unit_of_name(std::string_view name) {
  if (const auto* const all = std::ranges::find(kUnitWords, name, &UnitWord::word); all != kUnitWords.end() && all->unit.empty()) {
    return UnitOfName{};
  }
  return unit_at_end(name, nullptr);
}

std::optional<std::string> unit_text_of_name(std::string_view name, UnitText unit_text) {
  const std::optional<UnitOfName> found = unit_at_end(name, unit_text);
  return found ? std::optional(found->unit) : std::nullopt;
}

bool is_number_with_unit(std::string_view before, std::string_view behind) {
  if (before.empty() || std::isdigit(static_cast<unsigned char>(before.back())) == 0) {
    return false;
  }
  constexpr std::array<std::string_view, 4> kSigns{"%", "°", "Ω", "µ"};
  if (std::ranges::any_of(kSigns, [behind](std::string_view sign) { return behind.starts_with(sign); })) {
    return true;
  }
  const auto end = std::ranges::find_if(behind, [](unsigned char c) { return std::isalpha(c) == 0; });
  const std::string_view word(behind.begin(), end);  // the first one of a quotient or product
  constexpr std::string_view kPrefixes = "GMkmunp";
  const bool has_prefix = word.size() > 1 && kPrefixes.find(word.front()) != std::string_view::npos;
  return is_symbol(word) || (has_prefix && is_symbol(word.substr(1)));
}

}  // namespace heatsoak::base
