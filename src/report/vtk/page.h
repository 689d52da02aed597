// Layout of a chart: the positions of all elements before anything is drawn.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/chart.h"
#include "report/vtk/scale.h"
#include "report/vtk/text.h"

namespace heatsoak::report {

enum class Anchor { left, middle, right };

/// Ground behind a text on top of curves: none, a white outline of its letters, or a white rectangle that hides what is behind it.
enum class Ground { none, rim, plate };

/// One line of text; `y_px` is its baseline.
struct PlacedText {
  std::string text;
  double x_px = 0.0;
  double y_px = 0.0;
  TextStyle style;
  Anchor anchor = Anchor::left;
  bool is_upright = false;  ///< rotated, reads from bottom to top
  Ground ground = Ground::none;
};

/// The colour and line sample in front of a legend name; `y_px` is its vertical centre.
struct LegendSwatch {
  double x_px = 0.0;
  double y_px = 0.0;
  std::optional<int> color_index = 0;  ///< index in the palette; empty: the colour of levels (ChartCurve::color_index)
  bool is_dashed = false;
  bool is_band = false;
  bool is_dots = false;
};

/// A bar of a ChartRange, upright at `x_px`.
struct RangeBar {
  double x_px = 0.0;
  double low_px = 0.0;
  double high_px = 0.0;
  double mark_px = 0.0;
  int color_index = 0;
};
inline constexpr double kRangeCap_px = 8.0;  ///< width of the ends of a bar

/// Plot area of one panel.
struct PanelPlace {
  AxisScale horizontal;
  AxisScale vertical;
  std::vector<AxisTick> x_ticks;
  std::vector<AxisTick> y_ticks;
  std::vector<RangeBar> bars;
};

/// Pixel coordinates start at the lower left corner, as in VTK's scene.
struct Page {
  int width_px = 0;
  int height_px = 0;
  std::vector<PanelPlace> panels;  ///< in the order of the chart's panels
  std::vector<PlacedText> texts;
  std::vector<LegendSwatch> swatches;
};

inline constexpr double kSwatchWidth_px = 26.0;
inline constexpr double kMarker_px = 5.0;

inline constexpr TextStyle kTickStyle{.size_px = 12, .is_bold = false, .color = {0x44, 0x44, 0x44}};
inline constexpr unsigned char kLimitColor[3] = {0xC8, 0x10, 0x2E};

/// Computes the layout of a chart.
Page lay_out(const Chart& chart);

}  // namespace heatsoak::report
