#include "calibration/forecast/forecast.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <optional>

#include "base/parallel.h"
#include "base/random.h"
#include "estimation/thresholds.h"
#include "estimation/turning_rows.h"

namespace heatsoak::calibration {
namespace {

constexpr std::size_t kRefitted = 4;
constexpr int kMostExtensions = 4;
// Shares of 44 calibrations in which a round of extensions takes place, first and after another one.
constexpr double kFirstRound = 0.95;
constexpr double kNextRound = 0.4;
constexpr int kScreeningSteps = 8;
constexpr int kPieceSteps = 12;
/// Largest ratio by which the perturbed starting point differs from the file.
constexpr double kPerturbed_ratio = 1.5;

/// The result is sorted by signal.
SignalErrors errors_of(const PieceScore& score, std::span<const estimation::MeasuredRun> runs) {
  std::map<std::string, std::pair<double, double>> sums;
  for (const PredictedPiece& piece : score.pieces) {
    const estimation::MeasuredRun& run = runs[piece.run];
    for (Eigen::Index row = 0; row < piece.path.residual_K.size(); ++row) {
      if (const double error_K = piece.path.residual_K[row]; !std::isnan(error_K)) {
        auto& [squares_K2, count] = sums[run.sensors[static_cast<std::size_t>(row % piece.path.sensors())].signal];
        squares_K2 += error_K * error_K;
        count += 1.0;
      }
    }
  }
  SignalErrors errors;
  for (const auto& [signal, sum] : sums) {
    errors.emplace_back(signal, std::sqrt(sum.first / sum.second));
  }
  return errors;
}

struct Candidate {
  const Extension* extension = nullptr;
  ForecastSetup setup;
  std::optional<ForecastModel> model;
  ForecastFit fit;
  double gain_nats = -std::numeric_limits<double>::infinity();
  double cost_ratio = 1.0;  ///< duration of a simulation relative to the mean of the candidates
};

/// Returns `round` and those that may follow it: each follows the one before with the same probability. `begun`: rounds before it.
std::vector<ExtensionRound> rounds_from(ExtensionRound round, int begun) {
  std::vector<ExtensionRound> all;
  for (; begun < kMostExtensions; ++begun, round.probability *= kNextRound) {
    all.push_back(round);
  }
  return all;
}

/// Returns the probability that one of the candidates is accepted. In eight calibrations most of those whose short fit gained more than a
/// few nats were, and few of the others.
double acceptance_probability(std::span<const Candidate> candidates) {
  constexpr double kMuch_nats = 3.0;
  double none = 1.0;
  for (const Candidate& each : candidates) {
    none *= each.gain_nats > kMuch_nats ? 0.5 : 0.97;
  }
  return 1.0 - none;
}

class Search {
 public:
  Search(ForecastSetup setup, std::span<const estimation::MeasuredRun> runs, int threads, const base::JobProgress& progress)
      : runs_(runs), threads_(threads), progress_(progress) {
    base_setup_ = std::move(setup);
    out_.setup = base_setup_;
    model_.emplace(out_.setup.model());
  }

  Forecast run(std::span<const Eigen::VectorXd> hints) {
    const CalibrationWork usual(runs_, runs_.size() > 1 ? runs_.size() : kBlocks, threads_);
    FitCounter counter(progress_, calibration_phases::kWholeRuns, usual.of_whole_runs(2 + hints.size()));
    out_.fit = best_of_starts(hints, counter);
    if (!std::isfinite(out_.fit.cost_nats)) {
      out_.source = ForecastSource::file;
      out_.band = usual_band(runs_.front().time_s.back() - runs_.front().time_s.front());
      return std::move(out_);
    }
    base_.emplace(*model_);
    out_.pieces = pieces_of(*model_, out_.fit, runs_);
    const ForecastRules rules = of_piece();
    work_.emplace(runs_, out_.pieces.size(), threads_);
    score_ = score_pieces(*model_, runs_, out_.pieces, out_.fit.theta, &rules, &counter);
    // Quarters of one run share its load: they score, but they choose neither a network nor a fit without priors.
    const bool are_runs = runs_.size() > 1;
    for (int round = 0; are_runs && out_.pieces.size() >= kLeastPieces && round < kMostExtensions && could_gain(score_) && extend(round);
         ++round) {
    }
    progress_.expect(work_->after_whole_runs({}));
    if (out_.pieces.size() >= kLeastToCompare) {
      compare_with_rivals(are_runs);
    }
    set_band();
    return std::move(out_);
  }

 private:
  [[nodiscard]] ForecastRules rules() const { return {.threads = threads_}; }
  /// Fewer steps: a fit to the other pieces starts near its optimum.
  [[nodiscard]] ForecastRules of_piece() const { return {.rounds = 2, .steps = kPieceSteps, .threads = threads_}; }

  [[nodiscard]] ForecastFit fitted_to_all(const ForecastModel& model, const Eigen::VectorXd& theta, ForecastRules rules,
                                          FitCounter& counter) const {
    rules.on_simulation = [&counter] { counter.simulated_all(); };
    ForecastFit fit = fit_forecast(model, runs_, {}, theta, rules);
    counter.fitted_all();
    return fit;
  }

  [[nodiscard]] ForecastFit best_of_starts(std::span<const Eigen::VectorXd> hints, FitCounter& counter) const {
    std::vector<Eigen::VectorXd> starts{model_->start()};
    starts.insert(starts.end(), hints.begin(), hints.end());
    base::Random random(1, 0);
    Eigen::VectorXd perturbed = model_->start();
    for (double& each : perturbed) {
      each += std::log(kPerturbed_ratio) * (2.0 * random.uniform() - 1.0);
    }
    starts.push_back(std::move(perturbed));
    ForecastFit best;
    best.cost_nats = std::numeric_limits<double>::infinity();
    for (const Eigen::VectorXd& start : starts) {
      ForecastFit fit = fitted_to_all(*model_, start, rules(), counter);
      const double weight = std::min(best.weight, fit.weight);
      if (!std::isfinite(best.cost_nats) || (std::isfinite(fit.cost_nats) && cost_at_weight(fit, weight) < cost_at_weight(best, weight))) {
        best = std::move(fit);
      }
    }
    return best;
  }

  /// Cost of `fit` in nats with its own error, which maximises the likelihood, and a common weight: fits with different errors compare.
  static double cost_at_weight(const ForecastFit& fit, double weight) {
    double squares_K2 = 0.0;
    double count = 0.0;
    for (const Eigen::VectorXd& each : fit.residual_K) {
      squares_K2 += each.array().isNaN().select(0.0, each).matrix().squaredNorm();
      count += static_cast<double>((!each.array().isNaN()).count());
    }
    const double prior_nats = fit.cost_nats - 0.5 * fit.weight * squares_K2 / (fit.error_K * fit.error_K);
    return prior_nats + weight * count * std::log(fit.error_K);
  }

  /// False if a score is already as good as that of a network whose error is the sensors' noise.
  [[nodiscard]] bool could_gain(const PieceScore& score) const {
    double least_nats = 0.0;
    double count = 0.0;
    for (const Piece& piece : out_.pieces) {
      for (const estimation::Sensor& sensor : runs_[piece.run].sensors) {
        least_nats += 0.5 * std::log(2.0 * sensor.noise_K * sensor.noise_K);
        count += 1.0;
      }
    }
    return score.score_nats > least_nats / count + kLeastGain_nats;
  }

  /// Accepts the extension that predicts the left-out pieces best, if the gain exceeds the penalty for its parameters.
  bool extend(int round) {
    const std::vector<Extension> all = extensions_for(out_.setup, *model_, out_.fit.theta, runs_);
    const std::size_t refitted = std::min(kRefitted, all.size());
    const ExtensionRound next{all.size(), refitted, kNextRound};
    std::vector<ExtensionRound> rounds = rounds_from(next, round + 1);
    rounds.insert(rounds.begin(), {all.size(), refitted, 1.0});
    progress_.expect(work_->after_whole_runs(rounds));
    std::vector<Candidate> candidates = screened(all);
    std::vector<double> cost_ratio;
    std::transform(candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(refitted), std::back_inserter(cost_ratio),
                   [](const Candidate& each) { return each.cost_ratio; });
    FitCounter counter(progress_, calibration_phases::kExtending, work_->of_extending(std::move(cost_ratio)));
    progress_.expect(work_->after_whole_runs(
        rounds_from({all.size(), refitted, acceptance_probability(std::span(candidates).first(refitted))}, round + 1)));
    Candidate* best = nullptr;
    std::optional<PieceScore> best_score;
    double best_nats = 0.0;
    for (std::size_t i = 0; i < refitted; ++i) {
      Candidate& each = candidates[i];
      each.fit = fitted_to_all(*each.model, each.fit.theta, rules(), counter);
      const ForecastRules rules = of_piece();
      PieceScore score = score_pieces(*each.model, runs_, out_.pieces, each.fit.theta, &rules, &counter);
      counter.ended_model();
      const double gain_nats = score_.score_nats - score.score_nats - kLeastGain_nats * each.extension->free_count;
      if (gain_nats > best_nats && matters(score)) {
        best = &each;
        best_nats = gain_nats;
        best_score = std::move(score);
      }
      // One good candidate decides whether another round follows.
      const double follows =
          best ? (could_gain(*best_score) ? 1.0 : 0.0) : acceptance_probability(std::span(candidates).subspan(i + 1, refitted - 1 - i));
      progress_.expect(work_->after_whole_runs(rounds_from({all.size(), refitted, follows}, round + 1)));
    }
    if (!best) {
      return false;
    }
    out_.accepted.push_back({best->extension->name, score_.score_nats - best_score->score_nats});
    out_.setup = std::move(best->setup);
    out_.fit = std::move(best->fit);
    model_ = std::move(best->model);
    score_ = std::move(*best_score);
    return true;
  }

  /// True if the RMS error of a signal is smaller than now by more than the accuracy of ordinary sensors.
  [[nodiscard]] bool matters(const PieceScore& score) const {
    const SignalErrors before = errors_of(score_, runs_);
    const SignalErrors after = errors_of(score, runs_);
    return std::ranges::any_of(before, [&](const auto& each) {
      const auto same = std::ranges::find(after, each.first, [](const auto& other) { return other.first; });
      return same != after.end() && same->second < each.second - estimation::thresholds().matters_K;
    });
  }

  /// Makes one short fit of each extension with the error and weight of the present fit. Returns the candidates, best first.
  std::vector<Candidate> screened(const std::vector<Extension>& all) const {
    std::vector<Candidate> candidates(all.size());
    const ForecastErrorModel held{out_.fit.error_K, out_.fit.weight};
    ScreeningCounter counter(progress_, work_->of_screening(all.size()));
    base::in_parallel(all.size(), threads_, [&](std::size_t i) {
      const ForecastRules rules{
          .rounds = 1, .steps = kScreeningSteps, .held = held, .threads = 1, .on_simulation = [&counter, i] { counter.simulated(i); }};
      const auto begin = std::chrono::steady_clock::now();
      Candidate& each = candidates[i];
      each.extension = &all[i];
      each.setup = with_extension(out_.setup, all[i]);
      each.model.emplace(each.setup.model());
      each.fit = fit_forecast(*each.model, runs_, {}, carried_over(*model_, out_.fit.theta, *each.model, all[i]), rules);
      each.gain_nats = out_.fit.cost_nats - each.fit.cost_nats - 0.5 * all[i].free_count;
      counter.fitted(i, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    });
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      candidates[i].cost_ratio = counter.cost_ratio(i);
    }
    std::ranges::stable_sort(candidates, std::ranges::greater(), &Candidate::gain_nats);
    return candidates;
  }

  /// Scores file, ordinary least squares and tempered fit. With `chooses` the best of them becomes the result.
  void compare_with_rivals(bool chooses) {
    const ForecastRules ordinary{
        .is_tempered = false, .has_heat_factors = false, .rounds = 2, .steps = 2 * kPieceSteps, .threads = threads_};
    FitCounter counter(progress_, calibration_phases::kComparing, work_->of_comparing());
    const ForecastFit plain = fitted_to_all(*base_, base_->start(), ordinary, counter);
    const ForecastFit near = fitted_to_all(*base_, carried_over(*model_, out_.fit.theta, *base_), ordinary, counter);
    const ForecastFit& best_plain = near.error_K < plain.error_K ? near : plain;
    const PieceScore of_plain = score_pieces(*base_, runs_, out_.pieces, best_plain.theta, &ordinary, &counter);
    const PieceScore of_file = score_pieces(*base_, runs_, out_.pieces, base_->start(), nullptr);
    const auto add = [&](ForecastSource source, const PieceScore& left_out, const ForecastModel& model, const Eigen::VectorXd& theta) {
      out_.rivals.push_back(rival_score(source, left_out, score_pieces(model, runs_, out_.pieces, theta, nullptr), runs_));
    };
    add(ForecastSource::tempered, score_, *model_, out_.fit.theta);
    add(ForecastSource::ordinary, of_plain, *base_, best_plain.theta);
    add(ForecastSource::file, of_file, *base_, base_->start());
    if (!chooses) {
      return;
    }
    // A fit uses more information than the file, so the file must be clearly better.
    const auto handicapped = [](const RivalScore& rival) {
      return rival.score_nats + (rival.source == ForecastSource::file ? kLeastGain_nats : 0.0);
    };
    out_.source = std::ranges::min_element(out_.rivals, {}, handicapped)->source;
    if (out_.source == ForecastSource::tempered) {
      return;
    }
    out_.accepted.clear();
    model_.emplace(*base_);
    out_.setup = base_setup_;
    score_ = out_.source == ForecastSource::ordinary ? of_plain : of_file;
    if (out_.source == ForecastSource::ordinary) {
      out_.fit = best_plain;
    } else {
      out_.fit.theta = base_->start();
      out_.fit.covariance = base_->prior().precision.inverse();
    }
  }

  /// Fits the band. Without left-out pieces it uses the fitted runs, with one degree of freedom, and does not narrow the band.
  void set_band() {
    if (score_.pieces.empty()) {
      for (std::size_t r = 0; r < runs_.size(); ++r) {
        score_.pieces.push_back(predicted_from(*model_, out_.fit.theta, out_.fit.covariance, runs_[r], r, out_.fit.starts[r].state_C));
      }
    }
    out_.band = fit_band(runs_, score_.pieces, std::max<std::size_t>(1, out_.pieces.size()));
    out_.band.width_ratio = out_.pieces.empty() ? std::max(1.0, out_.band.width_ratio) : out_.band.width_ratio;
  }

  std::span<const estimation::MeasuredRun> runs_;
  int threads_;
  const base::JobProgress& progress_;
  std::optional<ForecastModel> model_, base_;
  ForecastSetup base_setup_;
  std::optional<CalibrationWork> work_;
  PieceScore score_;
  Forecast out_;
};

}  // namespace

RivalScore rival_score(ForecastSource source, const PieceScore& left_out, const PieceScore& fitted,
                       std::span<const estimation::MeasuredRun> runs) {
  // Blocks of one run share its load, so that the fitted run says little about others.
  const double weight = runs.size() > 1 ? left_out_weight(left_out.pieces.size()) : 1.0;
  RivalScore rival{source, left_out.score_nats, errors_of(left_out, runs)};
  rival.expected_K = rival.rmse_K;
  if (!std::isfinite(left_out.score_nats)) {
    return rival;
  }
  rival.score_nats = weight * left_out.score_nats + (1.0 - weight) * fitted.score_nats;
  const SignalErrors own = errors_of(fitted, runs);
  for (std::size_t i = 0; i < std::min(own.size(), rival.expected_K.size()); ++i) {
    double& expected_K = rival.expected_K[i].second;
    expected_K = std::hypot(std::sqrt(weight) * expected_K, std::sqrt(1.0 - weight) * own[i].second);
  }
  return rival;
}

std::vector<base::JobPhase> calibration_work(std::span<const estimation::MeasuredRun> runs, int threads) {
  constexpr std::size_t kUsualCandidates = 12;
  const bool are_runs = runs.size() > 1;
  const std::vector<ExtensionRound> rounds =
      runs.size() >= kLeastPieces ? rounds_from({kUsualCandidates, kRefitted, kFirstRound}, 0) : std::vector<ExtensionRound>();
  return CalibrationWork(runs, are_runs ? runs.size() : kBlocks, threads)
      .all(std::ranges::any_of(runs, estimation::may_turn_within_rows), rounds);
}

Forecast forecast_of(ForecastSetup setup, std::span<const estimation::MeasuredRun> runs, std::span<const Eigen::VectorXd> hints,
                     int threads, const base::JobProgress& progress) {
  return Search(std::move(setup), runs, threads, progress).run(hints);
}

}  // namespace heatsoak::calibration
