// A derating table that was written earlier, against a fresh one: does it still hold?
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "derate/derating.h"

namespace heatsoak {

/// What a CSV table says of one place.
struct CommittedRow {
  double speed_rad_per_s = 0.0;
  double stator_C = 0.0;
  double winding_C = 0.0;
  double current_A = 0.0;
};

/// Either a table or rows.
struct CommittedTable {
  std::filesystem::path file;
  std::optional<CurrentTable> table;  ///< of a C header
  std::vector<CommittedRow> rows;     ///< of a CSV table, the full grid of its places
  std::string motor_id;               ///< that the file names at its beginning; empty where it names none
  std::string robot_id;               ///< the same
  std::string version;                ///< of the program that wrote the file, "0.1.0"; empty where the file has none
  std::string code;                   ///< of a C header all of its text, else empty
};

/// Reads a C header or a CSV table of `derate`, whichever the content is. Throws Failure (bad_input): unreadable, neither of the two, a
/// header that is cut off, an axis that does not ascend, a value that cannot be, an incomplete grid, with the line where there is one.
CommittedTable read_committed_table(const std::filesystem::path& file);

/// Where two tables are furthest apart.
struct TablePlace {
  double difference_A = 0.0;  ///< ≥ 0
  double committed_A = 0.0;
  double fresh_A = 0.0;
  double speed_rad_per_s = 0.0;
  double stator_C = 0.0;
  double winding_C = 0.0;
};

struct TableComparison {
  TablePlace excess;  ///< the committed table allows more: unsafe
  TablePlace lost;    ///< it allows less: safe, but current is given away
  /// Of a C header: the first line outside the table, comments apart, that differs from a fresh header, 0 where none does. Then the
  /// observer of the firmware is not the one that the table was checked with.
  int differing_line = 0;
  std::string differing_text;        ///< of that line
  std::string differing_fresh_text;  ///< of the fresh header
};

/// A C header over all speeds and temperatures: the squares of both tables are straight between the points of both axes, so the largest
/// differences are looked for on the grid of all points, and just behind the ends. A CSV table in its rows. Differences below 0.05 % of the
/// largest current are rounding of the file and count as none; so are numbers of the header's other lines that agree to 1 in 10⁴.
TableComparison compare(const CommittedTable& committed, const Derating& fresh);

}  // namespace heatsoak
