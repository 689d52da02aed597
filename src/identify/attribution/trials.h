// A selection's model with terms added, refitted in the equations.
#pragma once

#include <string_view>
#include <vector>

#include "identify/attribution/selection.h"

namespace heatsoak {

/// How much the free-running error on the training runs may grow: by a curve, a changed figure, a sensor's error.
inline constexpr double kMostWorse_ratio = 1.1;

/// All that is given outlives it.
class Trials {
 public:
  /// `first_place` is where a search for the unknown heat begins that knows nothing yet.
  Trials(const SelectionInput& input, const Selection& so_far, const RefitOptions& options, const FluxGrid::Place& first_place)
      : input_(input), so_far_(so_far), options_(options), first_place_(first_place) {}

  /// One judged effect; `promised_nats` is what it has to gain, or it is tried once more from what was known beforehand.
  [[nodiscard]] RefitResult of_term(const JudgedCandidate& judged, double promised_nats) const;
  /// Several of a round's candidates at once.
  [[nodiscard]] RefitResult of_set(const SetScore& set, const std::vector<Candidate>& candidates) const;
  /// Why an effect that was tried gets no name; empty where it may.
  [[nodiscard]] std::string_view why_not(const JudgedCandidate& judged, const RefitResult& fit) const;

 private:
  [[nodiscard]] RefitResult from_step(const std::vector<Candidate>& added, const std::vector<double>& size_share,
                                      const Eigen::VectorXd& step, const FluxGrid::Place& place) const;

  const SelectionInput& input_;
  const Selection& so_far_;
  const RefitOptions& options_;
  const FluxGrid::Place& first_place_;
};

}  // namespace heatsoak
