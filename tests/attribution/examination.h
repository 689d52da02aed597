// Blind test cases: a motor with an effect missing in its model, its recorded runs, and the tool's answer.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calibration/contradicting_run.h"
#include "diagnosis/diagnosis.h"
#include "errors_of_models.h"
#include "estimation/fit.h"
#include "missing_effects.h"
#include "motor/motor.h"
#include "truth_motor.h"

namespace heatsoak::attribution::truth {

/// Ground truth of a case, hidden from the analysed code.
struct Case {
  Missing missing;
  Surprise surprise;
  int rows = 1800;             ///< rows of each run, one per second
  int training_runs = 4;       ///< if there are several, the last is a bench run
  double metal_ratio = 1.0;    ///< value for MotorMake
  bool is_calibrated = false;  ///< true if the model was calibrated with earlier runs without the missing effect
  bool has_winding_sensor = true;
  bool has_right_speed = true;  ///< if false, the logs contain speeds of randomly drawn other rows
  std::uint64_t seed = 1;
};

struct Runs {
  std::vector<TrueRun> training;
  std::vector<TrueRun> unseen;   ///< the last one is a bench run
  std::vector<TrueRun> earlier;  ///< runs of the earlier calibration
  MotorMake make;
};
/// Simulates the runs of a case. Capacities and resistances of the motor are drawn within ±25 % of the usual values.
Runs record(const Case& sealed);

/// Model before a calibration: the copper resistance is right, every other parameter is off by up to 25 %.
estimation::Model model_before(const MotorMake& make, std::uint64_t seed);

/// Returns a data sheet of the motor, whose thermal resistances are off by up to 15 %.
motor::Motor sheet_of(const MotorMake& make);
/// Writes the motor's file and reads it, as the next verb of a user would.
motor::Motor read_back(const motor::Motor& motor);

struct Calibrated {
  estimation::Model model;
  estimation::Fit fit;
  UsualErrors usual = {};
};
/// Calibrates model_before() with runs of that motor.
Calibrated calibrated(const Case& sealed, const MotorMake& make, const std::vector<TrueRun>& runs);

/// Converts a run to the log format of the tool. A log with gaps has several pieces.
std::vector<estimation::MeasuredRun> measured_pieces(const TrueRun& run);
/// Returns the first piece.
estimation::MeasuredRun measured(const TrueRun& run);

/// Input of the diagnosis, without any hint of the missing effect.
diagnosis::DiagnosisInput question(const Case& sealed, const Runs& runs);
/// Runs for scoring only, with the speed within rows in which the motor may reverse (turning_rows.h).
std::vector<estimation::MeasuredRun> holdout(const Runs& runs, bool is_speed_linear = false);

/// Returns the run that contradicts the others, after a diagnosis.
std::optional<calibration::ContradictingRun> contradiction(const diagnosis::DiagnosisInput& input, const Selection& selection);

struct Answer {
  diagnosis::Diagnosis diagnosis;
  ErrorsOfModels score;
  std::vector<std::string> named;  ///< ids of catalogue effects, and curves as "node~driver"
  double seconds_s = 0.0;
  double before_K = 0.0;  ///< RMS error on unseen runs against true temperatures, winding and stator together
  double after_K = 0.0;
};
Answer examine(const Case& sealed);

/// RMS error on unseen runs for the model fitted to the same motor without a missing effect. It is the error floor from noise and unknown
/// heat.
double floor_K(Case sealed);

/// Open-loop RMS error of the model against the true temperatures of the runs.
double rms_error_K(const estimation::Model& model, const std::vector<TrueRun>& runs);

}  // namespace heatsoak::attribution::truth
