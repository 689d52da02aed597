// Sealed cases: a motor with something missing in its model, the runs it was recorded in, and what the tool says about them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "identify/attribution/selection.h"
#include "missing_effects.h"
#include "truth_motor.h"

namespace heatsoak::truth {

/// What the examiner knows.
struct Case {
  Missing missing;
  Surprise surprise;
  int rows = 1800;       ///< of each run, one second each
  int training_runs = 4; ///< the last of them on the bench
  std::uint64_t seed = 1;
};

struct Runs {
  std::vector<TrueRun> training;
  std::vector<TrueRun> unseen;
  MotorMake make;
};
/// Every make has capacities and resistances within ±25 % of the usual.
Runs record(const Case& sealed);

/// What a calibration knows beforehand: copper's resistance is right, everything else is off by up to 25 %.
ExtendedModel model_before(const MotorMake& make, std::uint64_t seed);

/// The log as the tool takes it.
MeasuredRun measured(const TrueRun& run);

struct Answer {
  Selection selection;
  std::vector<std::string> named;  ///< ids of effects of the catalogue, curves as "node~driver"
  double seconds_s = 0.0;
  double before_K = 0.0;  ///< rms error on unseen runs against true temperatures, winding and stator together
  double after_K = 0.0;
  double floor_K = 0.0;   ///< of the same model fitted to the same motor without anything missing
};
Answer examine(const Case& sealed, bool scans_drivers = true);

/// Open-loop rms error of the model on a run against the true temperatures.
double rms_error_K(const ExtendedModel& model, const std::vector<TrueRun>& runs);

}  // namespace heatsoak::truth
