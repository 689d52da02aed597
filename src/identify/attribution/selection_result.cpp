#include <fmt/format.h>

#include <algorithm>

#include "identify/attribution/open_loop.h"
#include "identify/attribution/selection.h"
#include "identify/log_columns.h"

namespace heatsoak {

const std::string& AcceptedTerm::what(const std::vector<Driver>& all_drivers) const {
  return candidate ? candidate->id : all_drivers[static_cast<std::size_t>(curve->term.driver)].name;
}

void AcceptedTerm::add_rival(const Candidate& other) {
  if (other.id != candidate->id && std::ranges::find(confusable_with, other.id) == confusable_with.end()) {
    confusable_with.push_back(other.id);
    experiments.emplace_back(other.experiment());
  }
}

bool Selection::is_known(const ScanResult& curve) const {
  constexpr double kBeside_ratio = 2.0;
  const auto is_much_more = [&](const AcceptedTerm& term) { return term.candidate && term.gain_nats > kBeside_ratio * curve.gain_nats; };
  return !curve.leaves_heat || std::ranges::any_of(terms, is_much_more) ||
         drivers[static_cast<std::size_t>(curve.term.driver)].name == kTimeDriver;
}

int Selection::place_of(Driver driver) {
  const auto known = std::ranges::find(drivers, driver.name, &Driver::name);
  const auto place = static_cast<int>(known - drivers.begin());
  if (known == drivers.end()) {
    drivers.push_back(std::move(driver));
  } else {
    *known = std::move(driver);
  }
  return place;
}

void Selection::close(Round round, std::size_t terms_before, std::size_t changed_before) {
  for (std::size_t i = changed_before; i < changed.size(); ++i) {
    round.taken.push_back("doubt in " + changed[i].name);
  }
  for (std::size_t i = terms_before; i < terms.size(); ++i) {
    round.taken.push_back(terms[i].candidate ? terms[i].what(drivers) : "curve over " + terms[i].what(drivers));
  }
  round.taken_nats = round.taken.empty() ? 0.0 : after.evidence_nats - round.evidence_nats;
  rounds.push_back(std::move(round));
}

ScanResult Selection::with_drivers_of(const Selection& other, ScanResult curve) {
  curve.term.driver = place_of(other.drivers[static_cast<std::size_t>(curve.term.driver)]);
  return curve;
}

void Selection::tell_other_drivers(AcceptedTerm& term, const std::vector<ScanResult>& scan, double within_nats) const {
  for (const ScanResult& other : scan) {
    const std::string& name = drivers[static_cast<std::size_t>(other.term.driver)].name;
    // The same driver may rule another node or another law: that is no other driver.
    if (other.term.driver != term.curve->term.driver && other.gain_nats > term.curve->gain_nats - within_nats &&
        std::ranges::find(term.confusable_with, name) == term.confusable_with.end()) {
      term.confusable_with.push_back(name);
    }
  }
}

void Selection::forget_refusal(const std::string& id) {
  std::erase_if(refused, [&](const Refusal& known) { return known.id == id; });
}

bool Selection::leaves_doubt() const { return !std::ranges::all_of(refused, &Refusal::is_negligible); }

void Selection::refuse(const std::string& id, double gain_nats, std::string_view why, bool is_negligible) {
  forget_refusal(id);
  refused.push_back({id, fmt::format("{}: {:.0f} nats, but {}", id, gain_nats, why), is_negligible});
}

namespace {

/// Whole runs, with what was found, than with the model's own figures alone.
bool follows_better(const SelectionInput& input, const Selection& found) {
  std::vector<MeasuredRun> runs = input.runs;
  set_column(runs, found.after.model.column);
  return rms_K(open_loop_errors(found.after.model, runs, {})) < rms_K(open_loop_errors(found.own.model, runs, {}));
}

Selection selected(const SelectionInput& input, const SelectionRules& rules) {
  Selection found = select_once(input, rules);
  if (!found.waits_for_others || follows_better(input, found)) {
    return found;
  }
  SelectionInput strict = input;
  strict.waits_for_others = false;
  return select_once(strict, rules);
}

}  // namespace

Selection select_effects(const SelectionInput& input, const SelectionRules& rules) {
  Selection found = selected(input, rules);
  if (input.model.free_run_error_K == 0.0 || !input.refused.empty()) {
    return found;
  }
  // What the model leaves in other runs of the same motor is no effect as a rule.
  constexpr double kThanUsual_share = 0.7;
  std::vector<MeasuredRun> runs = input.runs;
  set_column(runs, found.after.model.column);
  const double before_K = rms_K(open_loop_errors(input.model, runs, {}));
  const double most_share = input.model.is_as_usual(before_K) ? kThanUsual_share : kPlainlyBetter_share;
  if (rms_K(open_loop_errors(found.after.model, runs, {})) < most_share * before_K) {
    return found;
  }
  SelectionInput held = input;
  held.model.hold_figures();
  held.adds_terms = false;
  Selection none = selected(held, rules);
  none.is_held = true;
  for (const AcceptedTerm& term : found.terms) {
    none.refuse(term.what(found.drivers), term.gain_nats, kHardlyBetterTold, true);
  }
  return none;
}

}  // namespace heatsoak
