#include "identify/attribution/ladder.h"

#include <algorithm>
#include <functional>
#include <map>
#include <numeric>

namespace heatsoak {

Sight sight_of(const std::vector<Candidate>& candidates, const std::vector<double>& gain_nats, double least_nats) {
  std::map<std::string, double> best_nats;
  for (std::size_t j = 0; j < candidates.size(); ++j) {
    if (candidates[j].type && candidates[j].condition.empty()) {
      double& best = best_nats[std::string(candidates[j].type->name)];
      best = std::max(best, gain_nats[j]);
    }
  }
  Sight sight;
  for (const auto& [name, nats] : best_nats) {
    if (!(nats >= least_nats)) {
      sight.unseen.push_back(name);
    }
  }
  const auto judged = static_cast<double>(std::max<std::size_t>(1, best_nats.size()));
  sight.seen_share = 1.0 - static_cast<double>(sight.unseen.size()) / judged;
  return sight;
}

std::vector<CandidateColumn> column_rules(const std::vector<Candidate>& candidates) {
  std::vector<CandidateColumn> rules;
  for (const Candidate& each : candidates) {
    rules.push_back({each.size_spec().range.low < 0.0, 2.0});
  }
  return rules;
}

std::vector<int> most_promising(const std::vector<double>& gain_nats, std::size_t most) {
  std::vector<int> order(gain_nats.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, std::greater(), [&](int j) { return gain_nats[static_cast<std::size_t>(j)]; });
  std::erase_if(order, [&](int j) { return gain_nats[static_cast<std::size_t>(j)] <= 0.0; });
  order.resize(std::min(order.size(), most));
  std::ranges::sort(order);
  return order;
}

std::vector<JudgedCandidate> judge(const std::vector<Candidate>& candidates, EvidenceTable& table, const SetScore& base) {
  std::vector<JudgedCandidate> ladder;
  for (int j = 0; j < static_cast<int>(candidates.size()); ++j) {
    const std::vector<int> set{j};
    const SetScore best = table.best(set, base.place);
    JudgedCandidate judged;
    judged.candidate = candidates[static_cast<std::size_t>(j)];
    judged.column = j;
    judged.gain_nats = best.is_allowed ? best.evidence_nats - base.evidence_nats : 0.0;
    judged.visibility_ratio = table.visibility_ratio(base.candidates, base.place, j);
    judged.size_share = best.coefficient[table.free_count()];
    judged.place = best.place;
    judged.step = best.coefficient.head(table.free_count());
    const std::vector<double> left_out = table.left_out_gains_nats(base, best);
    const std::vector<SizeInRun> sizes = table.size_by_run(best, j);
    for (std::size_t r = 0; r < left_out.size(); ++r) {
      const bool acts = sizes[r].sd_share > 0.0;
      judged.left_out_gain_nats += left_out[r];
      judged.runs_acting += acts ? 1 : 0;
      judged.runs_gained += acts && left_out[r] > 0.0 ? 1 : 0;
    }
    ladder.push_back(std::move(judged));
  }
  std::ranges::stable_sort(ladder, [](const JudgedCandidate& a, const JudgedCandidate& b) { return a.gain_nats > b.gain_nats; });
  return ladder;
}

}  // namespace heatsoak
