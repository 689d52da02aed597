// A log that is read in parts must give the same result at the borders of the parts. All logs in this file are synthetic.
#include "recording/recording_stream.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <iterator>

#include "base/random.h"
#include "log_files.h"
#include "recording/quality.h"
#include "recording/read_recording.h"

namespace heatsoak::recording {
namespace {

constexpr int kRows = 230'000;
constexpr double kPeriod_s = 0.01;

struct Row {
  double time_s = 0.0;
  double winding_C = 0.0;
  double current_A = 0.0;
};

/// Uniform noise of ±0.05 K on a temperature that rises and falls, and a current with a pattern of some seconds.
std::string log_text(const std::function<void(int, Row&)>& change) {
  std::string text = "time_s,winding_C,current_A\n";
  base::Random random(7, 0);
  for (int i = 0; i < kRows; ++i) {
    const double t = kPeriod_s * i;
    Row row{t, 60.0 + 30.0 * std::sin(t / 300.0) + 0.1 * (random.uniform() - 0.5), 5.0 * std::sin(t)};
    change(i, row);
    fmt::format_to(std::back_inserter(text), "{:.2f},{:.4f},{:.4f}\n", row.time_s, row.winding_C, row.current_A);
  }
  return text;
}

std::vector<std::size_t> parts_of(const LogFile& file, RecordingReport& report, const Mapping& mapping = {}) {
  RecordingStream stream(file.path(), mapping, report);
  std::vector<std::size_t> sizes;
  for (Recording part; stream.next(part);) {
    sizes.push_back(part.rows());
  }
  return sizes;
}

/// Returns the last row of the first part. The second part has the same length.
std::size_t first_border() {
  static const std::size_t border = [] {
    const LogFile file("log.csv", log_text([](int, Row&) {}));
    RecordingReport report;
    const std::vector<std::size_t> sizes = parts_of(file, report);
    EXPECT_GT(sizes.size(), 2U);
    EXPECT_TRUE(report.left_out.empty());
    return sizes.front();
  }();
  return border;
}

TEST(RecordingStream, FaultsAcrossABorderAreFoundAsElsewhere) {
  const int border = static_cast<int>(first_border());
  for (const int middle : {border / 2, border}) {
    SCOPED_TRACE(middle);
    double held_C = 0.0;
    const LogFile file("log.csv", log_text([&](int i, Row& row) {
                         held_C = i == middle - 2000 ? row.winding_C : held_C;
                         row.winding_C = i >= middle - 2000 && i < middle + 2000 ? held_C : row.winding_C;
                         row.winding_C += i == middle - 2300 || i == middle + 2300 ? 8.0 : 0.0;
                         row.time_s -= i == middle + 2400 ? 1.0 : 0.0;
                       }));
    RecordingReport report;
    const Recording all = read_recording(file.path(), {}, report);
    EXPECT_EQ(all.rows(), kRows - 1U);
    EXPECT_THAT(all.run_begins, testing::ElementsAre(0U));
    const LeftOut* const frozen = report.find("winding_C", LeftOutReason::frozen);
    ASSERT_NE(frozen, nullptr);
    EXPECT_EQ(frozen->count, 4000U);
    EXPECT_EQ(frozen->lines.front().first, middle - 2000 + 2);
    const LeftOut* const outliers = report.find("winding_C", LeftOutReason::outlier);
    ASSERT_NE(outliers, nullptr);
    EXPECT_EQ(outliers->lines.front().first, middle - 2300 + 2);
    EXPECT_EQ(outliers->lines.back().first, middle + 2300 + 2);
    EXPECT_EQ(outliers->count, 2U);
    const LeftOut* const backwards = report.find("", LeftOutReason::time_does_not_increase);
    ASSERT_NE(backwards, nullptr);
    EXPECT_EQ(backwards->count, 1U);
    EXPECT_EQ(backwards->lines.front().first, middle + 2400 + 2);
  }
}

TEST(RecordingStream, StaysFrozenForMoreThanAPart) {
  const int begin = static_cast<int>(first_border()) - 2000;
  double held_C = 0.0;
  const LogFile file("log.csv", log_text([&](int i, Row& row) {
                       held_C = i == begin ? row.winding_C : held_C;
                       row.winding_C = i >= begin && i < begin + 150'000 ? held_C : row.winding_C;
                     }));
  RecordingReport report;
  read_recording(file.path(), {}, report);
  const LeftOut* const frozen = report.find("winding_C", LeftOutReason::frozen);
  ASSERT_NE(frozen, nullptr);
  EXPECT_EQ(frozen->count, 150'000U);
}

/// A heating winding with noise of 0.12 K and steps of 0.1 K: 12 equal samples alone are possible, but not with a jump of 8 K behind them.
TEST(RecordingStream, ShortHoldBeforeAJumpIsFrozen) {
  for (const bool holds : {false, true}) {
    int found = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      base::Random random(seed, 0);
      std::string text = "time_s,winding_C,current_A\n";
      double held_C = 0.0;
      for (int i = 0; i < 600; ++i) {
        const double noise_K = 0.12 * std::sqrt(12.0) * (random.uniform() - 0.5);
        double winding_C = std::round(10.0 * (30.0 + 60.0 * (1.0 - std::exp(-i / 60.0)) + noise_K)) / 10.0;
        held_C = i == 20 ? winding_C : held_C;
        winding_C = holds && i > 20 && i < 32 ? held_C : winding_C;
        fmt::format_to(std::back_inserter(text), "{},{:.1f},8\n", i, winding_C);
      }
      const LogFile file("log.csv", text);
      RecordingReport report;
      read_recording(file.path(), {}, report);
      const LeftOut* const frozen = report.find("winding_C", LeftOutReason::frozen);
      found += frozen != nullptr ? 1 : 0;
      if (holds && frozen != nullptr) {
        EXPECT_EQ(frozen->count, 12U) << seed;
      }
    }
    EXPECT_EQ(found, holds ? 20 : 0);
  }
}

TEST(RecordingStream, GapSplitsAtTheBorderOnly) {
  const int border = static_cast<int>(first_border());
  const LogFile file("log.csv", log_text([&](int i, Row& row) { row.time_s += i >= border ? 5.0 : 0.0; }));
  RecordingReport report;
  EXPECT_THAT(read_recording(file.path(), {}, report).run_begins, testing::ElementsAre(0U, static_cast<std::size_t>(border)));
}

/// For linear signals, the results of clock offsets and input conventions are known exactly.
TEST(RecordingStream, ClocksAndHabitsReachOverBorders) {
  std::string text = "t,T,I\n";
  for (int i = 0; i < kRows; ++i) {
    fmt::format_to(std::back_inserter(text), "{:.2f},{:.6f},{:.6f}\n", kPeriod_s * i, 20.0 + 1e-4 * i, 1.0 + 1e-5 * i);
  }
  const LogFile file("log.csv", text);
  // 80 s are 8000 rows. This is more than the reader keeps around a part without a clock offset.
  const auto map = file.add("log.map.toml",
                            "inputs = \"previous_interval\"\n[quantities]\ntime_s = { column = \"t\" }\n"
                            "winding_C = { column = \"T\", clock_offset = \"80 s\" }\ncurrent_A = { column = \"I\" }\n");
  RecordingReport report;
  const Recording all = read_recording(file.path(), read_mapping(map, file.path()), report);
  ASSERT_EQ(all.rows(), static_cast<std::size_t>(kRows));
  const std::vector<double>& winding_C = all.find("winding_C")->values;
  const std::vector<double>& current_A = all.find("current_A")->values;
  double most_K = 0.0;
  double most_A = 0.0;
  for (int i = 8000; i + 1 < kRows; ++i) {
    const auto row = static_cast<std::size_t>(i);
    ASSERT_FALSE(std::isnan(winding_C[row]) || std::isnan(current_A[row])) << i;
    most_K = std::max(most_K, std::abs(winding_C[row] - (20.0 + 1e-4 * (i - 8000))));
    most_A = std::max(most_A, std::abs(current_A[row] - (1.0 + 1e-5 * (i + 1))));
  }
  EXPECT_LT(most_K, 1e-6);
  EXPECT_LT(most_A, 1e-6);
}

TEST(RecordingStream, SortedBackwardsIsRefused) {
  const LogFile file("log.csv", log_text([](int i, Row& row) { row.time_s = kPeriod_s * (kRows - i); }));
  RecordingReport report;
  try {
    parts_of(file, report);
    FAIL() << "was read";
  } catch (const base::Failure& failure) {
    EXPECT_THAT(failure.what(), testing::HasSubstr(":3:1: error: time_s: time does not increase"));
  }
}

/// The summary of a log has a bounded size. It must still contain the heat, the extremes and the noise.
TEST(Assessment, KeepsABoundedPictureOfALongLog) {
  const int border = static_cast<int>(first_border());
  const LogFile file("log.csv", log_text([&](int i, Row& row) { row.current_A = i == border + 17 ? 55.5 : row.current_A; }));
  RecordingReport report;
  const Recording all = read_recording(file.path(), {}, report);
  Assessment assessment;
  RecordingReport again;
  RecordingStream stream(file.path(), {}, again);
  for (Recording part; stream.next(part);) {
    assessment.add(part);
  }
  const DataQuality quality = assessment.conclude(again);
  const Recording& rows = assessment.condensed().rows();
  EXPECT_LE(rows.rows(), CondensedRecording::kMostRows);
  EXPECT_GT(rows.rows(), CondensedRecording::kMostRows / 4);
  const auto heat_J_per_ohm = [](const Recording& recording) {
    const std::vector<double>& current_A = recording.find("current_A")->values;
    double sum = 0.0;
    for (std::size_t i = 0; i < recording.rows(); ++i) {
      const double end_s = i + 1 < recording.rows() ? recording.time_s[i + 1] : kRows * kPeriod_s;
      sum += current_A[i] * current_A[i] * (end_s - recording.time_s[i]);
    }
    return sum;
  };
  EXPECT_NEAR(heat_J_per_ohm(rows), heat_J_per_ohm(all), 1e-6 * heat_J_per_ohm(all));
  EXPECT_EQ(quality.channels[1].high, 55.5);
  EXPECT_EQ(quality.channels[1].at_high, 1U);
  const std::vector<double>& high_A = assessment.condensed().high(1);
  EXPECT_EQ(*std::ranges::max_element(high_A), 55.5);
  EXPECT_EQ(quality.channels[0].samples, static_cast<std::size_t>(kRows));
  // Uniform noise of ±0.05 K.
  EXPECT_NEAR(quality.channels[0].noise, 0.1 / std::sqrt(12.0), 0.006);
  EXPECT_NEAR(quality.sampling.usual_period_s, kPeriod_s, 1e-9);
  EXPECT_NEAR(quality.sampling.duration_s, kPeriod_s * (kRows - 1), 1e-6);
  EXPECT_EQ(quality.runs, 1U);
}

TEST(Assessment, ManyShortRunsStayBounded) {
  std::string text = "time_s,winding_C,current_A\n";
  for (int i = 0; i < kRows; ++i) {
    fmt::format_to(std::back_inserter(text), "{},{:.3f},1\n", i + 10 * (i / 2), 20.0 + std::sin(0.01 * i));
  }
  const LogFile file("log.csv", text);
  const auto map = file.add("log.map.toml",
                            "[runs]\nlongest_gap = \"3 s\"\n[quantities]\ntime_s = { column = \"time_s\" }\n"
                            "winding_C = { column = \"winding_C\" }\ncurrent_A = { column = \"current_A\" }\n");
  RecordingReport report;
  RecordingStream stream(file.path(), read_mapping(map, file.path()), report);
  Assessment assessment;
  for (Recording part; stream.next(part);) {
    assessment.add(part);
  }
  const DataQuality quality = assessment.conclude(report);
  EXPECT_EQ(quality.runs, kRows / 2U);
  EXPECT_EQ(quality.gaps.size(), DataQuality::kMostGaps);
  EXPECT_LE(assessment.condensed().rows().rows(), CondensedRecording::kMostRows);
}

TEST(Thinned, KeepsEveryNth) {
  Thinned some(8);
  for (int i = 0; i < 100; ++i) {
    some.add(i);
  }
  EXPECT_THAT(some.values(), testing::ElementsAre(0, 16, 32, 48, 64, 80, 96));
}

}  // namespace
}  // namespace heatsoak::recording
