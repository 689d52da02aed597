// Numbers with units, as people write them: "36.9 mN m/A", "265 rpm/V", "155 degC", "10 %".
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace heatsoak {

/// The value in the wanted unit, or what is wrong with the text.
struct ParsedQuantity {
  double value = 0.0;
  std::string problem;  ///< empty where `value` is good
  [[nodiscard]] bool ok() const { return problem.empty(); }
};

/// Reads one finite number with a unit and converts it (UDUNITS-2). `wanted_unit` is a UDUNITS text; ""
/// means a pure number, for which "%" is understood too. An angle must be named: "1/s" is no speed of rotation,
/// because a sheet's "1/min" means rpm and would be taken for 2π less.
ParsedQuantity parse_quantity(std::string_view text, std::string_view wanted_unit);

/// A number without unit, all of `text`; nothing where it is not one.
std::optional<double> parse_number(std::string_view text);

/// `value`, given in `from`, expressed in `to`; both are units of this program, so a mismatch is a bug.
double convert(double value, std::string_view from, std::string_view to);

/// "K/W", "°C", "A": how a unit is written for people.
std::string unit_for_display(std::string_view unit);

/// Rounded to `digits` significant ones, plain notation, no trailing zeros: "3.8", "0.0041", "162".
std::string significant(double value, int digits);

}  // namespace heatsoak
