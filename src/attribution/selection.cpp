#include "attribution/selection.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>

#include "attribution/flux_grid.h"
#include "attribution/mean_heat.h"
#include "attribution/open_loop.h"
#include "attribution/set_search.h"
#include "attribution/terms.h"
#include "base/parallel.h"
#include "identify/averaged_run.h"
#include "identify/calibration/motor_model.h"
#include "identify/calibration/unlogged_speed.h"
#include "identify/log_columns.h"
#include "identify/model_screening.h"
#include "identify/smoothed_path.h"

namespace heatsoak {
namespace {

/// K/W: how far the outermost body that unknown heat may reach is warmed by a heat that is held, mean over the runs.
double steady_rise_K_per_W(const std::vector<LinearisedRun>& runs) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Index x = runs.front().states;
  const Eigen::Index q = runs.front().fluxes;
  Eigen::MatrixXd lost = Eigen::MatrixXd::Zero(x, x);
  Eigen::MatrixXd gained = Eigen::MatrixXd::Zero(x, q);
  for (const LinearisedRun& run : runs) {
    for (Eigen::Index k = 0; k + 1 < run.samples(); ++k) {
      lost += Eigen::MatrixXd::Identity(x, x) - Eigen::Map<const RowMajor>(run.transition.data() + k * x * x, x, x);
      gained += Eigen::Map<const RowMajor>(run.injection.data() + k * x * q, x, q);
    }
  }
  return (lost.colPivHouseholderQr().solve(gained)).colwise().maxCoeff().minCoeff();
}

/// What the search is told of a candidate: those that act in some runs only, or at unusual nodes, share the odds of one effect.
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
    const double kind_nats = each.condition.empty() ? rules.inclusion_nats : rules.conditional_nats;
    rule.prior_nats = kind_nats - std::log(static_cast<double>(counts[group(each)]));
    rule.id = each.id;
    // An offset of one sensor and one of the other differ by heat that both the runs and the figures may have.
    rule.family = each.sensor_type ? each.id.substr(0, each.id.rfind('_')) : std::string(each.family());
    for (const auto& [key, value] : each.condition) {
      rule.family += fmt::format(" where {} is {}", key, value);
    }
    all.push_back(std::move(rule));
  }
  return all;
}

/// A round's linear algebra and what the search makes of it.
struct Judged {
  std::vector<LinearisedRun> fitted;
  std::vector<DesignRun> designs;
  std::vector<FluxPlace> places;
  std::vector<int> best;  ///< members of the best set
  SetSearch::AtBest at_best;
  FluxPlace empty_place;  ///< most probable without any effect
  FluxPlace best_place;
};

class Selector {
 public:
  Selector(const SelectionInput& input, const SelectionRules& rules)
      : input_(input), rules_(rules), is_speed_open_(std::ranges::any_of(input.runs, turns_unseen)) {}

  double evidence_without_effects_nats() {
    begin();
    const std::vector<DesignRun> designs = design(now_.model.model.network, now_.fitted, input_.runs, out_.weights, merged_, {});
    RefitOptions options = final_options(best_place(designs, prior_here(now_.model), {}, place_));
    options.around.clear();
    return refit(now_.model, input_.runs, now_.start_C, options).evidence_nats;
  }

  Selection run() {
    begin();
    std::set<std::vector<int>> seen;
    Judged judged;
    for (int round = 0; round < rules_.most_rounds; ++round) {
      judged = judge();
      const bool repeats = round > 0 && judged.best == best_;
      const bool circles = !seen.insert(judged.best).second;
      best_ = judged.best;
      if (repeats || circles) {
        break;
      }
      follow(judged);
    }
    own_figures(judged);
    note_sight();
    decide(judged);
    return std::move(out_);
  }

 private:
  [[nodiscard]] const std::vector<Candidate>& candidates() const { return list_.candidates; }
  [[nodiscard]] bool is_figure(int member) const { return member >= static_cast<int>(candidates().size()); }
  [[nodiscard]] Eigen::Index figure_of(int member) const { return figures_[static_cast<std::size_t>(member) - candidates().size()]; }
  [[nodiscard]] Eigen::Index free_count() const { return input_.model.free_count(); }

  void begin() {
    out_.mean_heat_W = mean_heat_W(input_.model.model, input_.runs);
    RefitOptions plain;
    plain.white_noise_K = rules_.start_error_K;
    plain.longest_step = rules_.longest_step;
    plain.most_steps = 20;
    plain.flux = {std::vector<double>(input_.model.model.flux_nodes.size(), 0.0), 100.0};
    std::vector<std::vector<double>> start_C;
    std::vector<LinearisedRun> paths;
    for (const MeasuredRun& run : input_.runs) {
      start_C.push_back(measured_start_C(input_.model.model.network, run));
      paths.push_back(linearise(input_.model, start_C.back(), run));
      merged_.push_back(mergeable_samples(paths.back()));
    }
    plain.merged = merged_;
    unit_W_ = rules_.material_K / std::max(1e-6, steady_rise_K_per_W(paths));
    now_ = refit(input_.model, input_.runs, start_C, plain);
    out_.material_W = std::max({unit_W_, rules_.material_share * out_.mean_heat_W, rules_.as_usual_ratio * input_.model.usual_flux_W});
    grid_ = flux_grid(unit_W_, input_.model.model.flux_nodes.size());
    out_.weights = weights_by_model(now_.fitted, input_.runs, unit_W_);
    list_ = candidates_for(input_.model, input_.runs);
    if (is_speed_open_) {
      // Heat at the stator may well be the loss at the speed that nobody logged.
      std::erase_if(list_.candidates, [](const Candidate& each) { return each.type && each.nodes.front() == "stator"; });
    }
    out_.not_judged = list_.not_judged;
    figures_ = well_known_figures(input_.model, kSheet_sd);
    set_rules_ = rules_of(candidates(), rules_);
    for (const Eigen::Index figure : figures_) {
      const std::string name = "figure " + input_.model.model.name(figure);
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
    place_ = grid_.middle();
  }

  /// The base model about the path of the last fit.
  [[nodiscard]] ExtendedModel base_here() const { return with_values_of(input_.model, now_.model); }

  Judged judge() {
    Judged judged;
    const ExtendedModel base = base_here();
    std::vector<Columns> extra(input_.runs.size());
    judged.fitted.resize(input_.runs.size());
    in_parallel(input_.runs.size(), 0, [&](std::size_t r) {
      const MeasuredRun& run = input_.runs[r];
      judged.fitted[r] = linearise_along(base, now_.fitted[r].state_C.topRows(base.model.network.state_count()), run);
      const auto own = static_cast<Eigen::Index>(set_rules_.size());
      const auto bodies = static_cast<Eigen::Index>(bodies_.size());
      const auto runs = static_cast<Eigen::Index>(input_.runs.size());
      extra[r].setZero(judged.fitted[r].residual_K.size(), own + bodies * runs);
      const Columns columns = candidate_columns(candidates(), base, judged.fitted[r], run);
      const auto count = static_cast<Eigen::Index>(candidates().size());
      extra[r].leftCols(count) = columns.leftCols(count);
      for (Eigen::Index body = 0; body < bodies; ++body) {
        extra[r].col(own + body * runs + static_cast<Eigen::Index>(r)) = columns.col(count + body);
      }
      for (std::size_t i = 0; i < figures_.size(); ++i) {
        extra[r].col(static_cast<Eigen::Index>(candidates().size() + i)) = kSheet_sd * judged.fitted[r].by_parameter.col(figures_[i]);
      }
    });
    judged.designs = design(base.model.network, judged.fitted, input_.runs, out_.weights, merged_, extra);
    const ThetaPrior prior = prior_here(base);
    judged.empty_place = best_place(judged.designs, prior, {}, place_);
    std::map<FluxPlace, Reduced> points;
    add_points(judged.designs, prior, grid_.star(judged.empty_place), points);
    if (!best_.empty()) {
      add_points(judged.designs, prior, grid_.star(best_place_), points);
    }
    // The unknown heat beside the best set is not that beside nothing.
    constexpr int kMostMoves = 3;
    for (int move = 0; move < kMostMoves; ++move) {
      std::vector<Reduced> all;
      judged.places.clear();
      for (const auto& [place, reduced] : points) {
        judged.places.push_back(place);
        all.push_back(reduced);
      }
      search_.emplace(std::move(all), set_rules_, rules_);
      judged.best = search_->sets().front().members;
      judged.at_best = search_->at_best(judged.best);
      judged.best_place = best_place(judged.designs, prior, judged.best, judged.places[judged.at_best.point]);
      const std::size_t before = points.size();
      add_points(judged.designs, prior, grid_.star(judged.best_place), points);
      if (points.size() == before) {
        break;
      }
    }
    place_ = judged.empty_place;
    best_place_ = judged.best_place;
    note(judged);
    return judged;
  }

  void add_points(const std::vector<DesignRun>& designs, const ThetaPrior& prior, const std::vector<FluxPlace>& places,
                  std::map<FluxPlace, Reduced>& points) const {
    std::vector<std::pair<const FluxPlace, Reduced>*> wanted;
    for (const FluxPlace& place : places) {
      const auto [entry, is_new] = points.try_emplace(place);
      if (is_new) {
        wanted.push_back(&*entry);
      }
    }
    in_parallel(wanted.size(), 0,
                [&](std::size_t i) { wanted[i]->second = reduced(products_of(designs, grid_.at(wanted[i]->first), {}), prior); });
  }

  [[nodiscard]] FluxPlace best_place(const std::vector<DesignRun>& designs, const ThetaPrior& prior, const std::vector<int>& members,
                                     const FluxPlace& start) const {
    SetColumns set = columns_of(members, set_rules_, rules_.size_sd);
    std::vector<Eigen::Index> columns;
    for (Eigen::Index i = 0; i < free_count(); ++i) {
      columns.push_back(i);
    }
    for (Eigen::Index& column : set.columns) {
      columns.push_back(free_count() + column);
      column = static_cast<Eigen::Index>(columns.size()) - 1 - free_count();
    }
    return most_probable(grid_, start, [&](const FluxPlace& place) {
      const Reduced own = reduced(products_of(designs, grid_.at(place), columns), prior);
      return own.base_nats + set_gain_nats(own, set);
    });
  }

  /// The model with a set of effects, near where the linear algebra has them.
  [[nodiscard]] ExtendedModel with_members(const std::vector<int>& members, const SetSearch::AtBest& at, ShapesAre shapes) const {
    ExtendedModel model = base_here();
    Eigen::VectorXd theta = model.theta() + at.theta;
    for (Eigen::Index i = 0; i < theta.size(); ++i) {
      theta[i] = std::clamp(theta[i], model.low(i), model.high(i));
    }
    model.set_theta(theta);
    for (std::size_t m = 0; m < members.size(); ++m) {
      if (is_figure(members[m])) {
        const Eigen::Index figure = figure_of(members[m]);
        model.model.prior = with_doubt(model.model.prior, figure, kSheet_sd);
        Eigen::VectorXd moved = model.theta();
        moved[figure] =
            std::clamp(moved[figure] + kSheet_sd * at.sizes[static_cast<Eigen::Index>(m)], model.low(figure), model.high(figure));
        model.set_theta(moved);
      }
    }
    for (std::size_t m = 0; m < members.size(); ++m) {
      if (!is_figure(members[m])) {
        const Candidate& candidate = candidates()[static_cast<std::size_t>(members[m])];
        model = with_candidate(model, candidate, at.sizes[static_cast<Eigen::Index>(m)], {}, shapes);
      }
    }
    return model;
  }

  /// Moves the path to the free run of the best set, and the columns of its members to their shapes and sizes.
  void follow(const Judged& judged) {
    RefitOptions options;
    options.flux = grid_.at(judged.best_place);
    options.weights = out_.weights;
    options.merged = merged_;
    RefitResult next = try_refit(with_members(judged.best, judged.at_best, ShapesAre::free), input_.runs, now_.start_C, options);
    if (!std::isfinite(next.evidence_nats)) {
      return;
    }
    now_ = std::move(next);
    std::size_t instance = input_.model.model.network.effects().size();
    for (const int member : judged.best) {
      if (is_figure(member)) {
        continue;
      }
      Candidate& candidate = list_.candidates[static_cast<std::size_t>(member)];
      if (candidate.type) {
        take_shapes(now_.model.model.network.effects()[instance++], candidate);
      } else if (candidate.sensor_type) {
        candidate.column_at_share = away_from_zero(now_.model.theta()[size_coordinate(now_.model, candidate, {})]);
      }
    }
    out_.weights = weights_by_model(now_.fitted, input_.runs, unit_W_);
  }

  static double away_from_zero(double share) {
    constexpr double kLeast_share = 0.1;
    return std::abs(share) < kLeast_share ? std::copysign(kLeast_share, share) : share;
  }

  /// The candidate's exponents, thresholds and time constants as the fit has them; its size stays the typical one.
  void take_shapes(const EffectInPlace& fitted, Candidate& candidate) const {
    const auto value_of = [&](std::size_t p) { return now_.model.model.values[static_cast<std::size_t>(fitted.parameter_index[p])]; };
    const auto size = static_cast<std::size_t>(candidate.size_parameter());
    const double share = away_from_zero(value_of(size) / candidate.typical_size());
    for (std::size_t p = 0; p < candidate.parameters.size(); ++p) {
      const bool is_capacity =
          std::ranges::any_of(candidate.type->nodes, [&](const NodeRole& role) { return role.own_capacity == static_cast<int>(p); });
      if (p != size && candidate.type->parameters[p].choices.empty()) {
        candidate.parameters[p] = is_capacity ? value_of(p) / share : value_of(p);
      }
    }
  }

  void note(const Judged& judged) {
    constexpr std::size_t kTold = 12;
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
    round.ladder.resize(std::min(round.ladder.size(), kTold));
    const EffectSet& best = search_->sets().front();
    for (const int member : best.members) {
      round.taken.push_back(set_rules_[static_cast<std::size_t>(member)].id);
    }
    const auto empty = std::ranges::find_if(search_->sets(), [](const EffectSet& set) { return set.members.empty(); });
    round.taken_nats = best.log_probability_nats - empty->log_probability_nats;
    out_.nothing_probability = empty->probability;
    out_.rounds.push_back(std::move(round));
    (void)judged;
  }

  void note_sight() {
    std::map<std::string, double> best_nats;
    for (std::size_t j = 0; j < candidates().size(); ++j) {
      if (candidates()[j].type && candidates()[j].condition.empty()) {
        double& best = best_nats[std::string(candidates()[j].type->name)];
        best = std::max(best, search_->typical_gain_nats(static_cast<int>(j)));
      }
    }
    for (const auto& [name, nats] : best_nats) {
      if (nats < rules_.seen_nats) {
        out_.unseen.push_back(name);
      }
    }
    const auto all = static_cast<double>(std::max<std::size_t>(1, best_nats.size()));
    out_.seen_share = 1.0 - static_cast<double>(out_.unseen.size()) / all;
  }

  [[nodiscard]] RefitOptions final_options(const FluxPlace& place) const {
    RefitOptions options;
    options.flux = grid_.at(place);
    options.weights = out_.weights;
    options.merged = merged_;
    for (const FluxPlace& each : grid_.star(place)) {
      options.around.push_back(grid_.at(each));
    }
    return options;
  }

  /// The model with nothing added, as the file has it and with doubt in what does not hold.
  void own_figures(const Judged& judged) {
    const ExtendedModel start = base_here();
    out_.before = refit(start, input_.runs, starts_of(start), final_options(judged.empty_place));
    out_.own = out_.before;
    std::vector<int> doubted;
    std::ranges::copy_if(judged.best, std::back_inserter(doubted), [&](int member) { return is_figure(member); });
    if (!doubted.empty()) {
      const ExtendedModel with_doubts = with_members(doubted, search_->at_best(doubted), ShapesAre::held);
      out_.own = refit(with_doubts, input_.runs, starts_of(with_doubts), final_options(judged.best_place));
    }
  }

  /// Of the last fit; nodes that it does not have begin at the ambient temperature.
  [[nodiscard]] std::vector<std::vector<double>> starts_of(const ExtendedModel& model) const {
    std::vector<std::vector<double>> start_C = now_.start_C;
    for (std::vector<double>& each : start_C) {
      each.resize(std::min(each.size(), static_cast<std::size_t>(model.model.network.state_count())));
    }
    return start_C;
  }

  /// Root mean square of what a fit leaves, by node.
  [[nodiscard]] std::map<std::string, double> left_by(const RefitResult& fit) const {
    std::vector<Eigen::VectorXd> squares(input_.runs.size());
    const std::vector<DesignRun> designs = design(fit.model.model.network, fit.fitted, input_.runs, out_.weights, merged_, {});
    in_parallel(designs.size(), 0, [&](std::size_t r) {
      const DesignRun& one = designs[r];
      squares[r] = Whitening(one.run, fit.flux, one.noise).smoothed_flux(one.run.residual_K).mean_W.rowwise().squaredNorm();
    });
    std::map<std::string, double> left;
    for (std::size_t f = 0; f < input_.model.model.flux_nodes.size(); ++f) {
      double sum = 0.0;
      double count = 0.0;
      for (std::size_t r = 0; r < designs.size(); ++r) {
        sum += squares[r][static_cast<Eigen::Index>(f)];
        count += static_cast<double>(designs[r].run.samples());
      }
      left[std::string(input_.model.model.network.node_name(input_.model.model.flux_nodes[f]))] = std::sqrt(sum / count);
    }
    return left;
  }

  void decide(const Judged& judged) {
    const EffectSet& best = search_->sets().front();
    RefitOptions options = final_options(judged.best_place);
    options.around.clear();
    const ExtendedModel with_best = with_members(best.members, judged.at_best, ShapesAre::held);
    const RefitResult full = try_refit(with_best, input_.runs, starts_of(with_best), options);
    out_.left_W = left_by(std::isfinite(full.evidence_nats) ? full : out_.before);
    std::vector<std::size_t> named;
    for (std::size_t m = 0; m < best.members.size(); ++m) {
      const double probability = search_->family_probability(best, m);
      if (is_figure(best.members[m])) {
        add_changed(best, m);
      } else if (probability > rules_.named_probability) {
        named.push_back(m);
      } else {
        refuse(best.members[m], fmt::format("its probability is {:.0f} %, and a name needs {:.0f} %", 100.0 * probability,
                                            100.0 * rules_.named_probability));
      }
    }
    if (rules_.scans_drivers && !is_speed_open_ && (out_.is_material() || !named.empty())) {
      scan(judged, best);
    }
    weigh_curve(best, named);
    if (input_.model.usual_flux_W > 0.0) {
      keep_what_helps(best, named);
    }
    std::ranges::stable_sort(named, std::greater(), [&](std::size_t m) { return search_->loss_without_nats(best, m); });
    build(judged, best, named);
  }

  void refuse(int member, const std::string& why) {
    const std::string& id = set_rules_[static_cast<std::size_t>(member)].id;
    out_.refused.push_back({id, fmt::format("{}: {}", id, why)});
  }

  void add_changed(const EffectSet& best, std::size_t place) {
    const Eigen::Index coordinate = figure_of(best.members[place]);
    const FreeParameter& free = input_.model.model.free[static_cast<std::size_t>(coordinate)];
    const NetworkParameter& parameter = input_.model.model.network.parameters()[static_cast<std::size_t>(free.place)];
    ChangedFigure figure;
    figure.coordinate = coordinate;
    figure.name = parameter.name;
    figure.unit = parameter.unit;
    figure.gain_nats = search_->loss_without_nats(best, place);
    out_.changed.push_back(std::move(figure));
  }

  void scan(const Judged& judged, const EffectSet& best) {
    constexpr std::size_t kTold = 8;
    const ExtendedModel base = base_here();
    // Where the model is far off, curves are drawn over temperatures as they were measured, smoothed. What heat is multiplied with stays
    // the model's: noise in it would be that of the residual.
    std::vector<LinearisedRun> path = judged.fitted;
    for (std::size_t r = 0; out_.is_material() && r < path.size(); ++r) {
      const std::vector<DesignRun> own = design(now_.model.model.network, {now_.fitted[r]}, {input_.runs[r]}, {out_.weights[r]}, {}, {});
      path[r].state_C = smoothed_path_C(now_.fitted[r], grid_.at(judged.best_place), own.front().noise).topRows(path[r].states);
    }
    out_.drivers = drivers_of(base.model, path, input_.runs);
    ScanInput input{&base.model,
                    &input_.runs,
                    &judged.fitted,
                    &out_.drivers,
                    &judged.designs,
                    prior_here(base),
                    {},
                    grid_,
                    {judged.best_place, judged.empty_place},
                    out_.mean_heat_W};
    input.members.size_sd = rules_.size_sd;
    input.members.companion_sd = rules_.body_start_K;
    for (const int member : best.members) {
      for (const int companion : set_rules_[static_cast<std::size_t>(member)].companions) {
        input.members.companions.push_back(free_count() + companion);
      }
      input.members.columns.push_back(free_count() + member);
      input.members.has_sign.push_back(set_rules_[static_cast<std::size_t>(member)].has_sign);
      input.members.prior_nats.push_back(set_rules_[static_cast<std::size_t>(member)].prior_nats);
    }
    out_.rounds.back().scan = scan_drivers(input, rules_, kTold);
  }

  /// Whether heat remains that no effect is, whether a curve is it, and which names a curve takes away.
  void weigh_curve(const EffectSet& best, std::vector<std::size_t>& named) {
    const std::vector<ScanResult>& scan = out_.rounds.back().scan;
    const bool has_curve = !scan.empty() && scan.front().gain_nats > rules_.curve_gain_nats;
    if (!has_curve) {
      out_.is_unexplained = out_.is_material();
      for (const std::size_t m : out_.is_unexplained ? named : std::vector<std::size_t>()) {
        refuse(best.members[m], "more heat remains than what every model leaves");
      }
      named.resize(out_.is_unexplained ? 0 : named.size());
      return;
    }
    const ScanResult& curve = scan.front();
    for (std::size_t m = 0; m < best.members.size(); ++m) {
      const double share = curve.gain_nats / (curve.gain_nats + search_->loss_without_nats(best, m));
      // Another shape of the same effect is that effect.
      if (!is_figure(best.members[m]) && curve.shape_ratio[m] > rules_.same_shape_ratio && share < rules_.same_shape_share) {
        if (std::ranges::find(named, m) == named.end()) {
          named.push_back(m);
        }
        return;
      }
    }
    std::erase_if(named, [&](std::size_t m) {
      const bool goes = std::ranges::find(curve.beside, static_cast<int>(m)) == curve.beside.end();
      if (goes) {
        refuse(best.members[m],
               fmt::format("a curve over {} explains the runs better", out_.drivers[static_cast<std::size_t>(curve.term.driver)].name));
      }
      return goes;
    });
    out_.is_unexplained = true;
    out_.open_curve = curve;
  }

  [[nodiscard]] double free_run_error_K(const ExtendedModel& model) const { return rms_K(open_loop_errors(model, input_.runs, {})); }

  /// What a calibrated model leaves of the runs at once it left of the runs that it was fitted to as well: a name must let whole runs be
  /// followed plainly better, and where whole runs decided the file's figures, runs that are followed as usual show nothing.
  void keep_what_helps(const EffectSet& best, std::vector<std::size_t>& named) {
    if (input_.model.usual_error_K > 0.0 && free_run_error_K(input_.model) < rules_.as_usual_ratio * input_.model.usual_error_K) {
      named.clear();
      out_.open_curve.reset();
      out_.is_unexplained = false;
      out_.is_as_usual = true;
      return;
    }
    const auto error_with_K = [&](const std::vector<std::size_t>& members) {
      std::vector<int> kept;
      std::ranges::transform(members, std::back_inserter(kept), [&](std::size_t m) { return best.members[m]; });
      std::ranges::sort(kept);
      const SetSearch::AtBest at = search_->at_best(kept);
      const ExtendedModel model = with_members(kept, at, ShapesAre::held);
      RefitOptions options = final_options(best_place_);
      options.around.clear();
      const RefitResult fit = try_refit(model, input_.runs, starts_of(model), options);
      return std::isfinite(fit.evidence_nats) ? free_run_error_K(fit.model) : std::numeric_limits<double>::infinity();
    };
    // The surest stays longest.
    std::ranges::stable_sort(named, std::greater(), [&](std::size_t m) { return search_->loss_without_nats(best, m); });
    for (std::size_t i = named.size(); i-- > 0;) {
      std::vector<std::size_t> others = named;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
      const double better_share = input_.model.usual_error_K > 0.0 ? rules_.plainly_better_share : rules_.better_share;
      if (error_with_K(named) > better_share * error_with_K(others)) {
        refuse(best.members[named[i]], "whole runs are followed hardly better with it");
        named = std::move(others);
      }
    }
  }

  void build(const Judged& judged, const EffectSet& best, const std::vector<std::size_t>& named) {
    std::vector<int> kept;
    for (std::size_t m = 0; m < best.members.size(); ++m) {
      if (is_figure(best.members[m]) || std::ranges::find(named, m) != named.end()) {
        kept.push_back(best.members[m]);
      }
    }
    out_.after = out_.own;
    if (out_.is_as_usual) {
      RefitOptions as_it_is = final_options(judged.empty_place);
      as_it_is.most_steps = 0;
      as_it_is.around.clear();
      out_.after = out_.own = refit(input_.model, input_.runs, starts_of(input_.model), as_it_is);
      out_.after.covariance = input_.model.prior().precision.inverse();
    } else if (!named.empty()) {
      const SetSearch::AtBest at = search_->at_best(kept);
      const ExtendedModel model = with_members(kept, at, ShapesAre::free);
      RefitResult fit = try_refit(model, input_.runs, starts_of(model), final_options(judged.best_place));
      if (!std::isfinite(fit.evidence_nats)) {
        out_.is_unexplained = true;
        return;
      }
      out_.after = std::move(fit);
      add_terms(best, named, kept);
    }
    if (out_.open_curve && !adopt_curve(judged)) {
      // A part of what is missing foretells no better than the model without it.
      for (const AcceptedTerm& term : out_.terms) {
        out_.refused.push_back({term.candidate->id, fmt::format("{}: more heat remains than what every model leaves", term.candidate->id)});
      }
      out_.terms.clear();
      out_.after = out_.own;
    }
  }

  void add_terms(const EffectSet& best, const std::vector<std::size_t>& named, const std::vector<int>& kept) {
    constexpr double kAmbiguous_nats = 5.0;
    // Instances stand in the network in the order in which they were added.
    const std::size_t first = input_.model.model.network.effects().size();
    std::map<int, std::string> names;
    std::size_t instance = first;
    for (const int member : kept) {
      if (!is_figure(member) && candidates()[static_cast<std::size_t>(member)].type) {
        names[member] = out_.after.model.model.network.effects()[instance++].name;
      }
    }
    for (const std::size_t m : named) {
      const int member = best.members[m];
      AcceptedTerm term;
      term.candidate = candidates()[static_cast<std::size_t>(member)];
      term.effect_name = names.contains(member) ? names[member] : "";
      term.probability = search_->family_probability(best, m);
      term.loss_without_nats = search_->loss_without_nats(best, m);
      term.visibility_ratio = search_->visibility_ratio(member);
      for (const int other : search_->stand_ins(best, m, kAmbiguous_nats)) {
        if (!is_figure(other)) {
          const Candidate& rival = candidates()[static_cast<std::size_t>(other)];
          if (std::ranges::find(term.confusable_with, rival.id) == term.confusable_with.end()) {
            term.confusable_with.push_back(rival.id);
            term.experiments.emplace_back(rival.experiment());
          }
        }
      }
      out_.terms.push_back(std::move(term));
    }
  }

  /// The model follows a curve where that foretells training runs that the fit did not see.
  bool adopt_curve(const Judged& judged) {
    const Driver& driver = out_.drivers[static_cast<std::size_t>(out_.open_curve->term.driver)];
    const std::optional<ExtendedModel> curved = with_curve(out_.after.model, *out_.open_curve, driver);
    if (!curved || input_.runs.size() < 2 || driver.name == kTimeDriver) {
      return false;
    }
    std::vector<MeasuredRun> runs = input_.runs;
    set_column(runs, curved->column);
    RefitOptions options = final_options(judged.best_place);
    options.around.clear();
    double without_K2 = 0.0;
    double with_K2 = 0.0;
    for (std::size_t left_out = 0; left_out < runs.size(); ++left_out) {
      const auto error_K2 = [&](const ExtendedModel& model, const LatentFlux& flux) {
        std::vector<MeasuredRun> others;
        std::vector<std::vector<double>> start_C;
        RefitOptions own;
        own.flux = flux;
        for (std::size_t r = 0; r < runs.size(); ++r) {
          if (r != left_out) {
            others.push_back(runs[r]);
            start_C.push_back(out_.after.start_C[r]);
            own.weights.push_back(out_.weights[r]);
            own.merged.push_back(merged_[r]);
          }
        }
        const RefitResult fit = try_refit(model, others, start_C, own);
        return std::isfinite(fit.evidence_nats) ? std::pow(rms_K(open_loop_errors(fit.model, {runs[left_out]}, others)), 2)
                                                : std::numeric_limits<double>::infinity();
      };
      without_K2 += error_K2(out_.after.model, out_.after.flux);
      with_K2 += error_K2(*curved, options.flux);
    }
    if (!(with_K2 < without_K2)) {
      return false;
    }
    RefitResult fit = try_refit(*curved, runs, out_.after.start_C, final_options(judged.best_place));
    if (!std::isfinite(fit.evidence_nats)) {
      return false;
    }
    AcceptedTerm term;
    term.curve = out_.open_curve;
    term.effect_name = fit.model.model.network.effects().back().name;
    term.loss_without_nats = out_.open_curve->gain_nats;
    term.probability = 1.0;
    for (const ScanResult& each : out_.rounds.back().scan) {
      constexpr double kAmbiguous_nats = 5.0;
      const std::string& other = out_.drivers[static_cast<std::size_t>(each.term.driver)].name;
      if (each.gain_nats > out_.open_curve->gain_nats - kAmbiguous_nats && other != driver.name &&
          std::ranges::find(term.confusable_with, other) == term.confusable_with.end()) {
        term.confusable_with.push_back(other);
      }
    }
    out_.after = std::move(fit);
    // In the order of their evidence.
    const auto behind =
        std::ranges::find_if(out_.terms, [&](const AcceptedTerm& other) { return other.loss_without_nats < term.loss_without_nats; });
    out_.terms.insert(behind, std::move(term));
    out_.open_curve.reset();
    return true;
  }

  const SelectionInput& input_;
  const SelectionRules& rules_;
  bool is_speed_open_;  ///< heat at the stator then may well be the loss at the speed that nobody logged
  Selection out_;
  RefitResult now_;  ///< the fit whose path the equations are linearised about
  std::vector<int> merged_;
  double unit_W_ = 0.0;  ///< of unknown heat
  FluxGrid grid_;
  FluxPlace place_, best_place_;
  CandidateList list_;
  std::vector<Eigen::Index> figures_;
  std::vector<CandidateRule> set_rules_;
  std::vector<int> bodies_;  ///< candidates with a body of their own
  std::vector<int> best_;
  std::optional<SetSearch> search_;
};

}  // namespace

bool Selection::is_material() const {
  return std::ranges::any_of(left_W, [&](const auto& each) { return each.second > material_W; });
}

double evidence_without_effects_nats(const SelectionInput& input) {
  const SelectionRules rules;
  return Selector(input, rules).evidence_without_effects_nats();
}

Selection select_effects(const SelectionInput& input, const SelectionRules& rules) { return Selector(input, rules).run(); }

}  // namespace heatsoak
