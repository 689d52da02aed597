// Arithmetic with the units in which names end: "copper_loss_W" per "current_squared_A2" is in "ohm".
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace heatsoak::derate {

/// A name split into its quantity and its unit: "winding_rate", K / s.
struct NameWithUnit {
  std::string stem;
  std::vector<std::string> dividend;
  std::vector<std::string> divisor;
  bool has_unit = false;  ///< false if the name ends in no unit
};

/// Splits a name; "x_ratio" and "x_share" are pure numbers, without words in dividend and divisor.
NameWithUnit split_name(std::string_view name);

/// Returns the name of a quantity with the stem of `result` and the unit of result/other or, if `is_product`, result·other. Products that
/// have a name of their own get it: "no_load_loss_W" per "speed_rad_per_s" is "no_load_loss_torque_Nm". Empty if one has no unit.
std::string name_of_quotient(const NameWithUnit& result, const NameWithUnit& other, bool is_product = false);

/// Returns "stem_word_unit": "current_squared_A2" for the squared current, "loss_part_W" for a part of a loss.
std::string with_word(const NameWithUnit& name, std::string_view word);
std::string squared_name(const NameWithUnit& name);

}  // namespace heatsoak::derate
