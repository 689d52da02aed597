// Single wrong samples, frozen and saturated sensors in synthetic logs are left out by line, and nothing else.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "read_log.h"

namespace heatsoak::recording {
namespace {

TEST(Screening, PlantedOutliersAreFoundByLine) {
  const Read result = read_text(changed({}, [](int row, std::vector<double>& cells) {
    cells[winding] += row == 400 ? 5.0 : row == 880 || row == 881 ? -6.0 : 0.0;
  }));
  const std::vector<int> lines = lines_of(result.report.find("winding_C", LeftOutReason::outlier));
  EXPECT_THAT(lines, testing::IsSupersetOf({402, 882, 883}));
  EXPECT_LE(lines.size(), 5U);
  EXPECT_TRUE(std::isnan(result.recording.find("winding_C")->values[400]));
}

/// The winding heats and cools by 1 to 2 K between rows. An outlier differs from its neighbours little more than these do from each other.
TEST(Screening, OutliersOnSlopesAreFoundAndNothingElse) {
  SyntheticLog log;
  log.noise_K = 0.1;
  log.step_K = 0.1;
  log.current_A = [](double t) { return std::fmod(t, 40.0) < 20.0 ? 7.0 : 0.0; };
  constexpr int kEvery = 37;
  std::set<int> planted;
  const Read result = read_text(changed(log, [&planted](int row, std::vector<double>& cells) {
    if (row % kEvery == kEvery - 1) {
      cells[winding] += row % 2 == 0 ? 10.0 : -10.0;
      planted.insert(row + 2);
    }
  }));
  const std::vector<int> lines = lines_of(result.report.find("winding_C", LeftOutReason::outlier));
  const auto found = std::ranges::count_if(lines, [&](int line) { return planted.contains(line); });
  EXPECT_GE(found, 0.95 * static_cast<double>(planted.size())) << planted.size();
  EXPECT_LE(static_cast<std::ptrdiff_t>(lines.size()) - found, 1);
}

TEST(Screening, FrozenSensorIsLeftOutByLine) {
  double held = 0.0;
  const Read result = read_text(changed({}, [&held](int row, std::vector<double>& cells) {
    held = row == 320 ? cells[winding] : held;
    cells[winding] = row >= 320 && row < 380 ? held : cells[winding];
  }));
  const std::vector<int> lines = lines_of(result.report.find("winding_C", LeftOutReason::frozen));
  ASSERT_EQ(lines.size(), 60U);
  EXPECT_EQ(lines.front(), 322);
  EXPECT_EQ(result.report.find("stator_C", LeftOutReason::frozen), nullptr);
}

TEST(Screening, FrozenToTheEnd) {
  double held = 0.0;
  const Read result = read_text(changed({}, [&held](int row, std::vector<double>& cells) {
    held = row == 1550 ? cells[winding] : held;
    cells[winding] = row >= 1550 ? held : cells[winding];
  }));
  EXPECT_EQ(lines_of(result.report.find("winding_C", LeftOutReason::frozen)).size(), 250U);
}

/// Most samples are then equal, but the noise of the others shows that this is impossible.
TEST(Screening, FrozenForMostOfTheLog) {
  for (const int from : {850, 400}) {
    double held = 0.0;
    const Read result = read_text(changed({}, [&held, from](int row, std::vector<double>& cells) {
      held = row == from ? cells[winding] : held;
      cells[winding] = row >= from ? held : cells[winding];
    }));
    EXPECT_EQ(lines_of(result.report.find("winding_C", LeftOutReason::frozen)).size(), static_cast<std::size_t>(1800 - from));
    EXPECT_EQ(result.report.find("stator_C", LeftOutReason::frozen), nullptr);
  }
}

TEST(Screening, SaturatedSensorIsLeftOut) {
  int cut = 0;
  const Read result = read_text(changed({}, [&cut](int, std::vector<double>& cells) {
    cut += cells[winding] >= 85.0 ? 1 : 0;
    cells[winding] = std::min(cells[winding], 85.0);
  }));
  ASSERT_GT(cut, 50);
  EXPECT_EQ(lines_of(result.report.find("winding_C", LeftOutReason::saturated)).size(), static_cast<std::size_t>(cut));
}

}  // namespace
}  // namespace heatsoak::recording
