// Configuration of the drive core for one robot with one motor, with or without the motor's thermal guard.
#pragma once

#include <optional>
#include <string_view>

#include "base/diagnostic.h"
#include "base/job_progress.h"
#include "firmware/core_config.h"
#include "firmware/host_guard.h"

namespace heatsoak::simulate {

enum class GuardUse {
  off,
  shadow,  ///< the guard counts how much it would limit, but does not limit
  on
};
inline constexpr std::string_view kGuardUses[]{"off", "shadow", "on"};

// Expected durations on two cores, for progress.
inline constexpr double kPlayedGame_s = 0.25;  ///< nominal game
inline constexpr double kGuard_s = 0.8;
inline constexpr double kDrive_s = 1.5;  ///< one game on one core

/// Guard of a motor from derate(), or the reason why there is none.
struct MotorGuard {
  std::optional<derate::Derating> derating;
  std::optional<firmware::HostGuard> guard;
  std::optional<base::Failure> why_none;  ///< failure of derate(); empty if there is a guard or none was requested
};

/// Runs derate() with its defaults, for air of up to 40 °C or `ambient_C`, whichever is larger. A motor that exceeds a limit without
/// current, or has more nodes than the guard supports, gets no guard; `why_none` states the reason. Other failures are thrown.
MotorGuard make_guard(const motor::Motor& motor, const robot::Robot& robot, double ambient_C, int threads,
                      const base::Progress& progress = {});

/// Owns the objects that its config() points to, so it can be neither copied nor moved. Cores in several threads need one object each.
class GuardedCore {
 public:
  /// Without a guard in `guard` the use is off. Throws the failures of make_core_config() and, with the guard on, of
  /// require_driving_current().
  GuardedCore(robot::Robot robot, const motor::Motor& motor, GuardUse use, const MotorGuard& guard);
  GuardedCore(const GuardedCore&) = delete;
  GuardedCore& operator=(const GuardedCore&) = delete;

  [[nodiscard]] const robot_core::Config& config() const { return config_; }

 private:
  std::optional<firmware::HostGuard> guard_;
  robot_core::Config config_;
};

}  // namespace heatsoak::simulate
