#include "base/version.h"

namespace heatsoak::base {

std::string_view program_version() { return HEATSOAK_VERSION; }

}  // namespace heatsoak::base
