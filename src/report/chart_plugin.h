// Interface of the drawing library. It is opened only when a picture is drawn, because VTK loads slowly.
#pragma once

#include <cstddef>
#include <string>

#include "report/chart.h"

namespace heatsoak::report {

inline constexpr const char* kChartPluginFile = "heatsoak_charts.so";
inline constexpr const char* kChartPluginFunction = "heatsoak_draw_chart";
/// Detects a library of an older build, which would misinterpret the chart's memory layout.
inline constexpr std::size_t kChartLayout = sizeof(Chart) + (sizeof(ChartPanel) << 10U) + (sizeof(ChartCurve) << 20U) +
                                            (sizeof(ChartBand) << 30U) + (sizeof(ChartLevel) << 40U) + (sizeof(ChartRange) << 50U);

/// Writes the picture to `text` and returns true, or writes the reason and returns false; never throws. `layout` is the caller's
/// kChartLayout. C++ types may be passed, because the same compiler builds both sides from the same source tree.
using DrawSvg = bool (*)(const Chart* chart, std::string* text, std::size_t layout);

inline constexpr const char* kPngPluginFunction = "heatsoak_svg_to_png";
/// Converts an SVG to a PNG: writes it to `png` and returns true, or writes the reason and returns false; never throws.
using SvgToPng = bool (*)(const std::string* svg, std::string* png);

}  // namespace heatsoak::report
