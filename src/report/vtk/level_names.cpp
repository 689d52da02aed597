#include "report/vtk/level_names.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <optional>
#include <string>

#include "report/vtk/reduce.h"

namespace heatsoak::report {
namespace {

constexpr TextStyle kLimitStyle{.size_px = 12, .is_bold = false, .color = {kLimitColor[0], kLimitColor[1], kLimitColor[2]}};
constexpr double kDescent_px = kDescent_ratio * kLimitStyle.size_px;

/// Rectangle; y counts downwards.
struct Box {
  double left_px;
  double right_px;
  double top_px;
  double bottom_px;
};

bool overlap(const Box& a, const Box& b) {
  return a.left_px < b.right_px && b.left_px < a.right_px && a.top_px < b.bottom_px && b.top_px < a.bottom_px;
}

/// Returns whether the line from `a` to `b` crosses the box.
bool passes(const CurvePoint& a, const CurvePoint& b, const Box& box) {
  const auto [left, right] = std::minmax(a, b, [](const auto& p, const auto& q) { return p.x_px < q.x_px; });
  const double slope = right.x_px > left.x_px ? (right.y_px - left.y_px) / (right.x_px - left.x_px) : 0.0;
  const double from_px = std::max(left.x_px, box.left_px);
  const double to_px = std::min(right.x_px, box.right_px);
  const double y_from_px = left.y_px + slope * (from_px - left.x_px);
  const double y_to_px = slope == 0.0 ? right.y_px : left.y_px + slope * (to_px - left.x_px);
  return from_px <= to_px && std::min(y_from_px, y_to_px) < box.bottom_px && std::max(y_from_px, y_to_px) > box.top_px;
}

bool is_taken(const Box& box, const std::vector<Box>& names, const std::vector<std::vector<CurvePoint>>& curves) {
  return std::ranges::any_of(names, [&](const Box& name) { return overlap(box, name); }) ||
         std::ranges::any_of(curves, [&](const std::vector<CurvePoint>& points) {
           const auto through_box = [&](const CurvePoint& a, const CurvePoint& b) { return passes(a, b, box); };
           return std::ranges::adjacent_find(points, through_box) != points.end();
         });
}

/// Moves `box` to the left until it is free; returns nothing if it does not become free.
std::optional<Box> free_place(Box box, double left_end_px, const std::vector<Box>& names,
                              const std::vector<std::vector<CurvePoint>>& curves) {
  constexpr double kStep_px = 10.0;
  while (box.left_px > left_end_px) {
    if (!is_taken(box, names, curves)) {
      return box;
    }
    box.left_px -= kStep_px;
    box.right_px -= kStep_px;
  }
  return std::nullopt;
}

/// Returns all unbroken pieces of all curves, with the edges of a ripple in its place.
std::vector<std::vector<CurvePoint>> curves_px(const ChartPanel& panel, const AxisScale& horizontal, const AxisScale& vertical) {
  std::vector<std::vector<CurvePoint>> all;
  for (const ChartCurve& curve : panel.curves) {
    for (std::vector<CurvePoint>& piece : reduce(curve, horizontal, vertical)) {
      if (curve.has_ripple) {
        std::ranges::move(drawn_lines(without_ripple(piece)), std::back_inserter(all));
      } else {
        all.push_back(std::move(piece));
      }
    }
  }
  return all;
}

/// Names of one panel, placed from the highest level to the lowest.
class LevelNames {
 public:
  LevelNames(const ChartPanel& panel, const PanelPlace& place, const LevelSpace& space)
      : panel_(panel), vertical_(place.vertical), space_(space), curves_(curves_px(panel, place.horizontal, place.vertical)) {}

  PlacedText placed(const ChartLevel& level) {
    const AxisRange& shown = vertical_.range;
    const std::string arrow = level.y > shown.high ? "↑ " : level.y < shown.low ? "↓ " : "";
    PlacedText text{.text = arrow + printable(level.name), .style = kLimitStyle, .anchor = Anchor::right};
    constexpr double kBetweenNames_px = 12.0;
    const double width_px = text_width_px(text.text, kLimitStyle) + (arrow.empty() ? 0.0 : kBetweenNames_px);
    const double line_px = vertical_.to_px(std::clamp(level.y, shown.low, shown.high));
    text.ground = Ground::rim;
    std::optional<Box> box = place_beside(level, line_px, width_px);
    if (!box && arrow.empty()) {
      text.ground = Ground::plate;
      box = free_place(on_line(line_px, width_px), space_.left_px, taken(level), curves_);
    }
    if (!box) {
      box = place_outside(line_px, width_px);
      text.ground = Ground::none;
      text.anchor = box ? Anchor::left : Anchor::right;
    }
    if (!box) {
      text.ground = Ground::plate;
      box = place_on_curves(level, line_px, width_px);
    }
    text.x_px = text.anchor == Anchor::left ? box->left_px : box->right_px;
    text.y_px = box->bottom_px - kDescent_px;
    names_.push_back(*box);
    return text;
  }

 private:
  /// Returns the box of a name that ends at the right end of the curves. `baseline_px` is that of its text.
  [[nodiscard]] Box at_end(double baseline_px, double width_px) const {
    return {space_.last_px - width_px, space_.last_px, baseline_px - kLimitStyle.size_px, baseline_px + kDescent_px};
  }
  [[nodiscard]] Box above(double line_px, double width_px) const { return at_end(line_px - 5.0, width_px); }
  [[nodiscard]] Box below(double line_px, double width_px) const { return at_end(line_px + 14.0, width_px); }

  [[nodiscard]] Box on_line(double line_px, double width_px) const {
    constexpr double kHalfCapital_px = 0.36 * kLimitStyle.size_px;
    const double baseline_px = line_px + kHalfCapital_px;
    return {space_.last_px - width_px, space_.last_px, baseline_px - kAscent_ratio * kLimitStyle.size_px, baseline_px + kDescent_px};
  }

  [[nodiscard]] bool is_top_near(double line_px) const { return line_px - vertical_.high_px < kLimitStyle.size_px + 1.0; }

  /// Returns the names so far and the lines of the other levels.
  [[nodiscard]] std::vector<Box> taken(const ChartLevel& level) const {
    std::vector<Box> boxes = names_;
    for (const ChartLevel& other : panel_.levels) {
      if (other.y != level.y && other.y >= vertical_.range.low && other.y <= vertical_.range.high) {
        boxes.push_back({space_.left_px, space_.end_px, vertical_.to_px(other.y) - 1.0, vertical_.to_px(other.y) + 1.0});
      }
    }
    return boxes;
  }

  /// Returns a free place above or below the line.
  [[nodiscard]] std::optional<Box> place_beside(const ChartLevel& level, double line_px, double width_px) const {
    const std::vector<Box> others = taken(level);
    if (!is_top_near(line_px)) {
      if (const std::optional<Box> free = free_place(above(line_px, width_px), space_.left_px, others, curves_)) {
        return free;
      }
    }
    return free_place(below(line_px, width_px), space_.left_px, others, curves_);
  }

  /// Returns a free place to the right of the panel, at the line or up to a few text lines away from it.
  [[nodiscard]] std::optional<Box> place_outside(double line_px, double width_px) const {
    const double height_px = 1.2 * kLimitStyle.size_px;
    for (const double half_lines : {0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, -1.0, -2.0, -3.0}) {
      const double middle_px = line_px + half_lines * 0.5 * height_px;
      const Box place{space_.outside_px, space_.outside_px + width_px, middle_px - 0.5 * height_px, middle_px + 0.5 * height_px};
      if (place.right_px <= space_.end_px && place.top_px > space_.legend_bottom_px && !is_taken(place, names_, {})) {
        return place;
      }
    }
    return std::nullopt;
  }

  /// Returns a place that no other name has.
  [[nodiscard]] Box place_on_curves(const ChartLevel& level, double line_px, double width_px) const {
    const Box first = is_top_near(line_px) ? below(line_px, width_px) : above(line_px, width_px);
    std::optional<Box> free = free_place(first, space_.left_px, taken(level), {});
    for (Box lower = below(line_px, width_px); !free && lower.bottom_px < vertical_.low_px;) {
      free = free_place(lower, space_.left_px, names_, {});
      lower.top_px += kLimitStyle.size_px + 2.0;
      lower.bottom_px += kLimitStyle.size_px + 2.0;
    }
    return free.value_or(below(line_px, width_px));
  }

  const ChartPanel& panel_;
  const AxisScale& vertical_;
  const LevelSpace& space_;
  std::vector<std::vector<CurvePoint>> curves_;
  std::vector<Box> names_;
};

}  // namespace

std::vector<PlacedText> level_names(const ChartPanel& panel, const PanelPlace& place, const LevelSpace& space) {
  std::vector<ChartLevel> from_above = panel.levels;
  std::erase_if(from_above, [](const ChartLevel& level) { return level.name.empty() || !std::isfinite(level.y); });
  if (from_above.empty()) {
    return {};
  }
  std::ranges::stable_sort(from_above, std::greater(), &ChartLevel::y);
  LevelNames names(panel, place, space);
  std::vector<PlacedText> texts;
  std::ranges::transform(from_above, std::back_inserter(texts), [&names](const ChartLevel& level) { return names.placed(level); });
  return texts;
}

}  // namespace heatsoak::report
