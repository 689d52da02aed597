// A canonical log becomes a recording; what is no measurement is left out and said by line.
#include "identify/measurement/read_recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/diagnostic.h"
#include "log_files.h"

namespace heatsoak {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

Recording read(const std::string& text, RecordingReport& report, const Mapping& mapping = {}) {
  const LogFile file("log.csv", text);
  return read_recording(file.path(), mapping, report);
}

std::string failure_of(const std::string& text, const Mapping& mapping = {}) {
  RecordingReport report;
  try {
    read(text, report, mapping);
  } catch (const Failure& failure) {
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
  EXPECT_THAT(report.notes, ElementsAre(HasSubstr("column 5 'comment' is not used")));
  EXPECT_EQ(report.rows_kept, 3U);
  EXPECT_TRUE(report.left_out.empty());
}

TEST(ReadRecording, GapOfMoreThanThreePeriodsSplitsTheRun) {
  RecordingReport report;
  const Recording recording = read("time_s,winding_C\n0,20\n1,20\n2,20\n5,20\n8.5,20\n9.5,20\n", report);
  EXPECT_THAT(recording.run_begins, ElementsAre(0U, 4U)) << "a step of exactly three periods does not split";
}

TEST(ReadRecording, WithoutTimeSaysWhatToDo) {
  EXPECT_THAT(failure_of("tme_s,winding_C\n0,20\n"),
              HasSubstr("log.csv:1:1: error: time_s: there is no such column; did you mean 'tme_s'?"));
}

}  // namespace
}  // namespace heatsoak
