#include "report/vtk/reduce.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <utility>

namespace heatsoak::report {
namespace {

/// Rounds to 0.01 px: finer steps are invisible and only enlarge the file.
double rounded_px(double value_px) { return std::round(value_px * 100.0) / 100.0; }

/// Half width of the dot for an isolated sample, which would be invisible as a line.
constexpr double kDot_px = 1.0;

/// Indices of consecutive samples in the same column of pixels.
struct PixelColumn {
  std::vector<std::size_t> samples;
  bool starts_piece = false;
};

/// `is_shown(i)` returns whether sample i is finite.
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
    // A gap narrower than a pixel is invisible and would split noisy logs into thousands of pieces.
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

constexpr double kWindow_px = 8.0;

/// Points [begin, end) of a piece within one window of kWindow_px pixels.
struct Window {
  std::size_t begin = 0;
  std::size_t end = 0;
  double low_px = 0.0;
  double high_px = 0.0;
  bool is_ripple = false;  ///< oscillates more than once, by more than the lines along its maxima and minima are wide
};

/// Ripple lasts for several windows: a few windows alone are noise or a peak, and a few without ripple beside a ripple, such as the steep
/// first cycles of a warm-up, belong to it. Otherwise the picture would change between line and area.
void unify(std::vector<Window>& windows) {
  constexpr std::ptrdiff_t kLeastWindows = 6;
  for (const bool is_ripple : {true, false}) {
    for (auto first = windows.begin(); first != windows.end();) {
      const auto last = std::find_if(first, windows.end(), [&](const Window& each) { return each.is_ripple != first->is_ripple; });
      const bool is_whole = first == windows.begin() && last == windows.end();
      if (first->is_ripple == is_ripple && last - first < kLeastWindows && (is_ripple || !is_whole)) {
        std::for_each(first, last, [is_ripple](Window& each) { each.is_ripple = !is_ripple; });
      }
      first = last;
    }
  }
}

std::vector<Window> windows_of(const std::vector<CurvePoint>& piece) {
  constexpr double kSwings = 2.5;
  constexpr double kLeast_px = kCurveWidth_px + kMinimaWidth_px;  // below it the two lines overlap
  std::vector<Window> windows;
  for (std::size_t i = 0; i < piece.size();) {
    Window window{.begin = i, .end = i, .low_px = piece[i].y_px, .high_px = piece[i].y_px};
    double travel_px = 0.0;
    const double place = std::floor(piece[i].x_px / kWindow_px);
    for (; i < piece.size() && std::floor(piece[i].x_px / kWindow_px) == place; ++i) {
      travel_px += i > window.begin ? std::abs(piece[i].y_px - piece[i - 1].y_px) : 0.0;
      window.low_px = std::min(window.low_px, piece[i].y_px);
      window.high_px = std::max(window.high_px, piece[i].y_px);
    }
    window.end = i;
    const double range_px = window.high_px - window.low_px;
    window.is_ripple = range_px > kLeast_px && travel_px > kSwings * range_px;
    windows.push_back(window);
  }
  // A last window that ends early contains no whole cycle.
  if (windows.size() > 1 && piece.back().x_px - piece[windows.back().begin].x_px < 0.5 * kWindow_px) {
    const Window last = windows.back();
    windows.pop_back();
    windows.back().end = last.end;
    windows.back().low_px = std::min(windows.back().low_px, last.low_px);
    windows.back().high_px = std::max(windows.back().high_px, last.high_px);
  }
  unify(windows);
  return windows;
}

}  // namespace

RippledPiece without_ripple(const std::vector<CurvePoint>& piece) {
  RippledPiece result;
  bool was_ripple = true;
  bool is_first = true;
  for (const Window& window : windows_of(piece)) {
    const double begin_px = piece[window.begin].x_px;
    const double end_px = piece[window.end - 1].x_px;
    if (window.is_ripple) {
      if (is_first || !was_ripple) {
        // The envelope opens from the curve's own point, so that it does not jump.
        const CurvePoint& from = piece[window.begin > 0 ? window.begin - 1 : 0];
        result.envelopes.push_back({{from.x_px, from.y_px, from.y_px}});
      }
      result.envelopes.back().push_back({0.5 * (begin_px + end_px), window.low_px, window.high_px});
      if (window.end == piece.size()) {
        result.envelopes.back().push_back({end_px, window.low_px, window.high_px});
      }
    } else {
      if (is_first || was_ripple) {
        result.lines.emplace_back();
        if (window.begin > 0) {
          // The envelope closes at the point where the line continues.
          const CurvePoint& to = piece[window.begin - 1];
          result.envelopes.back().push_back({to.x_px, to.y_px, to.y_px});
          result.lines.back().push_back(to);
        }
      }
      result.lines.back().insert(result.lines.back().end(), piece.begin() + static_cast<std::ptrdiff_t>(window.begin),
                                 piece.begin() + static_cast<std::ptrdiff_t>(window.end));
    }
    was_ripple = window.is_ripple;
    is_first = false;
  }
  return result;
}

std::vector<std::vector<CurvePoint>> drawn_lines(const RippledPiece& piece) {
  std::vector<std::vector<CurvePoint>> lines = piece.lines;
  for (const std::vector<BandPoint>& ripple : piece.envelopes) {
    for (const auto edge : {&BandPoint::low_px, &BandPoint::high_px}) {
      lines.emplace_back();
      for (const BandPoint& at : ripple) {
        lines.back().push_back({at.x_px, at.*edge});
      }
    }
  }
  return lines;
}

std::vector<std::vector<CurvePoint>> markers(const ChartCurve& curve, const AxisScale& horizontal, const AxisScale& vertical,
                                             double length_px) {
  std::vector<std::vector<CurvePoint>> pieces;
  std::set<std::pair<double, double>> taken;
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    const double x_px = std::round(horizontal.to_px(curve.x[i]));
    const double y_px = std::round(vertical.to_px(curve.y[i]));
    if (!std::isfinite(x_px) || !std::isfinite(y_px)) {
      continue;
    }
    if (taken.emplace(x_px, y_px).second) {
      pieces.push_back({{x_px - 0.5 * length_px, y_px}, {x_px + 0.5 * length_px, y_px}});
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
      pieces.back() = {{only.x_px - kDot_px, only.y_px}, {only.x_px + kDot_px, only.y_px}};
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
    const double half_width_px = is_alone ? kDot_px : 0.0;
    point.x_px = rounded_px(horizontal.to_px(band.x[samples.front()])) - half_width_px;
    pieces.back().push_back(point);
    if (samples.size() > 1 || is_alone) {
      point.x_px = rounded_px(horizontal.to_px(band.x[samples.back()])) + half_width_px;
      pieces.back().push_back(point);
    }
  }
  return pieces;
}

}  // namespace heatsoak::report
