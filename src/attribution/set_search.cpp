#include "attribution/set_search.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <set>
#include <string_view>

#include "base/parallel.h"
#include "estimation/size_evidence.h"
#include "estimation/thresholds.h"

namespace heatsoak::attribution {
namespace {

constexpr double kNone_nats = -std::numeric_limits<double>::infinity();

/// Returns ln Σ exp(x) of a non-empty list.
double log_sum_nats(const std::vector<double>& nats) {
  const double most = std::ranges::max(nats);
  double sum = 0.0;
  for (const double each : nats) {
    sum += std::exp(each - most);
  }
  return std::isfinite(most) ? most + std::log(sum) : most;
}

/// Returns every set with every other member added, one at a time.
std::vector<SetSearch::Grown> grown(const std::vector<std::vector<int>>& sets, const auto& members) {
  std::vector<SetSearch::Grown> all;
  for (const std::vector<int>& set : sets) {
    for (const int member : members) {
      if (const auto place = std::ranges::lower_bound(set, member); place == set.end() || *place != member) {
        all.push_back({set, member});
        all.back().members.insert(all.back().members.begin() + (place - set.begin()), member);
      }
    }
  }
  return all;
}

}  // namespace

SetColumns columns_of(const std::vector<int>& members, const std::vector<CandidateRule>& candidates, double size_sd) {
  SetColumns set;
  std::vector<double> precision;
  for (const int member : members) {
    set.columns.push_back(member);
    set.has_sign.push_back(candidates[static_cast<std::size_t>(member)].has_sign);
    precision.push_back(1.0 / (size_sd * size_sd));
  }
  for (const int member : members) {
    const CandidateRule& rule = candidates[static_cast<std::size_t>(member)];
    for (const int companion : rule.companions) {
      set.columns.push_back(companion);
      set.has_sign.push_back(false);
      precision.push_back(1.0 / (rule.companion_sd * rule.companion_sd));
    }
  }
  set.precision = Eigen::Map<const Eigen::VectorXd>(precision.data(), static_cast<Eigen::Index>(precision.size()));
  return set;
}

double set_gain_nats(const estimation::Reduced& point, const SetColumns& set, Eigen::VectorXd* sizes) {
  return estimation::size_gain_nats(point, set.columns, set.precision, set.has_sign, sizes);
}

SetSearch::SetSearch(std::vector<estimation::Reduced> points, std::vector<CandidateRule> candidates, const SelectionRules& rules)
    : points_(std::move(points)), candidates_(std::move(candidates)), rules_(rules) {
  search();
}

double SetSearch::evaluated_nats(const std::vector<int>& members) const {
  const SetColumns set = columns_of(members, candidates_, rules_.size_sd);
  std::vector<double> nats;
  for (const estimation::Reduced& point : points_) {
    nats.push_back(point.base_nats + set_gain_nats(point, set));
  }
  double sum_nats = log_sum_nats(nats) - std::log(static_cast<double>(points_.size()));
  for (const int member : members) {
    sum_nats += candidates_[static_cast<std::size_t>(member)].prior_nats;
  }
  return sum_nats;
}

void SetSearch::evaluate(const std::vector<Grown>& sets) {
  const std::size_t first = sets_.size();
  for (const auto& [members, added] : sets) {
    std::set<std::string_view> ids;
    std::ranges::for_each(members, [&](int member) { ids.insert(candidates_[static_cast<std::size_t>(member)].id); });
    if (ids.size() == members.size() && std::ranges::find(sets_, members, &EffectSet::members) == sets_.end()) {
      sets_.push_back({members, 0.0, 0.0});
    }
  }
  base::in_parallel(sets_.size() - first, 0, [&](std::size_t i) {
    EffectSet& set = sets_[first + i];
    set.log_probability_nats = evaluated_nats(set.members);
  });
}

std::vector<std::vector<int>> SetSearch::best_of_size(std::size_t size, std::size_t most) const {
  std::vector<const EffectSet*> found;
  for (const EffectSet& set : sets_) {
    if (set.members.size() == size) {
      found.push_back(&set);
    }
  }
  std::ranges::stable_sort(found, std::greater(), [](const EffectSet* set) { return set->log_probability_nats; });
  found.resize(std::min(found.size(), most));
  std::vector<std::vector<int>> members;
  std::ranges::transform(found, std::back_inserter(members), &EffectSet::members);
  return members;
}

void SetSearch::search() {
  constexpr std::size_t kGrownFrom = 3;
  std::vector<int> all(candidates_.size());
  std::iota(all.begin(), all.end(), 0);
  evaluate({Grown{}});
  evaluate(grown({{}}, all));
  std::set<int> pool;
  for (const std::vector<int>& single : best_of_size(1, static_cast<std::size_t>(rules_.pool_of_one))) {
    pool.insert(single.front());
  }
  for (int size = 1; size < rules_.most_effects; ++size) {
    // An effect without evidence alone may explain the residual of the best sets.
    const std::vector<Grown> larger = grown(best_of_size(static_cast<std::size_t>(size), kGrownFrom), all);
    evaluate(larger);
    std::vector<std::pair<double, int>> additions;
    std::ranges::transform(larger, std::back_inserter(additions),
                           [&](const Grown& each) { return std::pair(nats_of(each.members), each.added); });
    std::ranges::sort(additions, std::greater());
    int free_places = size == 1 ? rules_.pool_of_two : rules_.pool_of_three;
    for (const auto& [nats, j] : additions) {
      free_places -= free_places > 0 && pool.insert(j).second ? 1 : 0;
    }
    evaluate(grown(best_of_size(static_cast<std::size_t>(size), static_cast<std::size_t>(rules_.best_grown)), pool));
  }
  rank();
}

void SetSearch::reconsider(const std::function<double(const std::vector<int>&, const AtBest&)>& fitted_nats, std::size_t most) {
  std::vector<double> change_nats;
  std::size_t winner = 0;
  for (std::size_t i = 0; i < std::min(most, sets_.size()); ++i) {
    const AtBest at = at_best(sets_[i].members);
    change_nats.push_back(fitted_nats(sets_[i].members, at) - at.evidence_nats);
    const auto nats = [&](std::size_t set) { return sets_[set].log_probability_nats + change_nats[set]; };
    winner = nats(i) > nats(winner) ? i : winner;
    if (change_nats.back() > -estimation::thresholds().distinct_nats) {
      break;
    }
  }
  const double common_nats = change_nats[winner];
  if (!std::isfinite(common_nats)) {
    return;  // all fits failed and show nothing
  }
  for (std::size_t i = 0; i < sets_.size(); ++i) {
    sets_[i].log_probability_nats += i < change_nats.size() ? change_nats[i] : common_nats;
  }
  rank();
}

void SetSearch::rank() {
  std::ranges::stable_sort(sets_, std::greater(), &EffectSet::log_probability_nats);
  std::vector<double> nats;
  std::ranges::transform(sets_, std::back_inserter(nats), &EffectSet::log_probability_nats);
  const double all_nats = log_sum_nats(nats);
  for (EffectSet& set : sets_) {
    set.probability = std::exp(set.log_probability_nats - all_nats);
  }
}

double SetSearch::nats_of(const std::vector<int>& members) const {
  const auto found = std::ranges::find(sets_, members, &EffectSet::members);
  return found == sets_.end() ? kNone_nats : found->log_probability_nats;
}

int SetSearch::count_of(const EffectSet& set, const std::string& family) const {
  return static_cast<int>(
      std::ranges::count_if(set.members, [&](int member) { return candidates_[static_cast<std::size_t>(member)].family == family; }));
}

int SetSearch::rank_in_family(const EffectSet& set, std::size_t place) const {
  // The effect with the larger loss of ln P without it has the better rank within its family.
  const auto nats_without = [&](std::size_t gone) {
    std::vector<int> rest = set.members;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(gone));
    return nats_of(rest);
  };
  const std::string& family = candidates_[static_cast<std::size_t>(set.members[place])].family;
  const double own_nats = nats_without(place);
  int rank = 1;
  for (std::size_t other = 0; other < set.members.size(); ++other) {
    const bool is_alike = other != place && candidates_[static_cast<std::size_t>(set.members[other])].family == family;
    const double other_nats = is_alike ? nats_without(other) : 0.0;
    rank += is_alike && (other_nats < own_nats || (other_nats == own_nats && other < place)) ? 1 : 0;
  }
  return rank;
}

bool SetSearch::answers(const EffectSet& each, const std::string& family, int least, const std::vector<int>& others) const {
  const auto is_in = [&](int other) { return std::ranges::binary_search(each.members, other); };
  return std::ranges::any_of(others, is_in) || count_of(each, family) >= least;
}

double SetSearch::family_probability(const EffectSet& set, std::size_t place, const std::vector<int>& others) const {
  const std::string& family = candidates_[static_cast<std::size_t>(set.members[place])].family;
  const int least = rank_in_family(set, place);
  double sum = 0.0;
  for (const EffectSet& each : sets_) {
    sum += answers(each, family, least, others) ? each.probability : 0.0;
  }
  return sum;
}

double SetSearch::loss_without_nats(const EffectSet& set, std::size_t place, const std::vector<int>& others) const {
  const std::string& family = candidates_[static_cast<std::size_t>(set.members[place])].family;
  const int least = rank_in_family(set, place);
  const auto without = std::ranges::find_if(sets_, [&](const EffectSet& each) { return !answers(each, family, least, others); });
  return without == sets_.end() ? 0.0 : set.log_probability_nats - without->log_probability_nats;
}

double SetSearch::single_gain_nats(int candidate) const {
  return nats_of({candidate}) - candidates_[static_cast<std::size_t>(candidate)].prior_nats - nats_of({});
}

std::vector<int> SetSearch::stand_ins(const EffectSet& set, std::size_t place, double within_nats) const {
  std::vector<int> found;
  const int own = set.members[place];
  for (const EffectSet& each : sets_) {
    if (each.log_probability_nats < set.log_probability_nats - within_nats) {
      break;
    }
    if (each.members.size() != set.members.size() || std::ranges::find(each.members, own) != each.members.end()) {
      continue;
    }
    std::vector<int> others;
    std::ranges::set_difference(each.members, set.members, std::back_inserter(others));
    const bool is_other =
        others.size() == 1 && candidates_[static_cast<std::size_t>(others.front())].id != candidates_[static_cast<std::size_t>(own)].id;
    if (is_other && std::ranges::find(found, others.front()) == found.end()) {
      found.push_back(others.front());
    }
  }
  return found;
}

SetSearch::AtBest SetSearch::at_best(const std::vector<int>& members) const {
  const SetColumns set = columns_of(members, candidates_, rules_.size_sd);
  AtBest best;
  double best_nats = kNone_nats;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const estimation::Reduced& point = points_[i];
    Eigen::VectorXd sizes(static_cast<Eigen::Index>(set.columns.size()));
    const double nats = point.base_nats + set_gain_nats(point, set, &sizes);
    if (nats > best_nats) {
      best_nats = nats;
      best = {i, nats, sizes.head(static_cast<Eigen::Index>(members.size())),
              point.theta - point.theta_by_size(Eigen::all, set.columns) * sizes};
    }
  }
  return best;
}

double SetSearch::visibility_ratio(int candidate) const {
  const estimation::Reduced& point = points_[at_best({}).point];
  return point.whole[candidate] > 0.0 ? std::max(0.0, point.products(candidate, candidate) / point.whole[candidate]) : 0.0;
}

double SetSearch::typical_gain_nats(int candidate) const { return 0.5 * points_[at_best({}).point].products(candidate, candidate); }

}  // namespace heatsoak::attribution
