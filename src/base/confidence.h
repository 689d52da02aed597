// Levels of the intervals, bands and percentiles that the program reports. Calculations and texts take them from here.
#pragma once

#include <fmt/format.h>

#include <string>

namespace heatsoak::base {

/// Probability that a confidence interval does not contain the true value, half of it on each side.
inline constexpr double kError_share = 0.05;
/// Two-sided confidence of an interval.
inline constexpr double kInterval_share = 1.0 - kError_share;
/// One-sided confidence of each end of an interval.
inline constexpr double kBoundConfidence_share = 1.0 - 0.5 * kError_share;

/// Share of the measured samples that the band of a forecast contains, half of the others on each side.
inline constexpr double kBand_share = 0.9;

/// Percentiles of samples that answers give as "p05" and "p95".
inline constexpr double kLowPercentile_share = 0.05;
inline constexpr double kHighPercentile_share = 0.95;

/// Formats a level: "95 %".
inline std::string level_text(double share) { return fmt::format("{:.3g} %", 100.0 * share); }

}  // namespace heatsoak::base
