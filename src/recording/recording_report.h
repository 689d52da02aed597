// Report about omitted rows and samples of a file.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "recording/findings.h"

namespace heatsoak::recording {

enum class LeftOutReason {
  // reasons for whole rows
  wrong_number_of_cells,
  cut_off,
  without_time,
  time_does_not_increase,
  not_valid,  ///< by the mapping; also for single quantities
  // reasons for single quantities
  not_recorded,
  not_a_number,
  impossible,
  saturated,
  frozen,
  outlier
};
/// Returns the reason as text ("the cell is blank", "saturated"), also used in JSON.
std::string_view to_string(LeftOutReason reason);

/// Range of lines of the file, both ends included.
struct LineRange {
  int first = 0;
  int last = 0;
};

struct LeftOut {
  static constexpr std::size_t kMostRanges = 1000;

  std::size_t count = 0;         ///< number of samples, or of rows
  std::vector<LineRange> lines;  ///< the first kMostRanges ranges
  std::string example;           ///< text of the first omitted cell; may be empty

  /// Lines must be added in increasing order.
  void add(int line);
};

struct RecordingReport {
  std::size_t file_bytes = 0;
  std::size_t rows_in_file = 0;
  std::size_t rows_kept = 0;
  std::size_t repeated_times = 0;  ///< rows whose time equals that of the row before
  /// Omitted samples by quantity ("" for whole rows) and reason.
  std::map<std::pair<std::string, LeftOutReason>, LeftOut> left_out;
  std::vector<ReadingNote> notes;

  [[nodiscard]] const LeftOut* find(std::string_view quantity, LeftOutReason reason) const;
};

}  // namespace heatsoak::recording
