// Remaining time of a calibration, whose fits need unexpected numbers of simulations, on a clock that the test sets.
#include "calibration/forecast/forecast_work.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace heatsoak::calibration {
namespace {

std::vector<estimation::MeasuredRun> three_runs() {
  std::vector<estimation::MeasuredRun> runs(3);
  for (estimation::MeasuredRun& each : runs) {
    each.time_s.resize(600);
  }
  return runs;
}

/// Job on the test's clock, whose phases before the whole runs are over.
class Played {
 public:
  static constexpr double kSimulation_s = 0.02;

  Played() {
    job_.expect(work_.all(false, {}));
    job_.begin(calibration_phases::kFitting);
    time_s_ += 1.0;
    job_.begin(calibration_phases::kIntervals);
    time_s_ += 0.2;
  }
  /// Plays fits to all runs and without pieces with these numbers of simulations each.
  void fit(FitCounter& counter, int to_all, int to_all_simulations, int pieces, int piece_simulations) {
    for (int i = 0; i < to_all; ++i) {
      simulate(to_all_simulations, [&] { counter.simulated_all(); });
      counter.fitted_all();
    }
    for (int i = 0; i < pieces; ++i) {
      simulate(piece_simulations, [&] { counter.simulated_without_piece(); });
      counter.fitted_without_piece();
    }
  }
  template <class Count>
  void simulate(int simulations, const Count& count) {
    for (int i = 0; i < simulations; ++i) {
      time_s_ += kSimulation_s;
      count();
    }
  }
  [[nodiscard]] double left_s() const { return job_.estimate().remaining->p50_s; }
  [[nodiscard]] const base::JobProgress& job() const { return job_; }
  [[nodiscard]] const CalibrationWork& work() const { return work_; }
  void wait(double wait_s) { time_s_ += wait_s; }

 private:
  double time_s_ = 0.0;
  std::vector<estimation::MeasuredRun> runs_ = three_runs();
  CalibrationWork work_{runs_, 3, 1};
  base::JobProgress job_{[this] { return time_s_; }};
};

/// Returns the remaining time after the fits of whole runs, in which each fit needs `ratio` times the usual number of simulations.
double left_after_whole_runs_s(double ratio) {
  Played played;
  const PhaseFits fits = played.work().of_whole_runs(3);
  const auto times = [ratio](const FitWork& fit) { return static_cast<int>(std::lround(ratio * fit.simulations.count)); };
  FitCounter counter(played.job(), calibration_phases::kWholeRuns, fits);
  played.fit(counter, 3, times(fits.to_all), 3, times(fits.without_piece));
  return played.left_s();
}

// The later fits start near their optimum: slow convergence of the first ones says nothing about them.
TEST(CalibrationProgress, fits_of_many_simulations_do_not_lengthen_later_phases) {
  const double usual_s = left_after_whole_runs_s(1.0);
  EXPECT_GT(usual_s, 0.5);
  EXPECT_NEAR(left_after_whole_runs_s(8.0) / usual_s, 1.0, 0.1);
}

/// Returns the remaining time after two of three fits to all runs, with this number of simulations each.
double left_after_two_fits_s(int simulations) {
  Played played;
  FitCounter counter(played.job(), calibration_phases::kWholeRuns, played.work().of_whole_runs(3));
  played.fit(counter, 2, simulations, 0, 0);
  return played.left_s();
}

// The third fit is expected to need (15 + 2·150)/3 = 105 simulations instead of 15.
TEST(CalibrationProgress, fits_of_many_simulations_lengthen_the_rest_of_their_phase) {
  EXPECT_NEAR(left_after_two_fits_s(150) - left_after_two_fits_s(15), 90.0 * Played::kSimulation_s, 0.3);
}

// Two extensions, the first of which takes nine times as long per simulation. After it a tenth of the work is left.
TEST(CalibrationProgress, an_extension_that_is_slow_to_simulate_does_not_lengthen_the_others) {
  Played played;
  PhaseFits fits = played.work().of_extending({1.8, 0.2});
  fits.without_piece.fits_count = 0.0;
  played.job().expect({{calibration_phases::kExtending, fits.all_s()}});
  FitCounter counter(played.job(), calibration_phases::kExtending, fits);
  constexpr int kSimulations = 40;
  played.simulate(kSimulations, [&] {
    played.wait(8.0 * Played::kSimulation_s);
    counter.simulated_all();
  });
  counter.fitted_all();
  counter.ended_model();
  // A fit counts with the mean of the usual number of simulations and that of the first extension.
  const double expected = 0.5 * (fits.to_all.simulations.count + kSimulations);
  EXPECT_NEAR(played.job().estimate().remaining->p50_s, expected * Played::kSimulation_s, 0.2);
}

TEST(CalibrationProgress, screening_measures_the_cost_of_each_extension) {
  Played played;
  ScreeningCounter counter(played.job(), played.work().of_screening(2));
  played.simulate(10, [&] { counter.simulated(0); });
  counter.fitted(0, 3.0);
  played.simulate(30, [&] { counter.simulated(1); });
  counter.fitted(1, 1.0);
  // 40 simulations take 4 s, so the mean is 0.1 s; those of the extensions take 0.3 s and 1/30 s.
  EXPECT_NEAR(counter.cost_ratio(0), 3.0, 1e-9);
  EXPECT_NEAR(counter.cost_ratio(1), 1.0 / 3.0, 1e-9);
}

// Candidates whose short fits converge early lower the expectation for those that have not begun.
TEST(CalibrationProgress, short_fits_of_candidates_shorten_the_rest) {
  Played played;
  constexpr std::size_t kCandidates = 12;
  ScreeningCounter counter(played.job(), played.work().of_screening(kCandidates));
  for (std::size_t i = 0; i < kCandidates / 2; ++i) {
    played.simulate(5, [&] { counter.simulated(i); });
    counter.fitted(i, 5.0 * Played::kSimulation_s);
  }
  played.job().expect({});
  const double begun_s = 0.5 * kCandidates * 5.0 * Played::kSimulation_s;
  EXPECT_LT(played.job().estimate().remaining->p50_s, 1.4 * begun_s) << "twice as many simulations as in the ended fits would be 2.4 times";
}

/// Returns the ratio of the ends of the range after `fits` of three fits to all runs with the usual number of simulations.
double width_of_range(int fits) {
  Played played;
  PhaseFits work = played.work().of_whole_runs(3);
  work.to_all.simulations.calibration_sd = work.without_piece.simulations.calibration_sd = 0.5;
  work.is_alike = true;
  FitCounter counter(played.job(), calibration_phases::kWholeRuns, work);
  played.job().expect({});
  played.fit(counter, fits, static_cast<int>(played.work().of_whole_runs(3).to_all.simulations.count), 0, 0);
  const base::JobEstimate estimate = played.job().estimate();
  return estimate.remaining->p975_s / estimate.remaining->p025_s;
}

// Ended fits show how many simulations the others need. What the models differ by stays unknown.
TEST(CalibrationProgress, ended_fits_narrow_the_range) {
  EXPECT_GT(width_of_range(1), 1.1 * width_of_range(3));
  EXPECT_GT(width_of_range(3), 1.2);
}

// An unknown number of simulations per fit is a spread of the phase, which several models average.
TEST(CalibrationProgress, phases_of_fits_declare_how_much_their_duration_scatters) {
  const Played played;
  const auto spread_of = [&](std::size_t models) {
    return played.work().of_extending(std::vector<double>(models, 1.0)).phase(calibration_phases::kExtending).spread;
  };
  EXPECT_GT(spread_of(1), 0.4);
  EXPECT_LT(spread_of(4), spread_of(1));
  EXPECT_GT(spread_of(100), played.work().of_extending({1.0}).without_piece.simulations.calibration_sd);
}

// Ordinary fits often do not converge, with all runs and with a part of them.
TEST(CalibrationProgress, slow_fits_to_all_runs_lengthen_those_without_a_piece) {
  const auto left_s = [](int simulations) {
    Played played;
    played.job().expect({played.work().of_comparing().phase(calibration_phases::kComparing)});
    FitCounter counter(played.job(), calibration_phases::kComparing, played.work().of_comparing());
    played.fit(counter, 2, simulations, 0, 0);
    return played.left_s();
  };
  EXPECT_GT(left_s(100), 2.0 * left_s(15));
}

TEST(CalibrationProgress, nobody_who_watches_costs_nothing) {
  const std::vector<estimation::MeasuredRun> runs = three_runs();
  const CalibrationWork work(runs, 3, 1);
  FitCounter counter({}, calibration_phases::kWholeRuns, work.of_whole_runs(3));
  counter.simulated_all();
  counter.fitted_all();
  counter.ended_model();
}

}  // namespace
}  // namespace heatsoak::calibration
