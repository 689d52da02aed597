// Several effects at once, by the linear evidence alone: which of those that a round has judged explain the runs together.
#pragma once

#include <vector>

#include "identify/attribution/selection.h"

namespace heatsoak {

/// The candidates of one round beside its base. All that is given outlives it.
class EffectSets {
 public:
  EffectSets(const std::vector<JudgedCandidate>& ladder, const std::vector<Candidate>& candidates, EvidenceTable& table,
             const SetScore& base, const SelectionRules& rules);

  /// Evidence that effects of the catalogue reach together, one after the other, at the present fit.
  [[nodiscard]] double catalogue_gain_nats() const;
  /// Of effects that gain something by themselves and can be seen: sets of two to `most`, which grow one by one from the best smaller ones;
  /// the few that are worth most, and no less than `least_worth_nats`.
  [[nodiscard]] std::vector<SetScore> best(std::size_t most, double least_worth_nats) const;
  /// Adds to `term`, which is number `own` of a chosen set, what could stand in its place.
  void tell_rivals(const std::vector<int>& chosen, std::size_t own, AcceptedTerm& term) const;

 private:
  [[nodiscard]] int place_of(const Candidate& candidate) const;
  [[nodiscard]] std::vector<int> visible() const;
  [[nodiscard]] std::vector<SetScore> one_larger(const std::vector<SetScore>& smaller, const std::vector<int>& pool) const;

  const std::vector<JudgedCandidate>& ladder_;
  const std::vector<Candidate>& candidates_;
  EvidenceTable& table_;
  const SetScore& base_;
  const SelectionRules& rules_;
};

/// What a set of so many terms is ahead: every term has to be worth the least gain.
double worth_nats(double gain_nats, std::size_t terms, const SelectionRules& rules);

}  // namespace heatsoak
