// Estimates how a quantity behaves over rows that are missing from a log, from windows of equally many logged rows.
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <vector>

namespace heatsoak::estimation {

/// Deviation of the mean over a gap from the midpoint of the values at its ends: variance = step_share² · (difference of the ends)² +
/// beyond_sd². Fitted to all windows of that length by least squares. A quantity that changes once within a gap of one row has a
/// step_share of 0.5. Short pulses give a large beyond_sd even if the ends are equal.
struct GapStatistics {
  double step_share = 0.5;
  double beyond_sd = 0.0;  ///< in the unit of the values
};

class GapStatisticsTable {
 public:
  /// `values` has one entry per row, NaN if unknown; `usual_s` is the usual time between rows. The times must outlive this object.
  GapStatisticsTable(std::span<const double> time_s, std::vector<double> values, double usual_s);

  /// Returns the behaviour over gaps of `rows` missing rows (0 counts as 1). Long gaps use the longest length with enough windows; a log
  /// with too few windows gives the default.
  const GapStatistics& over(std::size_t rows);

 private:
  [[nodiscard]] GapStatistics from_windows(std::size_t rows) const;

  std::span<const double> time_s_;
  std::vector<double> values_;
  std::vector<double> sum_;           ///< cumulative sum of the values before each row
  std::vector<std::size_t> unknown_;  ///< number of unknown values before each row
  double usual_s_;
  std::map<std::size_t, GapStatistics> by_rows_;
};

}  // namespace heatsoak::estimation
