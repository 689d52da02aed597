#include "report/vtk/reduce.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <utility>

namespace heatsoak {
namespace {

/// Hundredths of a pixel: finer is not seen and only makes the file larger.
double rounded_px(double value_px) { return std::round(value_px * 100.0) / 100.0; }

/// A lone sample is drawn as a dot of this half width, else it would not be seen at all.
constexpr double dot_px = 1.0;

/// Consecutive samples in one column of pixels, by index.
struct PixelColumn {
  std::vector<std::size_t> samples;
  bool starts_piece = false;
};

/// `is_shown(i)` tells whether sample i is finite.
template <class IsShown>
std::vector<PixelColumn> pixel_columns(const std::vector<double>& x, const AxisScale& horizontal, IsShown is_shown) {
  std::vector<PixelColumn> columns;
  bool gap = true;
  double previous_px = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !is_shown(i)) {
      gap = true;
      continue;
    }
    const double x_px = horizontal.to_px(x[i]);
    // A gap narrower than a pixel cannot be seen and would cut noisy logs into thousands of pieces.
    const bool starts_piece = columns.empty() || (gap && std::abs(x_px - previous_px) >= 1.0);
    if (starts_piece || std::floor(x_px) != std::floor(previous_px)) {
      columns.push_back({{}, starts_piece});
    }
    columns.back().samples.push_back(i);
    gap = false;
    previous_px = x_px;
  }
  return columns;
}

}  // namespace

std::vector<std::vector<CurvePoint>> markers(const ChartCurve& curve, const AxisScale& horizontal, const AxisScale& vertical,
                                             double marker_px) {
  std::vector<std::vector<CurvePoint>> pieces;
  std::set<std::pair<double, double>> taken;
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    const double x_px = std::round(horizontal.to_px(curve.x[i]));
    const double y_px = std::round(vertical.to_px(curve.y[i]));
    if (!std::isfinite(x_px) || !std::isfinite(y_px)) {
      continue;
    }
    if (taken.emplace(x_px, y_px).second) {
      pieces.push_back({{x_px - 0.5 * marker_px, y_px}, {x_px + 0.5 * marker_px, y_px}});
    }
  }
  return pieces;
}

std::vector<std::vector<CurvePoint>> reduce(const ChartCurve& curve, const AxisScale& horizontal, const AxisScale& vertical) {
  const auto columns = pixel_columns(curve.x, horizontal, [&](std::size_t i) { return std::isfinite(vertical.to_px(curve.y[i])); });
  std::vector<std::vector<CurvePoint>> pieces;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const std::vector<std::size_t>& samples = columns[k].samples;
    const bool ends_piece = k + 1 == columns.size() || columns[k + 1].starts_piece;
    const auto [lowest, highest] = std::ranges::minmax_element(samples, {}, [&](std::size_t i) { return curve.y[i]; });
    std::vector<std::size_t> kept{*lowest, *highest};
    if (columns[k].starts_piece) {
      pieces.emplace_back();
      kept.push_back(samples.front());
    }
    if (ends_piece) {
      kept.push_back(samples.back());
    }
    std::ranges::sort(kept);
    kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
    for (const std::size_t i : kept) {
      pieces.back().push_back({rounded_px(horizontal.to_px(curve.x[i])), rounded_px(vertical.to_px(curve.y[i]))});
    }
    if (ends_piece && pieces.back().size() == 1) {
      const CurvePoint only = pieces.back().front();
      pieces.back() = {{only.x_px - dot_px, only.y_px}, {only.x_px + dot_px, only.y_px}};
    }
  }
  return pieces;
}

std::vector<std::vector<BandPoint>> reduce(const ChartBand& band, const AxisScale& horizontal, const AxisScale& vertical) {
  const auto columns = pixel_columns(band.x, horizontal, [&](std::size_t i) {
    return std::isfinite(vertical.to_px(band.low[i])) && std::isfinite(vertical.to_px(band.high[i]));
  });
  std::vector<std::vector<BandPoint>> pieces;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const std::vector<std::size_t>& samples = columns[k].samples;
    if (columns[k].starts_piece) {
      pieces.emplace_back();
    }
    double low = band.low[samples.front()];
    double high = band.high[samples.front()];
    for (const std::size_t i : samples) {
      low = std::min(low, band.low[i]);
      high = std::max(high, band.high[i]);
    }
    BandPoint point{0.0, rounded_px(vertical.to_px(low)), rounded_px(vertical.to_px(high))};
    const bool is_alone = columns[k].starts_piece && (k + 1 == columns.size() || columns[k + 1].starts_piece);
    const double half_width_px = is_alone ? dot_px : 0.0;
    point.x_px = rounded_px(horizontal.to_px(band.x[samples.front()])) - half_width_px;
    pieces.back().push_back(point);
    if (samples.size() > 1 || is_alone) {
      point.x_px = rounded_px(horizontal.to_px(band.x[samples.back()])) + half_width_px;
      pieces.back().push_back(point);
    }
  }
  return pieces;
}

}  // namespace heatsoak
