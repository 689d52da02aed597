#include "check/thresholds/committed.h"

namespace heatsoak::thresholds {
namespace {

Measured measure(const Check& check, Computations& computations) {
  const TableComparison found = compared(check, computations);
  if (found.differing_line > 0) {
    throw Failure(
        ExitCode::limit_exceeded,
        fmt::format("{}:{}: the observer is not the one of a fresh header, so the table means something else: \"{}\", fresh \"{}\"; "
                    "make the header anew with `heatsoak derate`",
                    check.table.string(), found.differing_line, found.differing_text, found.differing_fresh_text));
  }
  std::string detail = place_text(found.excess);
  if (found.lost.difference_A > 0.0) {
    detail += fmt::format("{}allows up to {:.3f} A less elsewhere", detail.empty() ? "" : "; ", found.lost.difference_A);
  }
  return {found.excess.difference_A, 0.0, detail.empty() ? "the same as a fresh table" : detail};
}

}  // namespace

ThresholdType derating_excess() {
  return {.name = {},
          .unit = "A",
          .range = Range::between(0.0, 1e3),
          .meaning =
              "how much more current the committed 'table' allows than a fresh `derate` of the same robot, motor and options, at the "
              "speed and temperatures where that is most. A C header fails, too, where its observer differs from a fresh one",
          .example = "at most 0 A",
          .needs = {Setting::robot, Setting::motor, Setting::table},
          .takes = {Setting::conditions, Setting::derate},
          .measure = measure};
}

}  // namespace heatsoak::thresholds
