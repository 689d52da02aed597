// Contents, axes, curves and failures of charts.
#include "report/chart.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

#include "base/diagnostic.h"
#include "base/files.h"
#include "seen_chart.h"

namespace heatsoak::report {
namespace {

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

TEST_F(ChartTest, LimitThatIsNoHorizontalLineHasTheColourOfLevels) {
  const Chart chart{.title = "t",
                    .x_label = "x",
                    .panels = {{.title = "p",
                                .y_label = "y",
                                .curves = {{.x = {0.0, 10.0}, .y = {0.0, 10.0}},
                                           {.x = {4.0, 4.0}, .y = {0.0, 10.0}, .color_index = std::nullopt}}}}};
  const auto elements = drawn(chart);
  const auto limits = lines(elements, red, 2);
  ASSERT_EQ(limits.size(), 1U);
  EXPECT_NEAR(limits[0].front().x_px, seen_panels(elements).at(0).x.px(4.0), 1.0);
}

// VTK draws the frame of a panel with an invisible pen, which some viewers show as dots at its corners.
TEST_F(ChartTest, FrameWithoutAPenIsNotDrawn) {
  for (const Element& each : drawn(warm_up())) {
    EXPECT_NE(each.at("stroke-dasharray"), "0,10") << each.at("points");
  }
}

TEST_F(ChartTest, BarsOfRangesStandBesideTheCurvesAtTheirValues) {
  Chart chart = warm_up();
  constexpr int kColor = 6;  // no curve has this color
  chart.panels[1].ranges = {{100.0, 150.0, 120.0, kColor}, {50.0, 100.0, 80.0, kColor}};
  chart.panels[1].range_label = "peaks";
  const auto elements = drawn(chart);
  EXPECT_EQ(texts(elements, "peaks"), 1U);
  const SeenPanel winding = seen_panels(elements).at(1);
  const auto label = std::ranges::find_if(elements, [](const Element& each) { return each.name == "text" && each.text == "peaks"; });
  ASSERT_NE(label, elements.end());
  EXPECT_LT(std::stod(label->at("y")), winding.y.px(155.0)) << "above the bars: in the row of the ticks it reads as a unit";
  const double last_px = winding.x.px(40.0);
  for (const std::vector<Point>& curve : lines(elements, blue)) {
    EXPECT_LE(curve.back().x_px, last_px + 1.0) << "the curves end before the bars";
  }
  // A bar is a line with two caps and a mark.
  std::vector<std::vector<Point>> upright;
  for (const std::vector<Point>& line : lines(elements, "#d55e00", 2)) {
    for (const Point& point : line) {
      EXPECT_GT(point.x_px, last_px);
    }
    if (line.front().x_px == line.back().x_px) {
      upright.push_back(line);
    }
  }
  ASSERT_EQ(upright.size(), 2U);
  EXPECT_LT(upright[0].front().x_px, upright[1].front().x_px);
  for (const auto& [bar, low, high] : {std::tuple(upright[0], 100.0, 150.0), {upright[1], 50.0, 100.0}}) {
    const Extremes seen = extremes(bar);
    EXPECT_NEAR(seen.low.y_px, winding.y.px(low), 1.0);
    EXPECT_NEAR(seen.high.y_px, winding.y.px(high), 1.0);
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

// Two names in a column beside two panels would leave a third of the picture empty, also if they are wrapped.
TEST_F(ChartTest, PanelsUseTheWidthWhereTheirNamesAreFewAndLong) {
  for (const char* name :
       {"nanotec_df45l024048_a2, 38 °C, undecided", "a name that is much longer than nanotec_df45l024048_a2, 38 °C, undecided"}) {
    Chart chart{.title = "two panels", .x_label = "x", .panels = {{}, {}}};
    for (ChartPanel& panel : chart.panels) {
      panel.curves = {{.name = name, .x = {0.0, 1.0}, .y = {0.0, 1.0}},
                      {.name = std::string(name) + "b", .x = {0.0, 1.0}, .y = {0.0, 2.0}}};
    }
    for (const SeenPanel& panel : seen_panels(drawn(chart))) {
      EXPECT_GT(panel.x.px(1.0), 0.9 * chart.width_px) << name;
    }
  }
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
