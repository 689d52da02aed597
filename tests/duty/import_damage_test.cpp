// Logs that are truncated, damaged, foreign or far too large.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>

#include "base/diagnostic.h"
#include "base/random.h"
#include "duty/recorded_game.h"
#include "import_failure.h"
#include "ssl_log_writer.h"

namespace heatsoak::duty {
namespace {

using namespace testing_logs;
using namespace std::string_literals;
using testing::AllOf;
using testing::Contains;
using testing::Field;
using testing::HasSubstr;
using testing::VariantWith;

SeenRobot robot_at(double time_s) { return {true, 3, std::sin(time_s), 0.5, 0.1}; }

/// Returns a log with all kinds of contents in a few kilobytes.
LogWriter small_log(int frames = 100) {
  LogWriter log;
  const Message geometry = Message().message(2, camera_at(0, 1.0, 2.0));
  for (int i = 0; i < frames; ++i) {
    const double time_s = i * kFrame_s;
    log.add(time_s, 4, vision(time_s, i % 2, {robot_at(time_s), {false, 4, 1.0, 1.0, 2.0}}, i == 0 ? &geometry : nullptr));
    if (i % 20 == 0) {
      log.add(time_s, 3, referee(time_s, 1, i % 40 == 0 ? 1 : 2));
      log.add(time_s, 5, tracked(time_s, "u", "t", {robot_at(time_s)}));
    }
  }
  return log;
}

void expect_sane(const RecordedGame& game) {
  for (const RobotTrack& track : game.tracks) {
    for (const TrackSegment& segment : track.segments) {
      ASSERT_FALSE(segment.empty());
      for (std::size_t i = 0; i < segment.size(); ++i) {
        ASSERT_TRUE(std::isfinite(segment[i].x_m) && std::isfinite(segment[i].y_m) && std::isfinite(segment[i].yaw_rad));
        if (i > 0) {
          ASSERT_GT(segment[i].time_s, segment[i - 1].time_s);
          ASSERT_LE(segment[i].time_s - segment[i - 1].time_s, kLongestBridge_s);
        }
      }
    }
  }
}

TEST(ImportDamage, KeepsWhatCameBeforeTheEndOfATruncatedLog) {
  const LogWriter log = small_log();
  const TemporaryFile file("cut.log", log.bytes());
  for (std::size_t size = log.bytes().size(); size-- > 0;) {
    std::filesystem::resize_file(file.path(), size);
    if (size < 16) {
      EXPECT_THROW((void)import_game(file.path()), base::Failure) << size;
      continue;
    }
    const RecordedGame game = import_game(file.path());
    expect_sane(game);
    const auto after = std::ranges::upper_bound(log.starts(), size);
    const auto record = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, after - log.starts().begin() - 1));
    const bool is_whole = size == 16 || size == log.starts()[record];
    ASSERT_EQ(game.report.truncated_at.has_value(), !is_whole) << size;
    if (!is_whole) {
      ASSERT_EQ(*game.report.truncated_at, log.starts()[record]) << size;
      ASSERT_EQ(game.report.messages, record);
    }
  }
}

TEST(ImportDamage, KeepsWhatCameBeforeTheEndOfATruncatedPackedLog) {
  const std::string packed = gzip(small_log().bytes());
  const TemporaryFile file("cut.log.gz");
  std::uint64_t most_messages = 0;
  for (std::size_t size = 2; size < packed.size(); size += 7) {
    file.write(packed.substr(0, size));
    try {
      const RecordedGame game = import_game(file.path());
      expect_sane(game);
      EXPECT_THAT(game.report.notes, Contains(VariantWith<BytesEndEarly>(AllOf(Field(&BytesEndEarly::cause, BytesEndEarly::Cause::cut),
                                                                               Field(&BytesEndEarly::byte, size)))))
          << size;
      EXPECT_GE(game.report.messages, most_messages);
      most_messages = game.report.messages;
    } catch (const base::Failure& failure) {
      ASSERT_EQ(failure.code(), base::ExitCode::bad_input);
    }
  }
  EXPECT_GT(most_messages, 100U);
}

TEST(ImportDamage, SurvivesFlippedBitsAnywhere) {
  const std::string plain = small_log().bytes();
  const std::string packed = gzip(plain);
  const TemporaryFile file("flipped.log");
  base::Random random(2024, 1);
  std::uint64_t kept = 0;
  for (int i = 0; i < 2000; ++i) {
    std::string bytes = i % 4 == 3 ? packed : plain;
    const int flips = 1 + static_cast<int>(random.uniform() * 8.0);
    for (int k = 0; k < flips; ++k) {
      char& hit = bytes[static_cast<std::size_t>(random.uniform() * static_cast<double>(bytes.size()))];
      const auto bit = static_cast<unsigned>(random.uniform() * 8.0);
      hit = static_cast<char>(static_cast<unsigned char>(hit) ^ (1U << bit));
    }
    file.write(bytes);
    try {
      const RecordedGame game = import_game(file.path());
      expect_sane(game);
      kept += i % 4 == 3 ? 0 : game.report.messages;
    } catch (const base::Failure& failure) {
      ASSERT_EQ(failure.code(), base::ExitCode::bad_input);
    }
  }
  EXPECT_GT(static_cast<double>(kept), 0.95 * 1500.0 * 110.0) << "a flipped bit must not cost more than its message";
}

TEST(ImportDamage, PassesOverDamageAndSaysWhere) {
  const LogWriter log = small_log(300);
  std::string bytes = log.bytes();
  const std::size_t wrong_size = log.starts()[50] + 13;  // this message now claims an additional 20 to 30 kB
  bytes[wrong_size] = static_cast<char>(0x00);
  bytes[wrong_size + 1] = static_cast<char>(0x60);
  const std::size_t no_protobuf = log.starts()[100];
  bytes[no_protobuf + 16] = '\x07';  // a field of an undefined type
  const std::string rubbish(5000, '\xa5');
  bytes.insert(log.starts()[200], rubbish);
  const TemporaryFile file("damaged.log", bytes);
  const RecordedGame game = import_game(file.path());
  EXPECT_EQ(game.report.messages, log.starts().size()) << "all are found again, though two cannot be decoded";
  ASSERT_GE(game.report.problems.size(), 3U);
  EXPECT_EQ(game.report.problems[0].at, log.starts()[50]);
  const auto problem = [](std::size_t at, const auto& fault) {
    return AllOf(Field(&LogProblem::at, at), Field(&LogProblem::fault, fault));
  };
  EXPECT_THAT(game.report.problems,
              Contains(problem(no_protobuf, VariantWith<MessageUndecodable>(Field(&MessageUndecodable::kind, MessageKind::vision)))));
  EXPECT_THAT(game.report.problems, Contains(problem(log.starts()[200], VariantWith<BytesSkipped>(Field(&BytesSkipped::bytes, 5000U)))));
  ASSERT_EQ(game.tracks.size(), 2U);
  EXPECT_EQ(game.tracks[0].segments.size(), 1U);
}

TEST(ImportDamage, FindsNoMoreMessagesInRubbish) {
  std::string bytes = small_log().bytes();
  const std::size_t end = bytes.size();
  base::Random random(5, 5);
  for (int i = 0; i < 100'000; ++i) {
    bytes += static_cast<char>(random.uniform() * 256.0);
  }
  const TemporaryFile file("rubbish.log", bytes);
  const RecordedGame game = import_game(file.path());
  EXPECT_EQ(game.tracks.size(), 2U);
  ASSERT_FALSE(game.report.problems.empty());
  EXPECT_EQ(game.report.problems[0].at, end);
}

TEST(ImportDamage, SaysWhatAForeignFileIs) {
  EXPECT_THAT(failure_of("SSL_LOG_FILR\0\0\0\1 and so on"s), HasSubstr("begins with \"SSL_LOG_FILR\"; did you mean 'SSL_LOG_FILE'?"));
  EXPECT_THAT(failure_of(LogWriter(2).bytes()), HasSubstr("byte 12: SSL log of version 2; expected version 1"));
  EXPECT_THAT(failure_of("PK\x03\x04 something", "game.log.gz"), HasSubstr("is a zip archive; unpack it first"));
  EXPECT_THAT(failure_of("\xfd"
                         "7zXZ and more"),
              HasSubstr("is packed by xz"));
  EXPECT_THAT(failure_of(std::string("\0\0\0\x18\0S\0S\0L\0_", 12)), HasSubstr("version 0"));
  EXPECT_THAT(failure_of(""), HasSubstr("is empty"));
  EXPECT_THAT(failure_of("hello, world", "game.log.gz"), HasSubstr("is not a recorded game"));
  EXPECT_THAT(failure_of(gzip("hello, world"), "game.log.gz"), HasSubstr("begins with \"hello, world\""));
  EXPECT_THAT(failure_of("\x1f\x8b not gzip at all"), HasSubstr("damaged"));
}

TEST(ImportDamage, SaysWhichFilesAndFormatsThereAre) {
  EXPECT_THROW((void)import_game("/nowhere/game.log"), base::Failure);
  EXPECT_THROW((void)import_game("/tmp"), base::Failure);
  const TemporaryFile file("game.log", small_log().bytes());
  try {
    (void)import_game(file.path(), {.format = "ssl_lag"});
    FAIL();
  } catch (const base::Failure& failure) {
    EXPECT_THAT(failure.what(), HasSubstr("there is no log format 'ssl_lag'; did you mean 'ssl_log'?"));
  }
  EXPECT_THROW((void)import_game(file.path(), {.format = "csv"}), base::Failure);
}

long peak_memory_kB() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

#ifdef __SANITIZE_ADDRESS__
constexpr long kMostMemory_kB = 1'000'000;  // sanitizers keep freed memory
#else
constexpr long kMostMemory_kB = 100'000;
#endif

TEST(ImportHuge, StreamsALogOfAQuarterOfAGigabyte) {
  // 16 robots at 75 Hz on 4 cameras: the memory limit is too small for all their points.
  const TemporaryFile file("huge.log", LogWriter().bytes());
  std::uint64_t messages = 0;
  for (int block = 0; block < 50; ++block) {
    LogWriter log;
    for (; log.bytes().size() < 5'000'000; ++messages) {
      const std::uint64_t frame = messages / 4;
      const double time_s = static_cast<double>(frame) * kFrame_s;
      std::vector<SeenRobot> robots;
      for (int id = 0; id < 16; ++id) {
        robots.push_back({true, id, 0.5 * std::sin(0.3 * time_s + id), 0.2 * id, 0.1});
      }
      log.add(time_s, 4, vision(time_s, static_cast<int>(messages % 4), robots));
    }
    file.append(log.bytes().substr(16));
  }
  const long before_kB = peak_memory_kB();
  double last_share = 0.0;
  const RecordedGame game = import_game(file.path(), {.progress = [&last_share](double share) {
                                          EXPECT_GE(share, last_share);
                                          last_share = share;
                                        }});
  EXPECT_LT(peak_memory_kB() - before_kB, kMostMemory_kB);
  EXPECT_GT(last_share, 0.9);
  EXPECT_LE(last_share, 1.0);
  EXPECT_EQ(game.report.messages, messages);
  EXPECT_GT(game.report.bytes, 250'000'000U);
  EXPECT_TRUE(game.report.full_at_s);
  EXPECT_EQ(game.tracks.size(), 16U);
}

TEST(ImportHuge, EndsOnAPackedNothingOfManyGigabytes) {
  // Concatenated gzip members: 20 MB on disk, 20 GB of zeros.
  const std::string zeros = gzip(std::string(16 << 20, '\0'));
  for (const std::string& begin : {small_log().bytes(), LogWriter().bytes(), std::string()}) {
    std::string bytes = begin.empty() ? std::string() : gzip(begin);
    for (int i = 0; i < 1250; ++i) {
      bytes += zeros;
    }
    const TemporaryFile file("bomb.log.gz", bytes);
    bytes = {};
    const long before_kB = peak_memory_kB();
    try {
      const RecordedGame game = import_game(file.path());
      EXPECT_THAT(game.report.problems,
                  Contains(Field(&LogProblem::fault, VariantWith<RestNotRead>(Field(&RestNotRead::has_empty_messages, true)))));
      EXPECT_EQ(game.tracks.empty(), begin.size() == 16);
    } catch (const base::Failure& failure) {
      EXPECT_TRUE(begin.empty()) << failure.what();
    }
    EXPECT_LT(peak_memory_kB() - before_kB, kMostMemory_kB);
  }
}

}  // namespace
}  // namespace heatsoak::duty
