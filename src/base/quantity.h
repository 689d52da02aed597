// Numbers with units in the notation of data sheets: "36.9 mN m/A", "265 rpm/V", "155 degC", "10 %".
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace heatsoak::base {

/// The value in the wanted unit, or a description of the error.
struct ParsedQuantity {
  double value = 0.0;
  std::string problem;  ///< empty if `value` is valid
  [[nodiscard]] bool ok() const { return problem.empty(); }
};

/// Reads one finite number with a unit and converts it to `wanted_unit` (UDUNITS-2 syntax). With `wanted_unit` "" the text must be a pure
/// number or a percentage. A rotational speed must name its angle ("rpm", "rad/s"): UDUNITS would read a data sheet's "1/min" as rad/min,
/// which is wrong by 2π. `is_share` selects a percentage as the example in messages.
ParsedQuantity parse_quantity(std::string_view text, std::string_view wanted_unit, bool is_share = false);

/// Reads a number without unit. The whole text must be the number, except for spaces around it; otherwise returns nothing.
std::optional<double> parse_number(std::string_view text);

/// Converts `value` between two units of this program. Throws std::logic_error if they are not convertible.
double convert(double value, std::string_view from, std::string_view to);

/// Returns the unit as shown to the user: "degC" becomes "°C", all others stay as they are.
std::string unit_for_display(std::string_view unit);

/// Rounds to `digits` significant digits. Decimal notation without trailing zeros: "3.8", "0.0041", "162"; "1e+20" if very large or small.
std::string significant(double value, int digits);

}  // namespace heatsoak::base
