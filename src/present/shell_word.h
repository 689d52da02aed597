// Words of commands that an answer suggests.
#pragma once

#include <string>

namespace heatsoak::present {

/// Returns `word` as one word of a POSIX shell: in single quotes if it contains special characters.
std::string shell_word(const std::string& word);

}  // namespace heatsoak::present
