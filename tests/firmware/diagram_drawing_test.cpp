// The drawn block diagram: complete, legible, and identical to the shipped one.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>

#include "firmware/core_diagram.h"
#include "support/source_folder.h"

namespace heatsoak::firmware {
namespace {

using robot_core::BlockText;
using robot_core::SignalText;
using testing::HasSubstr;

struct Area {
  double left_px = 0.0;
  double top_px = 0.0;
  double right_px = 0.0;
  double bottom_px = 0.0;
  std::string words;

  [[nodiscard]] bool meets(const Area& other) const {
    return left_px < other.right_px && other.left_px < right_px && top_px < other.bottom_px && other.top_px < bottom_px;
  }
  [[nodiscard]] bool contains(const Area& other) const {
    return left_px <= other.left_px && top_px <= other.top_px && right_px >= other.right_px && bottom_px >= other.bottom_px;
  }
};

/// Height and mean width of a letter in px, for DejaVu Sans, the widest font of the list.
const std::map<std::string, std::pair<double, double>> kFonts{{"h1", {20.0, 14.0}},   {"h2", {12.0, 7.2}},    {"title", {14.0, 9.6}},
                                                              {"small", {11.0, 6.4}}, {"mono", {11.0, 6.63}}, {"head", {11.0, 6.63}},
                                                              {"no", {13.0, 10.0}}};

std::vector<Area> frames_of(const std::string& svg) {
  static const std::regex kRect(R"re(<rect x="([\d.]+)" y="([\d.]+)" width="([\d.]+)" height="([\d.]+)")re");
  std::vector<Area> areas;
  for (std::sregex_iterator each(svg.begin(), svg.end(), kRect), end; each != end; ++each) {
    const double x = std::stod((*each)[1]);
    const double y = std::stod((*each)[2]);
    areas.push_back({x, y, x + std::stod((*each)[3]), y + std::stod((*each)[4]), "frame"});
  }
  return areas;
}

std::vector<Area> texts_of(const std::string& svg) {
  static const std::regex kText(R"re(<text x="([\d.]+)" y="([\d.]+)" class="(\w+)"[^>]*>([^<]*)<)re");
  std::vector<Area> areas;
  for (std::sregex_iterator each(svg.begin(), svg.end(), kText), end; each != end; ++each) {
    const auto [size_px, advance_px] = kFonts.at((*each)[3]);
    const std::string words = (*each)[4];
    const auto letters = std::ranges::count_if(words, [](char c) { return (c & 0xC0) != 0x80; });
    const double width = advance_px * static_cast<double>(letters);
    const double x = std::stod((*each)[1]) - ((*each)[3] == "no" ? 0.5 * width : 0.0);
    const double y = std::stod((*each)[2]);
    areas.push_back({x, y - 0.76 * size_px, x + width, y + 0.24 * size_px, words});
  }
  return areas;
}

TEST(BlockDiagram, DrawingHasNoOverlapAndNoClippedText) {
  const std::string svg = core_diagram_svg();
  const std::vector<Area> frames = frames_of(svg);
  const std::vector<Area> texts = texts_of(svg);
  ASSERT_EQ(frames.size(), std::size(robot_core::kBlocks) + signal_groups().size());
  std::smatch size;
  ASSERT_TRUE(std::regex_search(svg, size, std::regex(R"re(viewBox="0 0 (\d+) (\d+)")re")));
  const Area page{0.0, 0.0, std::stod(size[1]), std::stod(size[2]), "page"};
  for (std::size_t i = 0; i < texts.size(); ++i) {
    EXPECT_TRUE(page.contains(texts[i])) << texts[i].words;
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_FALSE(texts[i].meets(texts[j])) << texts[i].words << " and " << texts[j].words;
    }
    for (const Area& frame : frames) {
      EXPECT_TRUE(frame.contains(texts[i]) || !frame.meets(texts[i])) << texts[i].words;
    }
  }
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_TRUE(page.contains(frames[i]));
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_FALSE(frames[i].meets(frames[j])) << i << " and " << j;
    }
  }
}

TEST(BlockDiagram, DrawingNamesEachSignalWithItsUnit) {
  const std::string svg = core_diagram_svg();
  for (const SignalText& signal : robot_core::kSignals) {
    EXPECT_THAT(svg, HasSubstr(fmt::format(">{}</text>", signal.name)));
    EXPECT_THAT(svg, HasSubstr(fmt::format(">{}</text>", signal.unit)));
    EXPECT_THAT(svg, HasSubstr(fmt::format(">{}</text>", numbers_of(signal.to))));
  }
  for (const BlockText& block : robot_core::kBlocks) {
    EXPECT_THAT(svg, HasSubstr(fmt::format(">{}()</text>", block.function)));
  }
}

TEST(BlockDiagram, DrawingOfTheReportsIsThatOfTheTables) {
  std::ifstream stream(kSource / "reports/drive_core/block_diagram.svg", std::ios::binary);
  const std::string shipped{std::istreambuf_iterator<char>(stream), {}};
  EXPECT_TRUE(shipped == core_diagram_svg())
      << "`heatsoak describe robot_core --diagram reports/drive_core/block_diagram.svg` draws it anew";
}

}  // namespace
}  // namespace heatsoak::firmware
