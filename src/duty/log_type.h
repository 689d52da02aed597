// Interface of importers of recorded games. Each file in src/duty/logs defines one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "duty/recorded_game.h"

namespace heatsoak::duty {

/// Detection of one robot in one frame of one camera.
struct Detection {
  RobotName robot;
  double time_s = 0.0;  ///< time with any origin; the first detection becomes 0
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_rad = 0.0;
  int camera = 0;
  double confidence = 1.0;                       ///< confidence of the detection, 0 to 1
  std::optional<double> camera_distance_m = {};  ///< horizontal distance to the camera
};

/// Receiver of an importer's results, in the order of the file.
class LogEvents {
 public:
  LogEvents() = default;
  LogEvents(const LogEvents&) = delete;
  LogEvents& operator=(const LogEvents&) = delete;
  virtual ~LogEvents() = default;

  virtual void see(const Detection& detection) = 0;
  /// Sets the phase from the latest detection on.
  virtual void phase(GamePhase phase) = 0;
  /// Cuts all tracks: later detections are not continuous with earlier ones.
  virtual void cut() = 0;
  /// Reports a part of the file that could not be used, see LogProblem.
  virtual void problem(std::uint64_t at, const LogFault& fault) = 0;
  /// Returns true if later events are not needed.
  [[nodiscard]] virtual bool done() const = 0;
  virtual ImportReport& report() = 0;
};

struct LogType {
  std::string_view name;  ///< name of the source file; set by all_logs()
  std::string_view summary;
  /// Returns whether a file with these first (uncompressed) bytes is of this type.
  bool (*recognises)(std::string_view head) = nullptr;
  void (*read)(const std::filesystem::path& file, const ImportOptions& options, LogEvents& events) = nullptr;
};
const std::vector<LogType>& all_logs();

}  // namespace heatsoak::duty
