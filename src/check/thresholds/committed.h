// Shared parts of the thresholds on a committed derating table.
#pragma once

#include <cmath>

#include "check/computations.h"
#include "check/not_evaluated.h"
#include "derate/committed_table.h"

namespace heatsoak::check::thresholds {

/// Throws NotEvaluated if the table is of another motor, or its observer differs from a fresh one: currents of two observers at one
/// temperature cannot be compared.
inline derate::TableComparison compared(const Check& check, Computations& computations) {
  // Read first, so that a missing file is reported before the derating, which may take a minute.
  const derate::CommittedTable committed = derate::read_committed_table(check.table);
  if (!committed.motor_id.empty() && committed.motor_id != check.motor->id) {
    throw NotEvaluated(TableOfOtherMotor{check.table, committed.motor_id, check.motor->id});
  }
  if (const std::optional<derate::SensorDifference> difference = derate::sensor_difference(committed, check.derate.sensor)) {
    throw NotEvaluated(SensorOptionsDiffer{check.table, *difference});
  }
  derate::TableComparison found = derate::compare(committed, computations.derating(check, check.derate));
  if (!found.differing.empty()) {
    throw NotEvaluated(ObserverDiffers{check.table, found.differing.front(), found.differing.size(), found.other_version});
  }
  return found;
}

/// A table cannot differ by more than the current that the driver permits.
inline std::optional<LoosestLimit> largest_difference(const Check& check) {
  return check.robot && check.robot->drive.current_limit_A
             ? std::optional<LoosestLimit>({*check.robot->drive.current_limit_A, LoosestBy::driver_limit, true})
             : std::nullopt;
}

}  // namespace heatsoak::check::thresholds
