// The seam to the drawing library, which is opened only when a picture is drawn: VTK loads slowly.
#pragma once

#include <string>

namespace heatsoak {

struct Chart;

inline constexpr const char* chart_plugin_file = "heatsoak_charts.so";
inline constexpr const char* chart_plugin_function = "heatsoak_draw_svg";

/// Puts the picture into `text` and returns true, or puts the reason and returns false; never throws.
/// Both sides are built by the same compiler from the same tree, so C++ types may cross.
using DrawSvg = bool (*)(const Chart* chart, std::string* text);

}  // namespace heatsoak
