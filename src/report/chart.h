// What a chart shows, free of how it is drawn.
#pragma once

#include <string>
#include <vector>

namespace heatsoak {

/// A curve. `x` and `y` have the same length and the axes' units; a NaN breaks the line where the gap is
/// a pixel or wider.
struct ChartCurve {
  std::string name = {};  ///< shown in the legend; empty: not listed
  std::vector<double> x = {};
  std::vector<double> y = {};
  int color_index = 0;  ///< place in the palette of eight; the same index is the same colour in every panel
  bool dashed = false;
  bool dots = false;        ///< a square at every sample in place of the line
  bool has_ripple = false;  ///< where it swings up and down every few pixels it is drawn as a light area, else as a line in any case
};

/// An area between two curves over the same `x`, such as the 5 % to 95 % range of samples.
struct ChartBand {
  std::string name = {};  ///< shown in the legend; empty: not listed
  std::vector<double> x = {};
  std::vector<double> low = {};
  std::vector<double> high = {};
  int color_index = 0;
};

/// A horizontal line across the panel, such as a temperature limit; always inside the y range.
struct ChartLevel {
  std::string name = {};  ///< written at the line
  double y = 0.0;
};

/// One pair of axes. Panels of a chart stand above each other and share the x range.
struct ChartPanel {
  std::string title = {};
  std::string y_label = {};  ///< with unit, "winding temperature / °C"
  std::vector<ChartCurve> curves = {};
  std::vector<ChartBand> bands = {};
  std::vector<ChartLevel> levels = {};
  bool logarithmic = false;  ///< of y; what is not positive breaks the line
};

struct Chart {
  std::string title = {};
  std::string subtitle = {};  ///< where the figures come from, in one line
  std::string x_label;        ///< with unit, "time / min"
  std::vector<ChartPanel> panels = {};
  int width_px = 1000;
  int panel_height_px = 360;  ///< with its title and tick labels
};

/// `chart` as SVG, drawn without a display. Throws Failure (bug) where the drawing library is not found.
std::string draw_svg(const Chart& chart);

/// The bytes of a picture file in the format of its ending: PNG for ".png", with two pixels for one of the chart, else SVG.
std::string draw_picture(const Chart& chart, const std::string& file);

}  // namespace heatsoak
