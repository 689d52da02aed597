// From values on an axis to pixels, and where the ticks are.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace heatsoak {

/// The part of an axis that is shown; empty until something finite was included. A logarithmic one takes positive values only.
struct AxisRange {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  bool is_logarithmic = false;

  void include(double value);
  void include(const std::vector<double>& values);
  /// Wider by `headroom` (a share of the span, of that in decades) at both ends; never empty, never of zero width.
  [[nodiscard]] AxisRange with_headroom(double headroom) const;
};

/// Map of a range to pixels, which count as VTK's scene does: y upwards. What a logarithmic axis cannot show is not finite.
struct AxisScale {
  AxisRange range;
  double low_px = 0.0;
  double high_px = 1.0;

  [[nodiscard]] double to_px(double value) const;
};

struct AxisTick {
  double value = 0.0;
  std::string label;  ///< plain notation, as many decimals as the step needs
};

/// Round values within the range, at most `count` and a few: 1, 2 or 5 times a power of ten apart; on a logarithmic axis powers
/// of ten, with twice and five times them where there is room.
std::vector<AxisTick> ticks(const AxisRange& range, double count);

}  // namespace heatsoak
