// Compares a derating table that was written earlier with a newly computed one.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"
#include "derate/derating.h"
#include "derate/header_text.h"

namespace heatsoak::derate {

/// One row of a CSV table.
struct CommittedRow {
  double speed_rad_per_s = 0.0;
  double stator_C = 0.0;
  double winding_C = 0.0;
  double current_A = 0.0;
};

/// An earlier derating table: from a C header (`table`, `code`) or from a CSV table (`rows`).
struct CommittedTable {
  std::filesystem::path file;
  std::optional<CurrentTable> table;  ///< only from a C header
  std::vector<CommittedRow> rows;     ///< only from a CSV table: the full grid, winding varies fastest
  std::string motor_id;               ///< named at the beginning of the file; empty if the file names none
  std::string robot_id;               ///< named at the beginning of the file; empty if the file names none
  bool has_sensor = false;            ///< a C header with a temperature sensor
  std::string sensor_flags;           ///< sensor_flags() of that sensor; empty if the header does not state them
  std::string version;                ///< version of the program that wrote the file, base::program_version(); empty if not stated
  std::string code;                   ///< full text of a C header, else empty
  bool is_integer = false;            ///< a C header in integers (c_header_q15)
};

/// Reads a C header or a CSV table of `derate`; the content decides which. Throws Failure (bad_input) for an unreadable file, another kind
/// of file, a truncated header, an axis that does not ascend, an impossible value or an incomplete grid. It has the line if there is one.
CommittedTable read_committed_table(const std::filesystem::path& file);

/// Difference between the sensor of a C header and the expected one.
struct SensorDifference {
  enum class Kind {
    options_unstated,   ///< the header has a sensor and does not state its options
    sensor_unexpected,  ///< the header has a sensor; none is expected
    sensor_missing,     ///< the header has none
    other_options
  };
  struct Option {
    std::string name;                           ///< "--thermistor-accuracy"
    std::string value;                          ///< in the header
    std::optional<std::string> expected_value;  ///< empty: the expected options lack it
  };
  Kind kind = Kind::other_options;
  std::string header_flags = {};     ///< sensor_flags() of the header
  std::vector<Option> options = {};  ///< those that differ, for other_options
};

/// Thrown by run_derating() if the sensor of the committed header is another one.
class SensorsDiffer : public base::Failure {
 public:
  SensorsDiffer(const std::filesystem::path& committed, SensorDifference difference);
  [[nodiscard]] const SensorDifference& difference() const { return difference_; }

 private:
  SensorDifference difference_;
};

/// Returns how the sensor of a C header differs from `expected`; nothing if it does not, and for a CSV table. A header with other options
/// has another observer, so its currents cannot be compared with those of a fresh header.
std::optional<SensorDifference> sensor_difference(const CommittedTable& committed, const std::optional<SensorOptions>& expected);

/// Point at which two tables differ most.
struct TablePlace {
  double difference_A = 0.0;  ///< ≥ 0
  double committed_A = 0.0;
  double fresh_A = 0.0;
  double speed_rad_per_s = 0.0;
  double stator_C = 0.0;
  double winding_C = 0.0;
};

struct TableComparison {
  TablePlace excess;  ///< the committed table allows more current: unsafe
  TablePlace lost;    ///< the committed table allows less current: safe, but wasteful
  /// Only for a C header: statements outside of tables and comments that differ from a fresh header, the most telling first. If there is
  /// one, the observer in the firmware is not the observer that the table was checked with.
  std::vector<HeaderDifference> differing;
  bool is_other_motor = false;  ///< the file names a motor, and it is another one
  /// Version of the program that wrote the file; empty if it is base::program_version(), or not stated.
  std::string other_version = {};

  /// Returns whether the committed table is safe to use.
  [[nodiscard]] bool holds() const { return !is_other_motor && excess.difference_A == 0.0 && differing.empty(); }
};

/// Words for kIgnored_share, which every answer of a comparison states.
inline constexpr double kIgnored_share = 5e-4;
inline constexpr std::string_view kIgnored = "0.05 % of the largest current";

/// Compares a C header with a fresh one of the same form, on the grid of all breakpoints of both tables and just beyond the ends of the
/// axes. This suffices, because both tables are piecewise linear in the copper heat. Compares a CSV table in its own rows. Ignores
/// differences below kIgnored_share of the largest current, which rounding of the file may cause. In the other lines of a header, numbers
/// with a relative difference of at most 1e-4 count as equal. Throws Failure (bad_input) if an axis of a CSV table is shorter than that of
/// the fresh table.
TableComparison compare(const CommittedTable& committed, const Derating& fresh);

}  // namespace heatsoak::derate
