// Recorded games: tracks of robots from log files of several formats.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "duty/import_report.h"

namespace heatsoak::duty {

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

/// Phase of a game, from the referee. The clock of the game runs only in `running`.
enum class GamePhase { unknown, off_play, halt, stop, preparation, ball_placement, timeout, running };
std::string_view to_string(GamePhase phase);

struct PhaseSpan {
  double begin_s = 0.0;
  double end_s = 0.0;
  GamePhase phase = GamePhase::unknown;
};

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
