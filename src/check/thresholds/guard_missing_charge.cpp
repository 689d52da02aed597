#include "check/computations.h"
#include "check/thresholds/duty_duration.h"

namespace heatsoak::check::thresholds {
namespace {

Measured measure_guard_missing_charge(const Check& check, Computations& computations) {
  const GuardedDrive& drive = computations.guarded_drive(check);
  return {drive.score.guard_missing_A_s, 0.0, GuardChargeBasis{drive.score.guard_limited_s, drive.duration_s}};
}

/// The guard cannot take away more than the largest current of all wheels during the whole duty.
std::optional<LoosestLimit> most_charge(const Check& check) {
  const std::optional<double> duration_s = duty_duration_s(check);
  if (!duration_s || !check.motor) {
    return std::nullopt;
  }
  try {
    const double most_A = derate::barrier_rules(*check.motor, *check.robot, check.derate).most_current_A;
    const auto wheels = static_cast<double>(check.robot->wheels.axis_rad.size());
    return LoosestLimit{*duration_s * most_A * wheels, LoosestBy::whole_charge, true};
  } catch (const base::Failure&) {
    return std::nullopt;  // the evaluation reports it
  }
}

}  // namespace

ThresholdType guard_missing_charge() {
  return {.name = {},
          .unit = "A s",
          .range = base::Range::between(0.0, 1e6),
          .meaning =
              "integral over time of the current that the thermal guard would take away in a match, all wheels together; the same drive as "
              "for guard_active_share",
          .example = "at most 0 A s",
          .needs = {Setting::robot, Setting::duty, Setting::motor},
          .takes = {Setting::seed, Setting::conditions, Setting::derate},
          .loosest = most_charge,
          .measure = measure_guard_missing_charge};
}

}  // namespace heatsoak::check::thresholds
