// Answers about measured logs: one library call from the job to the document, its data and its pictures.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "duty/named_files.h"
#include "present/measured/friction.h"
#include "present/measured/friction_chart.h"
#include "present/measured/log.h"
#include "support/shipped_folders.h"

namespace heatsoak::present {
namespace {

using testing::HasSubstr;

friction::FrictionJob friction_job() {
  friction::FrictionJob job{.robot = duty::robot_named(kShippedFolders, "roboteam_twente_v2024"),
                            .logs = {"reports/friction_test/steady_state_test.csv"},
                            .folders = kShippedFolders};
  job.motor_id = job.robot.drive.motor;
  job.motor = duty::own_motor(kShippedFolders, job.robot)->nominal;
  return job;
}

TEST(Friction, DocumentDataAndPicturesHaveTheSameVerdict) {
  const friction::FrictionJob job = friction_job();
  const friction::FrictionAnswer answer = friction::run_friction(job);
  const Document document = friction_document(job, answer);
  EXPECT_EQ(document.headline.at(0).words, "roboteam_twente_v2024: the friction of 4 of 4 wheels is identifiable.");
  EXPECT_EQ(document.data.at("motor"), job.motor_id);
  EXPECT_EQ(document.data.at("wheels").size(), 4U);
  const std::vector<report::Chart> charts = friction_charts(job, answer);
  ASSERT_EQ(charts.size(), 2U);
  for (const report::Chart& chart : charts) {
    EXPECT_THAT(chart.title, HasSubstr("friction of 4 of 4 wheels identifiable, hold-out error "));
  }
  EXPECT_TRUE(friction::robot_text(answer).empty());
}

TEST(Friction, StatesThatTheMotorHasNoFile) {
  friction::FrictionJob job = friction_job();
  job.robot.drive.motor = job.motor_id = "unlisted";
  EXPECT_FALSE(duty::own_motor(kShippedFolders, job.robot));
  job.motor.reset();
  const Document document = friction_document(job, friction::run_friction(job));
  EXPECT_TRUE(document.data.at("motor").is_null());
  EXPECT_THAT(document.data.at("findings").at(0).get<std::string>(), HasSubstr("no file of the robot's motor 'unlisted'"));
}

TEST(LogInspect, OneDocumentForAllLogs) {
  const std::vector<recording::InspectedLog> logs =
      recording::inspect_logs(kShippedFolders, {"reports/soak/bench.csv", "reports/soak/match_1.csv"}, "");
  const Document document = logs_document(logs);
  ASSERT_EQ(document.data.at("logs").size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string file = logs[i].condensed.rows().file.string();
    EXPECT_EQ(document.data.at("logs").at(i).at("file"), file);
    EXPECT_EQ(document.headline.at(i).words, file + ": usable for thermal models.");
  }
}

TEST(LogInspect, SizeHasAUnitThatFits) {
  const std::vector<recording::InspectedLog> logs = recording::inspect_logs(kShippedFolders, {"reports/soak/bench.csv"}, "");
  const auto rows_with = [&](std::size_t bytes) {
    std::vector<recording::InspectedLog> changed = logs;
    changed.front().report.file_bytes = bytes;
    return logs_document(changed).tables.front().rows.front().back().words;
  };
  EXPECT_THAT(rows_with(640), testing::EndsWith(", 640 B"));
  EXPECT_THAT(rows_with(78'400), testing::EndsWith(", 78.4 kB"));
  EXPECT_THAT(rows_with(59'000'000), testing::EndsWith(", 59.0 MB"));
}

}  // namespace
}  // namespace heatsoak::present
