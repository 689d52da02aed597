// How a foreign log becomes canonical: which column or expression gives which quantity, in which unit, when it counts.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "identify/measurement/quantities.h"
#include "identify/measurement/recording.h"
#include "input/number_table.h"

namespace heatsoak {

/// What replaces a blank cell, and on which rows. Blank is unknown unless a fill says otherwise.
struct GapFill {
  double value = 0.0;  ///< in the quantity's unit
  std::string where;   ///< expression of columns
};

struct QuantityMapping {
  Quantity quantity;
  std::string column;      ///< name in the header; empty where there is an expression
  std::string expression;  ///< of columns
  /// Canonical value = value + scale_factor · file value: the unit and the sign.
  double scale_factor = 1.0;
  double value = 0.0;
  double clock_offset_s = 0.0;          ///< added to the row's time gives the moment of the sample
  std::string valid;                    ///< expression; where it is 0 the sample is left out; empty: always
  std::optional<double> saturates_low;  ///< at or beyond it the sensor is at its end, in the quantity's unit
  std::optional<double> saturates_high;
  std::vector<GapFill> fills;
  bool is_optional = false;  ///< a file without the column is fine
  Location at;
  std::map<std::string, Location> places;  ///< of the keys that the file has

  [[nodiscard]] Location place_of(const std::string& part) const;
};

struct Mapping {
  std::filesystem::path file;  ///< empty for the canonical form
  TableFormat format;
  std::vector<QuantityMapping> quantities;  ///< empty: the header names quantities itself
  std::string valid;                        ///< expression; rows where it is 0 are left out; empty: all count
  Location valid_at;
  std::string run_column;  ///< a change of its value begins a run; may be empty
  Location run_column_at;
  std::optional<double> longest_gap_s;  ///< a longer gap between rows splits the run; three usual ones unless given
  InputHabit inputs = InputHabit::held;
  std::string motor;
  std::map<std::string, std::string> conditions;

  [[nodiscard]] bool is_canonical() const { return quantities.empty(); }
};

/// The mapping of `log` that this TOML file gives: its [[files]] may change motor and conditions by the log's name.
/// Throws Failure (bad_input) with every problem of the file.
Mapping read_mapping(const std::filesystem::path& file, const std::filesystem::path& log);

/// `chosen` (--map), or else LOG.map.toml beside the log (run1.csv.map.toml, run1.map.toml), or else the canonical form.
Mapping mapping_for(const std::filesystem::path& log, const std::filesystem::path& chosen);

}  // namespace heatsoak
