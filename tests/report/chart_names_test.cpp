// Names of limits, and ripple.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "report/chart.h"
#include "seen_chart.h"

namespace heatsoak::report {
namespace {

// A ripple over the whole width leaves no free place on the line, so the name is placed beside the plot, below the legend.
TEST_F(ChartTest, NameOfALimitInARippleStandsBesideThePlot) {
  Chart chart = warm_up();
  ChartCurve& ripple = chart.panels[1].curves[0];
  for (std::size_t i = 0; i < ripple.y.size(); ++i) {
    ripple.y[i] = i % 2 == 0 ? 100.0 : 200.0;
  }

  const auto elements = drawn(chart);
  const SeenPanel winding = seen_panels(elements).at(1);
  const auto is_name = [](const Element& each) { return each.name == "text" && each.text == "winding limit 155 °C"; };
  const auto name = std::ranges::find_if(elements, is_name);
  const auto last = std::ranges::find_if(elements, [](const Element& each) { return each.name == "text" && each.text == "5 % to 95 %"; });

  ASSERT_NE(name, elements.end());
  ASSERT_NE(last, elements.end());
  EXPECT_EQ(name->at("text-anchor"), "") << "it begins there";
  EXPECT_GT(name->number("x"), winding.x.px(40.0));
  EXPECT_LT(name->number("x"), winding.x.px(40.0) + 20.0);
  EXPECT_NEAR(name->number("y"), winding.y.px(155.0), 6.0);
  EXPECT_GT(name->number("y"), last->number("y") + 12.0);
}

/// Returns a panel of level curves over 40 min with a limit at 155 °C.
ChartPanel level_curves(const std::vector<double>& temperatures_C) {
  ChartPanel panel{.y_label = "winding temperature / °C", .levels = {{"limit 155 °C of 3 motors", 155.0}}};
  for (const double each_C : temperatures_C) {
    panel.curves.push_back({.x = {0.0, 20.0, 40.0}, .y = {each_C, each_C, each_C}});
  }
  return panel;
}

struct NamedLimit {
  double middle_px = 0.0;         ///< middle of the name, from the top of the picture
  std::vector<Point> plate = {};  ///< corners of the white rectangle behind it; empty: none
};

NamedLimit named_limit(const std::vector<Element>& elements) {
  const auto name = std::ranges::find_if(elements, [](const Element& each) { return each.text == "limit 155 °C of 3 motors"; });
  if (name == elements.end()) {
    throw std::runtime_error("the limit has no name");
  }
  NamedLimit limit{.middle_px = name->number("y") - 0.36 * name->number("font-size")};
  if (const auto before = name - 1; before->name == "path" && before->at("fill") == "#ffffff") {
    limit.plate = points(before->at("d"));
  }
  return limit;
}

TEST_F(ChartTest, NameOfALimitBetweenCloseCurvesInterruptsItsLine) {
  const auto elements = drawn({.x_label = "time / min", .panels = {level_curves({25.0, 147.0, 163.0, 260.0})}});
  const SeenPanel panel = seen_panels(elements).at(0);
  const NamedLimit limit = named_limit(elements);
  EXPECT_NEAR(limit.middle_px, panel.y.px(155.0), 1.5);
  ASSERT_FALSE(limit.plate.empty());
  for (const Point& corner : limit.plate) {
    EXPECT_GT(corner.y_px, panel.y.px(163.0));
    EXPECT_LT(corner.y_px, panel.y.px(147.0));
  }
}

TEST_F(ChartTest, NameOfALimitAmongManyCurvesHidesThem) {
  std::vector<double> temperatures_C;
  for (double each_C = 25.0; each_C <= 265.0; each_C += 5.0) {
    temperatures_C.push_back(each_C);
  }
  const NamedLimit limit = named_limit(drawn({.x_label = "time / min", .panels = {level_curves(temperatures_C)}}));
  ASSERT_FALSE(limit.plate.empty());
  const auto [top, bottom] = std::ranges::minmax(limit.plate, {}, &Point::y_px);
  const auto [left, right] = std::ranges::minmax(limit.plate, {}, &Point::x_px);
  EXPECT_GT(limit.middle_px, top.y_px);
  EXPECT_LT(limit.middle_px, bottom.y_px);
  EXPECT_GT(right.x_px - left.x_px, 100.0) << "narrower than the name";
}

TEST_F(ChartTest, NameOfALimitAwayFromCurvesHidesNothing) {
  EXPECT_TRUE(named_limit(drawn({.x_label = "time / min", .panels = {level_curves({25.0, 260.0})}})).plate.empty());
}

TEST_F(ChartTest, NoLineBreaksBetweenANumberAndItsUnit) {
  Chart chart = warm_up();
  for (int i = 0; i < 40; ++i) {
    chart.title += " 20 K";
  }
  for (const Element& each : drawn(chart)) {
    EXPECT_FALSE(each.name == "text" && (each.text.ends_with(" 20") || each.text.starts_with("K "))) << each.text;
  }
}

/// On/off load with a period of 10 s over 40 min: a warm-up with a ripple of 40 K.
Chart rippled_warm_up() {
  Chart chart = warm_up();
  chart.panels.erase(chart.panels.begin());
  ChartCurve& curve = chart.panels[0].curves[0];
  curve.x.clear();
  curve.y.clear();
  for (int second = 0; second <= 2400; ++second) {
    const double on_share = second % 10 < 4 ? second % 10 / 4.0 : (10 - second % 10) / 6.0;
    curve.x.push_back(second / 60.0);
    curve.y.push_back(25.0 + 80.0 * (1.0 - std::exp(-second / 300.0)) + 40.0 * on_share);
  }
  curve.has_ripple = true;
  chart.panels[0].curves.resize(1);
  chart.panels[0].bands.clear();
  return chart;
}

// A change from line to area within one picture, with a jump to the area's edge, looks like a defect.
TEST_F(ChartTest, RippleIsOneAreaFromItsFirstPointOn) {
  const auto elements = drawn(rippled_warm_up());
  const auto edges = lines(elements, blue);
  ASSERT_EQ(edges.size(), 2U) << "only the lower and the upper edge";
  const SeenPanel seen = seen_panels(elements).at(0);
  for (const std::vector<Point>& edge : edges) {
    EXPECT_NEAR(edge.front().x_px, seen.x.px(0.0), 1.0);
    EXPECT_NEAR(edge.front().y_px, seen.y.px(25.0), 1.0) << "both edges begin at the curve's first point";
    EXPECT_NEAR(edge.back().x_px, seen.x.px(40.0), 10.0);
  }
}

TEST_F(ChartTest, RippleThatBeginsLaterIsJoinedToItsLine) {
  Chart chart = rippled_warm_up();
  ChartCurve& curve = chart.panels[0].curves[0];
  curve.name.clear();
  for (std::size_t i = 0; i < 1200; ++i) {
    curve.y[i] = curve.y[1200];
  }
  const auto pieces = lines(drawn(chart), blue, 2);
  ASSERT_EQ(pieces.size(), 3U);
  const auto line = std::ranges::min_element(pieces, {}, [](const std::vector<Point>& each) { return each.back().x_px; });
  for (const std::vector<Point>& piece : pieces) {
    if (&piece != &*line) {
      EXPECT_NEAR(piece.front().x_px, line->back().x_px, 1.0);
      EXPECT_NEAR(piece.front().y_px, line->back().y_px, 1.0);
    }
  }
}

TEST_F(ChartTest, NamesOfCloseLimitsStandApart) {
  Chart chart = warm_up();
  const std::vector<std::string> names{
      "winding limit of a motor with a long name 150.0 °C", "winding limit of another with a long name 151.5 °C",
      "winding limit of a third with a long name 153.0 °C", "winding limit of a fourth with a long name 154.5 °C"};
  chart.panels[1].levels.clear();
  for (std::size_t i = 0; i < names.size(); ++i) {
    chart.panels[1].levels.push_back({names[i], 150.0 + 1.5 * static_cast<double>(i)});
  }
  struct Place {
    double left_px, right_px, y_px;
  };
  std::map<std::string, Place> places;
  for (const Element& each : drawn(chart)) {
    if (each.name == "text" && std::ranges::find(names, each.text) != names.end()) {
      const double width_px = 5.0 * static_cast<double>(each.text.size());  // underestimates the true width
      const double x_px = each.number("x");
      const bool ends_there = each.at("text-anchor") == "end";
      places[each.text] = {ends_there ? x_px - width_px : x_px, ends_there ? x_px : x_px + width_px, each.number("y")};
    }
  }
  ASSERT_EQ(places.size(), names.size());
  for (const auto& [name, a] : places) {
    for (const auto& [other, b] : places) {
      const bool are_beside = a.right_px <= b.left_px || b.right_px <= a.left_px;
      EXPECT_TRUE(name == other || are_beside || std::abs(a.y_px - b.y_px) >= 11.0) << name << " over " << other;
    }
  }
}

// A level that may be outside stays in the range if at most a third of the panel is empty; else only its name is shown, at the edge.
TEST_F(ChartTest, AFarLimitIsAnAnnotation) {
  Chart chart = warm_up();
  double lowest = std::numeric_limits<double>::infinity();
  double high = -lowest;
  for (const ChartCurve& curve : chart.panels[1].curves) {
    lowest = std::min(lowest, std::ranges::min(curve.y));
    high = std::max(high, std::ranges::max(curve.y));
  }
  for (const ChartBand& band : chart.panels[1].bands) {
    lowest = std::min(lowest, std::ranges::min(band.low));
    high = std::max(high, std::ranges::max(band.high));
  }
  const auto is_named = [](const std::vector<Element>& elements, const std::string& name) {
    return std::ranges::any_of(elements, [&](const Element& each) { return each.name == "text" && each.text == name; });
  };
  chart.panels[1].levels = {{"limit", high + 0.48 * (high - lowest), true}};
  const auto near = drawn(chart);
  EXPECT_EQ(lines(near, red, 2).size(), 1U);
  EXPECT_TRUE(is_named(near, "limit"));
  chart.panels[1].levels = {{"limit", high + 0.6 * (high - lowest), true}, {"lower limit", lowest - (high - lowest), true}};
  const auto far = drawn(chart);
  EXPECT_TRUE(lines(far, red, 2).empty());
  EXPECT_TRUE(is_named(far, "↑ limit"));
  EXPECT_TRUE(is_named(far, "↓ lower limit"));
}

}  // namespace
}  // namespace heatsoak::report
