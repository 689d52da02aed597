// Option --update: writes new limits into the user's own file.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "check/run_checks.h"

namespace heatsoak::check {

/// Sets every limit whose value could be determined to that value with `margin_share` of room (updated_limit()), and returns the text of
/// the file with the new limits. Only the limits change; comments, order, spaces and line ends stay. `content` is the text that the
/// outcomes' file had when it was read. Throws Failure (bad_input) if a limit cannot be replaced in place, for example because it is
/// written with an escape.
std::string with_new_limits(const std::string& content, std::span<Outcome> outcomes, double margin_share);

}  // namespace heatsoak::check
