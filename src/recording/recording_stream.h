// Reads a file of measurements in parts of some 65 000 rows.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "recording/mapping.h"
#include "recording/recording.h"
#include "recording/recording_report.h"

namespace heatsoak::recording {

/// Omits and reports invalid rows and samples (blank, not numbers, repeated or decreasing times, saturated, frozen, outliers of
/// temperatures); never replaces them by guesses. Memory is bounded. Frozen and saturated samples and the order of rows are judged within
/// parts of some 65 000 rows, which is all of most logs. Throws Failure (bad_input) if the file is not a table or lacks a column. The same
/// if more than 10 % of the rows go back in time, or more than half repeat a time. Throws Failure (cannot_answer) if nothing is left.
/// next() throws errors that are visible only at the end of the file.
class RecordingStream {
 public:
  /// `report` must outlive the stream.
  RecordingStream(const std::filesystem::path& log, const Mapping& mapping, RecordingReport& report);
  ~RecordingStream();
  RecordingStream(const RecordingStream&) = delete;
  RecordingStream& operator=(const RecordingStream&) = delete;

  /// Reads the next rows of all channels; returns false at the end. `run_begins` contains 0 only if a run begins with the part.
  bool next(Recording& part);
  [[nodiscard]] std::size_t bytes_read() const;
  /// Names of the columns of the file.
  [[nodiscard]] std::span<const std::string> header() const;
  /// True if the channel has had a valid number so far.
  [[nodiscard]] bool has_numbers(std::size_t channel) const;

 private:
  class Intake;
  std::unique_ptr<Intake> intake_;
};

}  // namespace heatsoak::recording
