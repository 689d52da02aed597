// Capabilities of the terminal behind a file descriptor.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "base/parallel.h"

namespace heatsoak::cli {

/// Returns the width in characters, 20 to 1000: COLUMNS if it is a positive integer, else the terminal's own width, else 80.
std::size_t terminal_width(int descriptor);

/// Returns true for a terminal unless NO_COLOR or TERM=dumb is set.
bool takes_colors(int descriptor);

/// Returns a progress bar with the remaining time on stderr; silent if stderr is not a terminal.
base::Progress progress_bar(std::string what);

/// If stderr is a terminal, an interrupt (Ctrl-C) then replaces the progress line by the word "interrupted" before it ends the program.
void announce_interrupts();

/// Shows the elapsed time of a job without known length on stderr, from its first second until the returned object is destroyed; silent if
/// stderr is not a terminal.
std::shared_ptr<void> elapsed_line(std::string what);

}  // namespace heatsoak::cli
