// Capabilities of the terminal behind a file descriptor.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "base/job_progress.h"

namespace heatsoak::cli {

/// Returns the width in characters, 20 to 1000: COLUMNS if it is a positive integer, else the terminal's own width, else 80.
std::size_t terminal_width(int descriptor);

/// Returns true for a terminal unless NO_COLOR or TERM=dumb is set.
bool takes_colors(int descriptor);

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
