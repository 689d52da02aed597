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

// Geometric means and scatter over 40 calibrations with two to four runs, by the training runs of two examinations.
constexpr UsualSimulations kWhole{8.0, 0.1, 0.1};
constexpr UsualSimulations kWhole_without_piece{5.0, 0.1, 0.1};
constexpr UsualSimulations kShort{7.5, 0.25, 0.4};
constexpr UsualSimulations kExtended{8.0, 0.3, 0.3};
constexpr UsualSimulations kExtended_without_piece{7.0, 0.3, 0.3};
constexpr UsualSimulations kOrdinary{6.5, 0.3, 0.1};
// The same calibrations: durations relative to one fit of the response. Half of the intervals are computed at once.
constexpr double kIntervals_share = 0.15;
constexpr double kIntervals_spread = 1.0;
constexpr double kPredicting_share = 0.2;
/// Duration of a fit of the response from a good start, relative to one from several starts.
constexpr double kFromGoodStart_share = 0.85;

/// Returns the expected number of simulations per fit: the mean of the ended fits, in which the usual number counts as one more.
double expected_simulations(const FitWork& usual, double ended_simulations_count, double ended_fits_count) {
  return (usual.simulations.count + ended_simulations_count) / (1.0 + ended_fits_count);
}

/// Work that is left of a phase, with the standard deviation that its unknown numbers of simulations cause.
class LeftWork {
 public:
  /// Adds the fits of a model of one kind. The mean of the calibration lets all of them deviate together.
  void add(double left_s, double expected_sd, double model_sd) {
    left_s_ += left_s;
    together_s_ += left_s * expected_sd;
    of_model_s_ += left_s * model_sd;
  }
  /// Ends the fits of a model; models deviate from the mean independently.
  void end_model() {
    models_s2_ += of_model_s_ * of_model_s_;
    of_model_s_ = 0.0;
  }
  [[nodiscard]] double left_s() const { return left_s_; }
  /// Returns the standard deviation of the logarithm.
  [[nodiscard]] double spread() const {
    return left_s_ > 0.0 ? std::hypot(base::kUsualSpread_sd, std::sqrt(together_s_ * together_s_ + models_s2_) / left_s_)
                         : base::kUsualSpread_sd;
  }

 private:
  double left_s_ = 0.0;
  double together_s_ = 0.0;
  double of_model_s_ = 0.0;
  double models_s2_ = 0.0;
};

/// Reports the finished work of the present phase, and the work that is left.
void report_work(const base::JobProgress& job, const base::Progress& progress, double done_s, const LeftWork& left) {
  constexpr double kUnits = 1e6;
  const double left_s = left.left_s();
  if (progress && done_s + left_s > 0.0) {
    job.resize(done_s + left_s, left.spread());
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

base::JobPhase PhaseFits::phase(const std::string& what, double probability) const {
  LeftWork work;
  for (const double each : cost_ratio) {
    for (const FitWork& fits : {to_all, without_piece}) {
      work.add(each * fits.all_s(), fits.simulations.calibration_sd, fits.simulations.model_sd);
    }
    work.end_model();
  }
  return {what, work.left_s(), probability, kSimulation, work.spread()};
}

PhaseFits CalibrationWork::fits_of(double to_all_count, const UsualSimulations& simulations, double without_piece_count,
                                   const UsualSimulations& simulations_without_piece) const {
  return {{to_all_count, simulations, all_runs_s_}, {without_piece_count, simulations_without_piece, other_runs_s_}};
}

PhaseFits CalibrationWork::of_whole_runs(std::size_t starts) const {
  PhaseFits fits = fits_of(static_cast<double>(starts), kWhole, piece_count_, kWhole_without_piece);
  fits.is_alike = false;
  return fits;
}

PhaseFits CalibrationWork::of_extending(std::vector<double> cost_ratio) const {
  PhaseFits fits = fits_of(1.0, kExtended, piece_count_, kExtended_without_piece);
  fits.cost_ratio = std::move(cost_ratio);
  return fits;
}

PhaseFits CalibrationWork::of_comparing() const { return fits_of(2.0, kOrdinary, piece_count_, kOrdinary); }

FitWork CalibrationWork::of_screening(std::size_t candidates) const { return {static_cast<double>(candidates), kShort, candidate_s_}; }

std::vector<base::JobPhase> CalibrationWork::all(bool refits_turning, std::span<const ExtensionRound> rounds) const {
  constexpr std::size_t kUsualStarts = 3;
  std::vector<base::JobPhase> phases(refits_turning ? 2 : 1, {calibration_phases::kFitting, response_s_, 1.0, kResponse});
  phases.push_back({calibration_phases::kIntervals, kIntervals_share * response_s_, 1.0, kResponse, kIntervals_spread});
  phases.push_back(of_whole_runs(kUsualStarts).phase(calibration_phases::kWholeRuns));
  std::ranges::move(after_whole_runs(rounds), std::back_inserter(phases));
  return phases;
}

std::vector<base::JobPhase> CalibrationWork::after_whole_runs(std::span<const ExtensionRound> rounds) const {
  std::vector<base::JobPhase> phases;
  for (const ExtensionRound& round : rounds) {
    const std::vector<double> usual_costs(round.tested, 1.0);
    const PhaseFits screening{of_screening(1), {}, std::vector<double>(round.candidates, 1.0)};
    phases.push_back(screening.phase(calibration_phases::kScreening, round.probability));
    phases.push_back(of_extending(usual_costs).phase(calibration_phases::kExtending, round.probability));
  }
  phases.push_back(of_comparing().phase(calibration_phases::kComparing));
  phases.push_back({calibration_phases::kLeavingOut, other_response_s_, 1.0, kResponse});
  phases.push_back({calibration_phases::kPredicting, kPredicting_share * response_s_, 1.0, kResponse});
  return phases;
}

FitCounter::FitCounter(const base::JobProgress& job, const std::string& phase, PhaseFits fits)
    : job_(job),
      progress_(job.begin(phase)),
      to_all_{fits.to_all},
      without_piece_{fits.without_piece},
      cost_ratio_(std::move(fits.cost_ratio)),
      is_alike_(fits.is_alike) {
  report();
}

FitCounter::Expected FitCounter::expected(const Count& count) const {
  double ended_simulations_count = count.ended_simulations_count;
  double ended_fits_count = count.ended_fits_count;
  if (is_alike_) {
    const Count& other = &count == &to_all_ ? without_piece_ : to_all_;
    ended_simulations_count += other.ended_simulations_count * count.usual.simulations.count / std::max(1.0, other.usual.simulations.count);
    ended_fits_count += other.ended_fits_count;
  }
  return {expected_simulations(count.usual, ended_simulations_count, ended_fits_count),
          count.usual.simulations.calibration_sd / std::sqrt(1.0 + ended_fits_count)};
}

double FitCounter::Count::left_of_model_s(double expected_count) const {
  const double fits = usual.fits_count - fits_of_model_count;
  if (fits <= 0.0) {
    return 0.0;
  }
  // A fit that needs more simulations than expected is assumed to need half as many again.
  constexpr double kMore_share = 0.5;
  const double left = std::max(expected_count - present_simulations_count, kMore_share * present_simulations_count);
  return (left + (fits - 1.0) * expected_count) * usual.simulation_s;
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
  LeftWork left;
  for (std::size_t model = model_; model < cost_ratio_.size(); ++model) {
    for (const Count* const count : {&to_all_, &without_piece_}) {
      const auto [simulations_count, sd] = expected(*count);
      const double left_s = model == model_ ? count->left_of_model_s(simulations_count) : count->of_model_s(simulations_count);
      left.add(cost_ratio_[model] * left_s, sd, count->usual.simulations.model_sd);
    }
    left.end_model();
  }
  report_work(job_, progress_, done_s_, left);
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
  const double expected_sd = usual_.simulations.calibration_sd / std::sqrt(1.0 + ended_fits_count);
  LeftWork left;
  for (const Count& each : counts_) {
    if (!each.elapsed_s) {
      left.add(std::max(0.0, expected - each.simulations_count) * usual_.simulation_s, expected_sd, usual_.simulations.model_sd);
      left.end_model();
    }
  }
  report_work(job_, progress_, done * usual_.simulation_s, left);
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
