// Finds a run that contradicts the other runs of the motor.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "estimation/fit.h"
#include "estimation/moved_sensor.h"
#include "estimation/posterior.h"

namespace heatsoak::calibration {

/// A run that the model does not follow with the parameters of the other runs, but with parameters of its own, or with a moved sensor.
struct ContradictingRun {
  std::string run;                                    ///< name of the recording
  std::string signal;                                 ///< sensor with the largest error
  double by_others_K = 0.0;                           ///< RMS error of this recording with parameters fitted to all other recordings
  double alone_K = 0.0;                               ///< RMS error of this recording with parameters fitted to it alone
  std::optional<estimation::MovedSensor> moved = {};  ///< the move that explains the recording with the parameters of the others
  double usual_K = 0.0;                               ///< RMS error of the other recordings with the parameters of `by_others_K`
  bool is_left_out = false;                           ///< the answer is that of the other runs
};

/// Returns the run that contradicts the others most; nothing if none does, or for fewer than three recordings. A run with an effect of its
/// own in the model contradicts only if it spoils the fit to the others.
/// `fit` is the fit to all runs; `weights` per run and sample as in estimation::PosteriorOptions.
std::optional<ContradictingRun> contradicting_run(const estimation::Posterior& fit, const std::vector<estimation::MeasuredRun>& runs,
                                                  const std::vector<Eigen::VectorXd>& weights);

/// Same for a calibration, whose model has no effects of single runs.
std::optional<ContradictingRun> contradicting_run(const estimation::Model& model, const estimation::Fit& fit,
                                                  const std::vector<estimation::MeasuredRun>& runs);

/// Returns the run whose moved sensor contradicts the other runs, if the model as it is follows these: an effect that is missing in all runs
/// explains no such run. Throws Failure as estimation::first_fit() does.
std::optional<ContradictingRun> run_with_moved_sensor(const estimation::Model& model, const std::vector<estimation::MeasuredRun>& runs);

}  // namespace heatsoak::calibration
