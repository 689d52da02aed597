#include "identify/attribution/many_starts.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "base/diagnostic.h"
#include "base/random.h"

namespace heatsoak {
namespace {

constexpr int kStarts = 12;
constexpr std::size_t kFollowed = 2;
/// ± of a logarithm that nobody knows: a factor of three.
constexpr double kReach = 1.1;
constexpr double kRoughStep_s = 15.0;
constexpr int kLeastRows = 60;

/// Few rows each: where the valleys lie shows in what changes over minutes.
std::vector<MeasuredRun> rough(const std::vector<MeasuredRun>& runs) {
  std::vector<MeasuredRun> all;
  for (const MeasuredRun& run : runs) {
    const double step_s = (run.time_s.back() - run.time_s.front()) / static_cast<double>(run.at.size());
    const int merged = std::min(static_cast<int>(kRoughStep_s / step_s), static_cast<int>(run.at.size()) / kLeastRows);
    all.push_back(merged > 1 ? thinned(run, merged) : run);
  }
  return all;
}

/// The model's own coordinates first.
std::vector<Eigen::VectorXd> points(const ExtendedModel& model) {
  const Eigen::VectorXd own = model.theta();
  const Prior prior = model.prior();
  std::vector<Eigen::VectorXd> all(kStarts + 1, own);
  Random random(1, 0);
  for (Eigen::Index i = 0; i < own.size(); ++i) {
    const double precision = prior.precision(i, i);
    const double prior_sd = precision > 0.0 ? 1.0 / std::sqrt(precision) : kReach;
    const bool by_log = i < model.model.free_count() && model.model.free[static_cast<std::size_t>(i)].by_log;
    const double reach = by_log ? std::min(kReach, 2.0 * prior_sd) : prior_sd;
    const double low = std::max(model.low(i), prior.mean[i] - reach);
    const double high = std::max(low, std::min(model.high(i), prior.mean[i] + reach));
    std::vector<int> cell(kStarts);
    std::iota(cell.begin(), cell.end(), 0);
    for (std::size_t k = cell.size(); k > 1; --k) {
      std::swap(cell[k - 1], cell[static_cast<std::size_t>(random.uniform() * static_cast<double>(k))]);
    }
    for (std::size_t k = 0; k < cell.size(); ++k) {
      const double share = (cell[k] + random.uniform()) / kStarts;
      all[k + 1][i] = low + share * (high - low);
    }
  }
  return all;
}

}  // namespace

RefitResult refit_from_many(const ExtendedModel& model, const std::vector<MeasuredRun>& runs,
                            const std::vector<std::vector<double>>& start_C, const RefitOptions& options) {
  const std::vector<MeasuredRun> few = rough(runs);
  RefitOptions quick = options;
  quick.merged.clear();
  quick.errors.weights.clear();
  quick.averages_flux = false;
  std::vector<RefitResult> tried;
  for (const Eigen::VectorXd& theta : points(model)) {
    ExtendedModel moved = model;
    moved.set_theta(theta);
    try {
      tried.push_back(refit(std::move(moved), few, start_C, quick));
    } catch (const Failure&) {
      continue;
    }
  }
  std::ranges::stable_sort(tried, [](const RefitResult& a, const RefitResult& b) { return a.evidence_nats > b.evidence_nats; });
  std::optional<RefitResult> best;
  for (std::size_t i = 0; i < std::min(tried.size(), kFollowed); ++i) {
    try {
      RefitResult fit = refit(tried[i].model, runs, tried[i].start_C, options);
      if (!best || fit.evidence_nats > best->evidence_nats) {
        best = std::move(fit);
      }
    } catch (const Failure&) {
      continue;
    }
  }
  return best ? std::move(*best) : refit(model, runs, start_C, options);
}

}  // namespace heatsoak
