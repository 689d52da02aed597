#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <numbers>

#include "base/diagnostic.h"
#include "duty/game_to_demand.h"
#include "duty/recorded_game.h"
#include "import_failure.h"
#include "ssl_log_writer.h"
#include "support/source_folder.h"

namespace heatsoak::duty {
namespace {

using testing::_;
using testing::AllOf;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Optional;
using testing::VariantWith;
using testing_logs::TemporaryFile;

constexpr const char* kHeader = "t_s,team,robot_id,x_m,y_m,yaw_rad\n";

std::string table(int rows) {
  std::string text = kHeader;
  for (int i = 0; i < rows; ++i) {
    text += std::to_string(100.0 + i * 0.01) + ",blue,7," + std::to_string(i * 0.01) + ",1.5,0\n";
  }
  return text;
}

std::string failure_of_table(const std::string& text) { return failure_of(text, "game.csv"); }

TEST(ImportCsv, ReadsATableWithItsOwnTime) {
  const TemporaryFile file("game.csv", table(300));
  const RecordedGame game = import_game(file.path());
  ASSERT_EQ(game.tracks.size(), 1U);
  EXPECT_EQ(to_string(game.tracks[0].robot), "blue 7");
  ASSERT_EQ(game.tracks[0].segments.size(), 1U);
  EXPECT_EQ(game.tracks[0].segments[0].size(), 300U);
  EXPECT_DOUBLE_EQ(game.tracks[0].segments[0].front().time_s, 100.0);
  EXPECT_NEAR(game.tracks[0].segments[0].back().x_m, 2.99, 1e-9);
  EXPECT_TRUE(game.phases.empty());
}

TEST(ImportCsv, TakesColumnsInAnyOrderAndRobotsOneAfterTheOther) {
  std::string text = "yaw_rad,extra,y_m,x_m,robot_id,team,t_s\n";
  for (const char* robot : {"0,yellow", "1,yellow", "0,blue"}) {
    for (int i = 0; i < 200; ++i) {
      text += "0,9,0,0," + std::string(robot) + "," + std::to_string(i * 0.01) + "\n";
    }
  }
  const TemporaryFile file("game.csv", text);
  const RecordedGame game = import_game(file.path());
  EXPECT_EQ(game.tracks.size(), 3U);
  EXPECT_EQ(game.report.out_of_order, 0U);
}

TEST(ImportCsv, NamesThePlaceOfWhatIsWrong) {
  EXPECT_THAT(failure_of_table(table(3) + "101,yelow,7,0,0,0\n"),
              HasSubstr("game.csv:5:5: error: team: \"yelow\" is not yellow or blue; did you mean 'yellow'?"));
  EXPECT_THAT(failure_of_table(table(3) + "101,blue,7,zero,0,0\n"),
              HasSubstr("game.csv:5:12: error: x_m: \"zero\" is not a finite number"));
  EXPECT_THAT(failure_of_table(table(3) + "101,blue,1.5,0,0,0\n"), HasSubstr("game.csv:5:10: error: robot_id: 1.5 is not a robot id"));
  EXPECT_THAT(failure_of_table(table(3) + "101,blue,7,0,0\n"), HasSubstr("game.csv:5:1: error: has 5 cells where the header has 6"));
  EXPECT_THAT(failure_of_table("t_s,team,robot,x_m,y_m,yaw_rad\n0,blue,1,0,0,0\n"), HasSubstr("robot_id: there is no such column"));
  EXPECT_THAT(failure_of_table(kHeader), HasSubstr("holds no row"));
}

// A recorder that stops abruptly leaves a truncated last row, perhaps inside its last number.
TEST(ImportCsv, LeavesOutALastRowThatMayBeCut) {
  const std::string last = "103,blue,7,3.00,1.5,0.125\n";
  for (std::size_t kept = 1; kept < last.size(); ++kept) {
    const TemporaryFile file("game.csv", table(300) + last.substr(0, kept));
    const RecordedGame game = import_game(file.path());
    EXPECT_EQ(game.tracks.at(0).segments.at(0).size(), 300U) << kept;
    EXPECT_THAT(game.report.notes, ElementsAre(VariantWith<LastRowOmitted>(Field(&LastRowOmitted::line, 302))));
  }
  for (const std::string& whole : {last, last.substr(0, last.size() - 1) + "\r\n"}) {
    const TemporaryFile file("game.csv", table(300) + whole);
    const RecordedGame game = import_game(file.path());
    EXPECT_EQ(game.tracks.at(0).segments.at(0).size(), 301U);
    EXPECT_THAT(game.report.notes, IsEmpty());
  }
  // Mistakes in earlier rows are still reported, and a header without rows is no game.
  EXPECT_THAT(failure_of_table(table(3) + "101,blue,7,zero,0,0\n101,bl"), HasSubstr("game.csv:5:12: error: x_m"));
  EXPECT_THAT(failure_of_table(std::string(kHeader) + "101,bl"), HasSubstr("holds no row"));
}

TEST(ImportCsv, ARowWithoutAPositionIsALostRobot) {
  std::string text = table(300);
  const char* const blanks[] = {",,", "nan,NaN,nan", "1.0,,0", "1.0,1.5, ", "NAN,1.5,0"};
  for (int i = 0; i < 100; ++i) {
    text += fmt::format("{:.2f},blue,7,{}\n", 103.0 + i * 0.01, blanks[i % 5]);
  }
  for (int i = 0; i < 300; ++i) {
    text += fmt::format("{:.2f},blue,7,3,1.5,0\n", 104.0 + i * 0.01);
  }
  const TemporaryFile file("game.csv", text);
  const RecordedGame game = import_game(file.path());
  ASSERT_EQ(game.tracks.at(0).segments.size(), 2U);
  EXPECT_EQ(game.tracks[0].segments[0].size(), 300U);
  EXPECT_EQ(game.tracks[0].segments[1].size(), 300U);
  EXPECT_THAT(game.report.notes, ElementsAre(VariantWith<RowsWithoutPosition>(Field(&RowsWithoutPosition::rows, 100U))));
  EXPECT_THAT(failure_of_table(table(3) + "nan,blue,7,0,0,0\n"), HasSubstr("game.csv:5:1: error: t_s: \"nan\" is not a finite number"));
  EXPECT_THAT(failure_of_table(table(3) + "101,blue,7,inf,0,0\n"), HasSubstr("game.csv:5:12: error: x_m: \"inf\""));
}

TEST(ImportCsv, APackedTableIsToBeUnpacked) {
  EXPECT_THAT(failure_of(testing_logs::gzip(table(300)), "game.csv.gz"), HasSubstr("is packed by gzip; unpack it first"));
}

TEST(ImportCsv, LeavesOutRowsThatGoBackInTimeAndSaysWhichOnes) {
  const TemporaryFile file("game.csv", table(300) + "101,blue,7,0,0,0\n");
  const RecordedGame game = import_game(file.path());
  EXPECT_EQ(game.tracks[0].segments[0].size(), 300U);
  EXPECT_EQ(game.report.out_of_order, 1U);
  ASSERT_EQ(game.report.problems.size(), 1U);
  EXPECT_EQ(game.report.problems[0].at, 302U);
  EXPECT_THAT(game.report.problems[0].fault,
              VariantWith<TimeNotIncreasing>(AllOf(Field(&TimeNotIncreasing::robot, RobotName{Team::blue, 7}),
                                                   Field(&TimeNotIncreasing::time_s, 101.0), Field(&TimeNotIncreasing::after_s, 102.99))));
}

/// Returns rows of a robot on a circle with the given yaw, 60 rows per second.
std::string with_yaw(int rows, double (*yaw)(double time_s)) {
  std::string text = kHeader;
  for (int i = 0; i < rows; ++i) {
    const double time_s = i / 60.0;
    text += fmt::format("{:.4f},blue,7,{:.5f},{:.5f},{:.5f}\n", time_s, std::sin(time_s), std::cos(time_s), yaw(time_s));
  }
  return text;
}

constexpr double kDegrees = 180.0 / std::numbers::pi;

TEST(ImportCsv, AStepOf360IsInDegreesHoweverSlowTheTurn) {
  // 0.25 rad/s from 0: the yaw exceeds 180 degrees at 12.566 s, in the 755th row, which starts with 12.5667,blue,7,0.00033,1.00000,
  EXPECT_THAT(failure_of_table(with_yaw(3600, [](double time_s) { return std::remainder(0.25 * kDegrees * time_s, 360.0); })),
              HasSubstr("game.csv:756:32: error: yaw_rad: jumps by a full turn of 360: it is in degrees; expected radians"));
  EXPECT_THAT(failure_of_table(with_yaw(3600, [](double time_s) { return std::fmod(0.25 * kDegrees * time_s, 360.0); })),
              HasSubstr("yaw_rad: jumps by a full turn of 360"));
}

TEST(ImportCsv, DegreesThatAreNotWrappedTurnMoreThanARobotKeepsUp) {
  EXPECT_THAT(failure_of_table(with_yaw(3600, [](double time_s) { return 0.25 * kDegrees * time_s; })), HasSubstr("is it in degrees?"));
  EXPECT_THAT(failure_of_table(with_yaw(3600, [](double time_s) { return kDegrees * (3.0 + 0.5 * std::sin(0.7 * time_s)); })),
              HasSubstr("is it in degrees?"));
}

TEST(ImportCsv, RadiansAreTakenWrappedOrNot) {
  for (double (*yaw)(double) : std::initializer_list<double (*)(double)>{
           [](double time_s) { return 2.0 * time_s; },                                            // 120 rad at the end
           [](double time_s) { return -3.9 * time_s; },                                           //
           [](double time_s) { return 300.0 + 0.25 * time_s; },                                   // many turns before the start
           [](double time_s) { return 40.0 * std::sin(0.07 * time_s); },                          // oscillating
           [](double time_s) { return std::remainder(14.0 * time_s, 2.0 * std::numbers::pi); },   // spinning
           [](double time_s) { return std::fmod(14.0 * time_s, 2.0 * std::numbers::pi); },        //
           [](double time_s) { return 3.0 + 0.005 * std::sin(40.0 * time_s); },                   // noisy camera
           [](double time_s) { return time_s > 30.0 ? 0.4 * time_s - 330.0 : 0.4 * time_s; }}) {  // restarts with another yaw
    const TemporaryFile file("game.csv", with_yaw(3600, yaw));
    EXPECT_NO_THROW((void)import_game(file.path())) << yaw(1.0) << " at 1 s";
  }
}

TEST(ImportCsv, AClockThatStartsAgainLosesNothing) {
  std::string text = kHeader;
  for (int i = 0; i < 2000; ++i) {
    for (const char* robot : {"blue,7", "yellow,1"}) {
      text += fmt::format("{:.2f},{},{:.4f},1.5,0\n", 50.0 + 0.01 * (i % 1000), robot, 0.001 * i);
    }
  }
  const TemporaryFile file("game.csv", text);
  const RecordedGame game = import_game(file.path());
  ASSERT_EQ(game.tracks.size(), 2U);
  for (const RobotTrack& track : game.tracks) {
    ASSERT_EQ(track.segments.size(), 2U);
    EXPECT_EQ(track.segments[0].size(), 1000U);
    EXPECT_EQ(track.segments[1].size(), 1000U);
    EXPECT_NEAR(track.segments[1].front().time_s, 59.99 + 1.0, 1e-9);
    EXPECT_NEAR(track.segments[1].back().time_s, 59.99 + 1.0 + 9.99, 1e-9);
  }
  EXPECT_EQ(game.report.out_of_order, 0U);
  ASSERT_EQ(game.report.problems.size(), 2U);
  EXPECT_EQ(game.report.problems[0].at, 2002U);
  EXPECT_THAT(game.report.problems[0].fault,
              VariantWith<ClockRestarts>(AllOf(Field(&ClockRestarts::robot, RobotName{Team::blue, 7}), Field(&ClockRestarts::time_s, 50.0),
                                               Field(&ClockRestarts::after_s, 59.99), Field(&ClockRestarts::pause_s, 1.0))));
}

TEST(ImportCsv, RowsOutOfOrderAreNoClockThatStartsAgain) {
  // Every tenth row is repeated one second later. The end contains a segment too short for a decision.
  std::string text = kHeader;
  for (int i = 0; i < 1000; ++i) {
    text += fmt::format("{:.2f},blue,7,1,1,0\n", 0.01 * i);
    if (i % 10 == 0 && i >= 100) {
      text += fmt::format("{:.2f},blue,7,1,1,0\n", 0.01 * (i - 100));
    }
  }
  for (int i = 0; i < 9; ++i) {
    text += fmt::format("{:.2f},blue,7,1,1,0\n", 0.01 * i);
  }
  const TemporaryFile file("game.csv", text);
  const RecordedGame game = import_game(file.path());
  EXPECT_EQ(game.tracks.at(0).segments.at(0).size(), 1000U);
  EXPECT_EQ(game.report.out_of_order, 99U);
}

TEST(ImportCsv, FindsWhyNobodyCanBeFollowed) {
  const auto notes_on = [](const std::string& text) {
    const TemporaryFile file("game.csv", text);
    return import_game(file.path()).report.notes;
  };
  std::string milliseconds = kHeader;
  std::string shuffled = kHeader;
  for (int i = 0; i < 600; ++i) {
    milliseconds += fmt::format("{:.2f},blue,7,1,1,0\n", 16.6667 * i);
    shuffled += fmt::format("{:.2f},blue,7,1,1,0\n", 0.01 * (i * 271 % 600));
  }
  EXPECT_THAT(notes_on(milliseconds),
              ElementsAre(VariantWith<RowsFarApart>(AllOf(Field(&RowsFarApart::step_s, DoubleNear(16.6667, 1e-3)),
                                                          Field(&RowsFarApart::suspected, RowTimeUnit::milliseconds)))));
  EXPECT_THAT(notes_on(shuffled), ElementsAre(VariantWith<RowsNotSorted>(_)));
  std::string rounded = kHeader;
  for (int i = 0; i < 600; ++i) {
    rounded += fmt::format("{:.1f},blue,7,1,1,0\n", i / 60.0);
  }
  EXPECT_THAT(notes_on(rounded), ElementsAre(VariantWith<TimesRepeat>(_)));
}

TEST(ImportCsv, FindsThatARobotIsSeenTooSeldom) {
  const auto low_rate_Hz = [](double rate_Hz) {
    std::string text = kHeader;
    for (int i = 0; i < 400; ++i) {
      text += fmt::format("{:.4f},blue,7,{:.4f},1.5,0\n", i / rate_Hz, std::sin(i / rate_Hz));
    }
    const TemporaryFile file("game.csv", text);
    return demand_of_game(file.path(), "blue 7", robot::read_robot(kSource / "robot_core/robots/tigers_v2020.toml"), 0.01)
        .low_sight_rate_Hz;
  };
  EXPECT_THAT(low_rate_Hz(3.0), Optional(DoubleNear(3.0, 0.05)));
  EXPECT_THAT(low_rate_Hz(9.0), Optional(DoubleNear(9.0, 0.05)));
  EXPECT_EQ(low_rate_Hz(10.0), std::nullopt);
}

TEST(ImportCsv, PlacesBeyondAllMeasureAreSaidShortly) {
  std::string text = kHeader;
  for (int i = 0; i < 300; ++i) {
    text += fmt::format("{:.2f},blue,7,1e300,1e300,0\n", 0.01 * i);
  }
  EXPECT_THAT(failure_of_table(text), HasSubstr("reach 1e+300 m, and most positions are outside any field"));
}

TEST(ImportCsv, AJumpOfTheClockIsNoPause) {
  std::string text = kHeader;
  for (int i = 0; i < 2000; ++i) {
    const double time_s = 0.01 * i + (i < 1000 ? 0.0 : 1e9) + (i < 1500 ? 0.0 : 120.0);
    text += std::to_string(time_s) + ",blue,7," + std::to_string(0.5 * std::sin(0.02 * i)) + ",1.5,0\n";
  }
  const TemporaryFile file("game.csv", text);
  const GameDemand demand = demand_of_game(file.path(), "blue 7", robot::read_robot(kSource / "robot_core/robots/tigers_v2020.toml"), 0.01);
  ASSERT_FALSE(demand.wheels.empty());
  EXPECT_NEAR(demand.wheels.front().duration_s(), 20.0 + 120.0, 0.1);
  EXPECT_EQ(demand.clock_jumps, 1);
}

}  // namespace
}  // namespace heatsoak::duty
