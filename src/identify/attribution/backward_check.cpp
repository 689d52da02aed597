#include "identify/attribution/backward_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "base/parallel.h"
#include "base/quantity.h"
#include "identify/attribution/mean_heat.h"
#include "identify/attribution/open_loop.h"
#include "identify/attribution/terms.h"
#include "identify/attribution/uneven_bodies.h"
#include "identify/interval.h"

namespace heatsoak {
namespace {

/// How much the free-running error on the training runs may grow by the mean over what is probable of unknown heat.
constexpr double kMostMoved_ratio = 1.5;

/// What a law has to be ahead of another to take its place.
constexpr double kSwap_nats = 1.0;

/// Names of nodes that a term reaches or watches besides those it brings itself.
std::vector<std::string> nodes_of(const AcceptedTerm& term, const std::vector<Driver>& drivers) {
  if (term.curve) {
    const Driver& driver = drivers[static_cast<std::size_t>(term.curve->term.driver)];
    return {term.curve->term.node, term.curve->term.other, driver.watched, driver.reference};
  }
  std::vector<std::string> nodes;
  for (std::size_t role = 0; role < term.candidate->nodes.size(); ++role) {
    if (term.candidate->type->nodes[role].own_capacity < 0) {
      nodes.push_back(term.candidate->nodes[role]);
    }
  }
  return nodes;
}

class BackwardCheck {
 public:
  BackwardCheck(Selection& selection, const SelectionInput& input, const SelectionRules& rules, RefitOptions options)
      : out_(selection), input_(input), rules_(rules), options_(std::move(options)) {}

  void run() {
    const bool had_terms = !out_.terms.empty();
    while (drops_superfluous() || drops_doubt() || drops_invisible() || drops_negligible() || drops_idle() || swaps_for_rival()) {
      has_dropped_ = true;
    }
    drop_refused();
    if (had_terms) {
      goes_back();
    }
  }

  void settle() {
    RefitResult averaged = averaged_fit();
    while (drops_unsettled(averaged)) {
      if (goes_back()) {
        return;
      }
      averaged = averaged_fit();
    }
    if (leads_away(out_.after.model, averaged.model, input_.runs, kMostMoved_ratio)) {
      out_.after.covariance = std::move(averaged.covariance);
    } else {
      out_.after = std::move(averaged);
    }
  }

 private:
  /// With nothing left of what was found the model is what it was before; false where something is.
  bool goes_back() {
    if (!out_.terms.empty() || !out_.changed.empty()) {
      return false;
    }
    out_.after = out_.before;
    return true;
  }

  /// False where none is.
  bool drops_superfluous() {
    for (std::size_t i = out_.terms.size(); i-- > 0;) {
      if (i + 1 == out_.terms.size() && !has_dropped_ && !out_.terms[i].is_of_set) {
        // Without the last one the model is what it was a round before.
        out_.terms[i].loss_without_nats = out_.terms[i].gain_nats;
        continue;
      }
      const std::vector<bool> stays = all_but(i);
      RefitResult without = refit_with(stays);
      out_.terms[i].loss_without_nats = out_.after.evidence_nats - without.evidence_nats;
      const auto dropped = static_cast<double>(std::ranges::count(stays, false));
      if (out_.terms[i].loss_without_nats < dropped * rules_.least_gain_nats) {
        if (out_.terms[i].candidate && drops_shape_of(i)) {
          return true;
        }
        keep(stays, std::move(without));
        return true;
      }
    }
    return false;
  }

  /// A figure was doubted while what is found now was not there.
  bool drops_doubt() {
    for (std::size_t i = 0; i < out_.changed.size() && !out_.terms.empty(); ++i) {
      std::vector<ChangedFigure> others = out_.changed;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
      const Prior doubted = out_.base.model.prior;
      out_.base.model.prior = input_.model.model.prior;
      for (const ChangedFigure& other : others) {
        out_.base.model.prior = with_doubt(out_.base.model.prior, other.coordinate);
      }
      RefitResult sure = refit_with(std::vector<bool>(out_.terms.size(), true));
      if (out_.after.evidence_nats - sure.evidence_nats < rules_.least_gain_nats) {
        out_.after = std::move(sure);
        out_.changed = std::move(others);
        return true;
      }
      out_.base.model.prior = doubted;
    }
    return false;
  }

  template <class Counts>
  [[nodiscard]] double gain_nats(const Counts& counts) const {
    return std::accumulate(out_.terms.begin(), out_.terms.end(), 0.0,
                           [&](double sum, const AcceptedTerm& term) { return sum + (counts(term) ? term.gain_nats : 0.0); });
  }

  /// What nobody would miss: every law is a little wrong, and perfect data see that.
  bool drops_negligible() {
    for (std::size_t i = 0; i < out_.terms.size(); ++i) {
      const AcceptedTerm& term = out_.terms[i];
      if (const std::string why = why_negligible(term); !why.empty()) {
        out_.refuse(term.candidate->id, term.loss_without_nats, why, true);
        const std::vector<bool> stays = all_but(i);
        keep(stays, refit_with(stays));
        return true;
      }
    }
    return false;
  }

  RefitResult averaged_fit() {
    options_.place = out_.after.place;
    options_.averages_flux = true;
    // What were slow errors of sensors to a model that lacked something are less now.
    options_.errors = wander_at(out_.after, input_.runs, options_.grid, options_.merged, options_.errors);
    return refit(out_.after.model, input_.runs, out_.after.start_C, options_);
  }

  /// Beside all that sensors and bodies may do little is left of the term, or it may as well be nothing.
  [[nodiscard]] bool is_unsettled(const AcceptedTerm& term, const RefitResult& averaged) const {
    constexpr double kSettled_share = 0.8;
    constexpr double kNothing_share = 0.01;
    const bool is_little = term.loss_without_nats < rules_.least_gain_nats;
    // Uneven bodies take nats from every law, and leave the size of those that are right.
    const bool is_law = term.candidate && term.candidate->type;
    if (!term.candidate || (is_little && !is_law)) {
      return is_little;
    }
    const Eigen::Index own = size_coordinate(averaged.model, *term.candidate, term.effect_name);
    const double size = std::abs(averaged.model.theta()[own]);
    const bool gives_way = size < kSettled_share * std::abs(out_.after.model.theta()[own]);
    // At a bound nothing seems uncertain, and nothing is there.
    const bool is_nothing = size < kNothing_share * std::abs(out_.after.model.theta()[own]);
    const bool is_better_without = term.loss_without_nats < 0.0;
    return (gives_way && is_little) || is_nothing || is_better_without || size < kInterval_sd * std::sqrt(averaged.covariance(own, own)) ||
           !why_small_fault(term, averaged.model).empty();
  }

  /// Of those that are unsettled the one of least evidence.
  bool drops_unsettled(const RefitResult& averaged) {
    std::size_t least = out_.terms.size();
    for (std::size_t i = 0; i < out_.terms.size(); ++i) {
      out_.terms[i].loss_without_nats = averaged.evidence_nats - refit_with(all_but(i)).evidence_nats;
      if (is_unsettled(out_.terms[i], averaged) &&
          (least == out_.terms.size() || out_.terms[i].loss_without_nats < out_.terms[least].loss_without_nats)) {
        least = i;
      }
    }
    if (least == out_.terms.size()) {
      return false;
    }
    const AcceptedTerm& term = out_.terms[least];
    out_.refuse(term.what(out_.drivers), term.gain_nats,
                fmt::format("bodies that are uneven by {:.1f} % and what else sensors do could be it", 100.0 * kUneven_share), true);
    options_.averages_flux = false;
    const std::vector<bool> stays = all_but(least);
    keep(stays, refit_with(stays));
    return true;
  }

  void drop_refused() {
    const auto is_refused = [&](const AcceptedTerm& term) { return input_.refused.contains(term.own_name()); };
    for (auto term = out_.terms.begin(); (term = std::ranges::find_if(out_.terms, is_refused)) != out_.terms.end();) {
      out_.refuse(term->what(out_.drivers), term->loss_without_nats, input_.refused.at(term->own_name()), true);
      const std::vector<bool> stays = all_but(static_cast<std::size_t>(term - out_.terms.begin()));
      keep(stays, refit_with(stays));
    }
  }

  /// Where whole runs decided the figures, what follows the load at once is known to be otherwise: that is no evidence alone.
  bool drops_idle() {
    if (input_.model.free_run_error_K == 0.0) {
      return false;
    }
    const double with_K = rms_K(open_loop_errors(out_.after.model, input_.runs, {}));
    for (std::size_t i = 0; i < out_.terms.size(); ++i) {
      const std::vector<bool> stays = all_but(i);
      RefitResult without = refit_with(stays);
      if (with_K > kPlainlyBetter_share * rms_K(open_loop_errors(without.model, input_.runs, {}))) {
        if (const AcceptedTerm& term = out_.terms[i]; term.candidate) {
          out_.refuse(term.candidate->id, term.loss_without_nats, kHardlyBetterTold, true);
        }
        keep(stays, std::move(without));
        return true;
      }
    }
    return false;
  }

  /// Motors of more parts than the model has look as if sensors had a little of a fault. Empty where it is more.
  [[nodiscard]] std::string why_small_fault(const AcceptedTerm& term, const ExtendedModel& model) const {
    const SensorEffectType* const type = term.candidate->sensor_type;
    const auto own = std::ranges::find(model.sensors, type, &SensorTerm::type);
    // Less than a tenth nobody's sensor can be blamed for, however well it fits.
    constexpr double kNoFault_share = 0.1;
    const double least_share = term.loss_without_nats < rules_.unmistakable_nats ? rules_.least_fault_share : kNoFault_share;
    const bool is_small = type && own != model.sensors.end() && std::abs(own->value) < least_share * type->typical_size;
    return is_small ? fmt::format("it is {}{}{} only", significant(own->value, 2), type->size.unit.empty() ? "" : " ", type->size.unit)
                    : std::string();
  }

  /// Empty where it is not.
  [[nodiscard]] std::string why_negligible(const AcceptedTerm& term) const {
    if (!term.candidate) {
      return {};
    }
    if (std::string small = why_small_fault(term, out_.after.model); !small.empty()) {
      return small;
    }
    const double beside_nats = gain_nats([&](const AcceptedTerm& other) {
      return other.candidate && other.candidate->type && term.candidate->type &&
             other.candidate->nodes.front() == term.candidate->nodes.front();
    });
    if (term.loss_without_nats < rules_.beside_law_share * beside_nats) {
      return fmt::format("of {:.0f} nats that explain the same node", beside_nats);
    }
    const HeatOfEffect heat = heat_of(
        out_.after, input_.runs, [&](const EffectInPlace& each) { return each.name == term.effect_name; }, term.candidate->condition);
    const bool is_of_some_runs = !term.candidate->condition.empty();
    const bool is_little = is_of_some_runs ? heat.mean_W < rules_.least_deviation_share * out_.mean_heat_W
                                           : heat.mean_W < rules_.least_heat_share * out_.mean_heat_W &&
                                                 heat.peak_W < rules_.least_peak_share * out_.mean_heat_W;
    if (const RunDeviationType* const type = term.candidate->deviation_type) {
      const auto& terms = out_.after.model.deviations;
      const auto own = std::ranges::find_if(terms, [&](const RunDeviation& d) { return d.is_same(type, term.candidate->condition); });
      return std::abs(own->deviation_share) < rules_.least_deviation_share
                 ? fmt::format("it is {:.1f} % only", 100.0 * own->deviation_share)
                 : std::string();
    }
    return term.candidate->type && is_little
               ? fmt::format("it is {} W of {} W only", significant(heat.mean_W, 1), significant(out_.mean_heat_W, 2))
               : std::string();
  }

  bool drops_invisible() {
    std::size_t least = out_.terms.size();
    double least_ratio = rules_.least_visibility_ratio;
    for (std::size_t i = 0; i < out_.terms.size(); ++i) {
      const double ratio = out_.terms[i].candidate ? visibility_ratio(i) : 1.0;
      if (ratio >= rules_.least_visibility_ratio) {
        out_.terms[i].visibility_ratio = out_.terms[i].candidate ? ratio : out_.terms[i].visibility_ratio;
      } else if (ratio < least_ratio && !beats_changed_figures(i)) {
        least = i;
        least_ratio = ratio;
      }
    }
    if (least == out_.terms.size()) {
      return false;
    }
    if (drops_shape_of(least)) {
      return true;
    }
    const AcceptedTerm& term = out_.terms[least];
    out_.refuse(term.candidate->id, term.loss_without_nats,
                fmt::format("all but {:.1f} % of it could be the base parameters and the other effects", 100.0 * least_ratio));
    const std::vector<bool> stays = all_but(least);
    keep(stays, refit_with(stays));
    return true;
  }

  /// Of a law and a curve that hide each other the law stays, unless the curve alone is as far ahead as one must be to be named without it.
  bool drops_shape_of(std::size_t law) {
    for (std::size_t i = 0; i < out_.terms.size(); ++i) {
      const AcceptedTerm& curve = out_.terms[i];
      const double ahead_nats = curve.loss_without_nats - out_.terms[law].loss_without_nats;
      if (!curve.curve || ahead_nats > std::max(rules_.outside_beyond_nats,
                                                rules_.outside_beyond_share * gain_nats([](const AcceptedTerm&) { return true; }))) {
        continue;
      }
      const std::vector<bool> stays = all_but(i);
      if (!stays[law]) {
        continue;
      }
      keep(stays, refit_with(stays));
      return true;
    }
    return false;
  }

  /// In the shape that was found little of it may be its own, and the runs still tell that little from whatever figures of the file do:
  /// by much evidence, or because with those in its place whole runs are followed much worse.
  [[nodiscard]] bool beats_changed_figures(std::size_t term) const {
    ExtendedModel doubted = model_with(all_but(term));
    for (Eigen::Index i = 0; i < doubted.model.free_count(); ++i) {
      doubted.model.prior = with_doubt(doubted.model.prior, i);
    }
    RefitOptions options = options_;
    options.place = out_.after.place;
    const RefitResult without = refit(std::move(doubted), input_.runs, out_.before.start_C, options);
    const double ahead_nats = out_.after.evidence_nats - without.evidence_nats;
    constexpr double kMuchWorse_ratio = 2.0;
    return ahead_nats >= rules_.unmistakable_nats ||
           (ahead_nats >= rules_.least_gain_nats && leads_away(out_.after.model, without.model, input_.runs, kMuchWorse_ratio));
  }

  /// Of several terms the first was chosen while the others were not there: a law of its family may go better with them, or as well.
  bool swaps_for_rival() {
    for (std::size_t i = 0; i < out_.terms.size() && out_.terms.size() > 1; ++i) {
      const std::vector<bool> stays = all_but(i);
      if (!out_.terms[i].candidate || std::ranges::count(stays, false) > 1) {
        continue;
      }
      const ExtendedModel without = model_with(stays);
      const std::vector<Candidate> rivals = rivals_of(*out_.terms[i].candidate, without);
      std::vector<RefitResult> fits(rivals.size());
      RefitOptions options = options_;
      options.place = out_.after.place;
      in_parallel(rivals.size(), 0, [&](std::size_t j) {
        fits[j] = try_refit(with_candidate(without, rivals[j], 1.0), input_.runs, out_.before.start_C, options);
      });
      std::size_t best = rivals.size();
      double best_nats = out_.after.evidence_nats + kSwap_nats;
      for (std::size_t j = 0; j < rivals.size(); ++j) {
        tell_rival(out_.terms[i], rivals[j], fits[j].evidence_nats - out_.after.evidence_nats);
        if (fits[j].evidence_nats > best_nats) {
          best_nats = fits[j].evidence_nats;
          best = j;
        }
      }
      if (best < rivals.size()) {
        swap(i, rivals[best], std::move(fits[best]));
        return true;
      }
    }
    return false;
  }

  /// Laws of one family at the same nodes.
  [[nodiscard]] std::vector<Candidate> rivals_of(const Candidate& candidate, const ExtendedModel& without) const {
    std::vector<Candidate> rivals = candidates_for(without, input_.runs).candidates;
    std::erase_if(rivals, [&](const Candidate& other) {
      return !other.type || other.type == candidate.type || candidate.family().empty() || other.family() != candidate.family() ||
             other.nodes != candidate.nodes || other.condition != candidate.condition;
    });
    return rivals;
  }

  void tell_rival(AcceptedTerm& term, const Candidate& rival, double ahead_nats) const {
    const double within_nats = std::max(rules_.ambiguous_within_nats, rules_.beside_law_share * term.gain_nats);
    if (ahead_nats > -within_nats) {
      term.add_rival(rival);
    }
  }

  void swap(std::size_t own, const Candidate& rival, RefitResult fit) {
    AcceptedTerm& term = out_.terms[own];
    term.candidate = rival;
    term.effect_name = std::string(fit.model.model.network.effects().back().name);
    term.gain_nats += fit.evidence_nats - out_.after.evidence_nats;
    term.confusable_with.clear();
    term.experiments.clear();
    out_.after = std::move(fit);
    // The model lists effects in the order in which they came.
    std::ranges::rotate(out_.terms.begin() + static_cast<std::ptrdiff_t>(own), out_.terms.begin() + static_cast<std::ptrdiff_t>(own) + 1,
                        out_.terms.end());
  }

  /// Of the whitened response to the term's size from nothing, in the shape that was found, what all else leaves of it: 1 − R².
  [[nodiscard]] double visibility_ratio(std::size_t term) const {
    Candidate candidate = *out_.terms[term].candidate;
    if (candidate.type) {
      const auto in_place = std::ranges::find(out_.after.model.model.network.effects(), out_.terms[term].effect_name, &EffectInPlace::name);
      const auto size = static_cast<std::size_t>(candidate.size_parameter());
      for (std::size_t p = 0; p < candidate.parameters.size(); ++p) {
        const double found = out_.after.model.model.values[static_cast<std::size_t>(in_place->parameter_index[p])];
        candidate.parameters[p] = p == size && found == 0.0 ? candidate.parameters[p] : found;
      }
    }
    const ExtendedModel without = model_with(all_but(term));
    const auto states = static_cast<std::size_t>(without.model.network.state_count());
    std::vector<LinearisedRun> fitted;
    std::vector<Columns> columns;
    for (std::size_t r = 0; r < input_.runs.size(); ++r) {
      std::vector<double> start_C = out_.after.start_C[r];
      start_C.resize(std::min(start_C.size(), states));
      fitted.push_back(linearise(without, start_C, input_.runs[r]));
      columns.push_back(candidate_columns({candidate}, without, fitted.back(), input_.runs[r]));
    }
    EvidenceTable table(design(without.model.network, fitted, input_.runs, options_.errors, options_.merged, columns), out_.grid,
                        prior_here(without), {CandidateColumn{}});
    return table.visibility_ratio({}, out_.after.place, 0);
  }

  /// Without the term and all that stand on a node which it brings.
  [[nodiscard]] std::vector<bool> all_but(std::size_t left_out) const {
    std::vector<bool> stays(out_.terms.size(), true);
    std::vector<std::string> gone{out_.terms[left_out].effect_name};
    stays[left_out] = false;
    for (std::size_t next = 0; next < gone.size(); ++next) {
      for (std::size_t i = 0; i < out_.terms.size(); ++i) {
        const std::vector<std::string> nodes = nodes_of(out_.terms[i], out_.drivers);
        if (stays[i] && !gone[next].empty() && std::ranges::find(nodes, gone[next]) != nodes.end()) {
          stays[i] = false;
          gone.push_back(out_.terms[i].effect_name);
        }
      }
    }
    return stays;
  }

  [[nodiscard]] ExtendedModel model_with(const std::vector<bool>& stays) const {
    ExtendedModel model = out_.base;
    for (std::size_t i = 0; i < out_.terms.size(); ++i) {
      const AcceptedTerm& term = out_.terms[i];
      if (!stays[i]) {
        continue;
      }
      model = term.candidate
                  ? with_candidate(model, *term.candidate, 1.0, term.effect_name)
                  : *with_curve(model, *term.curve, out_.drivers[static_cast<std::size_t>(term.curve->term.driver)], term.effect_name);
    }
    return with_values_of(std::move(model), out_.after.model);
  }

  /// What was found may have led the figures far away: then the way back is tried from where they were, too.
  [[nodiscard]] RefitResult refit_with(const std::vector<bool>& stays) {
    options_.place = out_.after.place;
    RefitResult fit = refit(model_with(stays), input_.runs, out_.before.start_C, options_);
    if (has_strayed(out_.after.model, out_.before.model)) {
      RefitOptions options = options_;
      options.place = out_.before.place;
      RefitResult back = try_refit(with_values_of(model_with(stays), out_.before.model), input_.runs, out_.before.start_C, options);
      return back.evidence_nats > fit.evidence_nats ? std::move(back) : std::move(fit);
    }
    return fit;
  }

  void keep(const std::vector<bool>& stays, RefitResult fit) {
    out_.after = std::move(fit);
    std::vector<AcceptedTerm> terms;
    for (std::size_t i = 0; i < out_.terms.size(); ++i) {
      if (stays[i]) {
        terms.push_back(std::move(out_.terms[i]));
      }
    }
    out_.terms = std::move(terms);
  }

  Selection& out_;
  const SelectionInput& input_;
  const SelectionRules& rules_;
  RefitOptions options_;
  bool has_dropped_ = false;
};

}  // namespace

void check_backwards(Selection& selection, const SelectionInput& input, const SelectionRules& rules, RefitOptions options) {
  BackwardCheck(selection, input, rules, std::move(options)).run();
}

void settle(Selection& selection, const SelectionInput& input, const SelectionRules& rules, RefitOptions options) {
  BackwardCheck(selection, input, rules, std::move(options)).settle();
}

}  // namespace heatsoak
