// Wording of the findings about recorded games: one sentence for every kind of finding.
#include "present/game_words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <utility>
#include <variant>
#include <vector>

namespace heatsoak::present {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

/// Expects the sentence of each finding, and that the list has every kind of finding.
template <class Finding>
void expect_sentences(const std::vector<std::pair<Finding, const char*>>& sentences) {
  std::set<std::size_t> kinds;
  for (const auto& [finding, words] : sentences) {
    EXPECT_EQ(words_of(finding), words);
    kinds.insert(finding.index());
  }
  EXPECT_EQ(kinds.size(), std::variant_size_v<Finding>);
}

TEST(WordsOfGames, Faults) {
  using namespace duty;
  const RobotName blue{Team::blue, 7};
  expect_sentences<LogFault>({
      {BytesSkipped{5000}, "no valid message here; 5000 bytes skipped"},
      {RestNotRead{.bytes = 7}, "no message in the 7 bytes from here on; the rest of the log is not read"},
      {RestNotRead{.bytes = 7, .has_empty_messages = true},
       "no usable message in the 7 bytes from here on; the rest of the log is not read"},
      {EndsWithoutMessage{9}, "no message begins here, nor in the 9 bytes that follow"},
      {MessageUndecodable{MessageKind::vision}, "vision message that cannot be decoded; left out"},
      {MessageUndecodable{MessageKind::tracker}, "tracker message that cannot be decoded; left out"},
      {MessageUndecodable{MessageKind::referee}, "referee message that cannot be decoded; left out"},
      {RefereeUndefined{1, 99}, "referee message with stage 1 and command 99; left out"},
      {TimeNotIncreasing{blue, 101.0, 102.99}, "blue 7 at 101 s, after 102.99 s; time must increase for each robot; left out"},
      {ClockRestarts{blue, 50.0, 59.99, 1.0},
       "blue 7 at 50 s, after 59.99 s: its clock restarts; the following rows are taken as 1 s later"},
  });
}

TEST(WordsOfGames, Notes) {
  using namespace duty;
  expect_sentences<ImportNote>({
      {BytesEndEarly{BytesEndEarly::Cause::cut, 3},
       "the compressed file ends at byte 3, before the end of its data; what came before is used"},
      {BytesEndEarly{BytesEndEarly::Cause::damaged, 3, "wrong data"},
       "the compressed file is damaged near byte 3 (wrong data); the rest cannot be decompressed; what came before is used"},
      {BytesEndEarly{BytesEndEarly::Cause::unreadable, 3, "Input/output error"},
       "byte 3 of the file cannot be read: Input/output error; what came before is used"},
      {NoFrameWithRobots{PositionSource::Kind::vision}, "the log holds no frame of vision with robots"},
      {NoFrameWithRobots{PositionSource::Kind::tracker}, "the log holds no frame of a tracker with robots"},
      {RowsFarApart{16.6667, RowTimeUnit::milliseconds},
       "t_s advances by 16.7 s from row to row of a robot, expected at most 0.5 s: is it in milliseconds, or are rows missing?"},
      {RowsWithoutPosition{100}, "100 rows without a position left out: the robot was lost"},
      {TimesRepeat{}, "most times repeat, as if t_s was rounded; expected increasing times for each robot: write t_s to the millisecond"},
      {RowsNotSorted{}, "most rows go back in time: expected the rows of each robot sorted by t_s"},
      {LastRowOmitted{302}, "line 302, the last, has no line break at its end and may be truncated: left out"},
  });
}

duty::ImportReport small_report() {
  duty::ImportReport report;
  report.format = "csv";
  report.source = {.kind = duty::PositionSource::Kind::table};
  report.span_s = 12.34;
  report.bytes = 1000;
  report.messages = 30;
  report.frames = 30;
  report.detections = 29;
  return report;
}

TEST(WordsOfGames, ReportCountsWhatWasLeftOut) {
  using namespace duty;
  ImportReport report = small_report();
  EXPECT_THAT(words_of(report),
              ElementsAre("csv: 30 messages in 1000 bytes, 30 frames of positions in a table over 12.3 s, 29 detections of 0 robots"));
  report.out_of_order = 1;
  report.full_at_s = 20.4;
  report.truncated_at = 999;
  report.notes.emplace_back(RowsNotSorted{});
  report.problems.push_back({.at = 302, .fault = BytesSkipped{1}});
  report.problems_in_all = 5;
  EXPECT_THAT(words_of(report), ElementsAre(testing::_, "1 detections left out: not after the one before",
                                            "points from 20 s on are not used, because they do not fit into memory; split the log",
                                            "the log ends inside a message that begins at byte 999; what came before is used",
                                            "most rows go back in time: expected the rows of each robot sorted by t_s",
                                            "line 302: no valid message here; 1 bytes skipped", "4 more problems of this kind"));
  report.source = {.kind = PositionSource::Kind::vision, .cameras = 4};
  EXPECT_THAT(words_of(report), Contains(HasSubstr("30 frames of vision, 4 cameras over")));
  EXPECT_THAT(words_of(report), Contains(HasSubstr("byte 302:"))) << "a log in bytes, not lines";
  report.source = {.kind = PositionSource::Kind::tracker, .tracker = "TIGERs"};
  EXPECT_THAT(words_of(report), Contains(HasSubstr("30 frames of tracker 'TIGERs' over")));
  report.source = {};
  EXPECT_THAT(words_of(report), Contains(HasSubstr("30 frames of no source over")));
}

duty::GameDemand small_game() {
  duty::GameDemand game{.player = "blue 7", .log = small_report(), .smoothing = duty::SmoothingReport{}};
  game.smoothing->points = 200;
  game.smoothing->frame_rate_Hz = 10.0;
  game.smoothing->place = {.bandwidth_Hz = 10.0 / 6.0, .quiet_bandwidth_Hz = 0.5, .quiet_share = 0.25, .noise_m_or_rad = 0.002};
  game.smoothing->turn = {.acceleration_noise_m_or_rad_per_s2 = 0.031, .noise_share = 0.9};
  game.wheels.resize(1);
  game.wheels[0].bins.push_back({.duration_s = 140.0});
  game.wheels[0].slip_share = 0.012;
  game.unseen_s = 2.0;
  return game;
}

TEST(WordsOfGames, MotionOfThePlayer) {
  using namespace duty;
  GameDemand game = small_game();
  EXPECT_THAT(
      words_of(game),
      ElementsAre(testing::_,
                  "blue 7: 200 points at 10.0 Hz; place: bandwidth 1.7 Hz (-3 dB; 0.5 Hz during the 25 % of the time that shows "
                  "only noise), noise 2.0 mm, about 0.0 % of the squared acceleration is noise, 0 outliers ignored; turn: bandwidth "
                  "0.0 Hz (-3 dB; 0.0 Hz during the 0 % of the time that shows only noise), noise 0.0 mrad, the acceleration is "
                  "below the noise, which is at most 0.031 rad/s² rms, 0 outliers ignored",
                  "blue 7: 140 s, 2 s of them not seen (taken as standstill); the motion needed more grip than available in 1.2 % "
                  "of the time"));
  game.low_sight_rate_Hz = 3.0;
  game.clock_jumps = 1;
  EXPECT_THAT(words_of(game),
              Contains("blue 7: torques are uncertain and accelerations smoothed, because the robot is seen only 3.0 times a second; "
                       "expected 10 or more"));
  EXPECT_THAT(words_of(game), Contains("blue 7: the time jumps ahead by more than 3600 s 1 times; these gaps are left out"));
  game.smoothing.reset();
  EXPECT_EQ(words_of(game), words_of(game.log)) << "without a track, only the log is known";
}

TEST(WordsOfGames, AFailureHasTheReport) {
  using namespace duty;
  const base::Failure failure = in_words(GameNotUsable(base::ExitCode::cannot_answer, "no robot", {.log = small_report()}));
  EXPECT_EQ(failure.code(), base::ExitCode::cannot_answer);
  EXPECT_EQ(failure.message(), "no robot\n" + words_of(small_report()).front());
}

}  // namespace
}  // namespace heatsoak::present
