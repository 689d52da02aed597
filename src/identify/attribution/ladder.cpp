#include "identify/attribution/ladder.h"

#include <algorithm>
#include <numeric>

namespace heatsoak {

std::vector<JudgedCandidate> judge(const std::vector<Candidate>& candidates, EvidenceTable& table, const SetScore& base, int most) {
  const std::vector<double> gain_nats = table.single_gains_nats(base);
  std::vector<int> order(candidates.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order,
                           [&](int a, int b) { return gain_nats[static_cast<std::size_t>(a)] > gain_nats[static_cast<std::size_t>(b)]; });
  std::vector<JudgedCandidate> ladder;
  for (const int j : order) {
    if (static_cast<int>(ladder.size()) >= most || gain_nats[static_cast<std::size_t>(j)] <= 0.0) {
      break;
    }
    const std::vector<int> set{j};
    const SetScore best = table.best(set, base.place);
    JudgedCandidate judged;
    judged.candidate = candidates[static_cast<std::size_t>(j)];
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
