// Sealed cases: a motor with something missing in its model, the runs it was recorded in, and what the tool says about them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "attribution/diagnosis.h"
#include "estimation/fit.h"
#include "missing_effects.h"
#include "truth_motor.h"

namespace heatsoak::truth {

/// What the examiner knows.
struct Case {
  Missing missing;
  Surprise surprise;
  int rows = 1800;             ///< of each run, one second each
  int training_runs = 4;       ///< of several the last is on the bench
  double metal_ratio = 1.0;    ///< of MotorMake
  bool is_calibrated = false;  ///< the model's figures are those of earlier runs in which nothing was missing
  bool has_winding_sensor = true;
  bool has_right_speed = true;  ///< otherwise the logs' speeds are those of other seconds, drawn by lot
  std::uint64_t seed = 1;
};

struct Runs {
  std::vector<TrueRun> training;
  std::vector<TrueRun> unseen;   ///< the last of them on the bench
  std::vector<TrueRun> earlier;  ///< of those that a model was calibrated with
  MotorMake make;
};
/// Every make has capacities and resistances within ±25 % of the usual.
Runs record(const Case& sealed);

/// What a calibration knows beforehand: copper's resistance is right, everything else is off by up to 25 %.
ExtendedModel model_before(const MotorMake& make, std::uint64_t seed);

struct Calibrated {
  ExtendedModel model;
  Fit fit;
};
/// model_before() and what a calibration makes of it with runs of that motor.
Calibrated calibrated(const Case& sealed, const MotorMake& make, const std::vector<TrueRun>& runs);

/// The log as the tool takes it.
MeasuredRun measured(const TrueRun& run);

/// What the analyser is given: nothing in it says what was left out.
DiagnosisInput question(const Case& sealed, const Runs& runs);
/// The runs that only score.
std::vector<MeasuredRun> holdout(const Runs& runs);

struct Answer {
  Diagnosis diagnosis;
  HoldoutScore score;
  std::vector<std::string> named;  ///< ids of effects of the catalogue, curves as "node~driver"
  double seconds_s = 0.0;
  double before_K = 0.0;  ///< rms error on unseen runs against true temperatures, winding and stator together
  double after_K = 0.0;
};
Answer examine(const Case& sealed);

/// On unseen runs, of the same model fitted to the same motor with nothing missing: what noise and unknown heat leave to the best.
double floor_K(Case sealed);

/// Open-loop rms error of the model on runs against the true temperatures.
double rms_error_K(const ExtendedModel& model, const std::vector<TrueRun>& runs);

}  // namespace heatsoak::truth
