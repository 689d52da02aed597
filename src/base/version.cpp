#include "base/version.h"

namespace heatsoak {

std::string_view program_version() { return HEATSOAK_VERSION; }

}  // namespace heatsoak
