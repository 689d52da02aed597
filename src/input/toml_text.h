// Text as TOML.
#pragma once

#include <string>
#include <string_view>

namespace heatsoak::input {

/// Quotes a text as a TOML basic string.
std::string toml_text(std::string_view text);

}  // namespace heatsoak::input
