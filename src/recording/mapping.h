// Mapping from a foreign log to the canonical form: column or expression, unit and validity of each quantity.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "input/number_table.h"
#include "recording/quantities.h"
#include "recording/recording.h"

namespace heatsoak::recording {

/// Value that replaces blank cells in certain rows. Without a fill, a blank cell is unknown.
struct GapFill {
  double value = 0.0;  ///< in the quantity's unit
  std::string where;   ///< expression of columns: rows in which it is not 0 are filled
};

struct QuantityMapping {
  Quantity quantity;
  std::string column;      ///< name in the header; empty if there is an expression
  std::string expression;  ///< expression of columns; empty if there is a column
  /// Unit and sign: canonical value = value + scale_factor · file value.
  double scale_factor = 1.0;
  double value = 0.0;                   ///< canonical value of the file value 0, such as -273.15 of kelvins
  double clock_offset_s = 0.0;          ///< time of the sample minus time of the row
  std::string valid;                    ///< expression: samples for which it is 0 are invalid; empty: all are valid
  std::optional<double> saturates_low;  ///< values at or below are saturated, in the quantity's unit
  std::optional<double> saturates_high;
  std::vector<GapFill> fills;
  bool is_optional = false;  ///< true: the file need not have the column
  base::Location at;
  std::map<std::string, base::Location> places;  ///< positions of the keys in the mapping file

  [[nodiscard]] base::Location place_of(const std::string& part) const;
};

struct Mapping {
  std::filesystem::path file;  ///< empty for the canonical form
  input::TableFormat format;
  std::vector<QuantityMapping> quantities;  ///< empty: the column names are quantities
  std::string valid;                        ///< expression: rows for which it is 0 are omitted; empty: all count
  base::Location valid_at;
  std::string run_column;  ///< column whose changes begin a new run; may be empty
  base::Location run_column_at;
  std::optional<double> longest_gap_s;  ///< a longer gap between rows begins a new run; default: three usual periods
  InputConvention inputs = InputConvention::held;
  std::string motor;
  std::map<std::string, std::string> conditions;

  [[nodiscard]] bool is_canonical() const { return quantities.empty(); }
};

/// Reads the mapping for `log` from a TOML file. Its [[files]] may set motor and conditions by the log's name. Throws Failure (bad_input)
/// with all problems of the file.
Mapping read_mapping(const std::filesystem::path& file, const std::filesystem::path& log);

/// Returns the mapping from `chosen` (--map) if not empty, else from a file beside the log (run1.csv.map.toml or run1.map.toml), else the
/// canonical form.
Mapping mapping_for(const std::filesystem::path& log, const std::filesystem::path& chosen);

}  // namespace heatsoak::recording
