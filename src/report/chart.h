// Content of a chart, independent of how it is drawn.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace heatsoak::report {

/// A curve. `x` and `y` have the same length and the units of the axes. NaN interrupts the line if the gap is at least one pixel wide.
struct ChartCurve {
  std::string name = {};  ///< shown in the legend; empty: not listed
  std::vector<double> x = {};
  std::vector<double> y = {};
  /// Index in the palette of eight, the same colour in every panel. Empty: the colour of levels, for a limit that is no horizontal line.
  std::optional<int> color_index = 0;
  bool dashed = false;
  bool dots = false;        ///< draw a square at every sample instead of a line
  bool has_ripple = false;  ///< draw parts that oscillate within a few pixels as lines along maxima and minima; false: one line
};

/// The area between two curves over the same `x`, such as the 5th to 95th percentile of samples.
struct ChartBand {
  std::string name = {};  ///< shown in the legend; empty: not listed
  std::vector<double> x = {};
  std::vector<double> low = {};
  std::vector<double> high = {};
  int color_index = 0;
};

/// A range of y, such as that of a peak, drawn as a bar with a mark beside the right end of the curves. The y range includes it.
struct ChartRange {
  double low = 0.0;
  double high = 0.0;
  double y = 0.0;  ///< the mark
  int color_index = 0;
};

/// A horizontal line across the panel, such as a temperature limit. The y range includes it.
struct ChartLevel {
  std::string name = {};  ///< written at the line
  double y = 0.0;
  /// Leaves the level out of the y range if it would make more than a third of the panel empty. Its name then stands at the edge with an
  /// arrow.
  bool may_be_outside = false;
};

/// One pair of axes. The panels of a chart are stacked and share the x range.
struct ChartPanel {
  std::string title = {};
  std::string y_label = {};  ///< with unit, "winding temperature / °C"
  std::vector<ChartCurve> curves = {};
  std::vector<ChartBand> bands = {};
  std::vector<ChartRange> ranges = {};
  std::string range_label = {};  ///< above the bars of `ranges`
  std::vector<ChartLevel> levels = {};
  bool logarithmic = false;  ///< logarithmic y axis; non-positive values interrupt the line
};

struct Chart {
  std::string title = {};
  std::string subtitle = {};  ///< origin of the data, in one line
  std::string x_label;        ///< with unit, "time / min"
  std::vector<ChartPanel> panels = {};
  int width_px = 1000;
  int panel_height_px = 360;  ///< includes title and tick labels
};

/// Throws Failure (bad_input) if the drawing library is missing. `what` needs it; `remedy` says how to do without it.
void require_drawing(std::string_view what, std::string_view remedy);

/// Draws `chart` as SVG; needs no display. Throws Failure (bug) if the drawing library is missing or fails.
std::string draw_svg(const Chart& chart);

/// Endings of the files that draw_picture() can write.
inline constexpr std::array<std::string_view, 2> kPictureEndings{".svg", ".png"};

/// Returns the bytes of a picture in the format of the file's extension: PNG for ".png" with two pixels per chart pixel, else SVG.
std::string draw_picture(const Chart& chart, const std::string& file);

}  // namespace heatsoak::report
