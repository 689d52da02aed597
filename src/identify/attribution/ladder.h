// Candidates in the order of what the runs say for them, by the linear evidence alone.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "identify/attribution/candidates.h"
#include "identify/attribution/evidence_table.h"

namespace heatsoak {

/// One effect that explains something, as it was judged in its round.
struct JudgedCandidate {
  Candidate candidate;
  int column = 0;  ///< of the round's table
  double gain_nats = 0.0;
  double visibility_ratio = 0.0;
  double left_out_gain_nats = 0.0;  ///< on runs left out of the fit, all together
  int runs_gained = 0;              ///< of the runs in which it acts at all
  int runs_acting = 0;
  double size_share = 0.0;  ///< in typical sizes
  FluxGrid::Place place;    ///< of the unknown heat that is most probable beside it
  Eigen::VectorXd step;     ///< that the model's coordinates make with it
};

/// What the runs could show.
struct Sight {
  std::vector<std::string> unseen;  ///< effects that would not show at their typical size in any of their forms
  double seen_share = 1.0;          ///< of the effects
};
/// `gain_nats`: of each candidate at its typical size.
Sight sight_of(const std::vector<Candidate>& candidates, const std::vector<double>& gain_nats, double least_nats);

/// The candidates as least squares see them.
std::vector<CandidateColumn> column_rules(const std::vector<Candidate>& candidates);

/// Places of those that gain most and something, at most `most`, in their own order.
std::vector<int> most_promising(const std::vector<double>& gain_nats, std::size_t most);

/// The candidates of a table with their unknown heat re-maximised, best first.
std::vector<JudgedCandidate> judge(const std::vector<Candidate>& candidates, EvidenceTable& table, const SetScore& base);

}  // namespace heatsoak
