// A log as everything that learns from measurements sees it: canonical quantities, checked, in columns.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "identify/measurement/quantities.h"

namespace heatsoak {

struct Channel {
  Quantity quantity;
  std::vector<double> values;  ///< one per row, in the quantity's unit; NaN where left out or not recorded
};

/// What a heat input's sample stands for in the file.
enum class InputHabit {
  held,              ///< the interval that begins at the row's time (canonical)
  linear,            ///< the moment itself; between rows it changes evenly
  previous_interval  ///< the interval that ends at the row's time
};

/// Rows of a log. Heat inputs and surroundings stand for the interval from the row's time to the next row's (a current is
/// the rms over it with the sign of its mean, the others are means), whatever the logger did: loggers with other habits
/// are brought to this one while reading. Temperatures and other signals are instantaneous.
struct Recording {
  std::string name;  ///< the file's stem
  std::filesystem::path file;
  std::string motor;                              ///< as the mapping names it; may be empty
  std::map<std::string, std::string> conditions;  ///< "fan" -> "on"; as the mapping names them
  std::vector<double> time_s;                     ///< strictly increasing
  std::vector<int> line;                          ///< of each row in the file, from 1 as an editor counts
  std::vector<Channel> channels;
  std::vector<std::size_t> run_begins;  ///< rows before which what happened is unknown; the first one is 0
  /// Of all that was read, of which this may be a part: content_hash() and the time of its first row.
  std::string content = {};
  double content_begin_s = 0.0;
  /// Where this is a part: what the whole looks like that spoils a fit, see Suspicions. Half a run may start warm and only cool.
  std::optional<std::vector<std::string>> spoiling_of_whole = {};
  InputHabit inputs = InputHabit::held;  ///< before it was brought to this one: which end of a gap a sample speaks of

  [[nodiscard]] const Channel* find(std::string_view key) const;
  [[nodiscard]] std::size_t rows() const { return time_s.size(); }
  /// [begin, end) of each run.
  [[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> runs() const;
  /// Rows [begin, end) as a part of this recording: `run_begins` has 0 only where a run begins there.
  [[nodiscard]] Recording slice(std::size_t begin, std::size_t end) const;
};

/// The rows of a recording between two shares of its duration, 0 … 1; its name and conditions stay.
Recording part_of(const Recording& recording, double from_share, double to_share);

}  // namespace heatsoak
