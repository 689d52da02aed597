#include "base/version.h"

#include <source_hash.h>

namespace heatsoak::base {

std::string_view program_version() { return HEATSOAK_VERSION "+" HEATSOAK_SOURCE_HASH; }

}  // namespace heatsoak::base
