// The mapping that is suggested for a foreign log: a file that can be saved and read back.
#include "recording/suggested_mapping.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "log_files.h"
#include "recording/inspect_log.h"
#include "recording/mapping.h"
#include "recording/read_recording.h"

namespace heatsoak::recording {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

const std::vector<std::string> kForeign{"Time [ms]",  "winding_F",      "Stator temp (K)", "speed_rpm", "wheel_speed_rpm_2",
                                        "current_mA", "Iq \"peak\" #1", "thrust_N",        "foo bar",   "winding_C"};

Mapping read_back(const std::vector<std::string>& header) {
  const LogFile log("log.csv", "");
  return read_mapping(log.add("log.csv.map.toml", suggested_mapping(header)), log.path());
}

TEST(SuggestedMapping, is_a_mapping_file_with_quantities_and_units_of_the_names) {
  std::vector<std::string> keys;
  for (const QuantityMapping& each : read_back(kForeign).quantities) {
    keys.push_back(each.quantity.key + " from " + each.column);
  }
  EXPECT_THAT(keys, testing::UnorderedElementsAre("time_s from Time [ms]", "winding_C from winding_F", "stator_C from Stator temp (K)",
                                                  "speed_rad_per_s from speed_rpm", "wheel_speed_rad_per_s_2 from wheel_speed_rpm_2",
                                                  "current_A from current_mA", "thrust_N from thrust_N"));
}

TEST(SuggestedMapping, lists_all_other_columns_as_comments) {
  const std::string text = suggested_mapping(kForeign);
  EXPECT_THAT(text, AllOf(HasSubstr("# ? = { column = \"foo bar\", unit = \"?\" }\n"),
                          HasSubstr("# ? = { column = \"Iq \\\"peak\\\" #1\", unit = \"?\" }\n"),
                          HasSubstr("# ? = { column = \"winding_C\", unit = \"?\" }\n"), Not(HasSubstr("Required: time_s"))));
}

TEST(SuggestedMapping, without_a_time_asks_for_one) {
  EXPECT_THAT(suggested_mapping(std::vector<std::string>{"zeit", "winding_C"}),
              AllOf(HasSubstr("# Required: time_s ="), HasSubstr("\nwinding_C = { column = \"winding_C\" }\n"),
                    HasSubstr("# ? = { column = \"zeit\"")));
}

// The program suggests the text for a log; saved beside that log, it is found and converts the units.
TEST(SuggestedMapping, saved_beside_the_log_makes_it_readable) {
  std::string rows = "time_s,winding_F,speed_rpm,current_A,I\n";
  for (int i = 0; i < 40; ++i) {
    rows += std::to_string(i) + "," + std::to_string(68.0 + 1.8 * i) + ",60," + std::to_string(i % 5) + ",1\n";
  }
  const LogFile log("bench.csv", rows);
  const std::vector<InspectedLog> before = inspect_logs({}, {log.path().string()}, "");
  EXPECT_FALSE(before.front().quality.thermal.is_good());
  log.add("bench.csv.map.toml", before.front().suggested_mapping);
  const InspectedLog after = std::move(inspect_logs({}, {log.path().string()}, "").front());
  EXPECT_TRUE(after.quality.thermal.is_good());
  EXPECT_EQ(after.suggested_mapping, "");
  RecordingReport report;
  const Recording read = read_recording(log.path(), mapping_for(log.path(), {}), report);
  EXPECT_NEAR(read.find("winding_C")->values[10], 30.0, 1e-9);
  EXPECT_NEAR(read.find("speed_rad_per_s")->values[10], 2.0 * M_PI, 1e-9);
}

// A log in the canonical form needs no mapping, also with signals of its own.
TEST(SuggestedMapping, is_absent_for_a_canonical_log) {
  std::string rows = "time_s,winding_C,current_A,thrust_N\n";
  for (int i = 0; i < 40; ++i) {
    rows += std::to_string(i) + "," + std::to_string(20 + i) + "," + std::to_string(i % 5) + ",1\n";
  }
  const LogFile log("bench.csv", rows);
  EXPECT_EQ(inspect_logs({}, {log.path().string()}, "").front().suggested_mapping, "");
}

}  // namespace
}  // namespace heatsoak::recording
