// Units in which names of numbers end: "winding_C", "slope_A_per_K". Names in code, JSON answers, logs and generated files share them.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace heatsoak::base {

/// Exponents of SI units, and value in these units = factor · value + offset.
struct SiUnit {
  int kg = 0;
  int m = 0;
  int s = 0;
  int A = 0;
  int K = 0;
  int rad = 0;
  double factor = 1.0;
  double offset_K = 0.0;
};

struct UnitWord {
  std::string_view word;  ///< final word of a name
  std::string_view unit;  ///< UDUNITS text; "" for a pure number
  SiUnit si;
};

inline constexpr std::array kUnitWords{
    UnitWord{"A", "A", {.A = 1}},
    UnitWord{"A2", "A^2", {.A = 2}},
    UnitWord{"C", "degC", {.K = 1, .offset_K = 273.15}},
    UnitWord{"F", "F", {.kg = -1, .m = -2, .s = 4, .A = 2}},
    UnitWord{"H", "H", {.kg = 1, .m = 2, .s = -2, .A = -2}},
    UnitWord{"Hz", "Hz", {.s = -1}},
    UnitWord{"J", "J", {.kg = 1, .m = 2, .s = -2}},
    UnitWord{"K", "K", {.K = 1}},
    UnitWord{"N", "N", {.kg = 1, .m = 1, .s = -2}},
    UnitWord{"Nm", "N m", {.kg = 1, .m = 2, .s = -2}},
    UnitWord{"V", "V", {.kg = 1, .m = 2, .s = -3, .A = -1}},
    UnitWord{"V2", "V^2", {.kg = 2, .m = 4, .s = -6, .A = -2}},
    UnitWord{"W", "W", {.kg = 1, .m = 2, .s = -3}},
    UnitWord{"Wb", "Wb", {.kg = 1, .m = 2, .s = -2, .A = -1}},
    UnitWord{"byte", "byte", {}},
    UnitWord{"deg", "deg", {.rad = 1, .factor = 0.017453292519943295}},
    UnitWord{"g", "g", {.kg = 1, .factor = 1e-3}},
    UnitWord{"h", "h", {.s = 1, .factor = 3600.0}},
    UnitWord{"kg", "kg", {.kg = 1}},
    UnitWord{"m", "m", {.m = 1}},
    UnitWord{"m2", "m^2", {.m = 2}},
    UnitWord{"min", "min", {.s = 1, .factor = 60.0}},
    UnitWord{"mm", "mm", {.m = 1, .factor = 1e-3}},
    UnitWord{"ms", "ms", {.s = 1, .factor = 1e-3}},
    UnitWord{"nats", "", {}},
    UnitWord{"ohm", "ohm", {.kg = 1, .m = 2, .s = -3, .A = -2}},
    UnitWord{"rad", "rad", {.rad = 1}},
    UnitWord{"rad2", "rad^2", {.rad = 2}},
    UnitWord{"ratio", "", {}},
    UnitWord{"rpm", "rpm", {.s = -1, .rad = 1, .factor = 0.10471975511965977}},
    UnitWord{"s", "s", {.s = 1}},
    UnitWord{"s2", "s^2", {.s = 2}},
    UnitWord{"s3", "s^3", {.s = 3}},
    UnitWord{"share", "", {}},
    UnitWord{"us", "us", {.s = 1, .factor = 1e-6}},
};

struct UnitOfName {
  std::string_view quantity;  ///< name without the unit: "slope" of "slope_A_per_K"
  std::string unit;           ///< UDUNITS text "A/K"; "" for a pure number
  SiUnit si;                  ///< with an offset only if the unit is one word
};

/// Returns the unit in which a name ends; nothing if it ends in none. Each word behind "per" divides up to the next "per". The first word
/// is the quantity ("a_V" is in V), unless a pure number is all of the name: "share".
std::optional<UnitOfName> unit_of_name(std::string_view name);

/// Returns the UDUNITS text of a word in place of that of kUnitWords, or of a unit that kUnitWords lacks; nothing for any other word.
using UnitText = std::optional<std::string_view> (*)(std::string_view word);
/// Reads the same units and further ones, and returns the text alone. A further unit is a whole dividend or divisor, as in "flow_m3_per_s":
/// the word before it belongs to the quantity. Returns nothing if the unit is all of the name.
std::optional<std::string> unit_text_of_name(std::string_view name, UnitText unit_text);

/// Returns whether text with a blank between `before` and `behind` has a number there with its unit: "20" and "K", "3.5" and "m/s², …".
/// Such a blank is no place for a line break.
bool is_number_with_unit(std::string_view before, std::string_view behind);

}  // namespace heatsoak::base
