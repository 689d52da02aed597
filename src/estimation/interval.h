// Width of the reported confidence intervals.
#pragma once

namespace heatsoak::estimation {

/// Half width of the confidence interval of a normal distribution with the level base::kInterval_share, in standard deviations.
inline constexpr double kInterval_sd = 1.959964;

}  // namespace heatsoak::estimation
