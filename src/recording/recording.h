// A log in canonical form: checked quantities in columns. All fits use it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "recording/findings.h"
#include "recording/quantities.h"

namespace heatsoak::recording {

struct Channel {
  Quantity quantity;
  std::vector<double> values;  ///< one per row, in the quantity's unit; NaN if omitted or not recorded
};

/// Meaning of a heat input's sample in the file.
enum class InputConvention {
  held,              ///< value of the interval that begins at the row's time (canonical)
  linear,            ///< value at the row's time, linear between rows
  previous_interval  ///< value of the interval that ends at the row's time
};

/// Rows of a log. Heat inputs and surroundings are values of the interval from the row's time to that of the next row: currents are RMS
/// values with the sign of the mean, the others means. Logs with other conventions are converted while reading. Temperatures and other
/// signals are instantaneous.
struct Recording {
  std::string name;  ///< the file's stem
  std::filesystem::path file;
  std::string motor;                              ///< from the mapping; may be empty
  std::map<std::string, std::string> conditions;  ///< from the mapping, for example "fan" -> "on"
  std::vector<double> time_s;                     ///< strictly increasing
  std::vector<int> line;                          ///< line number of each row in the file, from 1
  std::vector<Channel> channels;
  std::vector<std::size_t> run_begins;  ///< first row of each continuous run; the first entry is 0
  /// content_hash() of the whole log that was read, and the time of its first row. This recording may be a part of it.
  std::string content = {};
  double content_begin_s = 0.0;
  /// If this is a part: Suspicions::blocking of the whole log. A part may start warm and only cool down, which misleads the checks.
  std::optional<std::vector<Suspicion>> blocking_of_whole = {};
  InputConvention inputs =
      InputConvention::held;  ///< convention of the file before conversion; states to which end of a gap a sample belongs

  [[nodiscard]] const Channel* find(std::string_view key) const;
  [[nodiscard]] std::size_t rows() const { return time_s.size(); }
  /// Row range [begin, end) of each run.
  [[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> runs() const;
  /// Returns rows [begin, end). `run_begins` of the result contains 0 only if a run begins there.
  [[nodiscard]] Recording slice(std::size_t begin, std::size_t end) const;
};

/// Returns the rows of a recording between two fractions (0 to 1) of its duration. Name and conditions stay.
Recording part_of(const Recording& recording, double from_share, double to_share);

}  // namespace heatsoak::recording
