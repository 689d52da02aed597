// Conditions and input ranges of the runs that a model was fitted to, and a check whether a log is outside them.
#pragma once

#include <span>
#include <string>
#include <variant>
#include <vector>

#include "motor/fit_table.h"
#include "recording/recording.h"

namespace heatsoak::calibration {

/// Adds the conditions, ambient temperatures, speeds and currents of the recordings to `range`. The limits are the 1st and 99th percentile,
/// so that single outliers do not widen the range. With a heat input that does not use a logged current, the range has no current.
void widen(motor::TrainingRange& range, std::span<const recording::Recording> recordings, motor::HeatInput heat);

/// A condition of a recording that no fitted run had.
struct UnseenCondition {
  std::string recording;
  std::string key;
  std::string value;
  std::vector<std::string> seen;  ///< conditions "key=value" of the fitted runs with this key; empty if they do not state it
};
/// An input outside the range of the fitted runs.
struct Extrapolation {
  std::string recording;
  std::string channel;
  std::string unit;
  double value = 0.0;  ///< value of the recording that is farthest outside
  double low = 0.0;    ///< range of the fitted runs
  double high = 0.0;
};
using OutsideTraining = std::variant<UnseenCondition, Extrapolation>;

/// Returns what lies outside the range of the fitted runs. Empty if `range` is empty.
std::vector<OutsideTraining> outside(const motor::TrainingRange& range, const recording::Recording& recording);

}  // namespace heatsoak::calibration
