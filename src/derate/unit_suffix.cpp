#include "derate/unit_suffix.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <optional>

#include "base/unit_names.h"

namespace heatsoak::derate {
namespace {

using Words = std::vector<std::string>;

struct NamedUnit {
  std::string_view dividend;
  std::string_view divisor;
  std::string_view word;  ///< physical quantity of that unit
  std::string_view unit;  ///< unit in the form in which it ends a name
};
/// Units of the factors in thermal laws.
constexpr std::array kNamedUnits{NamedUnit{"W", "A2", "resistance", "ohm"},           NamedUnit{"W s", "rad", "torque", "Nm"},
                                 NamedUnit{"W", "K", "conductance", "W_per_K"},       NamedUnit{"W", "A", "voltage", "V"},
                                 NamedUnit{"K", "s W", "per_heat", "K_per_J"},        NamedUnit{"W", "W", "per_power", "ratio"},
                                 NamedUnit{"W s2", "rad2", "damping", "Nm_s_per_rad"}};

std::string suffix_of(const Words& dividend, const Words& divisor) {
  if (dividend.empty() && divisor.empty()) {
    return "ratio";
  }
  const std::string_view per = divisor.empty() ? "" : dividend.empty() ? "per_" : "_per_";
  return fmt::format("{}{}{}", fmt::join(dividend, "_"), per, fmt::join(divisor, "_per_"));
}

/// Removes the words that both lists have.
void cancel(Words& dividend, Words& divisor) {
  for (auto each = dividend.begin(); each != dividend.end();) {
    const auto same = std::ranges::find(divisor, *each);
    if (same == divisor.end()) {
      ++each;
      continue;
    }
    divisor.erase(same);
    each = dividend.erase(each);
  }
}

/// Returns the word of a squared unit; nothing if names have none, as for "Nm".
std::optional<std::string> squared_word(const std::string& word) {
  const std::string squared = word + "2";
  const auto known = std::ranges::find(base::kUnitWords, squared, &base::UnitWord::word);
  return known == base::kUnitWords.end() ? std::nullopt : std::optional(squared);
}

}  // namespace

NameWithUnit split_name(std::string_view name) {
  NameWithUnit split;
  const std::optional<base::UnitOfName> unit = base::unit_of_name(name);
  if (!unit) {
    split.stem = name;
    return split;
  }
  split.has_unit = true;
  split.stem = unit->quantity;
  std::string_view rest = name.substr(std::min(name.size(), unit->quantity.size() + 1));
  bool is_divisor = false;
  while (!rest.empty()) {
    const std::string_view word = rest.substr(0, rest.find('_'));
    rest.remove_prefix(std::min(rest.size(), word.size() + 1));
    if (word == "per") {
      is_divisor = true;
    } else if (word != "ratio" && word != "share") {
      (is_divisor ? split.divisor : split.dividend).emplace_back(word);
    }
  }
  return split;
}

std::string name_of_quotient(const NameWithUnit& result, const NameWithUnit& other, bool is_product) {
  if (!result.has_unit || !other.has_unit) {
    return {};
  }
  Words dividend = result.dividend;
  Words divisor = result.divisor;
  std::ranges::copy(is_product ? other.dividend : other.divisor, std::back_inserter(dividend));
  std::ranges::copy(is_product ? other.divisor : other.dividend, std::back_inserter(divisor));
  const std::string above = fmt::format("{}", fmt::join(dividend, " "));
  const std::string below = fmt::format("{}", fmt::join(divisor, " "));
  for (const NamedUnit& each : kNamedUnits) {
    if (above == each.dividend && below == each.divisor) {
      return fmt::format("{}_{}_{}", result.stem, each.word, each.unit);
    }
  }
  cancel(dividend, divisor);
  return fmt::format("{}_{}", result.stem, suffix_of(dividend, divisor));
}

std::string with_word(const NameWithUnit& name, std::string_view word) {
  return fmt::format("{}_{}{}", name.stem, word, name.has_unit ? "_" + suffix_of(name.dividend, name.divisor) : "");
}

std::string squared_name(const NameWithUnit& name) {
  NameWithUnit squared = name;
  for (Words* const words : {&squared.dividend, &squared.divisor}) {
    for (std::string& word : *words) {
      const std::optional<std::string> known = squared_word(word);
      if (!known) {
        return {};
      }
      word = *known;
    }
  }
  return with_word(squared, "squared");
}

}  // namespace heatsoak::derate
