#include "identify/attribution/trials.h"

#include <algorithm>

#include "identify/attribution/open_loop.h"
#include "identify/attribution/scan_term.h"
#include "identify/attribution/terms.h"

namespace heatsoak {

RefitResult Trials::of_term(const JudgedCandidate& judged, double promised_nats) const {
  const ExtendedModel& model = so_far_.after.model;
  RefitResult fit = from_step({judged.candidate}, {judged.size_share}, judged.step, judged.place);
  // A model that lacks something may have been fitted to where nothing is linear any more.
  if (fit.evidence_nats > so_far_.after.evidence_nats + promised_nats && !has_strayed(model, input_.model)) {
    return fit;
  }
  RefitOptions options = options_;
  options.place = first_place_;
  const double sign = judged.size_share < 0.0 ? -1.0 : 1.0;
  RefitResult afresh =
      try_refit(with_candidate(with_values_of(model, input_.model), judged.candidate, sign), input_.runs, so_far_.before.start_C, options);
  return afresh.evidence_nats > fit.evidence_nats ? std::move(afresh) : std::move(fit);
}

RefitResult Trials::of_set(const SetScore& set, const std::vector<Candidate>& candidates) const {
  std::vector<Candidate> added;
  for (const int candidate : set.candidates) {
    added.push_back(candidates[static_cast<std::size_t>(candidate)]);
  }
  const auto count = static_cast<Eigen::Index>(added.size());
  const Eigen::VectorXd sizes = set.coefficient.tail(count);
  return from_step(added, {sizes.begin(), sizes.end()}, set.coefficient.head(set.coefficient.size() - count), set.place);
}

std::string_view Trials::why_not(const JudgedCandidate& judged, const RefitResult& fit) const {
  // With more evidence a law is a part of the unknown heat whatever it leaves of it.
  constexpr double kClear_nats = 30.0;
  const Candidate& candidate = judged.candidate;
  const int flux = candidate.nodes.empty() ? -1 : flux_of(so_far_.after.model.model, candidate.nodes.front());
  if (fit.evidence_nats - so_far_.after.evidence_nats < kClear_nats && options_.grid.leaves_heat(so_far_.after.place, fit.place, flux)) {
    return kMoreRemains;
  }
  // Errors of sensors have no heat that later effects could put right.
  return candidate.sensor_type && leads_away(so_far_.after.model, fit.model, input_.runs, kMostWorse_ratio)
             ? "the model that has it follows the runs worse"
             : "";
}

RefitResult Trials::from_step(const std::vector<Candidate>& added, const std::vector<double>& size_share, const Eigen::VectorXd& step,
                              const FluxGrid::Place& place) const {
  const ExtendedModel& before = so_far_.after.model;
  RefitOptions options = options_;
  options.place = place;
  ExtendedModel model = before;
  for (std::size_t i = 0; i < added.size(); ++i) {
    model = with_candidate(model, added[i], size_share[i]);
  }
  Eigen::VectorXd theta = model.theta();
  const Eigen::Index inner = before.model.free_count();
  const auto sensors = static_cast<Eigen::Index>(before.sensors.size());
  const auto deviations = static_cast<Eigen::Index>(before.deviations.size());
  theta.head(inner) += step.head(inner);
  theta.segment(model.model.free_count(), sensors) += step.segment(inner, sensors);
  theta.segment(model.first_deviation(), deviations) += step.tail(deviations);
  for (Eigen::Index i = 0; i < theta.size(); ++i) {
    theta[i] = std::clamp(theta[i], model.low(i), model.high(i));
  }
  model.set_theta(theta);
  return try_refit(std::move(model), input_.runs, so_far_.after.start_C, options);
}

}  // namespace heatsoak
