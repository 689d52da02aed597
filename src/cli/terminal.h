// Capabilities of the terminal behind a file descriptor.
#pragma once

#include <cstddef>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "base/job_progress.h"

namespace heatsoak::cli {

/// Returns the width in characters, 20 to 1000: COLUMNS if it is a positive integer, else the terminal's own width. A file or pipe has none.
std::optional<std::size_t> known_width(int descriptor);
/// Returns the width, or 80 without one.
std::size_t terminal_width(int descriptor);

/// Returns true for a terminal unless NO_COLOR or TERM=dumb is set.
bool takes_colors(int descriptor);

/// Replaces control characters, which could come from file names and control the terminal, by question marks.
std::string printable(std::string_view text);

/// Writes to a stream. Never throws: run_program() finds a full disk at the end, and a failing stderr is ignored.
void put(std::FILE* file, std::string_view text);

/// Shows the progress of a job with its remaining time as one line on stderr, from its first second until the destructor removes the line.
/// Silent if stderr is not a terminal.
class JobLine {
 public:
  JobLine();
  JobLine(const JobLine&) = delete;
  JobLine& operator=(const JobLine&) = delete;
  ~JobLine();
  /// Returns the progress that the job reports to; it ignores all reports if the line is silent.
  [[nodiscard]] const base::JobProgress& progress() const { return progress_; }

 private:
  class Painter;
  base::JobProgress progress_;
  std::unique_ptr<Painter> painter_;
};

/// If stderr is a terminal, an interrupt (Ctrl-C) then replaces the progress line by the word "interrupted" before it ends the program.
void announce_interrupts();

}  // namespace heatsoak::cli
