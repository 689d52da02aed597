// Findings about the rows of logs that runs are made of, as data. src/present puts them into words.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/diagnostic.h"
#include "thermal/operating_point.h"

namespace heatsoak::estimation {

/// Gaps split the rows of a log into runs.
struct GapsSplitRows {
  std::size_t rows = 0;
  std::size_t runs = 0;
};
/// Rows lack a value that the model needs.
struct RowsLack {
  enum class What {
    signal,        ///< the heat input `signal`
    surroundings,  ///< the ambient temperature, also within a minute
    temperature    ///< every temperature of winding and stator
  };
  What what = What::signal;
  std::optional<thermal::Signal> signal = {};  ///< set for What::signal
  std::size_t lacking = 0;
  std::size_t rows = 0;  ///< number of all rows of the log
};
/// The whole log is too short.
struct TooFewIntervals {
  double duration_s = 0.0;
  std::size_t needed = 0;   ///< number of intervals
  double interval_s = 0.0;  ///< longest interval to which rows are merged
};
/// Parts between rows with unknown values have too few rows.
struct UsablePartsTooShort {};
/// Reason why rows are not used.
using LossOfRows = std::variant<GapsSplitRows, RowsLack, TooFewIntervals, UsablePartsTooShort>;

/// A temperature is not used as a sensor, because its value never changes.
struct SensorNeverChanges {
  std::string recording;
  std::string channel;
};
/// More than a tenth of the rows are not used.
struct RowsUnused {
  std::string recording;
  std::size_t unused = 0;
  std::size_t rows = 0;
  std::vector<LossOfRows> reasons;
};
/// A recording is split into runs, because heat or ambient temperature is unknown between them.
struct SplitIntoRuns {
  std::string recording;
  std::size_t runs = 0;
};
/// A log lacks columns over which the model has curves. The hottest value of each curve is used.
struct ColumnsLacking {
  std::string recording;
  std::vector<std::string> columns;  ///< at least one
};
/// A column that an effect depends on is blank for longer than it may be interpolated. A curve over it uses the nearest known value; the
/// temperature of a neighbour is treated as unknown.
struct ColumnBlank {
  std::string recording;
  std::string column;
  double blank_s = 0.0;  ///< sum of these blanks
  bool is_held = false;  ///< true: the nearest known value is used; false: the value is unknown
};
/// Omitted data and assumptions.
using RunNote = std::variant<SensorNeverChanges, RowsUnused, SplitIntoRuns, ColumnsLacking, ColumnBlank>;

/// Thrown if the model cannot be simulated over a run: name of the run and the cause. It has the cause's exit code.
class RunNotSimulated : public base::Failure {
 public:
  RunNotSimulated(const std::string& run, const base::Failure& cause);
};

/// Thrown if no interval of a recording has temperatures and all heat inputs.
class NoUsableInterval : public base::Failure {
 public:
  NoUsableInterval(const std::string& recording, std::filesystem::path file, std::size_t least_rows, std::vector<LossOfRows> reasons);
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  [[nodiscard]] const std::vector<LossOfRows>& reasons() const { return reasons_; }

 private:
  std::filesystem::path file_;
  std::vector<LossOfRows> reasons_;
};

}  // namespace heatsoak::estimation
