// Writes a recording as canonical CSV, for other programs and for archiving.
#pragma once

#include <string>

#include "recording/recording.h"

namespace heatsoak::recording {

/// Returns the CSV text. Every channel is in its unit with full precision; omitted samples are blank cells. Motor and conditions are
/// written as comments.
std::string to_canonical_csv(const Recording& recording);

}  // namespace heatsoak::recording
