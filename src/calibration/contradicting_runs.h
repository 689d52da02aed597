// Runs of one motor that contradict each other, for example because a sensor was moved or the mounting was changed between them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "estimation/free_run_errors.h"
#include "estimation/posterior.h"

namespace heatsoak::calibration {

/// A run that the model follows with parameters of its own, but not with those of the other runs.
struct ContradictingRun {
  std::string run;           ///< name of the recording
  std::string signal;        ///< sensor with the largest error
  double by_others_K = 0.0;  ///< RMS error of the run, predicted with the parameters of all other runs
  double alone_K = 0.0;      ///< the same with parameters fitted to this run alone
  double usual_K = 0.0;      ///< RMS error of the other runs with the same parameters
};

/// Returns the RMS errors of each run, predicted with parameters from a fit to all other runs; empty errors if that fit fails. `start_C` as
/// in posterior_of(); weights and averaging in `options` are per run.
std::vector<estimation::Errors> errors_by_others(const estimation::Model& model, const std::vector<estimation::MeasuredRun>& runs,
                                                 const std::vector<std::vector<double>>& start_C,
                                                 const estimation::PosteriorOptions& options);

/// Returns the run that contradicts the others most; nothing if none does, or for fewer than three recordings.
std::optional<ContradictingRun> contradicting_run(const estimation::Model& model, const std::vector<estimation::MeasuredRun>& runs,
                                                  const std::vector<std::vector<double>>& start_C,
                                                  const estimation::PosteriorOptions& options);

}  // namespace heatsoak::calibration
