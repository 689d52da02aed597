#include "attribution/selection.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>

#include "attribution/rounds.h"
#include "estimation/free_run_errors.h"
#include "estimation/interval.h"
#include "estimation/left_out_runs.h"
#include "estimation/log_columns.h"
#include "estimation/smoothed_path.h"
#include "estimation/thresholds.h"

namespace heatsoak::attribution {
namespace {

/// Decides which members of the best set get a name, whether a curve is accepted, and whether unknown heat remains.
class Selector : Rounds {
 public:
  using Rounds::Rounds;
  using Names = std::vector<std::size_t>;  ///< places of named members in the best set

  Selection run() {
    decide(run_rounds());
    return std::move(out_);
  }

 private:
  void decide(const Judged& judged) {
    const double sure = estimation::named_probability();
    const EffectSet& best = search_->sets().front();
    std::vector<int> supported;
    Names named;
    for (std::size_t m = 0; m < best.members.size(); ++m) {
      const double probability = probability_of(best, m);
      if (!is_parameter(best.members[m]) && probability > sure && needs_one_run(judged, best, m)) {
        refuse({.id = id_of(best.members[m]), .reason = RefusalReason::one_run_only});
        continue;
      }
      supported.push_back(best.members[m]);
      if (is_parameter(best.members[m])) {
        out_.changed_nats[parameter_of(best.members[m])] = search_->loss_without_nats(best, m);
      } else if (probability > sure) {
        named.push_back(m);
      } else {
        refuse({id_of(best.members[m]), RefusalReason::improbable, probability, sure});
      }
    }
    const estimation::Model with_best = with_members(supported, search_->at_best(supported), ShapesAre::held);
    const estimation::Posterior full =
        estimation::try_posterior_of(with_best, input_.runs, starts_of(with_best), setup_.with(setup_.grid.at(judged.best_place)));
    take_left_heat(std::isfinite(full.evidence_nats) ? full : out_.before);
    const bool is_something_missing = out_.is_material() || out_.nothing_probability < 1.0 - sure;
    if (rules_.scans_regressors && !is_speed_open_ && (is_something_missing || !named.empty())) {
      scan(judged, best);
    }
    input_.progress.begin(selection_phases::kLastFit);
    if (are_runs_as_usual()) {
      out_.is_as_usual = true;
      keep_as_it_is(judged);
      return;
    }
    const std::vector<ScanResult>& scan = out_.rounds.back().scan;
    const double clear_nats = estimation::thresholds().clear_nats;
    if (!scan.empty() && scan.front().gain_nats > clear_nats && estimation::is_confirmed(scan.front().left_out_gain_nats, clear_nats) &&
        // The law of an effect has another shape in every motor. A curve that only corrects it is no further effect.
        (out_.is_material() || named.empty() || beside(scan.front(), named).size() < named.size()) &&
        helps_beside_body(best, beside(scan.front(), named), scan.front())) {
      follow_curve(judged, best, named, scan.front());
      return;
    }
    if (out_.is_material()) {
      keep_what_reduces_error(best, named, estimation::thresholds().beside_unknown_share, RefusalReason::unknown_heat_remains,
                              [&](const Names& names, const Names&) { return error_with_K(best, names); });
      out_.is_unexplained = named.empty();
    }
    keep_what_helps(best, named);
    build(judged, best, named);
  }

  /// Records the unknown heat of a fit, and the heat that would matter in its model.
  void take_left_heat(const estimation::Posterior& fit) {
    const estimation::Thresholds& limits = estimation::thresholds();
    out_.left_W = left_by(fit);
    out_.material_W = std::max({estimation::material_heat_W(fit.fitted, limits.material_K), limits.material_share * out_.mean_heat_W,
                                limits.clearly_other_ratio * input_.usual.flux_W.value_or(0.0)});
  }

  /// Returns the effects of related conditions, see estimation::are_related(), that may replace a member; none for one of all runs.
  [[nodiscard]] std::vector<int> related(const EffectSet& best, std::size_t member) const {
    const estimation::Condition own = condition_of(best.members[member]);
    std::vector<int> others(own.empty() ? 0 : candidates().size());
    std::iota(others.begin(), others.end(), 0);
    std::erase_if(others, [&](int other) {
      return std::ranges::count(best.members, other) > 0 || !estimation::are_related(condition_of(other), own, input_.runs);
    });
    return others;
  }

  [[nodiscard]] double probability_of(const EffectSet& best, std::size_t member) const {
    return search_->family_probability(best, member, related(best, member));
  }

  [[nodiscard]] estimation::Condition condition_of(int member) const {
    return is_parameter(member) ? estimation::Condition{} : candidates()[static_cast<std::size_t>(member)].condition;
  }
  /// True for an effect of all runs that left-out recordings do not confirm.
  [[nodiscard]] bool needs_one_run(const Judged& judged, const EffectSet& best, std::size_t member) const {
    if (!condition_of(best.members[member]).empty()) {
      return false;
    }
    std::vector<int> others = best.members;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(member));
    const Eigen::VectorXd gain_nats = left_out_nats(judged, best.members) - left_out_nats(judged, others);
    return gain_nats.size() > 1 && !estimation::is_confirmed(gain_nats, estimation::thresholds().distinct_nats);
  }

  void refuse(Refusal refusal) {
    if (std::ranges::find(out_.refused, refusal) == out_.refused.end()) {
      out_.refused.push_back(std::move(refusal));
    }
  }

  void scan(const Judged& judged, const EffectSet& best) {
    input_.progress.begin(selection_phases::kCurves);
    constexpr std::size_t kMostReported = 8;
    const estimation::Model base = base_here();
    // With much missing heat, curves depend on smoothed measured temperatures. Multipliers stay those of the model: measurement noise in
    // them would correlate with the residual.
    std::vector<estimation::LinearisedRun> path = judged.fitted;
    for (std::size_t r = 0; out_.is_material() && r < path.size(); ++r) {
      const std::vector<estimation::DesignRun> own =
          estimation::design(now_.model.network, {now_.fitted[r]}, {input_.runs[r]}, {out_.weights[r]}, {}, {});
      path[r].state_C =
          estimation::smoothed_path_C(now_.fitted[r], setup_.grid.at(judged.best_place), own.front().noise).topRows(path[r].states);
    }
    out_.regressors = regressors_of(base, path, input_.runs);
    const ScanInput input{&base,           &input_.runs,
                          &judged.fitted,  &out_.regressors,
                          &judged.designs, estimation::prior_here(base),
                          &set_rules_,     best.members,
                          setup_.grid,     {judged.best_place, judged.empty_place},
                          out_.mean_heat_W};
    out_.rounds.back().scan = scan_regressors(input, rules_, kMostReported);
  }

  /// Returns the names that stay beside a curve.
  [[nodiscard]] static Names beside(const ScanResult& curve, Names named) {
    std::erase_if(named, [&](std::size_t m) { return std::ranges::find(curve.beside, static_cast<int>(m)) == curve.beside.end(); });
    return named;
  }

  /// Beside a body, a curve may imitate further bodies. It must then reduce the error of left-out recordings, as a name must. False for a
  /// curve over time, which no model contains.
  [[nodiscard]] bool helps_beside_body(const EffectSet& best, const Names& stay, const ScanResult& curve) const {
    if (!has_any_body(best, stay) || !estimation::can_leave_out(input_.model, input_.runs)) {
      return true;
    }
    const estimation::Posterior without = fit_with(best, stay, setup_.plain());
    const auto curved = with_curve(without.model, curve, out_.regressors[static_cast<std::size_t>(curve.term.regressor)]);
    if (!curved) {
      return false;
    }
    std::vector<estimation::MeasuredRun> runs = input_.runs;
    estimation::set_columns(runs, curved->columns);
    const estimation::Posterior with = estimation::try_posterior_of(*curved, runs, without.start_C, setup_.plain());
    const double largest_K = estimation::thresholds().better_share * estimation::left_out_error_K(without, runs, setup_.plain());
    return estimation::left_out_error_K(with, runs, setup_.plain(), largest_K) < largest_K;
  }

  /// Replaces the effects that the curve explains better by the curve.
  void follow_curve(const Judged& judged, const EffectSet& best, const Names& named, const ScanResult& curve) {
    Names stay = beside(curve, named);
    for (const std::size_t m : named) {
      if (std::ranges::find(stay, m) == stay.end()) {
        refuse({.id = id_of(best.members[m]),
                .reason = RefusalReason::curve_is_better,
                .signal = out_.regressors[static_cast<std::size_t>(curve.term.regressor)].name});
      }
    }
    keep_what_helps(best, stay);
    build(judged, best, stay, &curve);
    out_.is_unexplained = true;
  }

  [[nodiscard]] double free_run_error_K(const estimation::Model& model) const {
    return estimation::rms_K(estimation::open_loop_errors(model, input_.runs, {}));
  }

  /// Returns the RMS error in K of whole training runs with some members of the best set; ∞ if the fit fails.
  [[nodiscard]] double error_with_K(const EffectSet& best, const Names& members) const {
    std::vector<int> kept;
    std::ranges::transform(members, std::back_inserter(kept), [&](std::size_t m) { return best.members[m]; });
    std::ranges::sort(kept);
    const estimation::Model model = with_members(kept, search_->at_best(kept), ShapesAre::held);
    const estimation::PosteriorOptions options = setup_.with(setup_.grid.at(best_place_));
    estimation::Posterior fit = estimation::try_posterior_of(model, input_.runs, starts_of(model), options);
    // Sensor drift means that the network lacks bodies. Whitened residuals may then not give the most predictive parameters.
    fit = fit.flux.drift_K > 0.0 ? more_predictive(std::move(fit), input_.runs) : std::move(fit);
    return std::isfinite(fit.evidence_nats) ? free_run_error_K(fit.model) : std::numeric_limits<double>::infinity();
  }

  /// True if whole runs decided the file's parameters, and the model predicts these runs about as well as those.
  [[nodiscard]] bool are_runs_as_usual() const {
    return input_.usual.flux_W > 0.0 && input_.usual.error_K &&
           free_run_error_K(input_.model) < estimation::thresholds().clearly_other_ratio * *input_.usual.error_K;
  }

  void keep_as_it_is(const Judged& judged) {
    estimation::PosteriorOptions as_it_is = setup_.with(setup_.grid.at(judged.empty_place));
    as_it_is.most_steps = 0;
    out_.after = estimation::posterior_of(input_.model, input_.runs, starts_of(input_.model), as_it_is);
    out_.after.covariance = input_.model.full_prior().precision.inverse();
    out_.own = out_.after;
  }

  /// Returns the RMS error in K of left-out recordings, by plain fits; ∞ if one fails. Recordings with an own effect of `all` do not count.
  [[nodiscard]] double left_out_error_with_K(const EffectSet& best, const Names& names, const Names& all) const {
    const std::vector<int> kept = kept_members(best, all);
    const estimation::Model usual_in = with_members(kept, search_->at_best(kept), ShapesAre::held);
    return estimation::left_out_error_K(fit_with(best, names, setup_.plain()), input_.runs, setup_.plain(),
                                        std::numeric_limits<double>::infinity(), &usual_in);
  }

  [[nodiscard]] bool has_any_body(const EffectSet& best, const Names& named) const {
    return std::ranges::any_of(named, [&](std::size_t m) { return has_body(best.members[m]); });
  }

  /// Evidence alone is not sufficient in two cases. A calibrated model leaves unknown heat even in the runs it was fitted to. If the
  /// motor has more bodies than the model, an effect may imitate them, and a body several others; bodies must not predict clearly worse.
  void keep_what_helps(const EffectSet& best, Names& named) {
    if (input_.usual.flux_W > 0.0) {
      keep_what_reduces_error(best, named, estimation::thresholds().better_share, RefusalReason::hardly_improves_whole_runs,
                              [&](const Names& names, const Names&) { return error_with_K(best, names); });
    }
    if (has_any_body(best, named) && estimation::can_leave_out(input_.model, input_.runs)) {
      keep_what_reduces_error(
          best, named, estimation::thresholds().better_share, RefusalReason::hardly_improves_whole_runs,
          [&](const Names& names, const Names& all) { return left_out_error_with_K(best, names, all); },
          1.0 / estimation::thresholds().better_share);
    }
  }

  /// Keeps only names without which the error grows to more than 1/`error_share` times its value, for a body 1/`body_share`.
  void keep_what_reduces_error(const EffectSet& best, Names& named, double error_share, RefusalReason why_not,
                               const std::function<double(const Names& names, const Names& all)>& error_K_with,
                               std::optional<double> body_share = {}) {
    // The name with the weakest evidence is examined first, and bodies with an own share last.
    std::ranges::stable_sort(named, std::greater(), [&](std::size_t m) {
      return std::pair(body_share && has_body(best.members[m]), search_->loss_without_nats(best, m));
    });
    double error_K = error_K_with(named, named);
    for (std::size_t i = named.size(); i-- > 0;) {
      const int member = best.members[named[i]];
      // Left-out recordings show nothing about a recording with effects of its own, so these are removed together.
      const estimation::Condition own = condition_of(member);
      Names others = named;
      std::erase_if(others, [&](std::size_t m) { return m == named[i] || (!own.empty() && condition_of(best.members[m]) == own); });
      const double share = has_body(member) ? body_share.value_or(error_share) : error_share;
      if (!(error_K < share * error_K_with(others, named))) {
        refuse({.id = id_of(member), .reason = why_not});
        named.erase(named.begin() + static_cast<std::ptrdiff_t>(i));
        error_K = error_K_with(named, named);
      }
    }
  }

  /// Returns the named members and the changed parameters, ascending.
  [[nodiscard]] std::vector<int> kept_members(const EffectSet& best, const Names& named) const {
    std::vector<int> kept;
    for (std::size_t m = 0; m < best.members.size(); ++m) {
      if (is_parameter(best.members[m]) || std::ranges::find(named, m) != named.end()) {
        kept.push_back(best.members[m]);
      }
    }
    return kept;
  }

  /// Fits the model with the named effects and the changed parameters. The evidence is not finite if the fit fails.
  [[nodiscard]] estimation::Posterior fit_with(const EffectSet& best, const Names& named,
                                               const estimation::PosteriorOptions& options) const {
    const std::vector<int> kept = kept_members(best, named);
    const estimation::Model model = with_members(kept, search_->at_best(kept), ShapesAre::free);
    return estimation::try_posterior_of(model, input_.runs, starts_of(model), options);
  }

  void build(const Judged& judged, const EffectSet& best, Names named, const ScanResult* curve = nullptr) {
    std::ranges::stable_sort(named, std::greater(), [&](std::size_t m) { return search_->loss_without_nats(best, m); });
    out_.terms.clear();
    out_.after = out_.own;
    if (!named.empty()) {
      estimation::Posterior fit = fit_with(best, named, setup_.around(judged.best_place));
      if (std::isfinite(fit.evidence_nats)) {
        const bool decides = fit.flux.drift_K > 0.0 || estimation::can_leave_out(fit.model, input_.runs);
        out_.after = decides ? more_predictive(std::move(fit), input_.runs) : std::move(fit);
        add_terms(best, named, kept_members(best, named));
      } else {
        out_.is_unexplained = true;
        named.clear();
      }
    }
    if (curve && !add_curve(judged, *curve)) {
      return;  // without the heat of the curve, the sizes are not final
    }
    // The effect with the weakest evidence is removed first; without it, the others may have a size.
    if (const auto last = std::find_if(named.rbegin(), named.rend(), [&](std::size_t m) { return has_no_size(best, named, m); });
        last != named.rend()) {
      refuse({.id = id_of(best.members[*last]), .reason = RefusalReason::no_size});
      named.erase(std::next(last).base());
      build(judged, best, std::move(named), curve);
    }
  }

  /// Returns the instances of the kept effects in the model, whose network contains them in the order in which they were added.
  [[nodiscard]] std::map<int, std::string> instances(const estimation::Model& model, const std::vector<int>& kept) const {
    std::map<int, std::string> names;
    std::size_t instance = input_.model.network.effects().size();
    for (const int member : kept) {
      if (!is_parameter(member) && candidates()[static_cast<std::size_t>(member)].type) {
        names[member] = model.network.effects()[instance++].name;
      }
    }
    return names;
  }

  /// True if the final model sets the size to zero, or if zero is in the 95 % interval of an error of a sensor or of single runs.
  [[nodiscard]] bool has_no_size(const EffectSet& best, const Names& named, std::size_t m) const {
    const Candidate& candidate = candidates()[static_cast<std::size_t>(best.members[m])];
    const estimation::Model& model = out_.after.model;
    const Eigen::Index size = size_coordinate(model, candidate, instances(model, kept_members(best, named))[best.members[m]]);
    const double least_share = candidate.type ? 1e-6 : estimation::kInterval_sd * std::sqrt(out_.after.covariance(size, size));
    return model.low(size) <= 0.0 && std::abs(model.theta()[size]) < least_share;
  }

  void add_terms(const EffectSet& best, const Names& named, const std::vector<int>& kept) {
    std::map<int, std::string> names = instances(out_.after.model, kept);
    for (const std::size_t m : named) {
      const int member = best.members[m];
      AcceptedTerm term;
      term.candidate = candidates()[static_cast<std::size_t>(member)];
      term.effect_name = names.contains(member) ? names[member] : "";
      term.probability = probability_of(best, m);
      term.loss_without_nats = search_->loss_without_nats(best, m, related(best, m));
      term.visibility_ratio = search_->visibility_ratio(member);
      for (const int other : search_->stand_ins(best, m, estimation::thresholds().distinct_nats)) {
        if (!is_parameter(other)) {
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

  /// Adds the curve to the answer. Returns whether the model contains it, too: no motor has a law over the time since the start of a log.
  bool add_curve(const Judged& judged, const ScanResult& curve) {
    const Regressor& regressor = out_.regressors[static_cast<std::size_t>(curve.term.regressor)];
    AcceptedTerm term;
    term.curve = curve;
    if (const std::optional<estimation::Model> curved = with_curve(out_.after.model, curve, regressor)) {
      std::vector<estimation::MeasuredRun> runs = input_.runs;
      estimation::set_columns(runs, curved->columns);
      estimation::Posterior fit = estimation::posterior_of(*curved, runs, out_.after.start_C, setup_.around(judged.best_place));
      // With material unknown heat, whitened residuals determine the parameters less well than whole runs.
      if (estimation::can_leave_out(fit.model, runs) || out_.is_material()) {
        fit = more_predictive(std::move(fit), runs);
      }
      term.effect_name = fit.model.network.effects().back().name;
      out_.after = std::move(fit);
    }
    term.loss_without_nats = curve.gain_nats;
    term.probability = 1.0;
    for (const ScanResult& each : out_.rounds.back().scan) {
      const std::string& other = out_.regressors[static_cast<std::size_t>(each.term.regressor)].name;
      if (each.gain_nats > curve.gain_nats - estimation::thresholds().distinct_nats && other != regressor.name &&
          std::ranges::find(term.confusable_with, other) == term.confusable_with.end()) {
        term.confusable_with.push_back(other);
      }
    }
    // The terms are in order of evidence.
    const auto behind =
        std::ranges::find_if(out_.terms, [&](const AcceptedTerm& other) { return other.loss_without_nats < term.loss_without_nats; });
    return !out_.terms.insert(behind, std::move(term))->effect_name.empty();
  }
};

}  // namespace

bool Selection::is_material() const {
  return std::ranges::any_of(left_W, [&](const auto& each) { return each.second > material_W; });
}

Selection select_effects(const SelectionInput& input, const SelectionRules& rules) { return Selector(input, rules).run(); }

}  // namespace heatsoak::attribution
