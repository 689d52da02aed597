// Recorded games: tracks of robots from log files of several formats.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
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

/// Measured pose of a robot. `time_s` counts from the start of the recording. Yaw is unwrapped.
struct TrackPoint {
  double time_s = 0.0;
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_rad = 0.0;
};

/// Points in increasing time without gaps longer than `kLongestBridge_s`.
using TrackSegment = std::vector<TrackPoint>;

struct RobotTrack {
  RobotName robot;
  std::vector<TrackSegment> segments;
};

/// Longest gap within a track. Longer gaps cut it, because the motion during them is unknown.
inline constexpr double kLongestBridge_s = 0.5;

/// Phase of a game, from the referee. The clock of the game runs only in `running`.
enum class GamePhase { unknown, off_play, halt, stop, preparation, ball_placement, timeout, running };
std::string_view to_string(GamePhase phase);

struct PhaseSpan {
  double begin_s = 0.0;
  double end_s = 0.0;
  GamePhase phase = GamePhase::unknown;
};

/// Approximate activity of a robot, computed while reading, for choosing robots.
struct RobotSummary {
  RobotName robot;
  std::uint64_t points = 0;
  double seen_s = 0.0;  ///< duration of the tracks
  double path_m = 0.0;  ///< length of the path
  /// ∫a²dt from positions averaged over 0.1 s. Only for comparing robots of one recording, not for heat.
  double effort_m2_per_s3 = 0.0;
};

/// A part of the file that could not be used.
struct LogProblem {
  std::uint64_t at = 0;  ///< byte of the uncompressed log, or line of a CSV file
  std::string what;
};

/// Quality of a recording. Counts refer to detections unless stated otherwise.
struct ImportReport {
  std::string format;         ///< name of the log type
  std::string source;         ///< "vision, 4 cameras", "tracker 'TIGERs'"
  double start_unix_s = 0.0;  ///< Unix time of the first frame; 0 if unknown
  double span_s = 0.0;
  std::uint64_t bytes = 0;     ///< size of the uncompressed log
  std::uint64_t messages = 0;  ///< messages, or rows of a CSV file
  std::uint64_t frames = 0;    ///< frames of the source that is used
  std::uint64_t frames_of_other_sources = 0;
  std::uint64_t detections = 0;
  std::uint64_t merged = 0;              ///< merged with a detection of another camera
  std::uint64_t doubled = 0;             ///< same robot twice in a frame of a camera: the better one is used
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
  std::vector<std::string> notes;
  std::vector<RobotSummary> robots;
};

/// Returns the report as text, one finding per line. The last lines are the problems with their positions.
std::vector<std::string> sentences(const ImportReport& report);

struct RecordedGame {
  std::vector<RobotTrack> tracks;  ///< sorted by team and id
  std::vector<PhaseSpan> phases;   ///< empty if the recording has no referee
  ImportReport report;
};

enum class MotionSource { automatic, vision, tracked };

struct ImportOptions {
  std::string format{};              ///< name of a log type; empty: determined from the content
  std::optional<RobotName> robot{};  ///< keep this track only
  double from_s = -std::numeric_limits<double>::infinity();
  double until_s = std::numeric_limits<double>::infinity();
  MotionSource source = MotionSource::automatic;  ///< vision if the log has it
  /// Largest number of stored points (32 bytes each), enough for one robot for three hours. With 0 only the report is filled.
  std::size_t most_points = 1'000'000;
  std::function<void(double)> progress{};  ///< called repeatedly with the share of the file that has been read
};

/// Imports a recorded game. Memory is bounded by `most_points`, not by the file. Damaged parts are skipped and reported. Throws Failure
/// (bad_input) if the file is unreadable or not a recorded game, or if a CSV file is invalid.
RecordedGame import_game(const std::filesystem::path& file, const ImportOptions& options = {});

/// Returns the parts of a track in the wanted phases.
RobotTrack only_in(const RobotTrack& track, std::span<const PhaseSpan> phases, std::span<const GamePhase> wanted);

}  // namespace heatsoak::duty
