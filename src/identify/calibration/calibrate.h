// The figures of a motor from measured runs: values, how sure they are, what the data cannot tell and what would.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "identify/calibration/error_before_after.h"
#include "identify/calibration/motor_model.h"
#include "identify/fit.h"
#include "identify/forecast/forecast.h"
#include "identify/forecast/prediction.h"
#include "identify/measurement/recording.h"
#include "motor/motor.h"

namespace heatsoak {

struct CalibrationOptions {
  FitOptions fit;
  double ambient_C = MeasuredRunOptions::kNotStated_C;  ///< where a log has none
  /// The parameters are those of the fit to whole runs, with which left-out pieces are predicted best; else those of the innovations fit.
  bool is_for_forecasts = false;
};

struct CalibratedFigure {
  std::string name;  ///< as in the motor file; heat capacities besides
  std::string unit;
  bool is_of_file = true;
  double before = 0.0;
  double value = 0.0;
  double low = 0.0;  ///< of the 95 % interval
  double high = 0.0;
  bool is_identifiable = false;  ///< the data, not only what was known before, tell it to a factor of two or better
  bool by_profile = false;       ///< the interval is that of the profile likelihood, else of the curvature
};

/// A combination of parameters that the data leave open.
struct OpenDirection {
  std::string what;             ///< in words, with the parameters
  std::string why;              ///< in words
  std::string experiment;       ///< the cheapest that would settle it
  double experiment_min = 0.0;  ///< rough time of work that it takes, minutes
  double left_sd = 0.0;         ///< how open: of the logarithms together
};

struct Calibration {
  Fit fit;
  MotorModel motor_model;
  std::vector<MeasuredRun> runs;
  std::vector<std::string> fitted;  ///< name_and_fingerprint() of each recording
  TrainingRange training;           ///< of them
  std::vector<CalibratedFigure> figures;
  Eigen::MatrixXd correlation;  ///< of the logarithms of the figures of the file, in their order
  std::vector<OpenDirection> open;
  std::string next_experiment;  ///< empty where nothing is open
  std::vector<ErrorBeforeAfter> fit_error;
  std::optional<Forecast> forecast;                       ///< fit to whole runs, its rivals and its band
  bool is_forecast_written = false;                       ///< its parameters are those above; else the innovations fit's
  std::vector<MotorEffect> effects;                       ///< of the written file
  std::vector<PredictedRun> fitted_before, fitted_after;  ///< the fitted runs by the file and by what is written; their bands count nothing
  /// Predictions of the hold-out runs by the file and by what is written, made after everything is decided.
  std::vector<PredictedRun> holdout_before, holdout_after;
  std::vector<ErrorBeforeAfter> holdout_error;  ///< per signal, of the hold-out run that it is worst in after the fit
  std::vector<std::string> worse;               ///< signals that the fit foretells worse than the file it began with, in sentences
  std::vector<std::string> notes;               ///< what was taken for granted or left out, in sentences
};

/// Of logs that admit() (identify/admission.h) let pass. Throws Failure: bad_input where the logs lack what is needed, cannot_answer where
/// nothing can be learned from them (with the reason) or no fit succeeds.
Calibration calibrate(const Motor& motor, std::span<const Recording> recordings, std::span<const Recording> holdout,
                      const CalibrationOptions& options);

/// The motor with what was learned: figures that the data tell carry the origin "measured" and the interval, the file's
/// other figures stay. `source_id` names the runs among the file's sources.
Motor calibrated_motor(const Motor& motor, const Calibration& calibration);

}  // namespace heatsoak
