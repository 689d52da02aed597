#include "calibration/forecast/forecast_work.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <thread>
#include <utility>

namespace heatsoak::calibration {
namespace {

/// Kinds of work, which differ in the speed of this computer relative to the usual one.
const std::string kResponse = "response";
const std::string kSimulation = "simulation";

// Usual numbers of simulations per fit: medians over 13 calibrations with 1 to 5 runs of 430 to 6900 rows. Those of extended models count
// 1.3 times, because they have more parameters.
constexpr double kSimulations = 15.0;
constexpr double kSimulations_without_piece = 9.5;
constexpr double kSimulations_screening = 17.0;
constexpr double kSimulations_extended = 30.0;
constexpr double kSimulations_extended_without_piece = 20.0;
constexpr double kSimulations_ordinary = 15.0;
/// Duration of a fit of the response from a good start, relative to one from several starts.
constexpr double kFromGoodStart_share = 0.85;

double rows_of(const estimation::MeasuredRun& run) { return static_cast<double>(run.time_s.size()); }

}  // namespace

double usual_s(std::span<const estimation::MeasuredRun> runs) {
  constexpr double kRow_s = 1.4e-4;
  double rows = 0.0;
  for (const estimation::MeasuredRun& run : runs) {
    rows += rows_of(run);
  }
  return kRow_s * rows;
}

CalibrationWork::CalibrationWork(std::span<const estimation::MeasuredRun> runs, std::size_t pieces, int threads)
    : piece_count_(static_cast<double>(pieces)), response_s_(usual_s(runs)) {
  constexpr double kRow_s = 8.5e-6;
  const double cores = threads > 0 ? threads : std::max(1U, std::thread::hardware_concurrency());
  double all_rows = 0.0;
  double longest_rows = 0.0;
  for (const estimation::MeasuredRun& run : runs) {
    all_rows += rows_of(run);
    longest_rows = std::max(longest_rows, rows_of(run));
  }
  // Pieces are whole runs, or blocks of the only run, whose fits simulate the whole of it.
  const auto count = static_cast<double>(runs.size());
  const double others_share = count > 1.0 ? 1.0 - 1.0 / count : 1.0;
  all_runs_s_ = kRow_s * std::max(longest_rows, all_rows / cores);
  other_runs_s_ = kRow_s * std::max(longest_rows, others_share * all_rows / cores);
  candidate_s_ = kRow_s * all_rows / cores;
  other_response_s_ = kFromGoodStart_share * piece_count_ * others_share * response_s_;
}

PhaseFits CalibrationWork::fits_of(double to_all_count, double simulations_count, double without_piece_count,
                                   double simulations_without_piece_count) const {
  return {{to_all_count, simulations_count, all_runs_s_}, {without_piece_count, simulations_without_piece_count, other_runs_s_}};
}

PhaseFits CalibrationWork::of_whole_runs(std::size_t starts) const {
  return fits_of(static_cast<double>(starts), kSimulations, piece_count_, kSimulations_without_piece);
}

PhaseFits CalibrationWork::of_extending(std::size_t tested) const {
  const auto count = static_cast<double>(tested);
  return fits_of(count, kSimulations_extended, count * piece_count_, kSimulations_extended_without_piece);
}

PhaseFits CalibrationWork::of_comparing() const { return fits_of(2.0, kSimulations_ordinary, piece_count_, kSimulations_ordinary); }

std::vector<base::JobPhase> CalibrationWork::all(bool refits_turning, std::span<const ExtensionRound> rounds) const {
  constexpr std::size_t kUsualStarts = 3;
  std::vector<base::JobPhase> phases(refits_turning ? 2 : 1, {calibration_phases::kFitting, response_s_, 1.0, kResponse});
  phases.push_back({calibration_phases::kIntervals, 0.3 * response_s_, 1.0, kResponse});
  phases.push_back({calibration_phases::kWholeRuns, of_whole_runs(kUsualStarts).all_s(), 1.0, kSimulation});
  std::ranges::move(after_whole_runs(rounds), std::back_inserter(phases));
  return phases;
}

std::vector<base::JobPhase> CalibrationWork::after_whole_runs(std::span<const ExtensionRound> rounds) const {
  std::vector<base::JobPhase> phases;
  for (const ExtensionRound& round : rounds) {
    phases.push_back({calibration_phases::kScreening, kSimulations_screening * candidate_s_ * static_cast<double>(round.candidates),
                      round.probability, kSimulation});
    phases.push_back({calibration_phases::kExtending, of_extending(round.tested).all_s(), round.probability, kSimulation});
  }
  phases.push_back({calibration_phases::kComparing, of_comparing().all_s(), 1.0, kSimulation});
  phases.push_back({calibration_phases::kLeavingOut, other_response_s_, 1.0, kResponse});
  phases.push_back({calibration_phases::kPredicting, 0.01 * response_s_, 1.0, kResponse});
  return phases;
}

FitCounter::FitCounter(base::Progress progress, const PhaseFits& fits) : progress_(std::move(progress)), fits_(fits) {}

std::function<void()> FitCounter::simulated(const FitWork& fit) {
  if (!progress_) {
    return {};
  }
  return [this, &fit] {
    constexpr double kMore_share = 0.5;
    simulations_count_ += 1.0;
    const double later = std::max(fit.simulations_count - simulations_count_, kMore_share * simulations_count_);
    report(fit.one_s() * simulations_count_ / (simulations_count_ + later));
  };
}

void FitCounter::fitted(const FitWork& fit) {
  done_s_ += fit.one_s();
  simulations_count_ = 0.0;
  report(0.0);
}

void FitCounter::report(double present_s) const {
  constexpr double kUnits = 1e6;
  if (progress_ && fits_.all_s() > 0.0) {
    progress_(static_cast<std::size_t>(std::lround(kUnits * std::min(1.0, (done_s_ + present_s) / fits_.all_s()))),
              static_cast<std::size_t>(kUnits));
  }
}

}  // namespace heatsoak::calibration
