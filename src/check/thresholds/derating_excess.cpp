#include "check/thresholds/committed.h"

namespace heatsoak::check::thresholds {
namespace {

Measured measure_derating_excess(const Check& check, Computations& computations) {
  const derate::TableComparison found = compared(check, computations);
  return {found.excess.difference_A, 0.0, ExcessBasis{found.excess, found.lost.difference_A, found.other_version}};
}

}  // namespace

ThresholdType derating_excess() {
  return {.name = {},
          .unit = "A",
          .range = base::Range::between(0.0, 1e3),
          .meaning =
              "largest excess of the current that the committed 'table' allows over that of a fresh `derate` of the same robot, motor and "
              "options, over all speeds and temperatures. An excess within 0.05 % of the largest current counts as 0. A C header also "
              "fails if it is of another motor or its observer differs from a fresh one. The default of 400 drawn motors takes up to 3 s "
              "per motor; write and check the table with derate = { samples = "
              "\"60\" } for half of that. --update leaves 0.05 A if the value is 0, but keeps a limit of 0 A that "
              "holds",
          .example = "at most 0 A",
          .needs = {Setting::robot, Setting::motor, Setting::table},
          .takes = {Setting::conditions, Setting::derate},
          .loosest = largest_difference,
          .measure = measure_derating_excess};
}

}  // namespace heatsoak::check::thresholds
