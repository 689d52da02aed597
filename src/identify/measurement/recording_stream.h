// A file of measurements, some ten thousand rows at a time.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>

#include "identify/measurement/mapping.h"
#include "identify/measurement/recording.h"
#include "identify/measurement/recording_report.h"

namespace heatsoak {

/// Rows and samples that are no measurement (blank, not numbers, repeated or backward times, saturated, frozen, outliers of
/// temperatures) are left out and reported, never guessed. Memory does not grow with the file. Whether a sample is frozen,
/// saturated or in order is judged among some 65 000 rows, which is all of most logs.
/// Throws Failure: bad_input for a file that is no such table, has no such column or whose time does not increase at all;
/// cannot_answer where nothing is left. What only the end of the file can tell is thrown there, by next().
class RecordingStream {
 public:
  /// `report` outlives the stream.
  RecordingStream(const std::filesystem::path& log, const Mapping& mapping, RecordingReport& report);
  ~RecordingStream();
  RecordingStream(const RecordingStream&) = delete;
  RecordingStream& operator=(const RecordingStream&) = delete;

  /// The next rows, with all channels; false at the end. `run_begins` has 0 only where a run begins with the part.
  bool next(Recording& part);
  [[nodiscard]] std::size_t bytes_read() const;
  /// Whether the channel had a number so far.
  [[nodiscard]] bool has_numbers(std::size_t channel) const;

 private:
  class Intake;
  std::unique_ptr<Intake> intake_;
};

}  // namespace heatsoak
