// Reduces long curves to the resolution of a screen.
#pragma once

#include <vector>

#include "report/chart.h"
#include "report/vtk/scale.h"

namespace heatsoak::report {

inline constexpr double kCurveWidth_px = 2.0;
inline constexpr double kMinimaWidth_px = 1.0;  ///< line along the minima of a ripple; the one along its maxima is a curve

struct CurvePoint {
  double x_px = 0.0;
  double y_px = 0.0;
};

struct BandPoint {
  double x_px = 0.0;
  double low_px = 0.0;
  double high_px = 0.0;
};

/// Returns one short line, `length_px` long, for each visible sample; of several samples in one pixel only one is kept.
std::vector<std::vector<CurvePoint>> markers(const ChartCurve& curve, const AxisScale& horizontal, const AxisScale& vertical,
                                             double length_px);

/// Returns the unbroken pieces of a curve, reduced to minimum, maximum, first and last sample of each pixel column.
std::vector<std::vector<CurvePoint>> reduce(const ChartCurve& curve, const AxisScale& horizontal, const AxisScale& vertical);
/// Returns the unbroken pieces of a band, reduced to minimum and maximum of each pixel column.
std::vector<std::vector<BandPoint>> reduce(const ChartBand& band, const AxisScale& horizontal, const AxisScale& vertical);

/// A piece of a curve, split into lines and envelopes. Parts that oscillate within a few pixels become envelopes, because their line would
/// be a solid block.
struct RippledPiece {
  std::vector<std::vector<CurvePoint>> lines;
  std::vector<std::vector<BandPoint>> envelopes;  ///< minimum and maximum of the ripple
};
/// Replaces the ripple of a piece by envelopes.
RippledPiece without_ripple(const std::vector<CurvePoint>& piece);
/// Returns all lines that are drawn for the piece: its lines, and both edges of its envelopes.
std::vector<std::vector<CurvePoint>> drawn_lines(const RippledPiece& piece);

}  // namespace heatsoak::report
