// Findings of a diagnosis about its own limits and assumptions, as data. src/present puts them into words.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "base/diagnostic.h"
#include "calibration/contradicting_run.h"
#include "calibration/findings.h"

namespace heatsoak::diagnosis {

/// The motor file has these effects for better forecasts only. An effect that they imitate may stay unfound.
struct ExtensionsMayImitate {
  std::vector<std::string> effects;
};
/// The file was fitted to some of these runs. Its intervals are replaced by those of a data sheet.
struct IntervalsOfDataSheet {};
/// The file was fitted to this hold-out run, so its errors are not those of an unseen run.
struct HoldoutWasFitted {
  std::string recording;
};
/// Logs have a current but no speed. The loss at speed, up to `most_W`, is part of the unknown heat.
struct LossInUnknownHeat {
  double most_W = 0.0;
};
/// Not every log has a torque; without one, it is computed from the current.
struct TorqueFromCurrent {};
/// Not every log has these columns. Heat that depends on them is not searched for.
struct ColumnsNotSearched {
  std::vector<std::string> columns;
};

using DiagnosisFinding =
    std::variant<ExtensionsMayImitate, calibration::ContradictingRun, calibration::SignalsMissing, IntervalsOfDataSheet, HoldoutWasFitted,
                 LossInUnknownHeat, TorqueFromCurrent, ColumnsNotSearched, calibration::OutsideDeclaredRange, calibration::RowsTurn,
                 calibration::HeldValue, calibration::HeatInputLacking, calibration::ShaftPowerUnknown, calibration::HoldoutDiverges,
                 estimation::RunNote>;

/// Thrown if no log has a heat input that the motor's model uses.
class NothingHeatsModel : public base::Failure {
 public:
  explicit NothingHeatsModel(const std::string& motor);
};

/// Signal that is outside the range of the training runs for more than a quarter of the time of the hold-out runs.
struct BeyondTraining {
  thermal::Signal signal = thermal::Signal::current;
  double low = 0.0;         ///< 2nd percentile of the training runs, in the unit of the signal
  double high = 0.0;        ///< 98th percentile
  double time_share = 0.0;  ///< share of the time outside
};

}  // namespace heatsoak::diagnosis
