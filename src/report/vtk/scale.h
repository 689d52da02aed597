// Maps values on an axis to pixels and chooses its ticks.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace heatsoak::report {

/// Visible range of an axis; empty until a finite value was included. A logarithmic axis ignores non-positive values.
struct AxisRange {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  bool is_logarithmic = false;

  void include(double value);
  void include(const std::vector<double>& values);
  /// Returns the range widened at both ends by `headroom`, a share of its span (in decades if logarithmic). Never empty nor of zero width.
  [[nodiscard]] AxisRange with_headroom(double headroom) const;
};

/// Maps a range to pixels; y counts upwards as in VTK's scene. Values that a logarithmic axis cannot show give a non-finite result.
struct AxisScale {
  AxisRange range;
  double low_px = 0.0;
  double high_px = 1.0;

  [[nodiscard]] double to_px(double value) const;
};

/// Tick of an axis with its label.
struct AxisTick {
  double value = 0.0;
  std::string label;  ///< decimal notation with the decimals that the step needs
};

/// Returns round values within the range, roughly `count` of them: spaced by 1, 2 or 5 times a power of ten. On a logarithmic axis: powers
/// of ten, with 2 and 5 times them if there is room.
std::vector<AxisTick> ticks(const AxisRange& range, double count);

}  // namespace heatsoak::report
