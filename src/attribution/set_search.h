// Which effects the runs ask for: the exact evidence of sets of a few of them, from least squares that θ is eliminated from.
//
// With priors N(0, s²) on the sizes, half of it where a size has a sign, the evidence of a set S under one supposition about the unknown
// heat is ln p0 + ½ vᵀp − ½ ln|K| + ½ ln|Λ| + Σ ln 2Φ(p_j/sd_j), K = M_SS + Λ, p = K⁻¹ v_S. Sums over suppositions follow.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "attribution/design.h"
#include "attribution/rules.h"

namespace heatsoak {

/// What the search has to know of a candidate.
struct CandidateRule {
  bool has_sign = true;              ///< its size cannot be negative
  double prior_nats = -4.5;          ///< ln prior odds
  std::string id;                    ///< variants of one effect share it; a set has at most one of them
  std::string family;                ///< what stands in for each other
  std::vector<int> companions = {};  ///< columns that come with it, each with a size of its own that may be negative
  double companion_sd = 1.0;
};

struct EffectSet {
  std::vector<int> members;           ///< ascending
  double log_probability_nats = 0.0;  ///< not normalised
  double probability = 0.0;
};

/// Linear evidence under several suppositions about the unknown heat.
class SetSearch {
 public:
  /// A set under one supposition.
  struct AtBest {
    std::size_t point = 0;
    double evidence_nats = 0.0;  ///< linear, at that supposition; no prior of the set
    Eigen::VectorXd sizes;       ///< of the members, in typical sizes
    Eigen::VectorXd theta;       ///< step
  };
  SetSearch(std::vector<Reduced> points, std::vector<CandidateRule> candidates, const SelectionRules& rules);

  /// Linear evidence about the path of another set can be too good by more than what a name needs. The best sets, in their order, get the
  /// evidence of their own fits, until one keeps what it promised or `most` were fitted; all others change as the best of these does.
  void reconsider(const std::function<double(const std::vector<int>& members, const AtBest& at)>& fitted_nats, std::size_t most);
  /// All sets that were looked at, best first.
  [[nodiscard]] const std::vector<EffectSet>& sets() const { return sets_; }
  /// Of at least as many members of its family as `set` has that are as sure as its member `place` or surer.
  [[nodiscard]] double family_probability(const EffectSet& set, std::size_t place) const;
  /// What ln P loses with fewer of them.
  [[nodiscard]] double loss_without_nats(const EffectSet& set, std::size_t place) const;
  /// Of a set of one: ln evidence above that of the empty set, prior not counted.
  [[nodiscard]] double single_gain_nats(int candidate) const;
  /// Candidates of the family of `set`'s member that could stand in its place within `within_nats`.
  [[nodiscard]] std::vector<int> stand_ins(const EffectSet& set, std::size_t place, double within_nats) const;

  /// Under the supposition at which the set is most probable.
  [[nodiscard]] AtBest at_best(const std::vector<int>& members) const;
  /// Share of a candidate's column that θ does not absorb.
  [[nodiscard]] double visibility_ratio(int candidate) const;
  /// Expected gain at its typical size, where it is seen least of the suppositions that matter.
  [[nodiscard]] double typical_gain_nats(int candidate) const;

 private:
  void search();
  void rank();
  double score(std::vector<int> members);
  [[nodiscard]] bool is_allowed(const std::vector<int>& members) const;
  [[nodiscard]] double log_evidence(const std::vector<int>& members) const;
  [[nodiscard]] std::vector<std::vector<int>> best_of_size(std::size_t size, std::size_t most) const;
  [[nodiscard]] int count_of(const EffectSet& set, const std::string& family) const;
  /// 1 for the surest member of its family, 2 for the next.
  [[nodiscard]] int rank_in_family(const EffectSet& set, std::size_t place) const;

  std::vector<Reduced> points_;
  std::vector<CandidateRule> candidates_;
  const SelectionRules& rules_;
  std::vector<EffectSet> sets_;
};

/// Columns of some candidates and of what comes with them, with their prior.
struct SetColumns {
  std::vector<Eigen::Index> columns;  ///< the candidates' own first
  std::vector<bool> has_sign;
  Eigen::VectorXd precision;
};
SetColumns columns_of(const std::vector<int>& members, const std::vector<CandidateRule>& candidates, double size_sd);

/// ½ vᵀp − ½ ln|K| + ½ ln|Λ| + Σ ln 2Φ for those that have a sign; `precision` is Λ.
double set_gain_nats(const Eigen::MatrixXd& products, const Eigen::VectorXd& right, const Eigen::MatrixXd& precision,
                     const std::vector<bool>& has_sign, Eigen::VectorXd* sizes = nullptr);
/// Of the set in what the runs say at one supposition.
double set_gain_nats(const Reduced& point, const SetColumns& set, Eigen::VectorXd* sizes = nullptr);
/// ln Σ exp.
double log_sum_nats(const std::vector<double>& all_nats);

}  // namespace heatsoak
