// The drive core as one robot with one motor gets it: its configuration, with or without the motor's thermal guard.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/parallel.h"
#include "firmware/core_config.h"
#include "firmware/host_guard.h"

namespace heatsoak::simulate {

enum class GuardUse {
  off,
  shadow,  ///< the guard counts what it would limit, and limits nothing
  on
};
inline constexpr std::string_view kGuardUses[]{"off", "shadow", "on"};

/// derate()'s guard of a motor, or why there is none.
struct MotorGuard {
  std::optional<derate::Derating> derating;
  std::optional<firmware::HostGuard> guard;
  std::string why_none;  ///< derate()'s own message; empty where there is a guard, and where none was asked for
};

/// Runs derate() with its own defaults, in air of up to 40 degC or `ambient_C`, whichever is more. A motor that passes a limit without
/// current, or has more nodes than the core's guard takes, gets none. Other failures are thrown.
MotorGuard make_guard(const motor::Motor& motor, const robot::Robot& robot, double ambient_C, int threads,
                      const base::Progress& progress = {});

/// Owns what its config() points to, so that cores of one motor can run in several threads, each with its own. Neither copied nor moved.
class GuardedCore {
 public:
  /// Without a guard in `guard` the use is off. Throws as make_core_config() does, and with the guard on as require_driving_current() does.
  GuardedCore(const robot::Robot& robot, const motor::Motor& motor, GuardUse use, const MotorGuard& guard);
  GuardedCore(const GuardedCore&) = delete;
  GuardedCore& operator=(const GuardedCore&) = delete;

  [[nodiscard]] const robot_core::Config& config() const { return config_; }

 private:
  std::optional<firmware::HostGuard> guard_;
  robot_core::Config config_;
};

}  // namespace heatsoak::simulate
