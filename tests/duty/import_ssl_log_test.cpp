#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "duty/recorded_game.h"
#include "ssl_log_writer.h"

namespace heatsoak::duty {
namespace {

using namespace testing_logs;

SeenRobot on_a_line(double time_s) { return {true, 3, 0.5 * time_s - 1.0, 0.25, 0.1}; }

/// Log of one robot on a line for `seconds`, seen by camera 0.
LogWriter line(double seconds, int type = 4) {
  LogWriter log;
  for (int i = 0; i * kFrame_s < seconds; ++i) {
    log.add(i * kFrame_s, type, vision(i * kFrame_s, 0, {on_a_line(i * kFrame_s)}));
  }
  return log;
}

RecordedGame import_bytes(const std::string& bytes, const ImportOptions& options = {}, const std::string& name = "game.log") {
  const TemporaryFile file(name, bytes);
  return import_game(file.path(), options);
}

void expect_line(const RecordedGame& game, double tolerance_m = 1e-6) {
  ASSERT_EQ(game.tracks.size(), 1U);
  EXPECT_EQ(to_string(game.tracks[0].robot), "yellow 3");
  ASSERT_EQ(game.tracks[0].segments.size(), 1U);
  for (const TrackPoint& point : game.tracks[0].segments[0]) {
    ASSERT_NEAR(point.x_m, 0.5 * point.time_s - 1.0, tolerance_m);
    ASSERT_NEAR(point.y_m, 0.25, tolerance_m);
    ASSERT_NEAR(point.yaw_rad, 0.1, 1e-6);
  }
}

TEST(ImportSslLog, ReadsVisionOfBothGenerationsInMetresFromTheStartOfTheRecording) {
  for (const int type : {2, 4}) {
    const RecordedGame game = import_bytes(line(3.0, type).bytes());
    expect_line(game);
    EXPECT_EQ(game.tracks[0].segments[0].size(), 225U);
    EXPECT_DOUBLE_EQ(game.tracks[0].segments[0].front().time_s, 0.0);
    EXPECT_NEAR(game.report.start_unix_s.value(), kEpoch_s, 1e-3);
    EXPECT_NEAR(game.report.span_s, 3.0 - kFrame_s, 1e-6);
    EXPECT_EQ(game.report.frames, 225U);
    EXPECT_EQ(game.report.format, "ssl_log");
    EXPECT_TRUE(game.report.problems.empty());
    EXPECT_FALSE(game.report.truncated_at);
  }
}

TEST(ImportSslLog, UnpacksGzipOfOneOrSeveralMembersWhateverTheNameSays) {
  const std::string bytes = line(3.0).bytes();
  expect_line(import_bytes(gzip(bytes), {}, "game.log.gz"));
  expect_line(import_bytes(gzip(bytes), {}, "game.log"));
  expect_line(import_bytes(bytes, {}, "game.log.gz"));
  const RecordedGame game = import_bytes(gzip(bytes.substr(0, 1000)) + gzip(bytes.substr(1000)), {}, "game.log.gz");
  expect_line(game);
  EXPECT_EQ(game.report.bytes, bytes.size());
}

TEST(ImportSslLog, ReadsATrackerWhereThereIsNoVision) {
  LogWriter log;
  for (int i = 0; i < 200; ++i) {
    log.add(i * kFrame_s, 5, tracked(i * kFrame_s, "uuid-a", "TIGERs", {on_a_line(i * kFrame_s)}));
    if (i % 2 == 0) {
      log.add(i * kFrame_s, 5, tracked(i * kFrame_s, "uuid-b", "other", {{true, 3, 5.0, 5.0, 0.0}}));
    }
  }
  const RecordedGame game = import_bytes(log.bytes());
  expect_line(game);
  EXPECT_EQ(game.report.source.kind, PositionSource::Kind::tracker);
  EXPECT_EQ(game.report.source.tracker, "TIGERs");
  EXPECT_EQ(game.report.frames_of_other_sources, 100U);
}

TEST(ImportSslLog, PrefersVisionButTakesTheTrackerOnDemand) {
  LogWriter log;
  for (int i = 0; i < 200; ++i) {
    log.add(i * kFrame_s, 4, vision(i * kFrame_s, 0, {on_a_line(i * kFrame_s)}));
    log.add(i * kFrame_s, 5, tracked(i * kFrame_s, "uuid", "t", {{false, 9, 2.0, 1.0, 0.0}}));
  }
  expect_line(import_bytes(log.bytes()));
  const RecordedGame game = import_bytes(log.bytes(), {.source = MotionSource::tracked});
  ASSERT_EQ(game.tracks.size(), 1U);
  EXPECT_EQ(to_string(game.tracks[0].robot), "blue 9");
}

TEST(ImportSslLog, LeavesOutWhatATrackerOnlyGuesses) {
  LogWriter log;
  for (int i = 0; i < 400; ++i) {
    const bool is_hidden = i >= 150 && i < 250;
    log.add(i * kFrame_s, 5, tracked(i * kFrame_s, "u", "t", {{true, 3, 0.0, 0.0, 0.0, is_hidden ? 0.0 : 1.0}}));
  }
  const RecordedGame game = import_bytes(log.bytes());
  EXPECT_EQ(game.report.implausible, 100U);
  EXPECT_EQ(game.report.cuts, 1U);
  ASSERT_EQ(game.tracks.size(), 1U);
  EXPECT_EQ(game.tracks[0].segments.size(), 2U);
}

TEST(ImportSslLog, KeepsOneRobotOrASpanOfTimeOnDemandButSummarisesAll) {
  LogWriter log;
  for (int i = 0; i < 300; ++i) {
    const double time_s = i * kFrame_s;
    log.add(time_s, 4, vision(time_s, 0, {on_a_line(time_s), {false, 5, std::sin(5.0 * time_s), 1.0, 0.0}}));
  }
  const TemporaryFile file("game.log", log.bytes());
  const RecordedGame one = import_game(file.path(), {.robot = RobotName{Team::blue, 5}});
  ASSERT_EQ(one.tracks.size(), 1U);
  EXPECT_EQ(to_string(one.tracks[0].robot), "blue 5");
  ASSERT_EQ(one.report.robots.size(), 2U);
  EXPECT_NEAR(one.report.robots[0].path_m, 2.0, 0.1);
  // a = 25 sin(5t), so ∫a² over 4 s is about 25²·2
  EXPECT_NEAR(one.report.robots[1].effort_m2_per_s3, 1250.0, 150.0);
  EXPECT_LT(one.report.robots[0].effort_m2_per_s3, 1.0);
  const RecordedGame part = import_game(file.path(), {.from_s = 1.0, .until_s = 3.0});
  EXPECT_NEAR(part.tracks[0].segments[0].front().time_s, 1.0, kFrame_s);
  EXPECT_NEAR(part.tracks[0].segments[0].back().time_s, 3.0, kFrame_s);
  const RecordedGame none = import_game(file.path(), {.most_points = 0});
  EXPECT_TRUE(none.tracks.empty());
  EXPECT_EQ(none.report.robots.size(), 2U);
  const RecordedGame full = import_game(file.path(), {.most_points = 400});
  ASSERT_TRUE(full.report.full_at_s);
  EXPECT_NEAR(*full.report.full_at_s, 200 * kFrame_s, 0.1);
}

TEST(ImportSslLog, FollowsThePhasesOfTheReferee) {
  LogWriter log;
  // Published numbers of stages and commands: stage 0 is before the first half, 1 the first half, 2 half time.
  const std::vector<std::array<int, 3>> calls{{0, 0, 0},  {1, 0, 1}, {2, 0, 4},  {3, 1, 2}, {4, 1, 1},
                                              {5, 1, 17}, {6, 1, 9}, {7, 1, 12}, {8, 2, 0}, {9, 1, 99}};
  for (int i = 0; i < 750; ++i) {
    const double time_s = i * kFrame_s;
    log.add(time_s, 4, vision(time_s, 0, {on_a_line(time_s)}));
    if (i % 5 == 0) {
      const auto& call = calls[std::min<std::size_t>(static_cast<std::size_t>(time_s), calls.size() - 1)];
      log.add(time_s, 3, referee(time_s, call[1], call[2]));
    }
  }
  const RecordedGame game = import_bytes(log.bytes());
  std::vector<GamePhase> phases;
  for (std::size_t i = 0; i < game.phases.size(); ++i) {
    phases.push_back(game.phases[i].phase);
    EXPECT_NEAR(game.phases[i].begin_s, static_cast<double>(i), 0.1);
  }
  EXPECT_THAT(phases, testing::ElementsAre(GamePhase::halt, GamePhase::stop, GamePhase::preparation, GamePhase::running, GamePhase::stop,
                                           GamePhase::ball_placement, GamePhase::running, GamePhase::timeout, GamePhase::off_play));
  EXPECT_EQ(game.report.problems_in_all, 15U);  // command 99 does not exist
  const std::array wanted{GamePhase::running};
  const RobotTrack playing = only_in(game.tracks[0], game.phases, wanted);
  ASSERT_EQ(playing.segments.size(), 2U);
  EXPECT_NEAR(playing.segments[0].front().time_s, 3.0, 0.1);
  EXPECT_NEAR(playing.segments[0].back().time_s, 4.0, 0.1);
  const std::array two{GamePhase::stop, GamePhase::ball_placement};
  EXPECT_EQ(only_in(game.tracks[0], game.phases, two).segments.size(), 2U) << "stop and the placement after it are one piece";
}

TEST(ImportSslLog, PassesOverIndexBlankAndFutureMessages) {
  LogWriter log = line(2.0);
  log.add(2.0, 0, std::string()).add(2.0, 9, std::string(300, 'x')).add(2.0, 1, std::string(20, 'y'));
  log.add(2.0, 6, std::string(6'000'000, 'i'));
  const RecordedGame game = import_bytes(log.bytes());
  expect_line(game);
  EXPECT_EQ(game.report.messages, 150U + 4U);
  EXPECT_EQ(game.report.problems_in_all, 0U);
  EXPECT_FALSE(game.report.truncated_at);
}

TEST(ImportSslLog, UnwrapsTheTurn) {
  LogWriter log;
  for (int i = 0; i < 300; ++i) {
    const double time_s = i * kFrame_s;
    log.add(time_s, 4, vision(time_s, 0, {{true, 3, 0.0, 0.0, std::remainder(9.0 * time_s, 2.0 * std::numbers::pi)}}));
  }
  const RecordedGame game = import_bytes(log.bytes());
  ASSERT_EQ(game.tracks.size(), 1U);
  EXPECT_NEAR(game.tracks[0].segments[0].back().yaw_rad, 9.0 * 299 * kFrame_s, 1e-4);
}

}  // namespace
}  // namespace heatsoak::duty
