#include <fmt/format.h>

#include "check/computations.h"

namespace heatsoak::check::thresholds {
namespace {

Measured measure_guard_missing_charge(const Check& check, Computations& computations) {
  const GuardedDrive& drive = computations.guarded_drive(check);
  return {drive.score.guard_missing_A_s, 0.0,
          fmt::format("the guard would limit for {:.1f} of {:.0f} s", drive.score.guard_limited_s, drive.duration_s)};
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
          .measure = measure_guard_missing_charge};
}

}  // namespace heatsoak::check::thresholds
