// Calibrates a motor from measured runs: parameter values with intervals, combinations that the data do not determine, and the cheapest
// experiment for each.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "base/job_progress.h"
#include "calibration/error_before_after.h"
#include "calibration/findings.h"
#include "calibration/followed_signals.h"
#include "calibration/forecast/forecast.h"
#include "calibration/forecast/prediction.h"
#include "calibration/motor_model.h"
#include "estimation/fit.h"
#include "motor/motor.h"
#include "recording/recording.h"

namespace heatsoak::calibration {

/// Fit whose parameters are written. `best`: the innovations fit if it predicts left-out pieces as well as the forecast fit, else the
/// forecast fit.
enum class WrittenFit { best, forecast, innovations };

struct CalibrationOptions {
  estimation::FitOptions fit;
  std::optional<double> ambient_C = {};  ///< ambient temperature of logs without one
  WrittenFit written = WrittenFit::best;
  base::JobProgress progress = {};
};

struct CalibratedParameter {
  std::string name;  ///< key in the motor file, or the name of a heat capacity
  std::string unit;
  bool is_of_file = true;  ///< false: a heat capacity; files contain time constants instead
  double before = 0.0;     ///< value in the file
  double value = 0.0;      ///< calibrated value
  double low = 0.0;        ///< limits of the 95 % interval
  double high = 0.0;
  bool is_learned = false;       ///< the data reduce the prior's uncertainty, see is_learned() of motor_model.h
  bool is_identifiable = false;  ///< the data, not only the prior, determine it to a factor of two or better
  bool by_profile = false;       ///< true: interval from the profile likelihood; false: from the curvature
};

/// Why the data do not determine something.
enum class OpenReason {
  no_heat,                ///< the runs have no heat input
  common_factor,          ///< one factor on all heat, heat capacities and conductances changes no temperature
  only_stator_measured,   ///< a larger winding behind a smaller resistance gives the same stator temperature
  only_winding_measured,  ///< the runs are too short to determine the stator from the winding's temperature
  motor_hardly_turns,
  small_loss_at_speed,  ///< against the copper loss
  not_excited,          ///< the measured temperatures hardly depend on it
  speed_not_logged,
  stator_not_settled,          ///< the runs neither reach a steady state nor cool down far enough
  stator_beside_unknown_heat,  ///< the runs are long enough, but contain unmodelled heat
  winding_not_stepped          ///< the winding's temperature hardly differs from the stator's, or never changes in steps
};
/// Cheapest experiment that determines something.
enum class Remedy {
  heated_run,
  four_wire_resistance,
  winding_sensor,
  stator_sensor,
  no_load_run,
  long_run,  ///< up to the steady state, then the cool-down
  logged_speed,
  current_steps
};

/// Direction in which a parameter changes.
struct MovedParameter {
  std::string name;
  bool is_raised = true;
};

/// Parameters that the data do not determine.
struct OpenDirection {
  std::vector<MovedParameter> together;  ///< combination that is not determined; empty or two and more
  std::vector<std::string> parameters;   ///< parameters that are not identifiable because of it, or for the same reason
  OpenReason reason = OpenReason::not_excited;
  double longest_run_s = 0.0;  ///< duration of the longest run, set for parameters of the stator
  double stator_s = 0.0;       ///< time constant of the stator, set for its parameters
  Remedy remedy = Remedy::long_run;
  double left_sd = 0.0;  ///< remaining standard deviation along the direction, in logarithms
};

/// No parameter of the motor is identifiable from the logs (cannot_answer).
class NothingLearned : public base::Failure {
 public:
  NothingLearned(std::vector<OpenDirection> open, bool has_heat_input);
  [[nodiscard]] const std::vector<OpenDirection>& open() const { return open_; }
  /// True if a heat input varies. A current in the wrong unit, such as kiloamperes, then still heats nothing.
  [[nodiscard]] bool has_heat_input() const { return has_heat_input_; }

 private:
  std::vector<OpenDirection> open_;
  bool has_heat_input_;
};

struct Calibration {
  estimation::Fit fit;
  MotorModel motor_model;
  std::vector<estimation::MeasuredRun> runs;
  std::vector<std::string> fitted;  ///< name_and_fingerprint() of each recording
  motor::TrainingRange training;    ///< their conditions and input ranges
  bool is_speed_linear = false;     ///< in rows in which the motor may reverse; as in the file if no run has such rows
  std::vector<CalibratedParameter> parameters;
  Eigen::MatrixXd correlation;  ///< correlation of the logarithms of the motor file's parameters, in the order of `parameters`
  std::vector<OpenDirection> open;
  std::optional<Remedy> next_experiment;    ///< nullopt if nothing is open
  std::vector<ErrorBeforeAfter> fit_error;  ///< per signal, in the fitted run with the largest error: original and written file
  std::optional<Forecast> forecast;         ///< forecast fit, its rivals and its error band
  bool is_forecast_written = false;         ///< true: `parameters` are from the forecast fit; false: from the innovations fit
  std::vector<motor::MotorEffect> effects;  ///< effects of the written file
  std::vector<PredictedRun> fitted_before,
      fitted_after;  ///< fitted runs, predicted by the original and by the written file; bands not valid
  /// Hold-out runs, predicted by the original and by the written file. Computed last, so that they influence nothing.
  std::vector<PredictedRun> holdout_before, holdout_after;
  std::vector<ErrorBeforeAfter> holdout_error;  ///< per signal: errors in the hold-out run with the largest error after the fit
  std::vector<GrownError> worse;                ///< signals that the fit predicts worse than the original file
  std::vector<CalibrationFinding> findings;     ///< assumptions and limits of the answer
};

/// Calibrates the motor. The logs must have passed admit() (calibration/admission.h). Throws NothingLearned, NothingFollows, and Failure:
/// bad_input if the logs lack a needed column; cannot_answer (with the reason) if no fit succeeds.
Calibration calibrate(const motor::Motor& motor, std::span<const recording::Recording> recordings,
                      std::span<const recording::Recording> holdout, const CalibrationOptions& options);

/// Returns the motor with the calibrated values and intervals. Identifiable parameters get the origin "measured"; the others keep their
/// origin. The source "calibration" names the runs.
motor::Motor calibrated_motor(const motor::Motor& motor, const Calibration& calibration);

}  // namespace heatsoak::calibration
