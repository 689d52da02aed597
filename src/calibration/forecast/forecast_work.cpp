#include "calibration/forecast/forecast_work.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <thread>
#include <utility>

namespace heatsoak::calibration {
namespace {

/// Kinds of work, which differ in the speed of this computer relative to the usual one.
const std::string kResponse = "response";
const std::string kSimulation = "simulation";

// Usual numbers of simulations per fit: geometric means over 56 calibrations with four runs each.
constexpr double kSimulations = 15.0;
constexpr double kSimulations_without_piece = 10.0;
constexpr double kSimulations_screening = 11.0;
constexpr double kSimulations_extended = 20.0;
constexpr double kSimulations_extended_without_piece = 14.0;
constexpr double kSimulations_ordinary = 14.0;
/// Duration of a fit of the response from a good start, relative to one from several starts.
constexpr double kFromGoodStart_share = 0.85;

/// Returns the expected number of simulations per fit: the mean of the ended fits, in which the usual number counts as one more.
double expected_simulations(const FitWork& usual, double ended_simulations_count, double ended_fits_count) {
  return (usual.simulations_count + ended_simulations_count) / (1.0 + ended_fits_count);
}

/// Reports the finished work of the present phase, and the work that is left.
void report_work(const base::JobProgress& job, const base::Progress& progress, double done_s, double left_s) {
  constexpr double kUnits = 1e6;
  if (progress && done_s + left_s > 0.0) {
    job.resize(done_s + left_s);
    progress(static_cast<std::size_t>(std::lround(kUnits * done_s / (done_s + left_s))), static_cast<std::size_t>(kUnits));
  }
}

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

double PhaseFits::all_s() const {
  return (to_all.all_s() + without_piece.all_s()) * std::accumulate(cost_ratio.begin(), cost_ratio.end(), 0.0);
}

PhaseFits CalibrationWork::fits_of(double to_all_count, double simulations_count, double without_piece_count,
                                   double simulations_without_piece_count) const {
  return {{to_all_count, simulations_count, all_runs_s_}, {without_piece_count, simulations_without_piece_count, other_runs_s_}};
}

PhaseFits CalibrationWork::of_whole_runs(std::size_t starts) const {
  return fits_of(static_cast<double>(starts), kSimulations, piece_count_, kSimulations_without_piece);
}

PhaseFits CalibrationWork::of_extending(std::vector<double> cost_ratio) const {
  PhaseFits fits = fits_of(1.0, kSimulations_extended, piece_count_, kSimulations_extended_without_piece);
  fits.cost_ratio = std::move(cost_ratio);
  return fits;
}

PhaseFits CalibrationWork::of_comparing() const { return fits_of(2.0, kSimulations_ordinary, piece_count_, kSimulations_ordinary); }

FitWork CalibrationWork::of_screening(std::size_t candidates) const {
  return {static_cast<double>(candidates), kSimulations_screening, candidate_s_};
}

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
    const std::vector<double> usual_costs(round.tested, 1.0);
    phases.push_back({calibration_phases::kScreening, of_screening(round.candidates).all_s(), round.probability, kSimulation});
    phases.push_back({calibration_phases::kExtending, of_extending(usual_costs).all_s(), round.probability, kSimulation});
  }
  phases.push_back({calibration_phases::kComparing, of_comparing().all_s(), 1.0, kSimulation});
  phases.push_back({calibration_phases::kLeavingOut, other_response_s_, 1.0, kResponse});
  phases.push_back({calibration_phases::kPredicting, 0.01 * response_s_, 1.0, kResponse});
  return phases;
}

FitCounter::FitCounter(const base::JobProgress& job, const std::string& phase, PhaseFits fits)
    : job_(job),
      progress_(job.begin(phase)),
      to_all_{fits.to_all},
      without_piece_{fits.without_piece},
      cost_ratio_(std::move(fits.cost_ratio)) {
  report();
}

double FitCounter::Count::expected() const { return expected_simulations(usual, ended_simulations_count, ended_fits_count); }

double FitCounter::Count::left_of_model_s() const {
  const double fits = usual.fits_count - fits_of_model_count;
  if (fits <= 0.0) {
    return 0.0;
  }
  // A fit that needs more simulations than expected is assumed to need half as many again.
  constexpr double kMore_share = 0.5;
  const double left = std::max(expected() - present_simulations_count, kMore_share * present_simulations_count);
  return (left + (fits - 1.0) * expected()) * usual.simulation_s;
}

void FitCounter::simulated(Count& count) {
  count.present_simulations_count += 1.0;
  done_s_ += cost_ratio_[model_] * count.usual.simulation_s;
  report();
}

void FitCounter::fitted(Count& count) {
  count.ended_fits_count += 1.0;
  count.fits_of_model_count += 1.0;
  count.ended_simulations_count += count.present_simulations_count;
  count.present_simulations_count = 0.0;
  report();
}

void FitCounter::ended_model() {
  model_ = std::min(model_ + 1, cost_ratio_.size() - 1);
  for (Count* const count : {&to_all_, &without_piece_}) {
    count->fits_of_model_count = 0.0;
    count->present_simulations_count = 0.0;
  }
  report();
}

void FitCounter::report() const {
  double left_s = cost_ratio_[model_] * (to_all_.left_of_model_s() + without_piece_.left_of_model_s());
  for (std::size_t later = model_ + 1; later < cost_ratio_.size(); ++later) {
    left_s += cost_ratio_[later] * (to_all_.of_model_s() + without_piece_.of_model_s());
  }
  report_work(job_, progress_, done_s_, left_s);
}

ScreeningCounter::ScreeningCounter(const base::JobProgress& job, const FitWork& fits)
    : job_(job),
      progress_(job.begin(calibration_phases::kScreening)),
      usual_(fits),
      counts_(static_cast<std::size_t>(std::lround(fits.fits_count))) {}

void ScreeningCounter::simulated(std::size_t candidate) {
  const std::lock_guard lock(mutex_);
  counts_[candidate].simulations_count += 1.0;
  double done = 0.0;
  double ended = 0.0;
  double ended_fits_count = 0.0;
  for (const Count& each : counts_) {
    done += each.simulations_count;
    ended += each.elapsed_s ? each.simulations_count : 0.0;
    ended_fits_count += each.elapsed_s ? 1.0 : 0.0;
  }
  const double expected = expected_simulations(usual_, ended, ended_fits_count);
  double left = 0.0;
  for (const Count& each : counts_) {
    left += each.elapsed_s ? 0.0 : std::max(0.0, expected - each.simulations_count);
  }
  report_work(job_, progress_, done * usual_.simulation_s, left * usual_.simulation_s);
}

void ScreeningCounter::fitted(std::size_t candidate, double elapsed_s) {
  const std::lock_guard lock(mutex_);
  counts_[candidate].elapsed_s = elapsed_s;
}

double ScreeningCounter::cost_ratio(std::size_t candidate) const {
  const std::lock_guard lock(mutex_);
  double elapsed_s = 0.0;
  double simulations_count = 0.0;
  for (const Count& each : counts_) {
    elapsed_s += each.elapsed_s.value_or(0.0);
    simulations_count += each.simulations_count;
  }
  const Count& own = counts_[candidate];
  const double expected_s = elapsed_s * own.simulations_count;
  return expected_s > 0.0 ? own.elapsed_s.value_or(0.0) * simulations_count / expected_s : 1.0;
}

}  // namespace heatsoak::calibration
