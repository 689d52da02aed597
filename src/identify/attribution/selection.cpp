#include "identify/attribution/selection.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "identify/attribution/backward_check.h"
#include "identify/attribution/effect_sets.h"
#include "identify/attribution/first_fit.h"
#include "identify/attribution/ladder.h"
#include "identify/attribution/open_loop.h"
#include "identify/attribution/terms.h"
#include "identify/attribution/trials.h"
#include "identify/calibration/unlogged_speed.h"
#include "identify/log_columns.h"

namespace heatsoak {
namespace {

/// More unknown heat than this, as a share of what the model knows, raises the question whether sensors show what is not there.
constexpr double kMuchUnknown_share = 0.05;

constexpr std::size_t kMostCurvesTried = 3;
/// A curve that nothing in the network can follow has so many times the evidence of all laws before none of them is named for it.
constexpr double kOutweighed_ratio = 1.6;
/// Laws that the base could stand for are look-alikes of one that is named where they are no further behind it.
constexpr double kHiddenBeside_share = 0.1;
/// Of the evidence that the scan has for a curve, what its refit has to reach within what physics allows.
constexpr double kKeptPromise_ratio = 0.5;

/// Of a curve with which whole runs are followed worse: so much evidence is waited for what balances it.
constexpr double kBalanced_nats = 50.0;

class Selector {
 public:
  Selector(const SelectionInput& input, const SelectionRules& rules)
      : input_(input), rules_(rules), is_speed_open_(std::ranges::any_of(input.runs, turns_unseen)) {}

  Selection run() {
    FirstFit first = first_fit(input_.model, input_.runs);
    out_.mean_heat_W = first.mean_heat_W;
    options_ = std::move(first.options);
    first_place_ = std::move(first.place);
    out_.before = std::move(first.fit);
    fit_beside_sensor_errors();
    out_.after = out_.before;
    out_.base = out_.before.model;
    out_.grid = options_.grid;
    while (static_cast<int>(out_.terms.size()) < rules_.most_terms && one_round()) {
    }
    out_.errors = options_.errors;
    check_backwards(out_, input_, rules_, options_);
    while (input_.adds_terms && input_.refused.empty() && (!out_.refused.empty() || out_.open_curve) && doubt_once_more()) {
    }
    look_more_finely();
    out_.own = out_.before;
    if (!out_.changed.empty()) {
      options_.place = out_.before.place;
      out_.own = refit(out_.base, input_.runs, out_.before.start_C, options_);
    }
    if (!out_.terms.empty() || !out_.changed.empty()) {
      settle(out_, input_, rules_, options_);
    }
    for (const AcceptedTerm& term : out_.terms) {
      // A later round has found what an earlier one could not tell.
      out_.forget_refusal(term.what(out_.drivers));
    }
    return std::move(out_);
  }

 private:
  void look_more_finely() {
    options_.grid = out_.grid = options_.grid.finer();
    out_.before.place = FluxGrid::in_finer(out_.before.place);
    out_.after.place = FluxGrid::in_finer(out_.after.place);
  }

  /// At a bad fit sensors seem to do what they do not: the better one tells, until nothing moves any more.
  void fit_beside_sensor_errors() {
    RefitResult& fit = out_.before;
    options_.place = fit.place;
    const std::vector<double> unknown_W = options_.grid.at(fit.place).rms_W;
    if (*std::ranges::max_element(unknown_W) > kMuchUnknown_share * out_.mean_heat_W) {
      options_.errors = with_wander(fit, input_.runs, options_.grid, options_.merged, options_.errors);
    }
    options_.errors.weights = outlier_weights(fit, input_.runs, options_.grid, options_.errors);
    if (!options_.errors.wander_K.empty()) {
      options_.place = first_place_;
    }
    fit = refit(fit.model, input_.runs, fit.start_C, options_);
    constexpr int kMostLooks = 3;
    for (int look = 0; look < kMostLooks; ++look) {
      RefitOptions options = options_at(fit.place);
      options.errors = wander_at(fit, input_.runs, options_.grid, options_.merged, options_.errors);
      if (options.errors.is_same_wander(options_.errors)) {
        return;
      }
      RefitResult next = refit(fit.model, input_.runs, fit.start_C, options);
      if (next.evidence_nats < fit.evidence_nats) {
        return;
      }
      fit = std::move(next);
      options_.errors = std::move(options.errors);
    }
  }

  /// True where a term was taken in.
  bool one_round() {
    const CandidateList list = candidates_for(out_.after.model, input_.runs);
    out_.not_judged = list.not_judged;
    std::vector<Columns> columns(input_.runs.size());
    in_parallel(input_.runs.size(), 0, [&](std::size_t r) {
      columns[r] = candidate_columns(list.candidates, out_.after.model, out_.after.fitted[r], input_.runs[r]);
    });
    EvidenceTable of_all(design(out_.after.model.model.network, out_.after.fitted, input_.runs, options_.errors, options_.merged, columns),
                         options_.grid, prior_here(out_.after.model), column_rules(list.candidates));
    const SetScore base = of_all.best({}, out_.after.place);
    out_.after.evidence_nats = std::max(out_.after.evidence_nats, base.evidence_nats);
    out_.after.place = base.place;
    if (out_.rounds.empty()) {
      const Sight sight = sight_of(list.candidates, of_all.typical_gains_nats(base), rules_.least_gain_nats);
      out_.unseen = sight.unseen;
      out_.seen_share = sight.seen_share;
    }
    const std::vector<int> few = most_promising(of_all.single_gains_nats(base), static_cast<std::size_t>(rules_.in_question));
    std::vector<Candidate> candidates;
    std::ranges::transform(few, std::back_inserter(candidates), [&](int j) { return list.candidates[static_cast<std::size_t>(j)]; });
    EvidenceTable table = std::move(of_all).only(few);
    Round round;
    round.evidence_nats = base.evidence_nats;
    round.ladder = judge(candidates, table, base);
    if (input_.scans_drivers) {
      round.scan = scan(table, base);
    }
    const std::size_t terms_before = out_.terms.size();
    const std::size_t changed_before = out_.changed.size();
    const bool taken = input_.adds_terms && take_best(round, candidates, table, base);
    out_.close(std::move(round), terms_before, changed_before);
    return taken;
  }

  [[nodiscard]] ScanInput scan_input(const std::vector<Driver>& drivers) const {
    return {&out_.after.model.model, &input_.runs, &out_.after.fitted, &drivers, std::max(0.05, out_.mean_heat_W)};
  }

  /// Its results name drivers by their places in the list of all rounds: what one round looks at, another may not have.
  std::vector<ScanResult> scan(EvidenceTable& table, const SetScore& base) {
    std::vector<Driver> drivers = drivers_of(out_.after.model.model, out_.after.fitted, input_.runs);
    std::vector<ScanResult> results = scan_drivers(scan_input(drivers), table, base, 8);
    std::vector<int> place;
    std::ranges::transform(drivers, std::back_inserter(place), [&](Driver& driver) { return out_.place_of(std::move(driver)); });
    for (ScanResult& each : results) {
      each.term.driver = place[static_cast<std::size_t>(each.term.driver)];
    }
    return results;
  }

  [[nodiscard]] RefitOptions options_at(const FluxGrid::Place& place) const {
    RefitOptions options = options_;
    options.place = place;
    return options;
  }

  [[nodiscard]] Trials trials() const { return {input_, out_, options_, first_place_}; }

  /// A judged candidate after its refit in the equations.
  struct Tried {
    const JudgedCandidate* judged = nullptr;
    RefitResult fit;
    double gain_nats = 0.0;
  };

  /// Where an effect may not be named, or no model can follow it, a figure of the file may still have changed.
  bool doubt_once_more() {
    EvidenceTable table(design(out_.after.model.model.network, out_.after.fitted, input_.runs, options_.errors, options_.merged, {}),
                        options_.grid, prior_here(out_.after.model), {});
    return take_doubt(table, table.best({}, out_.after.place), 0.0);
  }

  /// Gives the figure that the runs contradict most its doubt back, where that explains them as well as anything else does.
  bool take_doubt(EvidenceTable& table, const SetScore& base, double rival_nats) {
    const double least_nats = std::max(rules_.least_gain_nats, rival_nats - rules_.ambiguous_within_nats);
    std::optional<ChangedFigure> figure = most_contradicted(out_.after.model, table, base, least_nats);
    if (!figure) {
      return false;
    }
    ExtendedModel doubted = out_.after.model;
    doubted.model.prior = with_doubt(doubted.model.prior, figure->coordinate);
    RefitResult fit = try_refit(std::move(doubted), input_.runs, out_.after.start_C, options_at(base.place));
    figure->gain_nats = fit.evidence_nats - out_.after.evidence_nats;
    if (figure->gain_nats < least_nats || leads_away(out_.after.model, fit.model, input_.runs, kMostWorse_ratio)) {
      return false;
    }
    out_.base.model.prior = with_doubt(out_.base.model.prior, figure->coordinate);
    out_.after = std::move(fit);
    out_.changed.push_back(std::move(*figure));
    return true;
  }

  /// A file that was calibrated with a model that lacked the law has figures that are wrong because of it, and sure of them: the law and
  /// the figure's doubt together may explain what neither does.
  bool take_law_beside_doubt(std::vector<Tried>& tried, EvidenceTable& table, const SetScore& base, double least_nats) {
    const Tried* law = nullptr;
    std::optional<ChangedFigure> figure;
    double best_nats = base.evidence_nats + least_nats;
    for (std::size_t i = 0; i < std::min(tried.size(), kMostCurvesTried); ++i) {
      const SetScore score = table.best(std::vector<int>{tried[i].judged->column}, tried[i].judged->place);
      const auto doubtful = most_contradicted(out_.after.model, table, score, rules_.least_gain_nats);
      if (doubtful && score.evidence_nats + doubtful->gain_nats > best_nats) {
        best_nats = score.evidence_nats + doubtful->gain_nats;
        law = &tried[i];
        figure = doubtful;
      }
    }
    if (!law) {
      return false;
    }
    ExtendedModel doubted = law->fit.model;
    doubted.model.prior = with_doubt(doubted.model.prior, figure->coordinate);
    RefitResult fit = try_refit(std::move(doubted), input_.runs, law->fit.start_C, options_at(law->fit.place));
    figure->gain_nats = fit.evidence_nats - law->fit.evidence_nats;
    if (fit.evidence_nats - out_.after.evidence_nats < least_nats || figure->gain_nats < rules_.least_gain_nats ||
        leads_away(out_.after.model, fit.model, input_.runs, kMostWorse_ratio)) {
      return false;
    }
    std::vector<Tried> front;
    front.push_back({law->judged, std::move(fit), law->gain_nats + figure->gain_nats});
    if (!take_front(front)) {
      return false;
    }
    out_.base.model.prior = with_doubt(out_.base.model.prior, figure->coordinate);
    out_.changed.push_back(std::move(*figure));
    return true;
  }

  bool take_best(Round& round, const std::vector<Candidate>& candidates, EvidenceTable& table, const SetScore& base) {
    double least_nats = rules_.least_gain_nats;
    for (const AcceptedTerm& term : out_.terms) {
      least_nats = std::max(least_nats, term.curve ? rules_.beside_curve_share * term.gain_nats : 0.0);
    }
    std::vector<Tried> tried = try_ladder(round, least_nats);
    const EffectSets sets(round.ladder, candidates, table, base, rules_);
    out_.open_curve.reset();
    const double best_nats = tried.empty() ? 0.0 : tried.front().gain_nats;
    if (!round.scan.empty() && round.scan.front().gain_nats > best_nats) {
      zoom_in(scan_input(out_.drivers), table, base, round.scan);
    }
    const double best_scan_nats = round.scan.empty() ? 0.0 : round.scan.front().gain_nats;
    const double beyond_nats = std::max(rules_.outside_beyond_nats, rules_.outside_beyond_share * best_scan_nats);
    if (take_doubt(table, base, std::max(best_nats, best_scan_nats - beyond_nats))) {
      return true;
    }
    const bool is_ahead = best_scan_nats >= least_nats && best_scan_nats > best_nats + beyond_nats;
    if (is_ahead && take_law_beside_doubt(tried, table, base, best_scan_nats - beyond_nats)) {
      return true;
    }
    const double catalogue_nats = is_ahead ? sets.catalogue_gain_nats() : 0.0;
    if (is_ahead && best_scan_nats > catalogue_nats + beyond_nats) {
      if (!is_speed_open_ && take_curve(round, std::max(best_nats, 0.0) + rules_.outside_beyond_nats)) {
        return true;
      }
      // A signal that did not hold in the equations and is no better than the clock: it may well be the clock.
      const auto clock = std::ranges::find_if(round.scan, [&](const ScanResult& each) {
        return driver_name(each) == kTimeDriver && each.gain_nats > best_scan_nats - rules_.ambiguous_within_nats;
      });
      const ScanResult& front = clock != round.scan.end() ? *clock : round.scan.front();
      // What is left over the signal that a curve follows already is the shape between its knots.
      if (std::ranges::any_of(out_.terms, [&](const AcceptedTerm& term) {
            return term.curve && term.curve->term.driver == front.term.driver && term.curve->term.node == front.term.node;
          })) {
        return false;
      }
      // In place of a speed that nobody logged another signal is no answer.
      const bool is_answer = out_.is_known(front) && (!is_speed_open_ || driver_name(front) == kTimeDriver);
      out_.open_curve = is_answer ? std::optional(front) : std::nullopt;
      // Heat that goes by the clock, or of which all laws together explain much less, is none of theirs.
      if (driver_name(front) == kTimeDriver || front.gain_nats > kOutweighed_ratio * std::max(best_nats, catalogue_nats)) {
        return false;
      }
    }
    if (take_set(sets, candidates, table, base, best_nats)) {
      return true;
    }
    if (best_nats < least_nats) {
      return false;
    }
    // What explains more and may not be named is the better explanation still; a runner-up gets no name in its place.
    if (!hidden_.empty() &&
        hidden_.front().gain_nats > best_nats + std::max(rules_.outside_beyond_nats, rules_.outside_beyond_share * best_nats)) {
      return take_doubt(table, base, 0.0);
    }
    return take_front(tried);
  }

  /// Refits of those that may be named, best first; tells which may not.
  std::vector<Tried> try_ladder(Round& round, double least_nats) {
    double worth_nats = 0.5 * least_nats;
    hidden_.clear();
    std::vector<JudgedCandidate*> worthy;
    std::vector<JudgedCandidate*> variants;
    for (JudgedCandidate& each : round.ladder) {
      if (each.gain_nats < worth_nats || !may_be_named(each, least_nats)) {
        continue;
      }
      worth_nats = std::max(worth_nats, 0.8 * each.gain_nats - 20.0);
      const bool is_variant = std::ranges::any_of(worthy, [&](const JudgedCandidate* w) { return w->candidate.id == each.candidate.id; });
      (is_variant ? variants : worthy).push_back(&each);
    }
    worthy.resize(std::min(worthy.size(), static_cast<std::size_t>(rules_.refitted)));
    std::vector<Tried> tried(worthy.size());
    in_parallel(worthy.size(), 0, [&](std::size_t i) { tried[i] = try_out(*worthy[i]); });
    for (JudgedCandidate* const each : variants) {
      // Shapes are free in a refit: another variant of an effect is only worth one where it promises more than the refit has reached.
      const auto own = std::ranges::find_if(tried, [&](const Tried& t) { return t.judged->candidate.id == each->candidate.id; });
      if (own != tried.end() && each->gain_nats > own->gain_nats) {
        tried.push_back(try_out(*each));
      }
    }
    std::ranges::stable_sort(tried, [](const Tried& a, const Tried& b) { return a.gain_nats > b.gain_nats; });
    return tried;
  }

  Tried try_out(JudgedCandidate& judged) const {
    RefitResult fit = trials().of_term(judged, 0.5 * judged.gain_nats);
    judged.gain_nats = std::isfinite(fit.evidence_nats) ? fit.evidence_nats - out_.after.evidence_nats : 0.0;
    return {&judged, std::move(fit), judged.gain_nats};
  }

  /// Tells where it may not though it explains something.
  bool may_be_named(const JudgedCandidate& judged, double least_nats) {
    std::string why_not;
    bool is_negligible = false;
    if (is_speed_open_ && judged.candidate.type && judged.candidate.nodes.front() == "stator") {
      why_not = "the loss at the speed that not every log has could be it";
    } else if (judged.visibility_ratio < rules_.least_visibility_ratio) {
      why_not = fmt::format("all but {:.1f} % of it could be the base parameters", 100.0 * judged.visibility_ratio);
    } else if (judged.candidate.is_rare() && judged.gain_nats < rules_.unmistakable_nats) {
      why_not = "that is rare and needs clearer evidence";
      is_negligible =
          judged.candidate.deviation_type && std::abs(judged.size_share) * judged.candidate.typical_size() < rules_.least_deviation_share;
    } else if (judged.runs_acting > 1 && judged.left_out_gain_nats <= 0.0) {
      why_not = "runs left out of the fit get no better";
    }
    if (judged.visibility_ratio < rules_.least_visibility_ratio) {
      hidden_.push_back(judged);
    }
    if (!why_not.empty() && judged.gain_nats >= least_nats) {
      out_.refuse(judged.candidate.id, judged.gain_nats, why_not, is_negligible);
    }
    return why_not.empty();
  }

  /// The best one that follows the runs, and beside it what could stand in its place.
  bool take_front(std::vector<Tried>& tried) {
    for (std::string_view why; !tried.empty() && !(why = trials().why_not(*tried.front().judged, tried.front().fit)).empty();) {
      out_.refuse(tried.front().judged->candidate.id, tried.front().gain_nats, why);
      tried.erase(tried.begin());
    }
    if (tried.empty() || tried.front().gain_nats < rules_.least_gain_nats) {
      return false;
    }
    AcceptedTerm term;
    term.candidate = tried.front().judged->candidate;
    term.gain_nats = tried.front().gain_nats;
    term.visibility_ratio = tried.front().judged->visibility_ratio;
    // No law is exact: with much evidence the runner-up may be the right one by more than chance allows.
    const double within_nats = std::max(rules_.ambiguous_within_nats, rules_.beside_law_share * term.gain_nats);
    for (const Tried& each : tried) {
      if (each.gain_nats > term.gain_nats - within_nats) {
        term.add_rival(each.judged->candidate);
      }
    }
    const double hidden_within_nats = std::max(rules_.ambiguous_within_nats, kHiddenBeside_share * term.gain_nats);
    for (const JudgedCandidate& hidden : hidden_) {
      if (hidden.gain_nats > term.gain_nats - hidden_within_nats) {
        term.add_rival(hidden.candidate);
      }
    }
    term.effect_name = term.candidate->type ? std::string(tried.front().fit.model.model.network.effects().back().name) : std::string();
    out_.after = std::move(tried.front().fit);
    out_.terms.push_back(std::move(term));
    return true;
  }

  /// Effects that hide each other: none is seen while unknown heat stands in for the others. Asked only where that heat is much.
  bool take_set(const EffectSets& sets, const std::vector<Candidate>& candidates, EvidenceTable& table, const SetScore& base,
                double best_single_nats) {
    const LatentFlux flux = table.grid().at(base.place);
    if (is_speed_open_ || *std::ranges::max_element(flux.rms_W) <= kMuchUnknown_share * out_.mean_heat_W) {
      return false;
    }
    double best_worth_nats = std::max(0.0, worth_nats(best_single_nats, 1, rules_));
    // Where no single effect holds up in the equations the linear evidence is no judge.
    const double least_worth_nats = best_single_nats > 0.0 ? best_worth_nats : std::numeric_limits<double>::lowest();
    const auto most = static_cast<std::size_t>(rules_.most_terms) - out_.terms.size();
    const std::vector<SetScore> best_sets = sets.best(most, least_worth_nats);
    std::vector<RefitResult> fits(best_sets.size());
    in_parallel(fits.size(), 0, [&](std::size_t i) { fits[i] = trials().of_set(best_sets[i], candidates); });
    RefitResult* best = nullptr;
    std::vector<int> chosen;
    for (std::size_t i = 0; i < fits.size(); ++i) {
      const double set_worth_nats = worth_nats(fits[i].evidence_nats - out_.after.evidence_nats, best_sets[i].candidates.size(), rules_);
      if (set_worth_nats > best_worth_nats) {
        best_worth_nats = set_worth_nats;
        best = &fits[i];
        chosen = best_sets[i].candidates;
      }
    }
    if (!best) {
      return false;
    }
    auto name = best->model.model.network.effects().end() -
                std::ranges::count_if(chosen, [&](int j) { return candidates[static_cast<std::size_t>(j)].type != nullptr; });
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      AcceptedTerm term;
      term.candidate = candidates[static_cast<std::size_t>(chosen[i])];
      term.effect_name = term.candidate->type ? (name++)->name : std::string();
      term.gain_nats = (best->evidence_nats - out_.after.evidence_nats) / static_cast<double>(chosen.size());
      term.visibility_ratio = table.visibility_ratio(base.candidates, base.place, chosen[i]);
      term.is_of_set = chosen.size() > 1;
      sets.tell_rivals(chosen, i, term);
      out_.terms.push_back(std::move(term));
    }
    out_.after = std::move(*best);
    return true;
  }

  [[nodiscard]] const std::string& driver_name(const ScanResult& curve) const {
    return out_.drivers[static_cast<std::size_t>(curve.term.driver)].name;
  }

  /// The first curve that is still worth `least_nats` when it is refitted in the equations within what physics allows.
  bool take_curve(const Round& round, double least_nats) {
    std::size_t tries = 0;
    const ScanResult& front = round.scan.front();
    const double rival_nats = front.gain_nats - std::max(rules_.ambiguous_within_nats, rules_.beside_curve_share * front.gain_nats);
    for (const ScanResult& each : round.scan) {
      if (each.gain_nats < least_nats || tries == kMostCurvesTried) {
        break;
      }
      // What is far behind another signal only looks like it; of one signal the law that the equations want may be far behind.
      const bool is_front = each.term.driver == front.term.driver;
      if (!out_.is_known(is_front ? front : each) || (!is_front && each.gain_nats < rival_nats)) {
        continue;
      }
      const Driver& driver = out_.drivers[static_cast<std::size_t>(each.term.driver)];
      const std::optional<ExtendedModel> with = with_curve(out_.after.model, each, driver);
      if (!with) {
        if (driver.choice == kColumnChoice) {
          out_.refuse(driver.name, each.gain_nats, kNoRoom);
        }
        continue;
      }
      set_column(input_.runs, with->column);
      ++tries;
      RefitResult fit = try_refit(*with, input_.runs, out_.after.start_C, options_at(each.place));
      if (fit.evidence_nats < out_.after.evidence_nats + least_nats) {
        fit = try_refit(with_values_of(*with, input_.model), input_.runs, out_.before.start_C, options_at(first_place_));
      }
      AcceptedTerm term;
      term.curve = each;
      term.gain_nats = fit.evidence_nats - out_.after.evidence_nats;
      if (term.gain_nats < std::max(least_nats, kKeptPromise_ratio * each.gain_nats)) {
        continue;
      }
      if (leads_away(out_.after.model, fit.model, input_.runs, kMostWorse_ratio)) {
        if (!input_.waits_for_others || term.gain_nats < kBalanced_nats) {
          out_.refuse(driver.name, term.gain_nats, kStraysAlone, true);
          continue;
        }
        out_.waits_for_others = true;
      }
      term.effect_name = std::string(fit.model.model.network.effects().back().name);
      out_.tell_other_drivers(term, round.scan, rules_.ambiguous_within_nats);
      out_.after = std::move(fit);
      out_.terms.push_back(std::move(term));
      return true;
    }
    return false;
  }

  SelectionInput input_;  ///< whose runs get the column that a curve is drawn over
  const SelectionRules& rules_;
  bool is_speed_open_;  ///< heat at the stator then may well be the loss at the speed that nobody logged
  RefitOptions options_;
  FluxGrid::Place first_place_;
  std::vector<JudgedCandidate> hidden_;  ///< of this round, best first: what the base parameters could stand for
  Selection out_;
};

}  // namespace

Selection select_once(const SelectionInput& input, const SelectionRules& rules) { return Selector(input, rules).run(); }

}  // namespace heatsoak
