// All runs together once more: Gauss-Newton in whitened space from a model that is near already, bounds kept.
#pragma once

#include <vector>

#include "identify/attribution/evidence_table.h"
#include "identify/attribution/extended_model.h"
#include "identify/attribution/sensor_errors.h"

namespace heatsoak {

struct RefitResult {
  ExtendedModel model;
  std::vector<std::vector<double>> start_C;  ///< per run
  std::vector<LinearisedRun> fitted;
  FluxGrid::Place place;  ///< of the unknown heat that is most probable
  double evidence_nats = 0.0;
  Eigen::MatrixXd covariance;  ///< of the coordinates; 0 for those at a bound
  bool converged = false;
};

struct RefitOptions {
  FluxGrid grid;
  FluxGrid::Place place;  ///< to begin with
  SensorErrors errors;
  std::vector<int> merged;  ///< per run how many samples are averaged; results with others are not comparable
  int most_steps = 8;
  /// Average the result over how probable neighbouring suppositions about the unknown heat are: intervals that hold what they
  /// promise. Otherwise the most probable one alone counts.
  bool averages_flux = false;
};

/// `start_C` per run, as linearise() takes it. Throws Failure (numerics_failed) where no step can be made at all.
RefitResult refit(ExtendedModel model, const std::vector<MeasuredRun>& runs, std::vector<std::vector<double>> start_C,
                  const RefitOptions& options);

/// The same for a model that is only tried: where its temperatures run away its evidence is −∞, and nothing of it is fitted.
RefitResult try_refit(ExtendedModel model, const std::vector<MeasuredRun>& runs, std::vector<std::vector<double>> start_C,
                      const RefitOptions& options);

/// The slow errors of a run's sensors.
void set_wander(SensorNoise& noise, const MeasuredRun& run, const SensorErrors& errors);

/// The runs as the table takes them, with `extra` columns beside those of the model's coordinates. `merged` is empty where no samples are
/// averaged.
std::vector<DesignRun> design(const Network& network, const std::vector<LinearisedRun>& fitted, const std::vector<MeasuredRun>& runs,
                              const SensorErrors& errors, const std::vector<int>& merged, const std::vector<Columns>& extra);
/// The prior of the model's coordinates relative to where they are.
ThetaPrior prior_here(const ExtendedModel& model);

/// First measured temperatures; nodes without a sensor begin between the measured ones.
std::vector<double> measured_start_C(const Network& network, const MeasuredRun& run);

}  // namespace heatsoak
