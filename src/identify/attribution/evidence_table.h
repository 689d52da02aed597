// How well each extension of a model explains the runs, from small dense least squares in whitened space.
//
// The evidence of a set of candidates (identify/evidence.h, with Z = [∂/∂θ, the set's columns]) is maximised over the strengths σ of the
// unknown heat and its time scale ℓ for every set anew: otherwise the unknown heat swallows the effect. One whitening per (σ, ℓ) serves all
// sets.
#pragma once

#include <Eigen/Core>
#include <map>
#include <span>
#include <vector>

#include "identify/evidence.h"

namespace heatsoak {

/// One run at the present fit. The columns are: one per free parameter (per unit of θ), one per candidate (per typical size).
struct DesignRun {
  LinearisedRun run;  ///< averaged, see identify/averaged_run.h; without by_parameter
  SensorNoise noise;
  StartPrior start;
  Columns columns;
  std::vector<Eigen::Index> interval_of;  ///< per interval of the log that of `run`; -1: none
};

/// What (σ, ℓ) may be. A place is one index per node that unknown heat may reach, then the index of the time scale.
struct FluxGrid {
  std::vector<double> rms_W;  ///< increasing, the first is 0
  std::vector<double> time_scale_s;
  double mean_heat_W = 0.0;  ///< that the model knows of
  using Place = std::vector<int>;

  [[nodiscard]] LatentFlux at(const Place& place) const;
  /// How probable a place is before anything is measured: models leave a few per cent of the heat they know unexplained. Exponential in
  /// the strengths (Simpson et al. 2017, the prior that penalises complexity), 5 % of it beyond a tenth of the mean heat.
  [[nodiscard]] double log_prior_nats(const Place& place) const;
  /// More heat is unknown at the node with place `flux` (-1: at all together) than every model leaves, and not plainly less than before.
  [[nodiscard]] bool leaves_heat(const Place& before, const Place& with, int flux) const;
  /// One more value between every two (σ = 0 keeps its neighbour): how sure a figure is depends on σ and ℓ more finely than what is named.
  [[nodiscard]] FluxGrid finer() const;
  /// The same (σ, ℓ) in the grid that finer() gives.
  [[nodiscard]] static Place in_finer(Place place);
};

/// Steps of 2 between 0.4 % and three times `mean_heat_W`, and times between 20 s and `longest_s`.
FluxGrid flux_grid(double mean_heat_W, double longest_s);

/// Gaussian knowledge of θ; the mean is relative to the present θ.
struct ThetaPrior {
  Eigen::MatrixXd precision;
  Eigen::VectorXd mean;
};

/// A candidate as least squares see it.
struct CandidateColumn {
  bool may_be_negative = false;
  double prior_sd_share = 2.0;  ///< standard deviation of the size before, in typical sizes
};

/// A set of candidates at its best place.
struct SetScore {
  std::vector<int> candidates;
  double evidence_nats = 0.0;
  FluxGrid::Place place;
  Eigen::VectorXd coefficient;  ///< θ steps, then sizes in typical sizes
  Eigen::MatrixXd covariance;
  bool is_allowed = true;  ///< no size breaks its sign
};

/// In typical sizes; a standard deviation of 0 says that the run is silent.
struct SizeInRun {
  double size_share = 0.0;
  double sd_share = 0.0;
};

/// rough: one number of a place after the other; thorough: also several at once, for much heat that changes slowly looks like little that
/// changes fast.
enum class Search { rough, thorough };

class EvidenceTable {
 public:
  EvidenceTable(std::vector<DesignRun> runs, FluxGrid grid, ThetaPrior prior, std::vector<CandidateColumn> candidates);

  /// The same with a few of the candidates, in that order: what a place costs grows with their number.
  [[nodiscard]] EvidenceTable only(std::span<const int> few) &&;

  /// The set at one place.
  [[nodiscard]] SetScore score(std::span<const int> set, const FluxGrid::Place& place);
  /// The set at its best place: from `start` step by step as long as the evidence grows.
  [[nodiscard]] SetScore best(std::span<const int> set, const FluxGrid::Place& start, Search search = Search::thorough);

  /// Gain over `base` of each single candidate added to its set, best over the places around the base's and those with less
  /// unknown heat; 0 where the sign is wrong.
  [[nodiscard]] std::vector<double> single_gains_nats(const SetScore& base);

  /// Evidence of the base with its candidates and another prior of θ, best over the same places.
  [[nodiscard]] double best_nats_with(const ThetaPrior& prior, const SetScore& base);

  /// Predictive gain of `set` over `base` on each run with all that is fitted on the other runs.
  [[nodiscard]] std::vector<double> left_out_gains_nats(const SetScore& base, const SetScore& set);
  /// Share of a candidate's whitened column that θ and the members of `base` do not absorb: 1 − R².
  [[nodiscard]] double visibility_ratio(std::span<const int> base, const FluxGrid::Place& place, int candidate);
  /// Evidence that each candidate would bring at its typical size beside the base.
  [[nodiscard]] std::vector<double> typical_gains_nats(const SetScore& base);
  /// Of the whitened columns of two candidates, after removal of what θ and `base` absorb.
  [[nodiscard]] double cosine_ratio(const SetScore& base, int a, int b);
  /// What each run alone says of a member's size while everything else is as the set has it.
  [[nodiscard]] std::vector<SizeInRun> size_by_run(const SetScore& set, int candidate);

  [[nodiscard]] const FluxGrid& grid() const { return grid_; }
  [[nodiscard]] std::span<const DesignRun> runs() const { return runs_; }
  /// Of θ and a set's sizes.
  [[nodiscard]] ThetaPrior prior_of(std::span<const int> set) const;
  /// Whitened squares that are left where the columns were taken, the start temperatures at their best, the prior's included.
  [[nodiscard]] double misfit_now(const FluxGrid::Place& place);
  /// Triangle of [θ, candidates, residual] of all runs.
  [[nodiscard]] const RunEvidence& all_runs(const FluxGrid::Place& place) { return at(place).all; }
  [[nodiscard]] Eigen::Index free_count() const { return prior_.mean.size(); }

 private:
  /// Triangles of [θ, candidates, residual], run by run and of all.
  struct Reduced {
    std::vector<RunEvidence> run;
    RunEvidence all;
  };
  /// Where nobody asks about a candidate, without their columns: they are what takes the time.
  const Reduced& at(const FluxGrid::Place& place, bool has_candidates = true);
  /// Of [θ, the set's members].
  [[nodiscard]] std::vector<Eigen::Index> columns_of(std::span<const int> set) const;
  [[nodiscard]] LinearFit fit(std::span<const RunEvidence> runs, std::span<const int> set) const;
  [[nodiscard]] RunEvidence selected(const RunEvidence& run, std::span<const int> set) const;
  /// What is left of candidates' columns once θ and the set's members have absorbed what they can.
  Eigen::MatrixXd unabsorbed(std::span<const int> base, const FluxGrid::Place& place, const std::vector<int>& candidates);

  std::vector<DesignRun> runs_;
  FluxGrid grid_;
  ThetaPrior prior_;
  std::vector<CandidateColumn> candidates_;
  std::map<std::pair<FluxGrid::Place, bool>, Reduced> reduced_;
};

}  // namespace heatsoak
