#include "check/thresholds/committed.h"

namespace heatsoak::check::thresholds {

ThresholdType derating_lost() {
  return {
      .name = {},
      .unit = "A",
      .range = base::Range::between(0.0, 1e3),
      .meaning =
          "largest deficit of the current that the committed 'table' allows below that of a fresh `derate` of the same robot, motor "
          "and options, over all speeds and temperatures: safe, but unused current. A C header also fails if it is of another motor or its "
          "observer differs from a fresh one. --update leaves at least 0.05 A",
      .example = "at most 0.5 A",
      .needs = {Setting::robot, Setting::motor, Setting::table},
      .takes = {Setting::conditions, Setting::derate},
      .loosest = largest_difference,
      .measure = [](const Check& check, Computations& computations) -> Measured {
        const derate::TableComparison found = compared(check, computations);
        return {found.lost.difference_A, 0.0, LostBasis{found.lost, found.other_version}};
      }};
}

}  // namespace heatsoak::check::thresholds
