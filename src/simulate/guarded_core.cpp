#include "simulate/guarded_core.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/diagnostic.h"

namespace heatsoak::simulate {

MotorGuard make_guard(const motor::Motor& motor, const robot::Robot& robot, double ambient_C, int threads, const base::Progress& progress) {
  derate::DerateOptions options;
  options.hottest_ambient_C = std::max(options.hottest_ambient_C, ambient_C);
  options.coldest_ambient_C = std::min(options.coldest_ambient_C, ambient_C);
  options.guarantee.threads = threads;
  MotorGuard made;
  try {
    made.derating.emplace(derate::derate(motor, robot, options, progress));
    made.guard.emplace(*made.derating);
  } catch (const base::Failure& failure) {
    if (failure.code() != base::ExitCode::limit_exceeded && failure.code() != base::ExitCode::bad_input) {
      throw;
    }
    made.why_none = failure;
  }
  return made;
}

namespace {

/// Calls make_core_config() and adds motor and robot to the message of a failure.
template <class... Arguments>
robot_core::Config named_config(const robot::Robot& robot, const motor::Motor& motor, const Arguments&... rest) {
  try {
    return firmware::make_core_config(robot, rest...);
  } catch (const base::Failure& failure) {
    if (!failure.diagnostics().empty()) {
      throw;
    }
    throw base::Failure(failure.code(), fmt::format("{} in {}: {}", motor.id, robot.id, failure.message()));
  }
}

}  // namespace

GuardedCore::GuardedCore(robot::Robot robot, const motor::Motor& motor, GuardUse use, const MotorGuard& guard) {
  robot.wheels.slip_factor.clear();  // simulated wheels slip by the law of [traction]
  const firmware::CoreOptions options = firmware::with_tolerance({}, motor);
  if (use == GuardUse::off || !guard.guard) {
    config_ = named_config(robot, motor, motor.nominal, options);
    return;
  }
  guard_.emplace(*guard.guard);
  config_ = named_config(robot, motor, motor, options, *guard.derating, *guard_);
  if (use == GuardUse::on) {
    firmware::require_driving_current(robot, motor, *guard.derating, config_);
  }
  config_.shadow_mode = use == GuardUse::shadow;
  robot_core::complete(config_);
}

}  // namespace heatsoak::simulate
