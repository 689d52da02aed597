// What the terminal behind a file descriptor can show.
#pragma once

#include <cstddef>
#include <string>

#include "base/parallel.h"

namespace heatsoak {

/// In characters: COLUMNS where that is a number from 20 to 1000, else the terminal's own width, else 80.
std::size_t terminal_width(int descriptor);

/// Whether it is a terminal, and neither NO_COLOR nor TERM=dumb is set.
bool takes_colors(int descriptor);

/// A bar with the remaining time on stderr; silent where that is no terminal.
Progress progress_bar(std::string what);

}  // namespace heatsoak
