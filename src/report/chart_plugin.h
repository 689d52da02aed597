// Interface of the drawing library. It is opened only when a picture is drawn, because VTK loads slowly.
#pragma once

#include <cstddef>
#include <string>

#include "report/chart.h"

namespace heatsoak::report {

inline constexpr const char* chart_plugin_file = "heatsoak_charts.so";
inline constexpr const char* chart_plugin_function = "heatsoak_draw_chart";
/// Detects a library of an older build, which would misinterpret the chart's memory layout.
inline constexpr std::size_t chart_layout = sizeof(Chart) + (sizeof(ChartPanel) << 10U) + (sizeof(ChartCurve) << 20U) +
                                            (sizeof(ChartBand) << 30U) + (sizeof(ChartLevel) << 40U) + (sizeof(ChartRange) << 50U);

/// Writes the picture to `text` and returns true, or writes the reason and returns false; never throws. `layout` is the caller's
/// chart_layout. C++ types may be passed, because the same compiler builds both sides from the same source tree.
using DrawSvg = bool (*)(const Chart* chart, std::string* text, std::size_t layout);

inline constexpr const char* png_plugin_function = "heatsoak_svg_to_png";
/// The same for the conversion of an SVG to a PNG.
using SvgToPng = bool (*)(const std::string* svg, std::string* png);

}  // namespace heatsoak::report
