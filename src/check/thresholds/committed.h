// Shared parts of the thresholds on a committed derating table.
#pragma once

#include <fmt/format.h>

#include <cmath>

#include "check/computations.h"
#include "derate/committed_table.h"

namespace heatsoak::check::thresholds {

inline derate::TableComparison compared(const Check& check, Computations& computations) {
  // Read first, so that a missing file is reported before the derating, which may take a minute.
  const derate::CommittedTable committed = derate::read_committed_table(check.table);
  if (!committed.motor_id.empty() && committed.motor_id != check.motor->id) {
    throw base::Failure(base::ExitCode::limit_exceeded, fmt::format("{}: the table is of another motor, {}; expected one of {}",
                                                                    check.table.string(), committed.motor_id, check.motor->id));
  }
  if (const std::string problem = derate::sensor_difference(committed, check.derate.sensor); !problem.empty()) {
    throw base::Failure(base::ExitCode::bad_input,
                        fmt::format("{}: {}; 'derate' takes them as keys without \"--\", \"_\" for \"-\"", check.table.string(), problem));
  }
  return derate::compare(committed, computations.derating(check, check.derate));
}

/// A table cannot differ by more than the current that the driver permits.
inline std::optional<LoosestLimit> largest_difference(const Check& check) {
  return check.robot && std::isfinite(check.robot->drive.current_limit_A)
             ? std::optional<LoosestLimit>({check.robot->drive.current_limit_A, "the current limit of the robot's driver", true})
             : std::nullopt;
}

inline std::string place_text(const derate::TablePlace& place) {
  return place.difference_A == 0.0 ? std::string()
                                   : fmt::format("at {:.0f} rad/s, stator {:.0f} °C, winding {:.0f} °C: {:.3f} A, a fresh table {:.3f} A",
                                                 place.speed_rad_per_s, place.stator_C, place.winding_C, place.committed_A, place.fresh_A);
}

}  // namespace heatsoak::check::thresholds
