#include "report/vtk/scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace heatsoak::report {
namespace {

double round_step(double step) {
  const double decade = std::pow(10.0, std::floor(std::log10(step)));
  for (const double multiple : {1.0, 2.0, 5.0}) {
    if (multiple * decade >= step * (1.0 - 1e-9)) {
      return multiple * decade;
    }
  }
  return 10.0 * decade;
}

/// Decimal notation up to ten digits, exponential notation beyond.
std::string tick_label(double value, double step, double largest) {
  if (largest >= 1e10 || step < 1e-6) {
    return fmt::format("{:.6g}", value);
  }
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  return fmt::format("{:.{}f}", value, decimals);
}

}  // namespace

void AxisRange::include(double value) {
  if (std::isfinite(value) && (!is_logarithmic || value > 0.0)) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
}

void AxisRange::include(const std::vector<double>& values) {
  for (const double value : values) {
    include(value);
  }
}

AxisRange AxisRange::with_headroom(double headroom) const {
  if (is_logarithmic) {
    constexpr double kLeastFactor = 1.1;
    const double factor = low > high ? 10.0 : std::max(kLeastFactor, std::pow(high / low, headroom));
    return {(low > high ? 1.0 : low) / factor, (low > high ? 1.0 : high) * factor, true};
  }
  if (low > high) {
    return {0.0, 1.0};
  }
  // A constant gets a range too: 0.3 A is shown from 0.285 to 0.315 A, 0 from -1 to 1.
  const double least_span = std::max(std::abs(low), std::abs(high)) * 1e-9;
  if (high - low <= least_span) {
    const double margin = low == 0.0 ? 1.0 : std::abs(low) * 0.05;
    return {low - margin, high + margin};
  }
  return {low - headroom * (high - low), high + headroom * (high - low)};
}

double AxisScale::to_px(double value) const {
  const double share = range.is_logarithmic ? std::log(value / range.low) / std::log(range.high / range.low)
                                            : (value - range.low) / (range.high - range.low);
  return low_px + share * (high_px - low_px);
}

namespace {

std::vector<AxisTick> logarithmic_ticks(const AxisRange& range, double count) {
  const bool has_room = 2.0 * std::log10(range.high / range.low) <= std::max(3.0, count);
  std::vector<AxisTick> result;
  const int last = static_cast<int>(std::floor(std::log10(range.high)));
  for (int exponent = static_cast<int>(std::floor(std::log10(range.low))); exponent <= last; ++exponent) {
    for (const double multiple : {1.0, 2.0, 5.0}) {
      const double value = multiple * std::pow(10.0, exponent);
      if (value >= range.low * (1.0 - 1e-9) && value <= range.high * (1.0 + 1e-9) && (multiple == 1.0 || has_room)) {
        result.push_back({value, fmt::format("{:g}", value)});
      }
    }
  }
  return result;
}

}  // namespace

std::vector<AxisTick> ticks(const AxisRange& range, double count) {
  if (range.is_logarithmic) {
    return logarithmic_ticks(range, count);
  }
  const double step = round_step((range.high - range.low) / std::max(3.0, count));
  // The tolerance keeps an outermost tick that rounding errors would drop.
  const double first = std::ceil(range.low / step - 1e-6);
  const double last = std::floor(range.high / step + 1e-6);
  const double largest = std::max(std::abs(range.low), std::abs(range.high));
  std::vector<AxisTick> result;
  for (int i = 0; first + i <= last; ++i) {
    const double value = (first + i) * step + 0.0;  // avoids "-0"
    result.push_back({value, tick_label(value, step, largest)});
  }
  return result;
}

}  // namespace heatsoak::report
