// Order of the rows of a log in time, and division into runs.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace heatsoak::recording {

/// Median time between two rows; 0 with fewer than two rows.
double usual_period_s(std::span<const double> time_s);

/// Returns 1 for each row to keep and 0 for the others, so that time strictly increases and as many rows as possible stay (longest
/// increasing subsequence). Of rows with equal time the first stays.
std::vector<char> increasing_rows(std::span<const double> time_s);

/// Longest step within a run, as a multiple of the usual period. The margin prevents that rounding splits at exactly three periods.
inline constexpr double kLongestStep_ratio = 3.0 * (1.0 + 1e-6);

/// Returns the first rows of runs: row 0, each row after a gap longer than `longest_gap_s`, and each row in which `values` (empty or one
/// per row) changes.
std::vector<std::size_t> run_begins(std::span<const double> time_s, std::span<const double> values, double longest_gap_s);

}  // namespace heatsoak::recording
