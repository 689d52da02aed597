// Long curves brought down to what a screen can show.
#pragma once

#include <vector>

#include "report/chart.h"
#include "report/vtk/scale.h"

namespace heatsoak {

struct CurvePoint {
  double x_px = 0.0;
  double y_px = 0.0;
};

struct BandPoint {
  double x_px = 0.0;
  double low_px = 0.0;
  double high_px = 0.0;
};

/// Every sample that can be seen as a piece of its own, a line as long as a marker is wide; of several in one pixel one.
std::vector<std::vector<CurvePoint>> markers(const ChartCurve& curve, const AxisScale& horizontal, const AxisScale& vertical,
                                             double marker_px);

/// The unbroken pieces of a curve, with the minimum and maximum of each pixel column and both ends.
std::vector<std::vector<CurvePoint>> reduce(const ChartCurve& curve, const AxisScale& horizontal, const AxisScale& vertical);
std::vector<std::vector<BandPoint>> reduce(const ChartBand& band, const AxisScale& horizontal, const AxisScale& vertical);

/// A piece of a curve, apart where it swings up and down every few pixels: a line there would be a solid block.
struct RippledPiece {
  std::vector<std::vector<CurvePoint>> lines;
  std::vector<std::vector<BandPoint>> envelopes;  ///< lowest and highest of the ripple
};
RippledPiece without_ripple(const std::vector<CurvePoint>& piece);

}  // namespace heatsoak
