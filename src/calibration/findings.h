// Findings of a calibration as data: limits of the accuracy and validity of its values. src/present puts them into words.
#pragma once

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include "calibration/assumptions.h"
#include "calibration/contradicting_run.h"
#include "calibration/forecast/forecast.h"

namespace heatsoak::calibration {

/// Logs have a current but no speed: the loss at speed is unknown, 0 to `most_W` (the loss at no-load speed).
struct LossAtSpeedUnknown {
  double most_W = 0.0;
};
/// The motor may have reversed within rows; the fit with interpolated speeds has the larger evidence.
struct RowsTurn {};
/// The runs contain heat that the model lacks.
struct UnmodelledHeat {
  double share = 0.0;         ///< ratio to the usual heat
  double usual_heat_W = 0.0;  ///< heat that flows through the motor on average
  bool exceeds_share = false;
};
/// The errors of the sensors change slowly: sensor errors, or an error of the two-node model.
struct SensorDrift {
  double drift_K = 0.0;  ///< standard deviation
  double time_scale_s = 0.0;
};
/// No sensor is at the winding.
struct WindingNotMeasured {};
/// The values follow whole runs best, and the response within seconds needs other values.
struct ResponseNeedsOtherValues {};
/// The search stopped before it had converged.
struct FitStoppedEarly {};
/// All capacities and resistances moved by one factor, which is the effect of wrong heat.
struct HeatSeemsWrong {
  double factor = 1.0;        ///< > 1: ratio of the values, in either direction
  bool is_too_large = false;  ///< the heat of the logs seems too large, else too small
};
/// Voltage, current and speed give another terminal resistance than the file.
struct ResistanceDiffers {
  double found_ohm = 0.0;
  double stated_ohm = 0.0;
};
/// A value changed by more than its prior and the fit's uncertainty make plausible.
struct LargeChange {
  std::string parameter;
  double factor = 1.0;     ///< new value divided by that of the file
  double change_sd = 0.0;  ///< size of the change in prior standard deviations
};
/// A fitted value is outside the declared range of its parameter.
struct OutsideDeclaredRange {
  std::string parameter;
  std::string unit;
  double value = 0.0;
  double low = 0.0;
  double high = 0.0;
};
/// The fitted model does not follow the runs well.
struct PoorFit {
  std::string signal;
  double rmse_K = 0.0;
  double varies_K = 0.0;  ///< standard deviation of the signal
};
/// Values that are not identifiable are written, because the forecast depends on all values together.
struct UnidentifiableAreWritten {};
/// Cross-validation was not possible: too few parts with heat.
struct TooFewPieces {
  std::size_t pieces = 0;
  std::size_t needed = 0;
  std::size_t runs = 0;        ///< number of fitted runs
  bool are_whole_runs = true;  ///< false: the pieces are parts of runs
};
/// The parameters of the tempered forecast fit are written.
struct ForecastFitIsWritten {};
/// No fit predicts left-out pieces better than the file.
struct FilePredictsBest {
  bool is_written = false;          ///< the values of the file are written
  bool is_better_than_fit = false;  ///< the file predicts better than the written values
};
/// Ordinary least squares of free runs has the smallest expected error (RivalScore::expected_K).
struct FreeRunsPredictBest {
  bool is_written = false;  ///< its parameters are written
};
/// For better forecasts the network has additional effects; this is no diagnosis.
struct ExtendedForForecasts {
  std::vector<std::string> effects;
  bool is_written = false;
};
using CalibrationFinding =
    std::variant<LossAtSpeedUnknown, RowsTurn, UnmodelledHeat, SensorDrift, WindingNotMeasured, ResponseNeedsOtherValues, FitStoppedEarly,
                 HeatSeemsWrong, ResistanceDiffers, LargeChange, OutsideDeclaredRange, PoorFit, ContradictingRun, UnidentifiableAreWritten,
                 TooFewPieces, ForecastFitIsWritten, FilePredictsBest, FreeRunsPredictBest, ExtendedForForecasts, HeldValue,
                 BandIncludesLossAtSpeed, BandIsEstimated, HeatInputLacking, ShaftPowerUnknown, SignalsMissing, HoldoutDiverges,
                 estimation::RunNote>;

/// Returns whether a finding of this type exists.
template <class Finding>
bool has_finding(const std::vector<CalibrationFinding>& findings) {
  for (const CalibrationFinding& each : findings) {
    if (std::holds_alternative<Finding>(each)) {
      return true;
    }
  }
  return false;
}

/// A signal that the fit predicts worse than the original file.
struct GrownError {
  std::string signal;
  bool is_holdout = false;   ///< true: error of the hold-out runs; false: error of the fitted runs
  double after_K = 0.0;      ///< rms error of the written file
  double before_K = 0.0;     ///< rms error of the original file
  bool is_extended = false;  ///< the written network has additional effects
};

}  // namespace heatsoak::calibration
