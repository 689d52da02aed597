// The answers of `log`: assessment and conversion of files.
#include "recording/inspect_log.h"

#include <gtest/gtest.h>

#include "log_files.h"
#include "read_log.h"
#include "recording/read_recording.h"

namespace heatsoak::recording {
namespace {

const input::DataFolders kNoFolders;

TEST(InspectLogs, AssessesEachAsAWholeRecordingIs) {
  const LogFile good("good.csv", SyntheticLog{}.csv());
  const std::filesystem::path bad = good.add("bad.csv", "time_s,winding_C\n0,20\n1,20\n2,20.5\n3,21\n");
  const std::vector<InspectedLog> logs = inspect_logs(kNoFolders, {good.path().string(), bad.string()}, "");
  ASSERT_EQ(logs.size(), 2U);
  const Read whole = read_text(SyntheticLog{}.csv());
  EXPECT_EQ(logs[0].report.rows_kept, whole.report.rows_kept);
  EXPECT_EQ(logs[0].condensed.rows().file, good.path());
  ASSERT_EQ(logs[0].quality.channels.size(), whole.quality.channels.size());
  for (std::size_t i = 0; i < whole.quality.channels.size(); ++i) {
    EXPECT_EQ(logs[0].quality.channels[i].noise, whole.quality.channels[i].noise);
  }
  EXPECT_TRUE(logs[0].is_good());
  // Without a heat input it suits neither purpose.
  EXPECT_FALSE(logs[1].is_good());
}

TEST(ConvertLog, TheCanonicalFormHasTheSameRows) {
  const LogFile foreign("foreign.csv", "t,T,I\n0,20,1\n1,21,2\n2,22,3\n");
  const std::filesystem::path map = foreign.add(
      "other.toml", "[quantities]\ntime_s = { column = \"t\" }\nwinding_C = { column = \"T\" }\ncurrent_A = { column = \"I\" }\n");
  const ConvertedLog converted = convert_log(kNoFolders, foreign.path().string(), map.string());
  EXPECT_EQ(converted.channels, 2U);
  EXPECT_EQ(converted.report.rows_kept, 3U);
  const Read again = read_text(converted.text);
  RecordingReport report;
  const Recording original = read_recording(foreign.path(), mapping_for(foreign.path(), map), report);
  EXPECT_EQ(again.recording.time_s, original.time_s);
  for (const Channel& channel : original.channels) {
    EXPECT_EQ(again.recording.find(channel.quantity.key)->values, channel.values) << channel.quantity.key;
  }
}

}  // namespace
}  // namespace heatsoak::recording
