// The seam to the drawing library, which is opened only when a picture is drawn: VTK loads slowly.
#pragma once

#include <cstddef>
#include <string>

#include "report/chart.h"

namespace heatsoak {

inline constexpr const char* chart_plugin_file = "heatsoak_charts.so";
inline constexpr const char* chart_plugin_function = "heatsoak_draw_chart";
/// A library of another build, left behind, would take a chart for something else.
inline constexpr std::size_t chart_layout =
    sizeof(Chart) + (sizeof(ChartPanel) << 10U) + (sizeof(ChartCurve) << 20U) + (sizeof(ChartBand) << 30U) + (sizeof(ChartLevel) << 40U);

/// Puts the picture into `text` and returns true, or puts the reason and returns false; never throws.
/// Both sides are built by the same compiler from the same tree, so C++ types may cross.
/// `layout` is the caller's chart_layout.
using DrawSvg = bool (*)(const Chart* chart, std::string* text, std::size_t layout);

inline constexpr const char* png_plugin_function = "heatsoak_svg_to_png";
/// The same for an SVG that is turned into a PNG.
using SvgToPng = bool (*)(const std::string* svg, std::string* png);

}  // namespace heatsoak
