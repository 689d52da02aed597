// Checks that every floating-point name ends in its unit.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace heatsoak::lint {

struct NamedNumber {
  std::string name;
  int line = 0;
};

/// Returns variables, fields and parameters of a floating-point type or of a container of one, without functions.
std::vector<NamedNumber> floating_point_names(std::string_view header);

bool ends_in_unit(std::string_view name);
/// True for names that need no unit.
bool is_unitless_by_nature(std::string_view name);

}  // namespace heatsoak::lint
