// The rounds of a selection: fit, linear equations about the fit's path, search of sets, and again about the path of the best set.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "attribution/flux_grid.h"
#include "attribution/selection.h"
#include "attribution/set_search.h"
#include "attribution/terms.h"

namespace heatsoak {

/// A round's linear algebra and what the search makes of it.
struct Judged {
  std::vector<LinearisedRun> fitted;
  std::vector<DesignRun> designs;
  std::vector<FluxPlace> places;
  std::vector<int> best;  ///< members of the best set
  SetSearch::AtBest at_best;
  FluxPlace empty_place;  ///< most probable without any effect
  FluxPlace best_place;
};

/// Until the best set repeats. What is found is left in the members; `out_` has the rounds.
class Rounds {
 public:
  Rounds(const SelectionInput& input, const SelectionRules& rules);

 protected:
  Judged run_rounds();
  [[nodiscard]] const std::vector<Candidate>& candidates() const { return list_.candidates; }
  [[nodiscard]] bool is_parameter(int member) const { return member >= static_cast<int>(candidates().size()); }
  [[nodiscard]] Eigen::Index parameter_of(int member) const { return figures_[static_cast<std::size_t>(member) - candidates().size()]; }
  [[nodiscard]] Eigen::Index free_count() const { return input_.model.free_count(); }
  void begin();
  /// The base model about the path of the last fit.
  [[nodiscard]] ExtendedModel base_here() const { return with_values_of(input_.model, now_.model); }
  Judged judge();
  void add_points(const std::vector<DesignRun>& designs, const ThetaPrior& prior, const std::vector<FluxPlace>& places,
                  std::map<FluxPlace, Reduced>& points) const;
  [[nodiscard]] FluxPlace best_place(const std::vector<DesignRun>& designs, const ThetaPrior& prior, const std::vector<int>& members,
                                     const FluxPlace& start) const;
  /// The model with a set of effects, near where the linear algebra has them.
  [[nodiscard]] ExtendedModel with_members(const std::vector<int>& members, const SetSearch::AtBest& at, ShapesAre shapes) const;
  /// Moves the path to the free run of the best set, and the columns of its members to their shapes and sizes.
  void follow(const Judged& judged);
  static double away_from_zero(double share);
  /// The candidate's exponents, thresholds and time constants as the fit has them; its size stays the typical one.
  void take_shapes(const EffectInPlace& fitted, Candidate& candidate) const;
  void note();
  void note_sight();
  [[nodiscard]] RefitOptions final_options(const FluxPlace& place) const;
  /// Where sensors show what heats nothing, the network lacks bodies, and whitened errors may no longer say which figures predict: these
  /// are fitted to the free runs then, if that predicts the ends of the runs better. What they move by counts as uncertainty.
  [[nodiscard]] RefitResult to_predict(RefitResult fit) const;
  /// K rms: how well a fit to the first parts of all runs predicts their last thirds.
  [[nodiscard]] double error_of_ends_K(const RefitResult& start, RefitOptions options) const;
  /// Least squares of free runs.
  [[nodiscard]] RefitOptions plain_options() const;
  /// The model with nothing added, as the file has it and with uncertainty in what does not hold.
  void own_parameters(const Judged& judged);
  /// Of the last fit; nodes that it does not have begin at the ambient temperature.
  [[nodiscard]] std::vector<std::vector<double>> starts_of(const ExtendedModel& model) const;
  /// Root mean square of what a fit leaves, by node.
  [[nodiscard]] std::map<std::string, double> left_by(const RefitResult& fit) const;

  const SelectionInput& input_;
  const SelectionRules& rules_;
  bool is_speed_open_;  ///< heat at the stator then may well be the loss at the speed that nobody logged
  Selection out_;
  RefitResult now_;  ///< the fit whose path the equations are linearised about
  std::vector<int> merged_;
  double unit_W_ = 0.0;  ///< of unknown heat
  FluxGrid grid_;
  FluxPlace place_, best_place_;
  CandidateList list_;
  std::vector<Eigen::Index> figures_;
  std::vector<CandidateRule> set_rules_;
  std::vector<int> bodies_;  ///< candidates with a body of their own
  std::vector<int> best_;
  std::optional<SetSearch> search_;
};

}  // namespace heatsoak
