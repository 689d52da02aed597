#include "attribution/rounds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <set>

#include "base/parallel.h"
#include "calibration/motor_model.h"
#include "calibration/unlogged_speed.h"
#include "estimation/left_out_runs.h"
#include "estimation/smoothed_path.h"
#include "estimation/thresholds.h"

namespace heatsoak::attribution {
namespace {

/// Size, in typical sizes, below which an effect has no shape and the column of a sensor error would vanish.
constexpr double kLeast_share = 0.1;

/// Returns the priors and families. Candidates of one type that act only in some runs, or at other nodes than the default, share the prior
/// odds of one effect.
std::vector<CandidateRule> rules_of(const std::vector<Candidate>& candidates, const SelectionRules& rules) {
  const auto group = [](const Candidate& each) {
    if (each.condition.empty()) {
      return each.is_rare() ? fmt::format("{} elsewhere", each.type->name) : each.id;
    }
    return fmt::format("{} in some runs", each.type ? each.type->name : each.deviation_type->name);
  };
  std::map<std::string, int> counts;
  for (const Candidate& each : candidates) {
    ++counts[group(each)];
  }
  std::vector<CandidateRule> all;
  for (const Candidate& each : candidates) {
    CandidateRule rule;
    rule.has_sign = each.size_spec().range.low >= 0.0;
    rule.prior_nats = each.condition.empty() ? rules.inclusion_nats : rules.conditional_nats;
    rule.prior_nats -= std::log(static_cast<double>(counts[group(each)]));
    rule.id = each.id;
    // Offsets of the two sensors have different families: their difference can also be explained by heat.
    rule.family = each.sensor_type ? each.id.substr(0, each.id.rfind('_')) : std::string(each.family());
    for (const auto& [key, value] : each.condition) {
      rule.family += fmt::format(" where {} is {}", key, value);
    }
    all.push_back(std::move(rule));
  }
  return all;
}

/// Returns the coordinates of positive parameters whose prior standard deviation is below that of a value on a data sheet times
/// `well_known_ratio`.
std::vector<Eigen::Index> well_known_values(const estimation::Model& model) {
  std::vector<Eigen::Index> known;
  const Eigen::MatrixXd precision = model.full_prior().precision;
  for (Eigen::Index i = 0; i < model.network_count(); ++i) {
    const double known_sd = estimation::thresholds().well_known_ratio * calibration::kSheet_sd;
    if (precision(i, i) * known_sd * known_sd > 1.0 && model.free[static_cast<std::size_t>(i)].by_log) {
      known.push_back(i);
    }
  }
  return known;
}

}  // namespace

Rounds::Rounds(const SelectionInput& input, const SelectionRules& rules)
    : input_(input), rules_(rules), is_speed_open_(std::ranges::any_of(input.runs, calibration::turns_unseen)) {}

Judged Rounds::run_rounds() {
  input_.progress.begin(selection_phases::kFirstFit);
  begin();
  std::set<std::vector<int>> seen;
  Judged judged;
  for (int round = 0; round < rules_.most_rounds; ++round) {
    input_.progress.begin(selection_phases::kSearching);
    judged = judge();
    best_ = judged.best;
    if (!seen.insert(judged.best).second) {
      break;
    }
    input_.progress.begin(selection_phases::kFollowing);
    follow(judged);
  }
  own_parameters(judged);
  note_sight();
  return judged;
}

void Rounds::begin() {
  estimation::FirstFit first = estimation::first_fit(input_.model, input_.runs, {.starts = 0});
  now_ = std::move(first.fit);
  setup_ = std::move(first.setup);
  out_.weights = setup_.weights;
  out_.mean_heat_W = setup_.mean_heat_W;
  list_ = candidates_for(input_.model, input_.runs);
  if (is_speed_open_) {
    // Heat at the stator may be the loss at the speed that was not logged.
    std::erase_if(list_.candidates, [](const Candidate& each) { return each.type && each.nodes.front() == "stator"; });
  }
  out_.not_judged = list_.not_judged;
  parameters_ = well_known_values(input_.model);
  set_rules_ = rules_of(candidates(), rules_);
  for (const Eigen::Index parameter : parameters_) {
    const std::string name = "parameter " + input_.model.name(parameter);
    set_rules_.push_back({false, rules_.inclusion_nats, name, name});
  }
  bodies_ = candidates_with_body(candidates());
  auto companion = static_cast<int>(set_rules_.size());
  for (const int body : bodies_) {
    CandidateRule& rule = set_rules_[static_cast<std::size_t>(body)];
    rule.companion_sd = rules_.body_start_K;
    for (std::size_t r = 0; r < input_.runs.size(); ++r) {
      rule.companions.push_back(companion++);
    }
  }
  place_ = setup_.grid.middle();
}

Judged Rounds::judge() {
  Judged judged;
  const estimation::Model base = base_here();
  std::vector<estimation::Columns> extra(input_.runs.size());
  judged.fitted.resize(input_.runs.size());
  base::in_parallel(input_.runs.size(), 0, [&](std::size_t r) {
    const estimation::MeasuredRun& run = input_.runs[r];
    judged.fitted[r] = estimation::linearise_along(base, now_.fitted[r].state_C.topRows(base.network.state_count()), run);
    const auto own = static_cast<Eigen::Index>(set_rules_.size());
    const auto bodies = static_cast<Eigen::Index>(bodies_.size());
    const auto runs = static_cast<Eigen::Index>(input_.runs.size());
    extra[r].setZero(judged.fitted[r].residual_K.size(), own + bodies * runs);
    const estimation::Columns columns = candidate_columns(candidates(), base, judged.fitted[r], run);
    const auto count = static_cast<Eigen::Index>(candidates().size());
    extra[r].leftCols(count) = columns.leftCols(count);
    for (Eigen::Index body = 0; body < bodies; ++body) {
      extra[r].col(own + body * runs + static_cast<Eigen::Index>(r)) = columns.col(count + body);
    }
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
      extra[r].col(static_cast<Eigen::Index>(candidates().size() + i)) =
          calibration::kSheet_sd * judged.fitted[r].by_parameter.col(parameters_[i]);
    }
  });
  judged.designs = estimation::design(base.network, judged.fitted, input_.runs, setup_.weights, setup_.merged, extra);
  const estimation::ThetaPrior prior = estimation::prior_here(base);
  judged.empty_place = best_place(judged.designs, prior, {}, place_);
  std::map<estimation::FluxPlace, estimation::Reduced> points;
  add_points(judged.designs, prior, setup_.grid.star(judged.empty_place), points);
  add_points(judged.designs, prior, setup_.grid.all_over(), points);
  if (!best_.empty()) {
    add_points(judged.designs, prior, setup_.grid.star(best_place_), points);
  }
  // The most probable unknown heat with the best set differs from that without effects.
  constexpr int kMostMoves = 3;
  for (int move = 0; move < kMostMoves; ++move) {
    std::vector<estimation::Reduced> all;
    judged.places.clear();
    for (const auto& [place, reduced] : points) {
      judged.places.push_back(place);
      all.push_back(reduced);
    }
    search_.emplace(std::move(all), set_rules_, rules_);
    take_best(judged, prior);
    const std::size_t before = points.size();
    add_points(judged.designs, prior, setup_.grid.star(judged.best_place), points);
    if (points.size() == before) {
      break;
    }
  }
  constexpr std::size_t kMostFits = 6;
  search_->reconsider(
      [&](const std::vector<int>& members, const SetSearch::AtBest& at) {
        const estimation::Model model = with_members(members, at, ShapesAre::free);
        const estimation::PosteriorOptions options = setup_.with(setup_.grid.at(judged.places[at.point]));
        return estimation::try_posterior_of(model, input_.runs, starts_of(model), options).evidence_nats;
      },
      kMostFits);
  take_best(judged, prior);
  place_ = judged.empty_place;
  best_place_ = judged.best_place;
  note();
  return judged;
}

void Rounds::take_best(Judged& judged, const estimation::ThetaPrior& prior) const {
  judged.best = search_->sets().front().members;
  const std::size_t point = search_->at_best(judged.best).point;
  judged.best_place = best_place(judged.designs, prior, judged.best, judged.places[point]);
}

void Rounds::add_points(const std::vector<estimation::DesignRun>& designs, const estimation::ThetaPrior& prior,
                        const std::vector<estimation::FluxPlace>& places,
                        std::map<estimation::FluxPlace, estimation::Reduced>& points) const {
  std::vector<std::pair<const estimation::FluxPlace, estimation::Reduced>*> wanted;
  for (const estimation::FluxPlace& place : places) {
    const auto [entry, is_new] = points.try_emplace(place);
    if (is_new) {
      wanted.push_back(&*entry);
    }
  }
  base::in_parallel(wanted.size(), 0, [&](std::size_t i) {
    wanted[i]->second = estimation::reduced(estimation::products_of(designs, setup_.grid.at(wanted[i]->first), {}), prior);
  });
}

std::pair<SetColumns, std::vector<Eigen::Index>> Rounds::own_columns(const std::vector<int>& members) const {
  SetColumns set = columns_of(members, set_rules_, rules_.size_sd);
  std::vector<Eigen::Index> columns;
  for (Eigen::Index i = 0; i < free_count(); ++i) {
    columns.push_back(i);
  }
  for (Eigen::Index& column : set.columns) {
    columns.push_back(free_count() + column);
    column = static_cast<Eigen::Index>(columns.size()) - 1 - free_count();
  }
  return {std::move(set), std::move(columns)};
}

Eigen::VectorXd Rounds::left_out_nats(const Judged& judged, const std::vector<int>& members) const {
  const auto [set, columns] = own_columns(members);
  std::vector<estimation::Products> parts;
  for (const estimation::DesignRun& design : judged.designs) {
    parts.push_back(estimation::products_of({&design, 1}, setup_.grid.at(judged.best_place), columns));
  }
  return estimation::left_out_nats(estimation::by_recording(parts, input_.runs), estimation::prior_here(base_here()),
                                   [&](const estimation::Reduced& at) { return at.base_nats + set_gain_nats(at, set); });
}

estimation::FluxPlace Rounds::best_place(const std::vector<estimation::DesignRun>& designs, const estimation::ThetaPrior& prior,
                                         const std::vector<int>& members, const estimation::FluxPlace& start) const {
  const auto [set, columns] = own_columns(members);
  return estimation::most_probable(setup_.grid, start, [&](const estimation::FluxPlace& place) {
    const estimation::Reduced own = estimation::reduced(estimation::products_of(designs, setup_.grid.at(place), columns), prior);
    return own.base_nats + set_gain_nats(own, set);
  });
}

estimation::Model Rounds::with_members(const std::vector<int>& members, const SetSearch::AtBest& at, ShapesAre shapes) const {
  estimation::Model model = base_here();
  Eigen::VectorXd theta = model.theta() + at.theta;
  for (std::size_t m = 0; m < members.size(); ++m) {
    if (is_parameter(members[m])) {
      const Eigen::Index parameter = parameter_of(members[m]);
      model.prior.widen(parameter, calibration::kSheet_sd);
      theta[parameter] += calibration::kSheet_sd * at.sizes[static_cast<Eigen::Index>(m)];
    }
  }
  for (Eigen::Index i = 0; i < theta.size(); ++i) {
    theta[i] = std::clamp(theta[i], model.low(i), model.high(i));
  }
  model.set_theta(theta);
  for (std::size_t m = 0; m < members.size(); ++m) {
    if (!is_parameter(members[m])) {
      const Candidate& candidate = candidates()[static_cast<std::size_t>(members[m])];
      model = with_candidate(model, candidate, at.sizes[static_cast<Eigen::Index>(m)], shapes);
    }
  }
  return model;
}

void Rounds::follow(const Judged& judged) {
  const estimation::PosteriorOptions options = setup_.with(setup_.grid.at(judged.best_place));
  // Evidence depends on the shape of a body, so its rivals need a fitted shape, too. The shapes of the best set are taken last.
  std::vector<std::vector<int>> sets = with_other_bodies();
  sets.push_back(judged.best);
  std::vector<estimation::Posterior> fits;
  for (const std::vector<int>& members : sets) {
    const estimation::Model model = with_members(members, search_->at_best(members), ShapesAre::free);
    fits.push_back(estimation::try_posterior_of(model, input_.runs, starts_of(model), options));
  }
  if (!std::isfinite(fits.back().evidence_nats)) {
    return;
  }
  for (std::size_t i = 0; i < sets.size(); ++i) {
    if (std::isfinite(fits[i].evidence_nats)) {
      take_shapes(fits[i].model, sets[i]);
    }
  }
  now_ = std::move(fits.back());
  setup_.screen(now_.fitted, input_.runs);
  out_.weights = setup_.weights;
}

std::vector<std::vector<int>> Rounds::with_other_bodies() const {
  const EffectSet& best = search_->sets().front();
  std::vector<std::vector<int>> sets;
  std::set<std::string> ids;
  for (std::size_t m = 0; m < best.members.size(); ++m) {
    for (const int other : search_->stand_ins(best, m, std::numeric_limits<double>::infinity())) {
      if (has_body(best.members[m]) && has_body(other) && ids.insert(id_of(other)).second) {
        sets.push_back(best.members);
        sets.back()[m] = other;
        std::ranges::sort(sets.back());
      }
    }
  }
  return sets;
}

void Rounds::take_shapes(const estimation::Model& fitted, const std::vector<int>& members) {
  std::size_t instance = input_.model.network.effects().size();
  for (const int member : members) {
    if (is_parameter(member)) {
      continue;
    }
    Candidate& candidate = list_.candidates[static_cast<std::size_t>(member)];
    if (candidate.type) {
      take_shape(fitted, fitted.network.effects()[instance++], candidate);
    } else if (candidate.sensor_type) {
      const double share = fitted.theta()[size_coordinate(fitted, candidate, {})];
      candidate.column_at_share = std::copysign(std::max(kLeast_share, std::abs(share)), share);
    }
  }
}

void Rounds::take_shape(const estimation::Model& fitted, const thermal::EffectInPlace& effect, Candidate& candidate) {
  const auto value_of = [&](std::size_t p) { return fitted.values[static_cast<std::size_t>(effect.parameter_index[p])]; };
  const auto size = static_cast<std::size_t>(candidate.size_parameter());
  const double share = value_of(size) / candidate.typical_size();
  for (std::size_t p = 0; p < candidate.parameters.size(); ++p) {
    const bool is_capacity =
        std::ranges::any_of(candidate.type->nodes, [&](const thermal::NodeRole& role) { return role.own_capacity == static_cast<int>(p); });
    if (p != size && candidate.type->parameters[p].choices.empty() && std::abs(share) > kLeast_share) {
      candidate.parameters[p] = is_capacity ? value_of(p) / share : value_of(p);
    }
  }
}

void Rounds::note() {
  constexpr std::size_t kMostReported = 12;
  Round round;
  for (int j = 0; j < static_cast<int>(candidates().size()); ++j) {
    const double gain_nats = search_->single_gain_nats(j);
    if (gain_nats > 0.0) {
      JudgedCandidate each{candidates()[static_cast<std::size_t>(j)], gain_nats, search_->visibility_ratio(j), 0.0, 0.0};
      each.size_share = search_->at_best({j}).sizes[0];
      for (const EffectSet& set : search_->sets()) {
        each.probability += std::ranges::find(set.members, j) != set.members.end() ? set.probability : 0.0;
      }
      round.ladder.push_back(std::move(each));
    }
  }
  std::ranges::stable_sort(round.ladder, std::greater(), &JudgedCandidate::gain_nats);
  round.ladder.resize(std::min(round.ladder.size(), kMostReported));
  const EffectSet& best = search_->sets().front();
  std::ranges::transform(best.members, std::back_inserter(round.taken), [this](int member) { return id_of(member); });
  const auto empty = std::ranges::find_if(search_->sets(), [](const EffectSet& set) { return set.members.empty(); });
  round.taken_nats = best.log_probability_nats - empty->log_probability_nats;
  out_.nothing_probability = empty->probability;
  out_.rounds.push_back(std::move(round));
}

void Rounds::note_sight() {
  std::map<std::string, double> best_nats;
  for (std::size_t j = 0; j < candidates().size(); ++j) {
    if (candidates()[j].type && candidates()[j].condition.empty()) {
      double& best = best_nats[std::string(candidates()[j].type->name)];
      best = std::max(best, search_->typical_gain_nats(static_cast<int>(j)));
    }
  }
  for (const auto& [name, nats] : best_nats) {
    if (nats < rules_.seen_nats()) {
      out_.unseen.push_back(name);
    }
  }
  out_.seen_share = 1.0 - static_cast<double>(out_.unseen.size()) / std::max(1.0, static_cast<double>(best_nats.size()));
}

estimation::Posterior Rounds::more_predictive(estimation::Posterior fit, const std::vector<estimation::MeasuredRun>& runs) const {
  const estimation::PosteriorOptions whitened = setup_.with(fit.flux);
  return estimation::more_predictive(std::move(fit), runs, whitened, setup_.plain());
}

void Rounds::own_parameters(const Judged& judged) {
  const estimation::Model here = base_here();
  const estimation::PosteriorOptions options = setup_.around(judged.empty_place);
  out_.before = estimation::try_posterior_of(here, input_.runs, starts_of(here), options);
  if (!std::isfinite(out_.before.evidence_nats)) {
    // With the parameters of a fit with effects, the model without them may run away.
    out_.before = estimation::posterior_of(input_.model, input_.runs, starts_of(input_.model), options);
  }
  out_.own = out_.before;
  std::vector<int> doubted;
  std::ranges::copy_if(judged.best, std::back_inserter(doubted), [&](int member) { return is_parameter(member); });
  if (!doubted.empty()) {
    SetSearch::AtBest at = search_->at_best(doubted);
    const auto fit_from = [&] {
      const estimation::Model with_changes = with_members(doubted, at, ShapesAre::held);
      return estimation::try_posterior_of(with_changes, input_.runs, starts_of(with_changes), setup_.around(judged.best_place));
    };
    out_.own = fit_from();
    if (!std::isfinite(out_.own.evidence_nats)) {
      // Without the effects, the linear solution may be far from any plausible temperature.
      at.sizes.setZero();
      at.theta.setZero();
      out_.own = fit_from();
    }
    out_.own = std::isfinite(out_.own.evidence_nats) ? out_.own : out_.before;
  }
  // An effect that is missing here biases the whitened fit even without drift.
  out_.own = more_predictive(std::move(out_.own), input_.runs);
}

std::vector<std::vector<double>> Rounds::starts_of(const estimation::Model& model) const {
  std::vector<std::vector<double>> start_C = now_.start_C;
  for (std::vector<double>& each : start_C) {
    each.resize(std::min(each.size(), static_cast<std::size_t>(model.network.state_count())));
  }
  return start_C;
}

std::map<std::string, double> Rounds::left_by(const estimation::Posterior& fit) const {
  const Eigen::VectorXd rms_W = estimation::rms_W(estimation::smoothed_flux(fit, input_.runs, setup_.weights, setup_.merged));
  std::map<std::string, double> left;
  for (std::size_t f = 0; f < input_.model.flux_nodes.size(); ++f) {
    left[std::string(input_.model.network.node_name(input_.model.flux_nodes[f]))] = rms_W[static_cast<Eigen::Index>(f)];
  }
  return left;
}

}  // namespace heatsoak::attribution
