// Reads a drawn chart back from its SVG.
#pragma once

#include <expat.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "base/files.h"
#include "report/chart.h"

namespace heatsoak::report {

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
inline std::vector<Element> parsed(const std::string& xml) {
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
inline std::vector<Point> points(std::string text) {
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
inline std::vector<SeenPanel> seen_panels(const std::vector<Element>& elements) {
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
    if (each.text.find_first_of("0123456789") == std::string::npos) {
      continue;  // the label of the bars
    }
    axis.values.push_back(std::stod(each.text));
    constexpr double half_capital_height = 0.36;
    axis.places_px.push_back(is_y_label ? each.number("y") - half_capital_height * each.number("font-size") : each.number("x"));
  }
  return panels;
}

inline std::vector<std::vector<Point>> lines(const std::vector<Element>& elements, const std::string& color, std::size_t least_points = 3) {
  std::vector<std::vector<Point>> result;
  for (const Element& each : elements) {
    if (each.name == "polyline" && each.at("stroke") == color && points(each.at("points")).size() >= least_points) {
      result.push_back(points(each.at("points")));
    }
  }
  return result;
}

inline std::size_t texts(const std::vector<Element>& elements, const std::string& text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(elements, [&](const Element& each) { return each.name == "text" && each.text == text; }));
}

inline bool is_band(const Element& element) { return element.at("fill-opacity") == "0.2"; }

inline constexpr const char* blue = "#0072b2";
inline constexpr const char* red = "#c8102e";

struct Extremes {
  Point low;
  Point high;
};

inline Extremes extremes(const std::vector<Point>& line) {
  const auto [high, low] = std::ranges::minmax_element(line, {}, &Point::y_px);  // y points downwards
  return {*low, *high};
}

/// First-order warm-up of three motors over 40 min, with the stator panel above the winding panel.
inline Chart warm_up() {
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

}  // namespace heatsoak::report
