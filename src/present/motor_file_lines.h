// Lines of a motor file, ready to paste.
#pragma once

#include <string>
#include <string_view>

#include "thermal/effect.h"

namespace heatsoak::present {

/// Returns the table "[effects.my_NAME]" with its type.
std::string effect_table(std::string_view type_name);

/// Returns the lines of a parameter at its typical size.
std::string typical_value(std::string_view key, double value, std::string_view unit);

/// Returns the lines of an effect with all parameters at their typical size.
std::string motor_file_lines(const thermal::EffectType& effect);

}  // namespace heatsoak::present
