// Memory over power-off of the header in integers.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "derate/c_header/c_text.h"

namespace heatsoak::derate::integer_form {

/// Inputs of the worst-case heating.
struct HeatingInputs {
  std::string fields;                                       ///< initialisers of an input, in its order
  std::vector<std::pair<std::string, std::size_t>> looped;  ///< fields with several possible values, and the number of these
};

/// Returns the C functions that save and restore a state. `guard_words` are those of the header: prefix and numbers of its placeholders.
std::string integer_memory(const c_header::Words& guard_words, const HeatingInputs& inputs);

}  // namespace heatsoak::derate::integer_form
