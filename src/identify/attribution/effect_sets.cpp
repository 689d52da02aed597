#include "identify/attribution/effect_sets.h"

#include <algorithm>
#include <functional>
#include <map>

namespace heatsoak {

EffectSets::EffectSets(const std::vector<JudgedCandidate>& ladder, const std::vector<Candidate>& candidates, EvidenceTable& table,
                       const SetScore& base, const SelectionRules& rules)
    : ladder_(ladder), candidates_(candidates), table_(table), base_(base), rules_(rules) {}

int EffectSets::place_of(const Candidate& candidate) const {
  const auto found =
      std::ranges::find_if(candidates_, [&](const Candidate& c) { return c.id == candidate.id && c.variant == candidate.variant; });
  return static_cast<int>(found - candidates_.begin());
}

double EffectSets::catalogue_gain_nats() const {
  SetScore best = base_;
  for (int term = 0; term < rules_.most_terms; ++term) {
    SetScore next = best;
    for (const JudgedCandidate& each : ladder_) {
      const int j = place_of(each.candidate);
      std::vector<int> set = best.candidates;
      if (std::ranges::find(set, j) != set.end()) {
        continue;
      }
      set.push_back(j);
      SetScore with = table_.best(set, best.place);
      if (with.is_allowed && with.evidence_nats > next.evidence_nats) {
        next = std::move(with);
      }
    }
    if (next.evidence_nats < best.evidence_nats + rules_.least_gain_nats) {
      break;
    }
    best = std::move(next);
  }
  return best.evidence_nats - base_.evidence_nats;
}

std::vector<SetScore> EffectSets::one_larger(const std::vector<SetScore>& smaller, const std::vector<int>& pool) const {
  std::map<std::vector<int>, SetScore> larger;
  for (const SetScore& from : smaller) {
    for (const int j : pool) {
      std::vector<int> set = from.candidates;
      set.insert(std::ranges::lower_bound(set, j), j);
      if (std::ranges::find(from.candidates, j) != from.candidates.end() || larger.contains(set)) {
        continue;
      }
      SetScore score = table_.best(set, from.place);
      if (score.is_allowed) {
        larger.emplace(std::move(set), std::move(score));
      }
    }
  }
  std::vector<SetScore> all;
  for (auto& [set, score] : larger) {
    all.push_back(std::move(score));
  }
  std::ranges::stable_sort(all, [](const SetScore& a, const SetScore& b) { return a.evidence_nats > b.evidence_nats; });
  return all;
}

std::vector<SetScore> EffectSets::best(std::size_t most, double least_worth_nats) const {
  constexpr std::size_t kKept = 6;
  constexpr std::size_t kRefitted = 4;
  const std::vector<int> pool = visible();
  std::vector<SetScore> all;
  std::vector<SetScore> smaller{base_};
  for (std::size_t size = 1; size <= most; ++size) {
    smaller = one_larger(smaller, pool);
    // Of single ones all go on: what they gain alone says little here.
    smaller.resize(std::min(smaller.size(), size == 1 ? pool.size() : kKept));
    if (size > 1) {
      all.insert(all.end(), smaller.begin(), smaller.end());
    }
  }
  const auto worth = [&](const SetScore& set) {
    return worth_nats(set.evidence_nats - base_.evidence_nats, set.candidates.size(), rules_);
  };
  std::erase_if(all, [&](const SetScore& set) { return worth(set) < least_worth_nats; });
  std::ranges::stable_sort(all, std::greater(), worth);
  all.resize(std::min(all.size(), kRefitted));
  return all;
}

std::vector<int> EffectSets::visible() const {
  std::vector<int> pool;
  for (const JudgedCandidate& each : ladder_) {
    // Shapes are free in a refit: one variant stands for all.
    const bool is_variant =
        std::ranges::any_of(pool, [&](int j) { return candidates_[static_cast<std::size_t>(j)].id == each.candidate.id; });
    if (each.visibility_ratio >= rules_.least_visibility_ratio && !is_variant && !each.candidate.is_rare()) {
      pool.push_back(place_of(each.candidate));
    }
  }
  return pool;
}

void EffectSets::tell_rivals(const std::vector<int>& chosen, std::size_t own, AcceptedTerm& term) const {
  const double chosen_nats = table_.best(chosen, base_.place).evidence_nats;
  for (const int j : visible()) {
    const Candidate& rival = candidates_[static_cast<std::size_t>(j)];
    std::vector<int> set = chosen;
    set[own] = j;
    if (std::ranges::find(chosen, j) != chosen.end() || rival.id == term.candidate->id ||
        std::ranges::find(term.confusable_with, rival.id) != term.confusable_with.end()) {
      continue;
    }
    const SetScore with = table_.best(set, base_.place);
    if (with.is_allowed && with.evidence_nats > chosen_nats - rules_.ambiguous_within_nats) {
      term.add_rival(rival);
    }
  }
}

double worth_nats(double gain_nats, std::size_t terms, const SelectionRules& rules) {
  return gain_nats - static_cast<double>(terms) * rules.least_gain_nats;
}

}  // namespace heatsoak
