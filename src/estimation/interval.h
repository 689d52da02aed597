// Width of the reported confidence intervals.
#pragma once

namespace heatsoak::estimation {

/// Half width of the 95 % interval of a normal distribution, in standard deviations.
inline constexpr double kInterval_sd = 1.959964;

}  // namespace heatsoak::estimation
