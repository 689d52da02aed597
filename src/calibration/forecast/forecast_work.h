// Expected work of a calibration, for its progress: the phases that follow, and how long they usually take.
#pragma once

#include <cmath>
#include <cstddef>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/job_progress.h"
#include "estimation/measured_run.h"

namespace heatsoak::calibration {

/// Names of the phases of a calibration, for its progress.
namespace calibration_phases {
inline const std::string kFitting = "fitting the response";
inline const std::string kIntervals = "computing intervals";
inline const std::string kWholeRuns = "fitting whole runs";
inline const std::string kScreening = "searching extensions of the model";
inline const std::string kExtending = "testing extensions of the model";
inline const std::string kComparing = "comparing the fits";
inline const std::string kLeavingOut = "testing the fit on left-out runs";
inline const std::string kPredicting = "predicting the runs";
}  // namespace calibration_phases

/// Returns the usual duration of one fit of the response to these runs, in s on two cores.
double usual_s(std::span<const estimation::MeasuredRun> runs);

/// A round of extensions: a short fit of each candidate, then tests of the best of them on left-out pieces.
struct ExtensionRound {
  std::size_t candidates = 0;
  std::size_t tested = 0;
  double probability = 1.0;  ///< probability that the round takes place
};

/// Usual number of simulations per fit, and the standard deviations of its logarithm.
struct UsualSimulations {
  double count = 0.0;           ///< geometric mean
  double calibration_sd = 0.0;  ///< scatter of the means of calibrations
  double model_sd = 0.0;        ///< scatter of the models of one calibration
};

/// Fits of a phase that share their usual number of simulations and the duration of each.
struct FitWork {
  double fits_count = 0.0;       ///< fits per model
  UsualSimulations simulations;  ///< per fit
  double simulation_s = 0.0;     ///< usual duration of one simulation of all runs of the fit, with sensitivities

  [[nodiscard]] double all_s() const { return fits_count * simulations.count * simulation_s; }
};

/// Fits of a phase: for each model those to all runs, and those to the rest without one piece.
struct PhaseFits {
  FitWork to_all;
  FitWork without_piece;
  /// Duration of a simulation relative to the usual one, per model in the order of the fits.
  std::vector<double> cost_ratio = {1.0};
  bool is_alike = true;  ///< both kinds of fits converge alike; false if some start far from the optimum

  [[nodiscard]] double all_s() const;
  /// Returns the phase of these fits.
  [[nodiscard]] base::JobPhase phase(const std::string& what, double probability = 1.0) const;
};

/// Expected durations of a calibration's phases: the number of fits, times the usual number of simulations in a fit, times the duration of
/// a simulation, which is proportional to its rows. Once fits have been measured, only the ratios matter.
class CalibrationWork {
 public:
  /// `pieces`: number of left-out pieces. `threads`: 0 for all cores.
  CalibrationWork(std::span<const estimation::MeasuredRun> runs, std::size_t pieces, int threads);

  /// Returns all phases. `refits_turning`: the response is fitted again with interpolated speeds.
  [[nodiscard]] std::vector<base::JobPhase> all(bool refits_turning, std::span<const ExtensionRound> rounds) const;
  /// Returns the phases after the fits of whole runs.
  [[nodiscard]] std::vector<base::JobPhase> after_whole_runs(std::span<const ExtensionRound> rounds) const;

  /// Returns the fits of kWholeRuns from this number of starting points.
  [[nodiscard]] PhaseFits of_whole_runs(std::size_t starts) const;
  /// Returns the fits of kExtending for the tested extensions with these durations of a simulation relative to the usual one.
  [[nodiscard]] PhaseFits of_extending(std::vector<double> cost_ratio) const;
  /// Returns the fits of kComparing.
  [[nodiscard]] PhaseFits of_comparing() const;
  /// Returns the short fits of kScreening, each of which simulates all runs on one core.
  [[nodiscard]] FitWork of_screening(std::size_t candidates) const;

 private:
  [[nodiscard]] PhaseFits fits_of(double to_all_count, const UsualSimulations& simulations, double without_piece_count,
                                  const UsualSimulations& simulations_without_piece) const;

  double piece_count_ = 0.0;
  double all_runs_s_ = 0.0;        ///< one simulation of all runs, parallel over the runs
  double other_runs_s_ = 0.0;      ///< the same without one piece
  double candidate_s_ = 0.0;       ///< the same of all runs per candidate, if candidates instead of runs are simulated in parallel
  double response_s_ = 0.0;        ///< one fit of the response to all runs
  double other_response_s_ = 0.0;  ///< fits of the response without each of the pieces
};

/// Progress of a phase of fits. How many simulations a fit needs is not known before its end. The expected work of the phase is corrected
/// with each simulation, so that a fit of many simulations makes only the rest of its phase longer. The time per simulation is the only
/// measure of speed that later phases take over.
class FitCounter {
 public:
  /// Begins the phase.
  FitCounter(const base::JobProgress& job, const std::string& phase, PhaseFits fits);

  /// Counts a simulation of the present fit to all runs, or without a piece.
  void simulated_all() { simulated(to_all_); }
  void simulated_without_piece() { simulated(without_piece_); }
  /// Ends a fit to all runs, or without a piece.
  void fitted_all() { fitted(to_all_); }
  void fitted_without_piece() { fitted(without_piece_); }
  /// Ends the fits of a model; those that are left did not take place.
  void ended_model();

 private:
  /// Fits of one kind, so far.
  struct Count {
    FitWork usual;
    double ended_fits_count = 0.0;           ///< number of ended fits of all models
    double ended_simulations_count = 0.0;    ///< simulations of those fits
    double fits_of_model_count = 0.0;        ///< number of ended fits of the present model
    double present_simulations_count = 0.0;  ///< simulations of the present fit

    /// Returns the duration of the fits of the present model that are left, with this number of simulations per fit.
    [[nodiscard]] double left_of_model_s(double expected_count) const;
    [[nodiscard]] double of_model_s(double expected_count) const { return usual.fits_count * expected_count * usual.simulation_s; }
  };
  /// Expected number of simulations per fit, with the standard deviation of its logarithm.
  struct Expected {
    double simulations_count = 0.0;
    double sd = 0.0;
  };
  [[nodiscard]] Expected expected(const Count& count) const;

  void simulated(Count& count);
  void fitted(Count& count);
  void report() const;

  base::JobProgress job_;
  base::Progress progress_;
  Count to_all_, without_piece_;
  std::vector<double> cost_ratio_;
  bool is_alike_ = true;
  std::size_t model_ = 0;  ///< index of the present model
  double done_s_ = 0.0;
};

/// Progress of the short fits of candidates, several of which run at the same time. All members may be called from any thread.
class ScreeningCounter {
 public:
  /// Begins the phase.
  ScreeningCounter(const base::JobProgress& job, const FitWork& fits);

  /// Counts a simulation of a candidate.
  void simulated(std::size_t candidate);
  /// Ends the fit of a candidate, which took `elapsed_s`.
  void fitted(std::size_t candidate, double elapsed_s);
  /// Returns the duration of a simulation of this candidate, relative to the mean of all simulations.
  [[nodiscard]] double cost_ratio(std::size_t candidate) const;

 private:
  struct Count {
    double simulations_count = 0.0;
    std::optional<double> elapsed_s = {};  ///< empty until the fit has ended
  };

  base::JobProgress job_;
  base::Progress progress_;
  FitWork usual_;
  mutable std::mutex mutex_;
  std::vector<Count> counts_;
};

}  // namespace heatsoak::calibration
