// Places of the names of horizontal lines, such as "limit 155 °C".
#pragma once

#include <vector>

#include "report/vtk/page.h"

namespace heatsoak::report {

/// Horizontal limits of the names of one panel.
struct LevelSpace {
  double left_px = 0.0;           ///< left end of the curves
  double last_px = 0.0;           ///< right end of names inside the panel
  double outside_px = 0.0;        ///< left end of names to the right of the panel
  double end_px = 0.0;            ///< right end of names to the right of the panel
  double legend_bottom_px = 0.0;  ///< names to the right of the panel start below it
};

/// Returns the names of a panel's levels where no curve, other level or other name passes. y counts downwards, as in `place`.
///
/// A name stands above the right end of its line. Other places, in the order of preference: below the line, on the line, further left, to
/// the right of the panel. If there is no free place, the name hides the curves behind it.
std::vector<PlacedText> level_names(const ChartPanel& panel, const PanelPlace& place, const LevelSpace& space);

}  // namespace heatsoak::report
