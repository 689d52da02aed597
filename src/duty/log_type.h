// What an importer of recorded games is: one file in src/duty/logs each.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "duty/recorded_game.h"

namespace heatsoak::duty {

/// One robot in one frame of one camera.
struct Detection {
  RobotName robot;
  double time_s = 0.0;  ///< any origin; the first one becomes 0
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_rad = 0.0;
  int camera = 0;
  double confidence = 1.0;         ///< 0 … 1
  double camera_distance_m = 0.0;  ///< along the floor; 0 where unknown
};

/// Where an importer puts what it finds, in the order of the file.
class LogEvents {
 public:
  LogEvents() = default;
  LogEvents(const LogEvents&) = delete;
  LogEvents& operator=(const LogEvents&) = delete;
  virtual ~LogEvents() = default;

  virtual void see(const Detection& detection) = 0;
  /// From the latest detection on.
  virtual void phase(GamePhase phase) = 0;
  /// Nothing before connects to what follows.
  virtual void cut() = 0;
  virtual void problem(std::uint64_t at, std::string what) = 0;
  /// Whether anything after this moment is still of use.
  [[nodiscard]] virtual bool done() const = 0;
  virtual ImportReport& report() = 0;
};

struct LogType {
  std::string_view name;  ///< the file's name; set by all_logs()
  std::string_view summary;
  /// Whether a file that begins with these bytes (unpacked where it was packed) is of this type.
  bool (*recognises)(std::string_view head) = nullptr;
  void (*read)(const std::filesystem::path& file, const ImportOptions& options, LogEvents& events) = nullptr;
};
const std::vector<LogType>& all_logs();

}  // namespace heatsoak::duty
