// Which rows of a log follow each other in time, and where a run ends.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace heatsoak {

/// The median time between two rows; 0 with less than two rows.
double usual_period_s(std::span<const double> time_s);

/// The rows to keep so that time strictly increases and as many rows as possible stay (longest increasing subsequence);
/// of rows with one time the first stays. One char per row: 1 stays.
std::vector<char> increasing_rows(std::span<const double> time_s);

/// Of the usual period. Three, and a little: a step of exactly three periods must not split by rounding.
inline constexpr double kLongestStep_ratio = 3.0 * (1.0 + 1e-6);

/// The first rows of runs: 0, each row after a gap of more than `longest_gap_s`, each row where `values` (empty, or one per row) changes.
std::vector<std::size_t> run_begins(std::span<const double> time_s, std::span<const double> values, double longest_gap_s);

}  // namespace heatsoak
