// Converts a canonical log to a recording. Invalid measurements are left out and reported by line.
#include "recording/read_recording.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/diagnostic.h"
#include "base/random.h"
#include "log_files.h"
#include "recording/quality.h"
#include "recording/write_recording.h"

namespace heatsoak::recording {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using namespace std::string_view_literals;

Recording read(const std::string& text, RecordingReport& report, const Mapping& mapping = {}) {
  const LogFile file("log.csv", text);
  return read_recording(file.path(), mapping, report);
}

std::string failure_of(const std::string& text, const Mapping& mapping = {}) {
  RecordingReport report;
  try {
    read(text, report, mapping);
  } catch (const base::Failure& failure) {
    return failure.what();
  }
  return "nothing";
}

TEST(ReadRecording, CanonicalColumnsByTheirNames) {
  RecordingReport report;
  const Recording recording = read("time_s,winding_C,current_A,thrust_N,comment\n0,25.0,1.5,7,0\n1,25.5,-1.5,8,0\n2,26.0,0,9,0\n", report);
  EXPECT_EQ(recording.name, "log");
  EXPECT_THAT(recording.time_s, ElementsAre(0.0, 1.0, 2.0));
  EXPECT_THAT(recording.line, ElementsAre(2, 3, 4));
  ASSERT_EQ(recording.channels.size(), 3U);
  EXPECT_THAT(recording.find("winding_C")->values, ElementsAre(25.0, 25.5, 26.0));
  EXPECT_EQ(recording.find("winding_C")->quantity.kind, QuantityKind::temperature);
  EXPECT_EQ(recording.find("thrust_N")->quantity.unit, "N");
  EXPECT_EQ(recording.find("comment"), nullptr);
  EXPECT_THAT(report.notes, ElementsAre(testing::VariantWith<ColumnWithoutUnit>(testing::AllOf(
                                testing::Field(&ColumnWithoutUnit::column, 5U), testing::Field(&ColumnWithoutUnit::name, "comment")))));
  EXPECT_EQ(report.rows_kept, 3U);
  EXPECT_TRUE(report.left_out.empty());
}

TEST(ReadRecording, GapOfMoreThanThreePeriodsSplitsTheRun) {
  RecordingReport report;
  const Recording recording = read("time_s,winding_C\n0,20\n1,20\n2,20\n5,20\n8.5,20\n9.5,20\n", report);
  EXPECT_THAT(recording.run_begins, ElementsAre(0U, 4U)) << "a step of exactly three periods does not split";
}

TEST(ReadRecording, CopiesOfRowsAreLeftOutHoweverMany) {
  std::string text = "time_s,winding_C\n";
  for (int i = 0; i < 60; ++i) {
    text += fmt::format("{0},{1}\n", i, 20.0 + 0.1 * i) + (i % 3 == 0 ? fmt::format("{0},{1}\n", i, 20.0 + 0.1 * i) : "");
  }
  RecordingReport report;
  EXPECT_EQ(read(text, report).rows(), 60U);
  EXPECT_EQ(report.find("", LeftOutReason::time_does_not_increase)->count, 20U);
  EXPECT_EQ(report.repeated_times, 20U);
}

TEST(ReadRecording, TimeOfTooFewDigitsIsRefused) {
  std::string text = "time_s,winding_C\n";
  for (int i = 0; i < 60; ++i) {
    text += fmt::format("{},{}\n", i / 10, 20.0 + 0.1 * i);
  }
  EXPECT_THAT(failure_of(text), HasSubstr("54 of 60 rows have the time of the row before"));
}

TEST(ReadRecording, OtherSeparatorsUnitsAndNamesAreSaid) {
  EXPECT_THAT(failure_of("log of 3 May\ntime_s,winding_C\n0,20\n"), HasSubstr("header_rows"));
  EXPECT_THAT(failure_of("time_s;winding_C\n0;20\n"), HasSubstr("this file seems to have ';'"));
  EXPECT_THAT(failure_of("time_s\twinding_C\n0\t20\n"), HasSubstr("separator = \"tab\""));
  RecordingReport report;
  read("time_s,winding_C,stator_F,windin_C\n0,20,68,20\n1,21,69,21\n", report);
  EXPECT_THAT(report.notes,
              testing::Contains(testing::VariantWith<AdditionalSignal>(testing::Field(&AdditionalSignal::channel, "stator_F"))));
  EXPECT_THAT(nearest_quantity("stator_F"), HasSubstr("did you mean 'stator_C'? A column in another unit is read with a mapping"));
  EXPECT_THAT(report.notes,
              testing::Contains(testing::VariantWith<AdditionalSignal>(testing::Field(&AdditionalSignal::channel, "windin_C"))));
  EXPECT_THAT(nearest_quantity("windin_C"), HasSubstr("; did you mean 'winding_C'?"));
}

TEST(ReadRecording, WithoutTimeSaysWhatToDo) {
  EXPECT_THAT(failure_of("tme_s,winding_C\n0,20\n"),
              HasSubstr("log.csv:1:1: error: time_s: there is no such column; did you mean 'tme_s'? A foreign log is read with a mapping"));
  EXPECT_THAT(failure_of("x_m,winding_C\n0,20\n"), HasSubstr("there is no such column. A foreign log is read with a mapping"));
  for (const std::string name : {"time_ms", "t_ms"}) {
    EXPECT_THAT(failure_of(name + ",winding_C\n0,20\n"),
                testing::AllOf(HasSubstr("there is no such column; '" + name + "' is in another unit"),
                               HasSubstr("[quantities]\ntime_s = { column = \"" + name + "\", unit = \"ms\" }\n")));
  }
}

TEST(ReadRecording, RowsThatAreNoneAreLeftOutByLine) {
  RecordingReport report;
  const Recording recording = read(
      "# a comment\n\ntime_s,winding_C,current_A\r\n0,20,1\n1,,1\n# "
      "pause\n2,nan,1\n2,21,1\n1.5,21,1\n3,warm,1,\n,22,1\n4,22,inf\n5,-300,1\n"
      "6,\"22.5\",1\n7,22,1\n8,22,1\n9,22,1\n10,22,1\n11,22,1\n12,22,1\n13,22,1\n14,22,1\n15,22,1\n16,22,1\n17,22,1\n18,22,1\n19,22,1\n20,"
      "22,1\n21,22,1\n22,2",
      report);
  const auto line_of = [&report](const char* quantity, LeftOutReason reason) {
    const LeftOut* const entry = report.find(quantity, reason);
    return entry == nullptr || entry->count != 1 ? -1 : entry->lines.front().first;
  };
  EXPECT_EQ(line_of("winding_C", LeftOutReason::not_recorded), 5);
  EXPECT_EQ(line_of("winding_C", LeftOutReason::not_a_number), 7);
  EXPECT_EQ(line_of("", LeftOutReason::wrong_number_of_cells), 10);
  EXPECT_EQ(line_of("", LeftOutReason::without_time), 11);
  EXPECT_EQ(line_of("current_A", LeftOutReason::not_a_number), 12);
  EXPECT_EQ(line_of("winding_C", LeftOutReason::impossible), 13);
  EXPECT_EQ(line_of("", LeftOutReason::cut_off), 30);
  ASSERT_NE(report.find("", LeftOutReason::time_does_not_increase), nullptr);
  EXPECT_THAT(report.find("", LeftOutReason::time_does_not_increase)->lines.front().first, 8);
  EXPECT_EQ(report.find("", LeftOutReason::time_does_not_increase)->count, 2U);
  EXPECT_EQ(report.repeated_times, 1U);
  EXPECT_EQ(report.rows_in_file, 26U);
  EXPECT_EQ(recording.rows(), 21U);
  EXPECT_DOUBLE_EQ(recording.find("winding_C")->values[5], 22.5);
}

/// One wrong time stamp must not remove the rows after it.
TEST(ReadRecording, OneTimeFarAheadGoesAlone) {
  RecordingReport report;
  std::string text = "time_s,winding_C\n";
  for (int i = 0; i < 100; ++i) {
    text += std::to_string(i == 40 ? 1000000 : i) + ",20\n";
  }
  const Recording recording = read(text, report);
  EXPECT_EQ(recording.rows(), 99U);
  EXPECT_EQ(report.find("", LeftOutReason::time_does_not_increase)->lines.front().first, 42);
}

TEST(ReadRecording, FilesThatAreNoLogs) {
  EXPECT_THAT(failure_of(""), HasSubstr("is empty"));
  EXPECT_THAT(failure_of("time_s,winding_C\n"), HasSubstr("has a header but no rows"));
  EXPECT_THAT(failure_of("winding_C\n20\n"), HasSubstr("the header has one column only"));
  EXPECT_THAT(failure_of("log of 3 May\ntime_s,winding_C\n0,20\n"), HasSubstr("header_rows"));
  EXPECT_THAT(failure_of("time_s;winding_C\n0;20\n"), HasSubstr("the header has one column only"));
  EXPECT_THAT(failure_of(std::string("time_s,winding_C\n0,\0\n", 21)), HasSubstr("binary file"));
  EXPECT_THAT(failure_of("time_s,winding_C\n0,20,1\n1,20,1\n"),
              HasSubstr("none of its 2 rows can be used; number of cells differs from the header"));
  EXPECT_THAT(failure_of("time_s,winding_C\n0,\"20\n1,21\n"), HasSubstr(":2:1: error: a quote in this row is not closed"));
  EXPECT_THAT(failure_of("time_s,winding_C\r0,20\r1,21\r"), HasSubstr(":1:1: error: its lines end with a carriage return alone"));
  EXPECT_THAT(failure_of("time_s,winding_C\n0," + std::string(3 << 20, '1') + "\n"), HasSubstr("a line of more than 1 MB"));
  EXPECT_THAT(failure_of("time_s,winding_C,winding_C\n0,20,20\n"), HasSubstr("'winding_C' appears twice in the header"));
  EXPECT_THAT(failure_of("time_s,winding_C\n5,20\n4,20\n3,20\n2,20\n"), HasSubstr(":3:1: error: time_s: time does not increase"));
  EXPECT_THAT(failure_of("time_s,winding_C\n0,\n1,nan\n"), HasSubstr("no quantity except the time contains a number"));
}

TEST(ReadRecording, ColumnsThatAreNoQuantitiesAreNamedWithAMapping) {
  EXPECT_THAT(failure_of("time_s,motor temp [C],current [A]\n0,20,1\n1,21,2\n"),
              testing::AllOf(HasSubstr(":1:1: error: 'motor temp [C]', 'current [A]' are not understood; expected names of quantities"),
                             HasSubstr("[quantities]\n"), HasSubstr("current_A = { column = \"current [A]\", unit = \"A\" }"),
                             testing::Not(HasSubstr("Required: time_s"))));
}

TEST(ReadRecording, ExitCodesTellWhatIsWrong) {
  const auto code_of = [](const std::string& text) {
    RecordingReport report;
    try {
      read(text, report);
    } catch (const base::Failure& failure) {
      return failure.code();
    }
    return base::ExitCode::done;
  };
  EXPECT_EQ(code_of("time_s,winding_C\n5,20\n4,20\n3,20\n"), base::ExitCode::bad_input);
  EXPECT_EQ(code_of("time_s,winding_C\n0,\n1,nan\n"), base::ExitCode::cannot_answer);
  EXPECT_EQ(code_of("time_s,temperature\n0,20\n1,21\n"), base::ExitCode::bad_input);
}

/// Any damaged log must give a consistent recording or a Failure with the reason.
TEST(ReadRecording, DamagedLogsNeverCrash) {
  std::string sound = "time_s,winding_C,stator_C,current_A\n";
  for (int i = 0; i < 200; ++i) {
    sound += fmt::format("{},{:.2f},{:.2f},{}\n", i, 25.0 + 0.1 * i, 25.0 + 0.05 * i, i % 7);
  }
  const std::string_view wrong_bytes = ",;\"\n\r #\0-+.eEnN9\xff\xef"sv;
  int failures = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    base::Random random(seed, 0);
    std::string damaged = sound;
    const int hits = 1 + static_cast<int>(random.uniform() * 30.0);
    for (int hit = 0; hit < hits; ++hit) {
      const auto at = static_cast<std::size_t>(random.uniform() * static_cast<double>(damaged.size()));
      const double what = random.uniform();
      if (what < 0.5) {
        damaged[at] = wrong_bytes[static_cast<std::size_t>(random.uniform() * static_cast<double>(wrong_bytes.size()))];
      } else if (what < 0.8) {
        damaged.erase(at, static_cast<std::size_t>(random.uniform() * 40.0));
      } else if (what < 0.95) {
        damaged.insert(at, damaged.substr(static_cast<std::size_t>(random.uniform() * static_cast<double>(damaged.size())), 60));
      } else {
        damaged.resize(at + 1);
      }
    }
    RecordingReport report;
    try {
      const Recording recording = read(damaged, report);
      EXPECT_EQ(recording.line.size(), recording.rows());
      for (const Channel& channel : recording.channels) {
        EXPECT_EQ(channel.values.size(), recording.rows());
      }
      EXPECT_EQ(std::ranges::adjacent_find(recording.time_s, std::greater_equal<>()), recording.time_s.end());
      assess(recording, report);
    } catch (const base::Failure& failure) {
      ++failures;
      EXPECT_NE(failure.code(), base::ExitCode::bug);
      EXPECT_NE(std::string(failure.what()), "");
    }
  }
  EXPECT_GT(failures, 10);
  EXPECT_LT(failures, 190);
}

// Motor files contain the content hash of logs that were read under the earlier name.
TEST(ReadRecording, EarlierNameGivesTheSameRecording) {
  RecordingReport report;
  const std::string rows = "\n0.1,20,0.5,0.25\n1.1,21,0.5,0.25\n2.1,22,0.1,0.5\n";
  const Recording earlier = read("time_s,winding_C,duty_ratio,wheel_pwm_ratio_2" + rows, report);
  const Recording now = read("time_s,winding_C,modulation_ratio,wheel_modulation_ratio_2" + rows, report);
  ASSERT_NE(earlier.find("modulation_ratio"), nullptr);
  EXPECT_EQ(earlier.find("modulation_ratio")->values, now.find("modulation_ratio")->values);
  EXPECT_EQ(earlier.find("wheel_modulation_ratio_2")->values, now.find("wheel_modulation_ratio_2")->values);
  EXPECT_EQ(earlier.content, now.content);
  EXPECT_EQ(to_canonical_csv(earlier), to_canonical_csv(now));
}

TEST(ReadRecording, TwoNamesOfOneQuantityAreAProblem) {
  RecordingReport report;
  try {
    read("time_s,winding_C,duty_ratio,modulation_ratio\n0.1,20,0.5,0.5\n1.1,21,0.5,0.5\n", report);
    ADD_FAILURE() << "read";
  } catch (const base::Failure& failure) {
    EXPECT_EQ(failure.code(), base::ExitCode::bad_input);
    EXPECT_THAT(failure.what(), HasSubstr("modulation_ratio: has two names: 'duty_ratio' is the earlier one"));
  }
}

TEST(ReadRecording, CanonicalFormReadsBackTheSame) {
  RecordingReport report;
  const Recording first = read("time_s,winding_C,current_A,flow_m3_per_s\n0.1,20.123456789,1,0.5\n1.1,,2,\n2.1,22,0.1,7e-9\n", report);
  EXPECT_EQ(first.find("flow_m3_per_s")->quantity.unit, "m3/s");
  const Recording again = read(to_canonical_csv(first), report);
  ASSERT_EQ(again.channels.size(), 3U);
  EXPECT_EQ(again.time_s, first.time_s);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(again.channels[i].quantity.key, first.channels[i].quantity.key);
    EXPECT_THAT(again.channels[i].values, testing::Pointwise(testing::NanSensitiveDoubleEq(), first.channels[i].values));
  }
}

}  // namespace
}  // namespace heatsoak::recording
