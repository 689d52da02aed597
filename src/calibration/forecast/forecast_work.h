// Expected work of a calibration, for its progress: the phases that follow, and how long they usually take.
#pragma once

#include <cstddef>
#include <functional>
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

/// Fits of one kind in a phase.
struct FitWork {
  double fits_count = 0.0;
  double simulations_count = 0.0;  ///< usual number of simulations per fit
  double simulation_s = 0.0;       ///< duration of one simulation of all runs of the fit, with sensitivities

  [[nodiscard]] double one_s() const { return simulations_count * simulation_s; }
};

/// Fits of a phase: to all runs, and to the rest without one piece.
struct PhaseFits {
  FitWork to_all;
  FitWork without_piece;

  [[nodiscard]] double all_s() const { return to_all.fits_count * to_all.one_s() + without_piece.fits_count * without_piece.one_s(); }
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
  /// Returns the fits of kExtending for this number of tested extensions.
  [[nodiscard]] PhaseFits of_extending(std::size_t tested) const;
  /// Returns the fits of kComparing.
  [[nodiscard]] PhaseFits of_comparing() const;

 private:
  [[nodiscard]] PhaseFits fits_of(double to_all_count, double simulations_count, double without_piece_count,
                                  double simulations_without_piece_count) const;

  double piece_count_ = 0.0;
  double all_runs_s_ = 0.0;        ///< one simulation of all runs, parallel over the runs
  double other_runs_s_ = 0.0;      ///< the same without one piece
  double candidate_s_ = 0.0;       ///< the same of all runs per candidate, if candidates instead of runs are simulated in parallel
  double response_s_ = 0.0;        ///< one fit of the response to all runs
  double other_response_s_ = 0.0;  ///< fits of the response without each of the pieces
};

/// Reports the progress of a phase of fits. How many simulations a fit needs is not known before its end: one that needs more than usual is
/// assumed to need half as many again, so that the later fits are expected to be slow, too.
class FitCounter {
 public:
  FitCounter(base::Progress progress, const PhaseFits& fits);

  /// Returns a function to be called after each simulation of a fit to all runs, or without a piece.
  [[nodiscard]] std::function<void()> of_fit_to_all() { return simulated(fits_.to_all); }
  [[nodiscard]] std::function<void()> of_fit_without_piece() { return simulated(fits_.without_piece); }
  /// Ends a fit to all runs, or without a piece.
  void fitted_all() { fitted(fits_.to_all); }
  void fitted_without_piece() { fitted(fits_.without_piece); }

 private:
  [[nodiscard]] std::function<void()> simulated(const FitWork& fit);
  void fitted(const FitWork& fit);
  void report(double present_s) const;

  base::Progress progress_;
  PhaseFits fits_;
  double done_s_ = 0.0;
  double simulations_count_ = 0.0;  ///< simulations of the present fit
};

}  // namespace heatsoak::calibration
