// What happened to the rows of a file on their way into a recording.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace heatsoak {

enum class LeftOutReason {
  // of whole rows
  wrong_number_of_cells,
  cut_off,
  without_time,
  time_does_not_increase,
  not_valid,  ///< by the mapping; also of one quantity
  // of one quantity
  not_recorded,
  not_a_number,
  impossible,
  saturated,
  frozen,
  outlier
};
/// "the cell is blank", "saturated": for people and for JSON.
std::string_view to_string(LeftOutReason reason);

/// Lines of the file, both ends included.
struct LineRange {
  int first = 0;
  int last = 0;
};

struct LeftOut {
  static constexpr std::size_t kMostRanges = 1000;

  std::size_t count = 0;         ///< samples, or rows
  std::vector<LineRange> lines;  ///< the first kMostRanges stretches
  std::string example;           ///< the first cell, as the file has it; may be empty

  /// Lines come in increasing order.
  void add(int line);
};

struct RecordingReport {
  std::size_t file_bytes = 0;
  std::size_t rows_in_file = 0;
  std::size_t rows_kept = 0;
  std::size_t repeated_times = 0;  ///< of the rows whose time does not increase, those that repeat one
  /// By quantity ("" is the whole row) and reason.
  std::map<std::pair<std::string, LeftOutReason>, LeftOut> left_out;
  std::vector<std::string> notes;  ///< what else was done or seen, in sentences

  [[nodiscard]] const LeftOut* find(std::string_view quantity, LeftOutReason reason) const;
};

}  // namespace heatsoak
