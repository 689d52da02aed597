#include "report/vtk/page.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>

#include "report/vtk/level_names.h"

namespace heatsoak::report {
namespace {

constexpr TextStyle kTitleStyle{.size_px = 20, .is_bold = true, .color = {0x11, 0x11, 0x11}};
constexpr TextStyle kSubtitleStyle{.size_px = 13, .is_bold = false, .color = {0x6B, 0x6B, 0x6B}};
constexpr TextStyle kPanelTitleStyle{.size_px = 14, .is_bold = true};
constexpr TextStyle kLabelStyle{.size_px = 13};

constexpr double kMargin_px = 24.0;
constexpr double kLabelLine_px = 18.0;
constexpr double kLegendGap_px = 4.0;
constexpr double kTickRow_px = 26.0;
constexpr double kTickDistanceX_px = 70.0;  // minimum distance
constexpr double kTickDistanceY_px = 36.0;
constexpr double kLeastPlotHeight_px = 60.0;
constexpr double kHeadroom = 0.05;
constexpr double kRangeDistance_px = 14.0;  // between two bars
constexpr double kLeastRanges_px = 84.0;    // room for the label above the bars

struct LegendEntry {
  std::string name;
  LegendSwatch swatch;
};

/// Returns every named curve and band of all panels; entries with the same name and look appear once.
std::vector<LegendEntry> legend_entries(const Chart& chart) {
  std::vector<LegendEntry> entries;
  const auto add = [&](const std::string& name, const LegendSwatch& swatch) {
    const auto same = [&](const LegendEntry& each) {
      const LegendSwatch& other = each.swatch;
      return std::tie(each.name, other.color_index, other.is_dashed, other.is_band, other.is_dots) ==
             std::tie(name, swatch.color_index, swatch.is_dashed, swatch.is_band, swatch.is_dots);
    };
    if (!name.empty() && std::ranges::none_of(entries, same)) {
      entries.push_back({name, swatch});
    }
  };
  for (const ChartPanel& panel : chart.panels) {
    for (const ChartCurve& curve : panel.curves) {
      add(curve.name, {.color_index = curve.color_index, .is_dashed = curve.dashed, .is_dots = curve.dots});
    }
  }
  for (const ChartPanel& panel : chart.panels) {
    for (const ChartBand& band : panel.bands) {
      add(band.name, {.color_index = band.color_index, .is_band = true});
    }
  }
  return entries;
}

AxisRange x_range(const Chart& chart) {
  AxisRange range;
  for (const ChartPanel& panel : chart.panels) {
    for (const ChartCurve& curve : panel.curves) {
      range.include(curve.x);
    }
    for (const ChartBand& band : panel.bands) {
      range.include(band.x);
    }
  }
  return range.with_headroom(0.0);
}

/// Returns whether more than a third of a range that includes `value` would contain no data.
bool is_far_from(const AxisRange& data, double value) {
  constexpr double kMostEmpty_share = 1.0 / 3.0;
  const auto place = [&data](double y) { return data.is_logarithmic ? std::log10(y) : y; };
  if (data.low > data.high || !std::isfinite(place(value))) {
    return false;
  }
  const double low = place(data.low);
  const double high = place(data.high);
  const double beyond = std::max(place(value) - high, low - place(value));
  return beyond > kMostEmpty_share * (beyond + high - low);
}

AxisRange y_range(const ChartPanel& panel) {
  AxisRange range;
  range.is_logarithmic = panel.logarithmic;
  for (const ChartCurve& curve : panel.curves) {
    range.include(curve.y);
  }
  for (const ChartBand& band : panel.bands) {
    range.include(band.low);
    range.include(band.high);
  }
  for (const ChartRange& each : panel.ranges) {
    range.include(each.low);
    range.include(each.high);
    range.include(each.y);
  }
  const AxisRange of_data = range;
  for (const ChartLevel& level : panel.levels) {
    if (!level.may_be_outside || !is_far_from(of_data, level.y)) {
      range.include(level.y);
    }
  }
  return range.with_headroom(kHeadroom);
}

/// Builds a Page from top to bottom. y counts downwards here; the result is flipped at the end.
class PageBuilder {
 public:
  explicit PageBuilder(const Chart& chart) : chart_(chart) { page_.width_px = std::max(200, chart.width_px); }

  Page build() {
    add_heading();
    find_margins();
    if (is_legend_on_top_) {
      add_legend_rows();
    }
    const double legend_top_px = y_px_ + panel_title_height_px(chart_.panels.empty() ? "" : chart_.panels[0].title);
    legend_bottom_px_ = legend_top_px;
    for (const LegendEntry& entry : is_legend_on_top_ ? std::vector<LegendEntry>{} : entries_) {
      legend_bottom_px_ += static_cast<double>(legend_lines(entry).size()) * kLabelLine_px + kLegendGap_px;
    }
    for (const ChartPanel& panel : chart_.panels) {
      add_panel(panel);
    }
    add_x_label();
    if (!is_legend_on_top_) {
      add_legend(legend_top_px);
    }
    return finished();
  }

 private:
  void add_heading() {
    const double width_px = page_.width_px - 2.0 * kMargin_px;
    y_px_ = 16.0;
    for (const std::string& line : wrapped(printable(chart_.title), kTitleStyle, width_px)) {
      y_px_ += 26.0;
      add({.text = line, .x_px = kMargin_px, .y_px = y_px_ - 3.0, .style = kTitleStyle});
    }
    for (const std::string& line : wrapped(printable(chart_.subtitle), kSubtitleStyle, width_px)) {
      y_px_ += kLabelLine_px;
      add({.text = line, .x_px = kMargin_px, .y_px = y_px_, .style = kSubtitleStyle});
    }
    y_px_ += 10.0;
  }

  /// All panels share their left and right edges, which leave room for the widest tick label and the longest legend.
  void find_margins() {
    std::size_t y_label_lines = 0;
    double tick_label_px = 0.0;
    for (const ChartPanel& panel : chart_.panels) {
      y_label_lines = std::max(y_label_lines, y_label(panel).size());
      for (const AxisTick& tick : ticks(y_range(panel), plot_height_px(panel) / kTickDistanceY_px)) {
        tick_label_px = std::max(tick_label_px, text_width_px(tick.label, kTickStyle));
      }
    }
    y_label_x_px_ = kMargin_px + kLabelStyle.size_px * 0.75;
    left_px_ = std::ceil(kMargin_px + static_cast<double>(y_label_lines) * kLabelLine_px + tick_label_px + 14.0);

    entries_ = legend_entries(chart_);
    double legend_px = 0.0;
    for (const LegendEntry& entry : entries_) {
      for (const std::string& line : legend_lines(entry)) {
        legend_px = std::max(legend_px, text_width_px(line, kLabelStyle));
      }
    }
    right_px_ = page_.width_px - kMargin_px;
    // A wide legend beside several panels, or a single entry beside any, would leave most of its column empty.
    constexpr double kBroad_share = 0.27;
    const bool wastes_column = entries_.size() == 1 || (chart_.panels.size() > 1 && column_width_px() > kBroad_share * page_.width_px);
    is_legend_on_top_ = wastes_column && column_width_px() <= right_px_ - left_px_;
    if (!entries_.empty() && !is_legend_on_top_) {
      legend_x_px_ = std::floor(right_px_ - legend_px - kSwatchWidth_px - 8.0);
      right_px_ = legend_x_px_ - 22.0;
    }
    right_px_ = std::max(right_px_, left_px_ + 60.0);
  }

  void add_panel(const ChartPanel& panel) {
    const double title_px = panel_title_height_px(panel.title);
    const double plot_px = plot_height_px(panel);
    if (!panel.title.empty()) {
      add({.text = printable(panel.title), .x_px = left_px_, .y_px = y_px_ + 18.0, .style = kPanelTitleStyle});
    }
    y_px_ += title_px;
    const double top_px = y_px_;
    const double bottom_px = y_px_ + plot_px;
    PanelPlace place;
    const AxisRange of_curves = x_range(chart_);
    const double curves_px = right_px_ - left_px_ - ranges_px();
    place.horizontal = {of_curves, left_px_, right_px_};
    place.horizontal.range.high += (of_curves.high - of_curves.low) * ranges_px() / curves_px;
    place.vertical = {y_range(panel), bottom_px, top_px};
    place.x_ticks = ticks(of_curves, curves_px / kTickDistanceX_px);
    add_ranges(panel, left_px_ + curves_px, top_px, place);
    place.y_ticks = ticks(place.vertical.range, plot_px / kTickDistanceY_px);
    add_y_label(panel, (top_px + bottom_px) / 2.0);
    const LevelSpace space{.left_px = left_px_,
                           .last_px = right_px_ - ranges_px() - 6.0,
                           .outside_px = right_px_ + 8.0,
                           .end_px = page_.width_px - 6.0,
                           .legend_bottom_px = legend_bottom_px_};
    std::ranges::move(level_names(panel, place, space), std::back_inserter(page_.texts));
    page_.panels.push_back(std::move(place));
    y_px_ = bottom_px + kTickRow_px;
  }

  /// Returns the width of the widest group of bars; 0 if no panel has ranges.
  [[nodiscard]] double ranges_px() const {
    std::size_t most = 0;
    for (const ChartPanel& panel : chart_.panels) {
      most = std::max(most, panel.ranges.size());
    }
    return most == 0 ? 0.0 : std::max(static_cast<double>(most) * kRangeDistance_px + kRangeDistance_px, kLeastRanges_px);
  }

  /// Places the bars side by side to the right of the curves.
  void add_ranges(const ChartPanel& panel, double left_px, double top_px, PanelPlace& place) {
    if (panel.ranges.empty()) {
      return;
    }
    const double middle_px = 0.5 * (left_px + right_px_);
    double x_px = middle_px - 0.5 * kRangeDistance_px * (static_cast<double>(panel.ranges.size()) - 1.0);
    for (const ChartRange& each : panel.ranges) {
      place.bars.push_back(
          {x_px, place.vertical.to_px(each.low), place.vertical.to_px(each.high), place.vertical.to_px(each.y), each.color_index});
      x_px += kRangeDistance_px;
    }
    place.x_ticks.push_back({x_range(chart_).high, ""});  // a line between curves and bars
    // Below the axis the label would read as the unit of the last tick.
    add({.text = printable(panel.range_label), .x_px = middle_px, .y_px = top_px - 5.0, .style = kTickStyle, .anchor = Anchor::middle});
  }

  void add_y_label(const ChartPanel& panel, double middle_px) {
    double x_px = y_label_x_px_;
    for (const std::string& line : y_label(panel)) {
      add({.text = line, .x_px = x_px, .y_px = middle_px, .style = kLabelStyle, .anchor = Anchor::middle, .is_upright = true});
      x_px += kLabelLine_px;
    }
  }

  void add_x_label() {
    for (const std::string& line : wrapped(printable(chart_.x_label), kLabelStyle, right_px_ - left_px_)) {
      y_px_ += kLabelLine_px;
      add({.text = line, .x_px = (left_px_ + right_px_) / 2.0, .y_px = y_px_ - 4.0, .style = kLabelStyle, .anchor = Anchor::middle});
    }
  }

  /// Places the legend above the panels, in as many columns of one width as fit.
  void add_legend_rows() {
    constexpr double kBetween_px = 24.0;
    const double width_px = column_width_px();
    double x_px = left_px_;
    double baseline_px = y_px_ + kLabelLine_px;
    for (const LegendEntry& entry : entries_) {
      const std::string name = printable(entry.name);
      if (x_px > left_px_ && x_px + width_px > right_px_) {
        x_px = left_px_;
        baseline_px += kLabelLine_px + kLegendGap_px;
      }
      LegendSwatch swatch = entry.swatch;
      swatch.x_px = x_px;
      swatch.y_px = std::round(baseline_px - kLabelStyle.size_px * 0.36);
      page_.swatches.push_back(swatch);
      add({.text = name, .x_px = x_px + kSwatchWidth_px + 8.0, .y_px = baseline_px, .style = kLabelStyle});
      x_px += width_px + kBetween_px;
    }
    y_px_ = baseline_px + kLegendGap_px;
  }

  void add_legend(double top_px) {
    double baseline_px = top_px + 12.0;
    for (const LegendEntry& entry : entries_) {
      LegendSwatch swatch = entry.swatch;
      swatch.x_px = legend_x_px_;
      swatch.y_px = std::round(baseline_px - kLabelStyle.size_px * 0.36);
      page_.swatches.push_back(swatch);
      for (const std::string& line : legend_lines(entry)) {
        add({.text = line, .x_px = legend_x_px_ + kSwatchWidth_px + 8.0, .y_px = baseline_px, .style = kLabelStyle});
        baseline_px += kLabelLine_px;
      }
      baseline_px += kLegendGap_px;
    }
    y_px_ = std::max(y_px_, baseline_px - kLabelLine_px);
  }

  Page finished() {
    page_.height_px = static_cast<int>(std::ceil(y_px_ + 16.0));
    const auto turn_round = [this](double& y_px) { y_px = page_.height_px - y_px; };
    for (PlacedText& text : page_.texts) {
      turn_round(text.y_px);
    }
    for (LegendSwatch& swatch : page_.swatches) {
      turn_round(swatch.y_px);
    }
    for (PanelPlace& place : page_.panels) {
      turn_round(place.vertical.low_px);
      turn_round(place.vertical.high_px);
      for (RangeBar& bar : place.bars) {
        turn_round(bar.low_px);
        turn_round(bar.high_px);
        turn_round(bar.mark_px);
      }
    }
    return std::move(page_);
  }

  void add(PlacedText text) { page_.texts.push_back(std::move(text)); }

  [[nodiscard]] static double panel_title_height_px(const std::string& title) { return title.empty() ? 12.0 : 28.0; }

  [[nodiscard]] double plot_height_px(const ChartPanel& panel) const {
    return std::max(kLeastPlotHeight_px, chart_.panel_height_px - panel_title_height_px(panel.title) - kTickRow_px);
  }

  [[nodiscard]] std::vector<std::string> y_label(const ChartPanel& panel) const {
    return wrapped(printable(panel.y_label), kLabelStyle, plot_height_px(panel));
  }

  /// Width of the widest legend entry without line breaks.
  [[nodiscard]] double column_width_px() const {
    double width_px = 0.0;
    for (const LegendEntry& entry : entries_) {
      width_px = std::max(width_px, kSwatchWidth_px + 8.0 + text_width_px(printable(entry.name), kLabelStyle));
    }
    return width_px;
  }

  [[nodiscard]] std::vector<std::string> legend_lines(const LegendEntry& entry) const {
    return wrapped(printable(entry.name), kLabelStyle, page_.width_px * 0.3);
  }

  const Chart& chart_;
  Page page_;
  std::vector<LegendEntry> entries_;
  double y_px_ = 0.0;
  double left_px_ = 0.0;
  double right_px_ = 0.0;
  bool is_legend_on_top_ = false;
  double legend_x_px_ = 0.0;
  double legend_bottom_px_ = 0.0;
  double y_label_x_px_ = 0.0;
};

}  // namespace

Page lay_out(const Chart& chart) { return PageBuilder(chart).build(); }

}  // namespace heatsoak::report
