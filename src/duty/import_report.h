// Findings about the log of a recorded game as data. src/present puts them into words.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace heatsoak::duty {

enum class Team { yellow, blue };
std::string_view to_string(Team team);

struct RobotName {
  Team team = Team::yellow;
  int id = 0;
  // NOLINTNEXTLINE(modernize-use-nullptr): clang-tidy 14 takes its zero for a pointer
  friend auto operator<=>(const RobotName&, const RobotName&) = default;
};
/// Returns the name as text, for example "yellow 3".
std::string to_string(const RobotName& name);

/// Longest gap within a track. Longer gaps cut it, because the motion during them is unknown.
inline constexpr double kLongestBridge_s = 0.5;

/// No valid message begins here; the importer continues after `bytes`.
struct BytesSkipped {
  std::uint64_t bytes = 0;
};
/// The rest of the log is not read, because `bytes` hold no message with content.
struct RestNotRead {
  std::uint64_t bytes = 0;
  bool has_empty_messages = false;
};
/// The log ends after `bytes` without a valid message.
struct EndsWithoutMessage {
  std::uint64_t bytes = 0;
};
enum class MessageKind { vision, tracker, referee };
struct MessageUndecodable {
  MessageKind kind = MessageKind::vision;
};
/// A referee message with an undefined stage or command.
struct RefereeUndefined {
  std::uint32_t stage = 0;
  std::uint32_t command = 0;
};
/// A row whose time is not after that of the previous row of its robot.
struct TimeNotIncreasing {
  RobotName robot;
  double time_s = 0.0;
  double after_s = 0.0;
};
/// The clock of a robot restarts; the following rows are shifted to `pause_s` after the previous ones.
struct ClockRestarts {
  RobotName robot;
  double time_s = 0.0;
  double after_s = 0.0;
  double pause_s = 0.0;
};
using LogFault =
    std::variant<BytesSkipped, RestNotRead, EndsWithoutMessage, MessageUndecodable, RefereeUndefined, TimeNotIncreasing, ClockRestarts>;

/// A part of the file that could not be used.
struct LogProblem {
  std::uint64_t at = 0;  ///< byte of the uncompressed log, or line of a CSV file
  LogFault fault;
};

/// Origin of the positions.
struct PositionSource {
  enum class Kind { unknown, vision, tracker, table };
  Kind kind = Kind::unknown;
  std::size_t cameras = 0;   ///< cameras of vision
  std::string tracker = {};  ///< name of a tracker
};

/// The bytes of the file end early.
struct BytesEndEarly {
  enum class Cause { unreadable, cut, damaged };
  Cause cause = Cause::cut;
  std::uint64_t byte = 0;   ///< position in the file, compressed if the file is
  std::string reason = {};  ///< words of the operating system or of zlib; empty for Cause::cut
};
/// Returns the cause and its place, also for the error of a file without any usable byte.
std::string to_string(const BytesEndEarly& end);
/// No frame of the source has robots.
struct NoFrameWithRobots {
  PositionSource::Kind source = PositionSource::Kind::vision;
};
enum class RowTimeUnit { milliseconds, microseconds, nanoseconds };
/// The rows of a robot are so far apart that no track results.
struct RowsFarApart {
  double step_s = 0.0;
  RowTimeUnit suspected = RowTimeUnit::milliseconds;
};
struct RowsWithoutPosition {
  std::uint64_t rows = 0;
};
/// Most times repeat, as if they were rounded.
struct TimesRepeat {};
struct RowsNotSorted {};
/// The last row has no line break and may be truncated; it is omitted.
struct LastRowOmitted {
  int line = 0;
};
using ImportNote =
    std::variant<BytesEndEarly, NoFrameWithRobots, RowsFarApart, RowsWithoutPosition, TimesRepeat, RowsNotSorted, LastRowOmitted>;

/// Approximate activity of a robot, computed while reading, for choosing robots.
struct RobotSummary {
  RobotName robot;
  std::uint64_t points = 0;
  double seen_s = 0.0;  ///< duration of the tracks
  double path_m = 0.0;  ///< length of the path
  /// ∫a²dt from positions averaged over 0.1 s. Only for comparing robots of one recording, not for heat.
  double effort_m2_per_s3 = 0.0;
};

/// Quality of a recording. Counts refer to detections unless stated otherwise.
struct ImportReport {
  std::string format;  ///< name of the log type
  PositionSource source;
  std::optional<double> start_unix_s = {};  ///< Unix time of the first frame
  double span_s = 0.0;
  std::uint64_t bytes = 0;     ///< size of the uncompressed log
  std::uint64_t messages = 0;  ///< messages, or rows of a CSV file
  std::uint64_t frames = 0;    ///< frames of the source that is used
  std::uint64_t frames_of_other_sources = 0;
  std::uint64_t detections = 0;
  std::uint64_t merged = 0;              ///< merged with a detection of another camera
  std::uint64_t doubled = 0;             ///< second detections of a robot in one frame of a camera; the better one is used
  std::uint64_t implausible = 0;         ///< invalid number or id, outside any field, or reported as not visible
  std::uint64_t outliers = 0;            ///< too far from the expected position
  std::uint64_t out_of_order = 0;        ///< time not after the previous detection
  std::uint64_t teleports = 0;           ///< the robot continues elsewhere, so its track is cut
  std::uint64_t bridged_gaps = 0;        ///< gaps of at least three frames, up to kLongestBridge_s
  std::uint64_t cuts = 0;                ///< gaps longer than kLongestBridge_s
  std::uint64_t short_segments = 0;      ///< segments omitted because they are too short
  std::uint64_t clock_jumps = 0;         ///< jumps of a capture clock, which cut every track
  std::uint64_t frames_out_of_time = 0;  ///< frames with an unconfirmed time of capture
  std::uint64_t problems_in_all = 0;
  std::vector<LogProblem> problems;           ///< the first of the problems
  std::optional<std::uint64_t> truncated_at;  ///< byte at which the last, incomplete message begins
  std::optional<double> full_at_s;            ///< time from which points are not kept, see ImportOptions::most_points
  std::vector<ImportNote> notes;
  std::vector<RobotSummary> robots;
};

}  // namespace heatsoak::duty
