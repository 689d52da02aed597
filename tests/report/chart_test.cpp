#include "report/chart.h"

#include <expat.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"
#include "base/files.h"

namespace heatsoak::report {
namespace {

namespace fs = std::filesystem;

struct Element {
  std::string name;
  std::map<std::string, std::string> attributes;
  std::string text;

  [[nodiscard]] std::string at(const std::string& key) const {
    const auto found = attributes.find(key);
    return found == attributes.end() ? "" : found->second;
  }
  [[nodiscard]] double number(const std::string& key) const { return std::stod(at(key)); }
};

struct Reader {
  std::vector<Element> elements;
  bool is_open = false;  ///< the following text belongs to the last element
};

/// Returns all elements in document order; throws if the text is not well-formed XML.
std::vector<Element> parsed(const std::string& xml) {
  Reader reader;
  XML_Parser parser = XML_ParserCreate(nullptr);
  XML_SetUserData(parser, &reader);
  XML_SetElementHandler(
      parser,
      [](void* data, const XML_Char* name, const XML_Char** attributes) {
        Element element{name, {}, {}};
        for (; *attributes != nullptr; attributes += 2) {
          element.attributes[attributes[0]] = attributes[1];
        }
        static_cast<Reader*>(data)->elements.push_back(element);
        static_cast<Reader*>(data)->is_open = true;
      },
      [](void* data, const XML_Char*) { static_cast<Reader*>(data)->is_open = false; });
  XML_SetCharacterDataHandler(parser, [](void* data, const XML_Char* text, int length) {
    if (static_cast<Reader*>(data)->is_open) {
      static_cast<Reader*>(data)->elements.back().text.append(text, static_cast<std::size_t>(length));
    }
  });
  const bool is_well_formed = XML_Parse(parser, xml.data(), static_cast<int>(xml.size()), 1) == XML_STATUS_OK;
  const XML_Error problem = XML_GetErrorCode(parser);
  XML_ParserFree(parser);
  if (!is_well_formed) {
    throw std::runtime_error(std::string("not well-formed: ") + XML_ErrorString(problem));
  }
  return reader.elements;
}

struct Point {
  double x_px = 0.0;
  double y_px = 0.0;
};

/// Returns the coordinates of a `points` or `d` attribute, ignoring letters between them.
std::vector<Point> points(std::string text) {
  const auto is_separator = [](char c) { return std::string_view(",MLz\n").find(c) != std::string_view::npos; };
  std::ranges::replace_if(text, is_separator, ' ');
  std::istringstream in(text);
  std::vector<Point> result;
  for (Point point; in >> point.x_px >> point.y_px;) {
    result.push_back(point);
  }
  return result;
}

/// A linear axis reconstructed from the places of its tick labels.
struct SeenAxis {
  std::vector<double> values;
  std::vector<double> places_px;

  [[nodiscard]] double px(double value) const {
    const double slope = (places_px.back() - places_px.front()) / (values.back() - values.front());
    return places_px.front() + slope * (value - values.front());
  }
};

struct SeenPanel {
  SeenAxis x;
  SeenAxis y;
};

/// Finds the panels by their tick labels, which are the grey 12 px texts. The y labels of a panel end at the axis; its centred x labels
/// follow.
std::vector<SeenPanel> seen_panels(const std::vector<Element>& elements) {
  std::vector<SeenPanel> panels;
  bool was_y_label = false;
  for (const Element& each : elements) {
    if (each.name != "text" || each.at("fill") != "#444444") {
      continue;
    }
    const bool is_y_label = each.at("text-anchor") == "end";
    if (is_y_label && !was_y_label) {
      panels.emplace_back();
    }
    was_y_label = is_y_label;
    SeenAxis& axis = is_y_label ? panels.back().y : panels.back().x;
    axis.values.push_back(std::stod(each.text));
    constexpr double half_capital_height = 0.36;
    axis.places_px.push_back(is_y_label ? each.number("y") - half_capital_height * each.number("font-size") : each.number("x"));
  }
  return panels;
}

std::vector<std::vector<Point>> lines(const std::vector<Element>& elements, const std::string& color, std::size_t least_points = 3) {
  std::vector<std::vector<Point>> result;
  for (const Element& each : elements) {
    if (each.name == "polyline" && each.at("stroke") == color && points(each.at("points")).size() >= least_points) {
      result.push_back(points(each.at("points")));
    }
  }
  return result;
}

std::size_t texts(const std::vector<Element>& elements, const std::string& text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(elements, [&](const Element& each) { return each.name == "text" && each.text == text; }));
}

bool is_band(const Element& element) { return element.at("fill-opacity") == "0.2"; }

constexpr const char* blue = "#0072b2";
constexpr const char* red = "#c8102e";

struct Extremes {
  Point low;
  Point high;
};

Extremes extremes(const std::vector<Point>& line) {
  const auto [high, low] = std::ranges::minmax_element(line, {}, &Point::y_px);  // y points downwards
  return {*low, *high};
}

/// First-order warm-up of three motors over 40 min, with the stator panel above the winding panel.
Chart warm_up() {
  const std::vector<std::string> names{"maxon_ecx_flat_32l_48v  162 °C", "maxon_ec_45_flat_70w  118 °C", "df45"};
  const std::vector<double> stator_rise_K{110.0, 80.0, 88.0};
  Chart chart{.title = "Warm-up", .subtitle = "5 A & 25 °C <measured>", .x_label = "time / min", .panels = {{}, {}}};
  chart.panels[0].title = "stator";
  chart.panels[0].y_label = "stator temperature / °C";
  chart.panels[1].title = "winding";
  chart.panels[1].y_label = "winding temperature / °C";
  chart.panels[1].levels = {{"winding limit 155 °C", 155.0}};
  for (std::size_t motor = 0; motor < names.size(); ++motor) {
    ChartCurve stator{.name = names[motor], .x = {}, .y = {}, .color_index = static_cast<int>(motor)};
    ChartCurve winding = stator;
    for (int second = 0; second <= 2400; second += 10) {
      const double rise_K = stator_rise_K[motor] * (1.0 - std::exp(-second / 840.0));
      stator.x.push_back(second / 60.0);
      stator.y.push_back(25.0 + rise_K);
      winding.x.push_back(second / 60.0);
      winding.y.push_back(25.0 + 1.25 * rise_K);
    }
    chart.panels[0].curves.push_back(stator);
    chart.panels[1].curves.push_back(winding);
  }
  const ChartCurve& hottest = chart.panels[1].curves[0];
  ChartBand band{.name = "5 % to 95 %", .x = hottest.x, .low = hottest.y, .high = hottest.y};
  std::ranges::for_each(band.low, [](double& y) { y -= 8.0; });
  std::ranges::for_each(band.high, [](double& y) { y += 9.0; });
  chart.panels[1].bands = {band};
  return chart;
}

class ChartTest : public testing::Test {
 protected:
  void SetUp() override {
    unsetenv("DISPLAY");
    folder_ = fs::temp_directory_path() / ("heatsoak_chart_test_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  [[nodiscard]] std::string svg(const Chart& chart) const {
    base::write_file(folder_ / "chart.svg", draw_svg(chart));
    std::ifstream in(folder_ / "chart.svg");
    return {std::istreambuf_iterator<char>(in), {}};
  }
  [[nodiscard]] std::vector<Element> drawn(const Chart& chart) const { return parsed(svg(chart)); }
  [[nodiscard]] std::ptrdiff_t files() const { return std::distance(fs::directory_iterator(folder_), fs::directory_iterator()); }

  fs::path folder_;
};

TEST_F(ChartTest, IsOneSvgWithItsSize) {
  const auto elements = drawn(warm_up());
  ASSERT_EQ(elements.front().name, "svg");
  EXPECT_EQ(elements.front().at("width"), "1000");
  EXPECT_EQ(elements.front().at("viewBox"), "0 0 1000 " + elements.front().at("height"));
  EXPECT_EQ(files(), 1);
}

TEST_F(ChartTest, WritesEveryNameOnce) {
  const auto elements = drawn(warm_up());
  for (const char* text : {"Warm-up", "5 A & 25 °C <measured>", "time / min", "stator", "winding", "winding temperature / °C",
                           "maxon_ecx_flat_32l_48v  162 °C", "df45", "5 % to 95 %"}) {
    EXPECT_EQ(texts(elements, text), 1U) << text;
  }
  EXPECT_GE(texts(elements, "winding limit 155 °C"), 1U);
}

// Every factor of ten has the same height. Zero cannot be drawn and interrupts the line.
TEST_F(ChartTest, ALogarithmicAxisShowsFactors) {
  Chart chart{.title = "factors", .x_label = "x", .panels = {{}}};
  chart.panels[0].logarithmic = true;
  chart.panels[0].curves = {{.name = "", .x = {0, 1, 2, 3, 4, 5, 6, 7}, .y = {0.1, 1, 10, 100, 0, 100, 10, 1}}};
  const auto elements = drawn(chart);
  const auto pieces = lines(elements, blue);
  ASSERT_EQ(pieces.size(), 2U);
  ASSERT_EQ(pieces[0].size(), 4U);
  const double decade_px = pieces[0][0].y_px - pieces[0][1].y_px;
  EXPECT_GT(decade_px, 30.0);
  for (std::size_t i = 1; i < 4; ++i) {
    EXPECT_NEAR(pieces[0][i - 1].y_px - pieces[0][i].y_px, decade_px, 0.05);
  }
  EXPECT_EQ(pieces[1][0].y_px, pieces[0][3].y_px);
  const SeenAxis axis = seen_panels(elements).at(0).y;
  for (const double decade : {0.1, 1.0, 10.0, 100.0}) {
    const auto tick = std::ranges::find(axis.values, decade);
    ASSERT_NE(tick, axis.values.end()) << decade;
    const double curve_px = pieces[0][static_cast<std::size_t>(std::lround(std::log10(decade) + 1.0))].y_px;
    EXPECT_NEAR(axis.places_px[static_cast<std::size_t>(tick - axis.values.begin())], curve_px, 1.0);
  }
}

TEST_F(ChartTest, CurvesStandWhereTheAxesSay) {
  const Chart chart = warm_up();
  const auto elements = drawn(chart);
  const auto panels = seen_panels(elements);
  const auto curves = lines(elements, blue);
  ASSERT_EQ(panels.size(), 2U);
  ASSERT_EQ(curves.size(), 2U);
  for (std::size_t i = 0; i < panels.size(); ++i) {
    ASSERT_GE(panels[i].x.values.size(), 3U);
    ASSERT_GE(panels[i].y.values.size(), 3U);
    const ChartCurve& curve = chart.panels[i].curves[0];
    const Extremes seen = extremes(curves[i]);
    EXPECT_NEAR(seen.low.x_px, panels[i].x.px(0.0), 1.0);
    EXPECT_NEAR(seen.low.y_px, panels[i].y.px(25.0), 1.0);
    EXPECT_NEAR(seen.high.x_px, panels[i].x.px(40.0), 1.0);
    EXPECT_NEAR(seen.high.y_px, panels[i].y.px(curve.y.back()), 1.0);
  }
  EXPECT_NEAR(panels[0].x.px(20.0), panels[1].x.px(20.0), 0.01);
}

TEST_F(ChartTest, LimitAndBandStandWhereTheAxesSay) {
  const Chart chart = warm_up();
  const auto elements = drawn(chart);
  const SeenPanel winding = seen_panels(elements).at(1);
  const auto limits = lines(elements, red, 2);
  ASSERT_EQ(limits.size(), 1U);
  EXPECT_NEAR(limits[0].front().y_px, winding.y.px(155.0), 1.0);
  EXPECT_NEAR(limits[0].back().y_px, winding.y.px(155.0), 1.0);
  EXPECT_NEAR(limits[0].back().x_px - limits[0].front().x_px, winding.x.px(40.0) - winding.x.px(0.0), 1.0);

  const auto band = std::ranges::find_if(elements, is_band);
  ASSERT_NE(band, elements.end());
  EXPECT_EQ(band->at("fill"), blue);
  const Extremes seen = extremes(points(band->at("d")));
  EXPECT_NEAR(seen.low.y_px, winding.y.px(25.0 - 8.0), 1.0);
  EXPECT_NEAR(seen.high.y_px, winding.y.px(chart.panels[1].curves[0].y.back() + 9.0), 1.0);
}

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

TEST_F(ChartTest, EverythingIsInsideThePlotWithHeadroom) {
  Chart chart = warm_up();
  chart.panels[1].levels = {{"far above", 400.0}, {"far below", -100.0}};
  const auto elements = drawn(chart);
  const SeenPanel winding = seen_panels(elements).at(1);
  const auto limits = lines(elements, red, 2);
  ASSERT_EQ(limits.size(), 2U);
  // Without a frame the vertical grid lines give the height of the plot: 500 K and 5 % at either end.
  const auto grid = lines(elements, "#e4e4e4", 2);
  const auto is_of_winding = [&](const std::vector<Point>& line) {
    return line[0].x_px == line[1].x_px && std::max(line[0].y_px, line[1].y_px) > limits[1][0].y_px;
  };
  const auto upright = std::ranges::find_if(grid, is_of_winding);
  ASSERT_NE(upright, grid.end());
  const Extremes plot = extremes(*upright);
  EXPECT_NEAR(plot.high.y_px, winding.y.px(425.0), 1.0);
  EXPECT_NEAR(plot.low.y_px, winding.y.px(-125.0), 1.0);
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

TEST_F(ChartTest, NanBreaksLineAndBand) {
  Chart chart = warm_up();
  const double gap = std::numeric_limits<double>::quiet_NaN();
  chart.panels[1].curves[0].y[100] = gap;
  chart.panels[1].curves[0].y[180] = gap;
  chart.panels[1].curves[0].y[182] = gap;  // isolates one sample
  chart.panels[1].bands[0].low[100] = gap;
  const std::string text = svg(chart);
  EXPECT_EQ(text.find("nan"), std::string::npos);
  const auto elements = parsed(text);
  EXPECT_EQ(lines(elements, blue).size(), 1U + 3U);
  EXPECT_EQ(std::ranges::count_if(elements, is_band), 2 + 1);  // plus the legend
}

TEST_F(ChartTest, BandOfTwoSamplesIsDrawn) {
  Chart chart = warm_up();
  const ChartCurve& curve = chart.panels[1].curves[0];
  chart.panels[1].bands = {{"left out", {curve.x[10], curve.x[20]}, {30.0, 30.0}, {60.0, 60.0}, 0}};
  const std::vector<Element> elements = parsed(svg(chart));
  EXPECT_EQ(std::ranges::count_if(elements, is_band), 1 + 1);  // plus the legend
}

TEST_F(ChartTest, LongCurvesStaySmallAndKeepTheirSpikes) {
  Chart chart{.title = "log", .subtitle = "", .x_label = "time / s", .panels = {{}}};
  for (int color = 0; color < 3; ++color) {
    ChartCurve curve{.name = "wheel", .x = {}, .y = {}, .color_index = color};
    for (int i = 0; i < 100'000; ++i) {
      curve.x.push_back(i * 1e-3);
      curve.y.push_back(std::sin(i * 1e-3) + (i * 7919 % 1000) * 1e-3);
    }
    chart.panels[0].curves.push_back(curve);
  }
  chart.panels[0].curves[0].y[54'321] = 9.0;
  chart.panels[0].curves[0].y[76'543] = -7.0;
  const std::string text = svg(chart);
  EXPECT_LT(text.size(), 200'000U);
  const auto elements = parsed(text);
  const SeenPanel panel = seen_panels(elements).at(0);
  const auto curve = lines(elements, blue);
  ASSERT_EQ(curve.size(), 1U);
  const Extremes seen = extremes(curve[0]);
  EXPECT_NEAR(seen.high.x_px, panel.x.px(54.321), 1.0);
  EXPECT_NEAR(seen.high.y_px, panel.y.px(9.0), 1.0);
  EXPECT_NEAR(seen.low.x_px, panel.x.px(76.543), 1.0);
  EXPECT_NEAR(seen.low.y_px, panel.y.px(-7.0), 1.0);
  EXPECT_LE(curve[0].size(), 2.0 * (panel.x.px(100.0) - panel.x.px(0.0)) + 4.0);
}

TEST_F(ChartTest, SameChartSameBytes) { EXPECT_EQ(svg(warm_up()), svg(warm_up())); }

TEST_F(ChartTest, LongTitleIsBrokenIntoLines) {
  Chart chart = warm_up();
  for (int i = 0; i < 12; ++i) {
    chart.title += " and a motor";
  }
  std::string joined;
  for (const Element& each : drawn(chart)) {
    if (each.name == "text" && each.at("font-size") == "20") {
      joined += (joined.empty() ? "" : " ") + each.text;
      EXPECT_LT(static_cast<double>(each.text.size()) * 0.6 * 20.0, 1000.0) << each.text;
    }
  }
  EXPECT_EQ(joined, chart.title);
}

TEST_F(ChartTest, NamesFromFilesCannotBreakTheXml) {
  Chart chart = warm_up();
  chart.title =
      "a\x01"
      "b \xFF \xE2\x82 \xC0\xAF \"<&>'";
  EXPECT_EQ(texts(drawn(chart), "a b \uFFFD \uFFFD\uFFFD \uFFFD\uFFFD \"<&>'"), 1U);
}

TEST_F(ChartTest, DrawsWhereThereIsLittleToShow) {
  EXPECT_NO_THROW(drawn(Chart{}));
  Chart chart{.title = "", .subtitle = "", .x_label = "", .panels = {{}, {}}};
  chart.panels[0].curves = {{.name = "empty", .x = {}, .y = {}}};
  chart.panels[1].curves = {{.name = "constant", .x = {2.0}, .y = {0.3}}};
  const auto elements = drawn(chart);
  EXPECT_EQ(seen_panels(elements).size(), 2U);
  EXPECT_EQ(lines(elements, blue, 2).size(), 1U + 2U);  // plus one dot and two names in the legend
}

void expect_failure(const Chart& chart, const fs::path& path, base::ExitCode code, const std::string& words) {
  try {
    base::write_file(path, draw_svg(chart));
    FAIL() << "wrote " << path;
  } catch (const base::Failure& failure) {
    EXPECT_EQ(failure.code(), code);
    EXPECT_NE(std::string(failure.what()).find(words), std::string::npos) << failure.what();
  }
}

TEST_F(ChartTest, UnwritablePathIsReportedAndLeavesNothing) {
  const fs::path missing = folder_ / "missing" / "chart.svg";
  expect_failure(warm_up(), missing, base::ExitCode::bad_input, missing.string() + ": error: cannot be written: No such file");
  fs::create_directories(folder_ / "taken" / "inside");
  expect_failure(warm_up(), folder_ / "taken", base::ExitCode::bad_input, "Is a directory");
  EXPECT_EQ(files(), 1);
}

TEST_F(ChartTest, BrokenLibraryIsABugAndKeepsTheOldPicture) {
  const std::string old = svg(warm_up());
  const fs::path plugins = folder_ / "plugins";
  fs::create_directories(plugins);
  std::ofstream(plugins / "heatsoak_charts.so") << "no library";
  const char* usual = std::getenv("HEATSOAK_PLUGINS");
  const std::string before = usual != nullptr ? usual : "";
  setenv("HEATSOAK_PLUGINS", plugins.c_str(), 1);
  expect_failure(Chart{}, folder_ / "chart.svg", base::ExitCode::bug, "heatsoak_charts.so");
  setenv("HEATSOAK_PLUGINS", before.c_str(), 1);  // an empty value counts as not set
  EXPECT_EQ(fs::file_size(folder_ / "chart.svg"), old.size());
  EXPECT_EQ(files(), 2);
}

TEST_F(ChartTest, ColumnsOfDifferentLengthAreABug) {
  Chart chart = warm_up();
  chart.panels[0].curves[1].y.pop_back();
  expect_failure(chart, folder_ / "chart.svg", base::ExitCode::bug, "maxon_ec_45_flat_70w");
  EXPECT_EQ(files(), 0);
}

}  // namespace
}  // namespace heatsoak::report
