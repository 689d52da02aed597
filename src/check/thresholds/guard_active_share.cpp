#include "check/computations.h"
#include "select/evaluate.h"

namespace heatsoak::check::thresholds {
namespace {

Measured measure_guard_active_share(const Check& check, Computations& computations) {
  const GuardedDrive& drive = computations.guarded_drive(check);
  return {drive.score.guard_limited_s / drive.duration_s, 0.0,
          GuardShareBasis{.limited_s = drive.score.guard_limited_s,
                          .duration_s = drive.duration_s,
                          .observer_peak_C = drive.score.guard_winding_peak_C.value(),
                          .winding_peak_C = drive.score.winding_peak_C}};
}

}  // namespace

ThresholdType guard_active_share() {
  return {.name = {},
          .unit = "",
          .is_share = true,
          .range = base::Range::between(0.0, 1.0),
          .meaning =
              "share of a match in which the motor's thermal guard would limit any wheel: one game of 'seed', driven by the drive core in "
              "a closed loop with real sensing, the guard in shadow mode. \"at most 0 %\": the guard never engages, not for one control "
              "period. A limit above 50 % is refused, because a guard that limits for most of the match shows that the motor is too small",
          .example = "at most 0 %",
          .needs = {Setting::robot, Setting::duty, Setting::motor},
          .takes = {Setting::seed, Setting::conditions, Setting::derate},
          .loosest = [](const Check&) -> std::optional<LoosestLimit> {
            return LoosestLimit{select::kMajority, LoosestBy::half_match};
          },
          .measure = measure_guard_active_share};
}

}  // namespace heatsoak::check::thresholds
