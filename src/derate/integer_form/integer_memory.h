// Memory over power-off of the header in integers.
#pragma once

#include <string>

#include "derate/c_header/c_text.h"

namespace heatsoak::derate::integer_form {

/// Returns the C functions that save and restore a state. `words` are those of the header: prefix and numbers of its placeholders.
std::string integer_memory(const c_header::Words& words);

}  // namespace heatsoak::derate::integer_form
