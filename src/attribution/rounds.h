// Rounds of a selection: fit the model, linearise along the fit, search sets of effects, and repeat along the path of the best set.
#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "attribution/selection.h"
#include "attribution/set_search.h"
#include "attribution/terms.h"
#include "estimation/fit.h"

namespace heatsoak::attribution {

/// One round: the linearised equations, and the best set found with them.
struct Judged {
  std::vector<estimation::LinearisedRun> fitted;
  std::vector<estimation::DesignRun> designs;
  std::vector<estimation::FluxPlace> places;
  std::vector<int> best;  ///< members of the best set
  estimation::FluxPlace empty_place;  ///< most probable unknown heat without any effect
  estimation::FluxPlace best_place;
};

/// Repeats rounds until the best set repeats. Results are in the protected members and in `out_`.
class Rounds {
 public:
  Rounds(const SelectionInput& input, const SelectionRules& rules);

 protected:
  Judged run_rounds();
  [[nodiscard]] const std::vector<Candidate>& candidates() const { return list_.candidates; }
  [[nodiscard]] bool is_parameter(int member) const { return member >= static_cast<int>(candidates().size()); }
  [[nodiscard]] Eigen::Index parameter_of(int member) const { return parameters_[static_cast<std::size_t>(member) - candidates().size()]; }
  [[nodiscard]] Eigen::Index free_count() const { return input_.model.free_count(); }
  [[nodiscard]] bool has_body(int member) const { return std::ranges::find(bodies_, member) != bodies_.end(); }
  [[nodiscard]] const std::string& id_of(int member) const { return set_rules_[static_cast<std::size_t>(member)].id; }
  void begin();
  /// Returns the base model with the parameter values of the last fit.
  [[nodiscard]] estimation::Model base_here() const { return with_values_of(input_.model, now_.model); }
  /// Runs one round along the path of the last fit.
  Judged judge();
  /// Sets the best set of the search with its solution and its most probable unknown heat.
  void take_best(Judged& judged, const estimation::ThetaPrior& prior) const;
  /// Adds the normal equations at those grid points that `points` does not contain yet.
  void add_points(const std::vector<estimation::DesignRun>& designs, const estimation::ThetaPrior& prior,
                  const std::vector<estimation::FluxPlace>& places, std::map<estimation::FluxPlace, estimation::Reduced>& points) const;
  /// Returns a set's columns, and the indices of θ and of these columns in a design. The set's indices refer to that selection.
  [[nodiscard]] std::pair<SetColumns, std::vector<Eigen::Index>> own_columns(const std::vector<int>& members) const;
  /// Returns ln p of every recording with a set of effects, given all others.
  [[nodiscard]] Eigen::VectorXd left_out_nats(const Judged& judged, const std::vector<int>& members) const;
  /// Returns the most probable unknown heat for a set of effects.
  [[nodiscard]] estimation::FluxPlace best_place(const std::vector<estimation::DesignRun>& designs, const estimation::ThetaPrior& prior,
                                                 const std::vector<int>& members, const estimation::FluxPlace& start) const;
  /// Returns the model with a set of effects, at the sizes and θ of the linear solution.
  [[nodiscard]] estimation::Model with_members(const std::vector<int>& members, const SetSearch::AtBest& at, ShapesAre shapes) const;
  /// Refits the best set, along whose free run the next round is linearised. The columns of its members, and of the bodies that may replace
  /// one of them, get their fitted shapes and sizes.
  void follow(const Judged& judged);
  /// Returns the best set with one body replaced by one of another law, in its most probable variant: a set for each such law.
  [[nodiscard]] std::vector<std::vector<int>> with_other_bodies() const;
  /// Copies the fitted shapes, and the sizes of sensor errors, to the candidates.
  void take_shapes(const estimation::Model& fitted, const std::vector<int>& members);
  /// Copies the fitted shape to the candidate, unless the effect has almost no size. Its size stays the typical one.
  static void take_shape(const estimation::Model& fitted, const thermal::EffectInPlace& effect, Candidate& candidate);
  /// Records the round: candidates with their single gains, the best set, and the probability of the empty set.
  void note();
  /// Records the effects whose expected gain at typical size is below `seen_nats`.
  void note_sight();
  /// Returns `fit` or plain least squares of the free runs, by the rule of estimation::more_predictive().
  [[nodiscard]] estimation::Posterior more_predictive(estimation::Posterior fit, const std::vector<estimation::MeasuredRun>& runs) const;
  /// Fits the model without effects: once with the file's priors (`before`), once with wider priors for the contradicted parameters
  /// (`own`).
  void own_parameters(const Judged& judged);
  /// Returns the start temperatures of the last fit. Nodes that it does not contain start at ambient temperature.
  [[nodiscard]] std::vector<std::vector<double>> starts_of(const estimation::Model& model) const;
  /// Returns the RMS of the smoothed unknown heat in W of a fit, by node.
  [[nodiscard]] std::map<std::string, double> left_by(const estimation::Posterior& fit) const;

  const SelectionInput& input_;
  const SelectionRules& rules_;
  bool is_speed_open_;  ///< speed was not logged: heat at the stator may be the loss at speed
  Selection out_;
  estimation::Posterior now_;  ///< fit along which the equations are linearised
  estimation::FitSetup setup_;
  estimation::FluxPlace place_, best_place_;
  CandidateList list_;
  std::vector<Eigen::Index> parameters_;
  std::vector<CandidateRule> set_rules_;
  std::vector<int> bodies_;  ///< candidates with a body of their own
  std::vector<int> best_;
  std::optional<SetSearch> search_;
};

}  // namespace heatsoak::attribution
