// Recorded games: where robots were, over time, out of log files of several formats.
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
/// "yellow 3".
std::string to_string(const RobotName& name);

/// One sight of a robot. `time_s` counts from the start of the recording; yaw is unwrapped: it does not jump by 2π.
struct TrackPoint {
  double time_s = 0.0;
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_rad = 0.0;
};

/// Points without a gap longer than `kLongestBridge_s`; time increases.
using TrackSegment = std::vector<TrackPoint>;

struct RobotTrack {
  RobotName robot;
  std::vector<TrackSegment> segments;
};

/// A robot that is not seen for longer than this is lost: its track is cut, because nobody knows what it did.
inline constexpr double kLongestBridge_s = 0.5;

/// What the referee allows. The clock of a game runs only in `running`.
enum class GamePhase { unknown, off_play, halt, stop, preparation, ball_placement, timeout, running };
std::string_view to_string(GamePhase phase);

struct PhaseSpan {
  double begin_s = 0.0;
  double end_s = 0.0;
  GamePhase phase = GamePhase::unknown;
};

/// What a robot did, roughly, computed while reading: to find the robots worth a closer look.
struct RobotSummary {
  RobotName robot;
  std::uint64_t points = 0;
  double seen_s = 0.0;
  double path_m = 0.0;
  /// ∫a² of positions averaged over 0.1 s: for comparing robots of one recording, not for heat.
  double effort_m2_per_s3 = 0.0;
};

/// A part of the file that could not be used.
struct LogProblem {
  std::uint64_t at = 0;  ///< byte (of the unpacked log), or line of a CSV file
  std::string what;
};

/// How good a recording is: what was found, joined, left out. Counts are of detections unless said otherwise.
struct ImportReport {
  std::string format;         ///< name of the log type
  std::string source;         ///< "vision, 4 cameras", "tracker 'TIGERs'"
  double start_unix_s = 0.0;  ///< 0 where the recording does not say
  double span_s = 0.0;
  std::uint64_t bytes = 0;     ///< of the unpacked log
  std::uint64_t messages = 0;  ///< that were found, or rows
  std::uint64_t frames = 0;    ///< of the source that is used
  std::uint64_t frames_of_other_sources = 0;
  std::uint64_t detections = 0;
  std::uint64_t merged = 0;              ///< joined with that of another camera
  std::uint64_t doubled = 0;             ///< the same robot twice in one frame: the surer one is used
  std::uint64_t implausible = 0;         ///< no number, no such robot, outside any field, not in sight
  std::uint64_t outliers = 0;            ///< too far from where the robot can be
  std::uint64_t out_of_order = 0;        ///< not after the one before
  std::uint64_t teleports = 0;           ///< the robot went on elsewhere: its track is cut there
  std::uint64_t bridged_gaps = 0;        ///< three frames missing, or more, up to kLongestBridge_s
  std::uint64_t cuts = 0;                ///< gaps longer than that
  std::uint64_t short_segments = 0;      ///< left out: too short to say anything
  std::uint64_t clock_jumps = 0;         ///< every track is cut there
  std::uint64_t frames_out_of_time = 0;  ///< frames with a time of capture that nothing else confirms
  std::uint64_t problems_in_all = 0;
  std::vector<LogProblem> problems;           ///< the first of them
  std::optional<std::uint64_t> truncated_at;  ///< the file ends inside a message; what came before is used
  std::optional<double> full_at_s;            ///< from here on points were no longer kept: see ImportOptions::most_points
  std::vector<std::string> notes;
  std::vector<RobotSummary> robots;
};

/// One finding a line, for people; the last lines are the problems with their places.
std::vector<std::string> sentences(const ImportReport& report);

struct RecordedGame {
  std::vector<RobotTrack> tracks;  ///< sorted by team and id
  std::vector<PhaseSpan> phases;   ///< empty where the recording has no referee
  ImportReport report;
};

enum class MotionSource { automatic, vision, tracked };

struct ImportOptions {
  std::string format{};              ///< name of a log type; empty: found from the content
  std::optional<RobotName> robot{};  ///< keep this track only
  double from_s = -std::numeric_limits<double>::infinity();
  double until_s = std::numeric_limits<double>::infinity();
  MotionSource source = MotionSource::automatic;  ///< vision where the log has it
  /// Bounds memory (32 bytes each): one robot for more than three hours. 0 keeps none and only fills the report.
  std::size_t most_points = 1'000'000;
  std::function<void(double)> progress{};  ///< called now and then with the share of the file that is read
};

/// Memory is bounded by `most_points`, not by the file. Damage is passed over and reported.
/// Throws Failure (bad_input) where the file cannot be read at all, is no recorded game, or a CSV file is wrong.
RecordedGame import_game(const std::filesystem::path& file, const ImportOptions& options = {});

/// The parts of a track inside the wanted phases.
RobotTrack only_in(const RobotTrack& track, std::span<const PhaseSpan> phases, std::span<const GamePhase> wanted);

}  // namespace heatsoak::duty
