// A derating table that was written earlier, against a fresh one: does it still hold?
#pragma once

#include <filesystem>
#include <string>

#include "derate/derating.h"

namespace heatsoak {

struct CommittedTable {
  std::filesystem::path file;
  CurrentTable table;
  std::string version;  ///< of the program that wrote the file, "0.1.0"; empty where the file has none
  std::string code;     ///< of a C header all of its text, else empty
};

/// Reads a C header or a CSV table of `derate`, whichever the content is. Throws Failure (bad_input): unreadable, neither of the two, an
/// axis that does not ascend, a current below 0, an incomplete grid, with the line where there is one.
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

/// Over all speeds and temperatures: both are straight between the points of both axes, so the largest differences lie on the grid of all
/// points, and just behind the end of a table, where it allows nothing. Differences below 0.05 % of the largest current are rounding of the
/// file and count as none; so are numbers of the header's other lines that agree to 1 in 10⁴.
TableComparison compare(const CommittedTable& committed, const Derating& fresh);

}  // namespace heatsoak
