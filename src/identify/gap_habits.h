// What a quantity does over rows that nobody logged, told by what it does over as many rows that somebody did.
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <vector>

namespace heatsoak {

/// How far the mean over a gap lies from the middle between the values at its ends: variance = step_share² · (difference of the ends)² +
/// beyond_sd², from all windows of that length by least squares. A quantity that changes once within the gap has a step_share of a half
/// where the gap is one row; one that comes and goes within it lies far off even where the ends are equal.
struct GapHabit {
  double step_share = 0.5;
  double beyond_sd = 0.0;  ///< in the quantity's unit
};

class GapHabits {
 public:
  /// `values` by row, NaN where they are not known; `usual_s` between rows.
  GapHabits(std::span<const double> time_s, std::vector<double> values, double usual_s);

  /// For gaps that lack `rows` rows, at least one; long ones as the longest that there are windows of.
  const GapHabit& over(std::size_t rows);

 private:
  [[nodiscard]] GapHabit told_by_windows(std::size_t rows) const;

  std::span<const double> time_s_;
  std::vector<double> values_;
  std::vector<double> sum_;           ///< of the rows before
  std::vector<std::size_t> unknown_;  ///< of the rows before
  double usual_s_;
  std::map<std::size_t, GapHabit> told_;
};

}  // namespace heatsoak
