// Search of the most probable set of effects, with the evidence of least squares after θ has been eliminated.
//
// Priors of the sizes are N(0, s²), or its positive half if a size has a sign. For one assumed unknown heat the ln evidence of a set S is
// ln p0 + ½ vᵀp − ½ ln|K| + ½ ln|Λ| + Σ ln 2Φ(p_j/sd_j). Here K = M_SS + Λ and p = K⁻¹ v_S. The evidence is averaged over the assumptions.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "attribution/rules.h"
#include "estimation/design.h"

namespace heatsoak::attribution {

/// Prior of a candidate, and its relation to the others.
struct CandidateRule {
  bool has_sign = true;              ///< the size cannot be negative
  double prior_nats = -4.5;          ///< ln prior odds
  std::string id;                    ///< same for all variants of an effect; a set contains at most one of them
  std::string family;                ///< group of effects that may replace each other
  std::vector<int> companions = {};  ///< columns added with it; each has a size that may be negative
  double companion_sd = 1.0;
};

struct EffectSet {
  std::vector<int> members;           ///< indices, ascending
  double log_probability_nats = 0.0;  ///< not normalised
  double probability = 0.0;
};

/// Searches the sets of effects with the highest linear evidence. A point is one assumption about the size of the unknown heat.
class SetSearch {
 public:
  /// Solution for a set, at one point.
  struct AtBest {
    std::size_t point = 0;
    double evidence_nats = 0.0;  ///< linear evidence at that point, without the prior of the set
    Eigen::VectorXd sizes;       ///< sizes of the members, in typical sizes
    Eigen::VectorXd theta;       ///< step of θ
  };
  /// A set, and how it was made from a smaller one.
  struct Grown {
    std::vector<int> members;  ///< indices, ascending
    int added = 0;             ///< member that the smaller set lacks
  };
  SetSearch(std::vector<estimation::Reduced> points, std::vector<CandidateRule> candidates, const SelectionRules& rules);

  /// Replaces the linear evidence of sets by that of nonlinear fits, best set first. The linear evidence can be too high, because it was
  /// computed along the path of another set. Stops after `most` fits, or at the first set whose evidence falls by less than
  /// `distinct_nats`. The evidence of each set without a fit changes by as much as that of the set which is best after the fits.
  void reconsider(const std::function<double(const std::vector<int>& members, const AtBest& at)>& fitted_nats, std::size_t most);
  /// Returns all evaluated sets, best first.
  [[nodiscard]] const std::vector<EffectSet>& sets() const { return sets_; }
  /// Ranks the members of the set within their family, the most certain first. Returns the probability of all sets that have at least as
  /// many members of the family as the rank of the member at `place`, or one of `others`, which may replace it.
  [[nodiscard]] double family_probability(const EffectSet& set, std::size_t place, const std::vector<int>& others = {}) const;
  /// Returns ln P of `set` minus that of the best set with fewer members of this family and none of `others`; 0 if there is none.
  [[nodiscard]] double loss_without_nats(const EffectSet& set, std::size_t place, const std::vector<int>& others = {}) const;
  /// Returns the ln evidence of the candidate alone minus that of the empty set, without priors.
  [[nodiscard]] double single_gain_nats(int candidate) const;
  /// Returns candidates that may replace the member at `place` with a loss of ln P of at most `within_nats`.
  [[nodiscard]] std::vector<int> stand_ins(const EffectSet& set, std::size_t place, double within_nats) const;

  /// Returns the solution at the point where the set is most probable.
  [[nodiscard]] AtBest at_best(const std::vector<int>& members) const;
  /// Returns the fraction of the candidate's column, as a sum of squares, that θ cannot reproduce; 0 to 1.
  [[nodiscard]] double visibility_ratio(int candidate) const;
  /// Returns the expected gain at typical size, at the most probable point of the empty set.
  [[nodiscard]] double typical_gain_nats(int candidate) const;

 private:
  /// Evaluates the empty set, all single candidates and growing combinations of the best ones.
  void search();
  void rank();
  /// Evaluates the sets that are not evaluated yet; sets with two variants of one effect are skipped.
  void evaluate(const std::vector<Grown>& sets);
  [[nodiscard]] double evaluated_nats(const std::vector<int>& members) const;
  [[nodiscard]] std::vector<std::vector<int>> best_of_size(std::size_t size, std::size_t most) const;
  /// Returns ln P of a set, not normalised; −∞ if it was not evaluated.
  [[nodiscard]] double nats_of(const std::vector<int>& members) const;
  [[nodiscard]] int count_of(const EffectSet& set, const std::string& family) const;
  /// True if the set has at least `least` members of the family, or one of `others`.
  [[nodiscard]] bool answers(const EffectSet& each, const std::string& family, int least, const std::vector<int>& others) const;
  /// Returns 1 for the most certain member of its family, 2 for the next, and so on.
  [[nodiscard]] int rank_in_family(const EffectSet& set, std::size_t place) const;

  std::vector<estimation::Reduced> points_;
  std::vector<CandidateRule> candidates_;
  const SelectionRules& rules_;
  std::vector<EffectSet> sets_;
};

/// Columns of a set with their companions, and the prior precision.
struct SetColumns {
  std::vector<Eigen::Index> columns;  ///< columns of the members first
  std::vector<bool> has_sign;
  Eigen::VectorXd precision;
};
SetColumns columns_of(const std::vector<int>& members, const std::vector<CandidateRule>& candidates, double size_sd);

/// Returns the gain in ln evidence of a set at one point, see estimation::size_gain_nats().
double set_gain_nats(const estimation::Reduced& point, const SetColumns& set, Eigen::VectorXd* sizes = nullptr);

}  // namespace heatsoak::attribution
