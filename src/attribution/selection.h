// Selection of the effects that a model lacks: sets of candidates compete by evidence, with unknown heat in every model.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "attribution/candidates.h"
#include "attribution/regressor_scan.h"
#include "attribution/rules.h"
#include "base/job_progress.h"
#include "estimation/posterior.h"

namespace heatsoak::attribution {

/// Unexplained part of the runs that the model's file was fitted to.
struct UsualErrors {
  std::optional<double> error_K = {};  ///< RMS error of whole runs if these decided the parameters (free_run_error_K of MotorFit)
  std::optional<double> flux_W = {};   ///< RMS of the unknown heat; empty: not known
};

/// Names of the phases of select_effects(), for its progress.
namespace selection_phases {
inline const std::string kFirstFit = "fitting the model";
inline const std::string kSearching = "searching missing effects";
inline const std::string kFollowing = "fitting the effects";
inline const std::string kCurves = "searching curves";
inline const std::string kLastFit = "fitting the extended model";
}  // namespace selection_phases

struct SelectionInput {
  estimation::Model model;
  std::vector<estimation::MeasuredRun> runs;  ///< at least one
  UsualErrors usual = {};
  base::JobProgress progress = {};
};

/// A candidate evaluated alone, as a set of one effect.
struct JudgedCandidate {
  Candidate candidate;
  double gain_nats = 0.0;         ///< ln evidence relative to the model without effects
  double visibility_ratio = 0.0;  ///< fraction of its column, as a sum of squares, that θ cannot reproduce
  double size_share = 0.0;        ///< fitted size in typical sizes
  double probability = 0.0;       ///< probability of all sets that contain it
};

/// Result of one search, along one linearisation.
struct Round {
  std::vector<JudgedCandidate> ladder;  ///< best first
  std::vector<ScanResult> scan;         ///< last round only; best first
  std::vector<std::string> taken;       ///< members of the best set
  double taken_nats = 0.0;              ///< ln P of the best set relative to the empty set
};

/// An accepted effect of the catalogue, or an accepted curve.
struct AcceptedTerm {
  std::optional<Candidate> candidate;  ///< effect of the catalogue; empty for a curve
  std::optional<ScanResult> curve;     ///< curve of the scan; empty for an effect
  std::string effect_name;             ///< name of the instance in the network; empty for sensor errors and run deviations
  double probability = 0.0;            ///< probability of its family, and of what may replace it in the same runs
  double loss_without_nats = 0.0;      ///< loss of ln P without its family
  double visibility_ratio = 0.0;
  std::vector<std::string> confusable_with;  ///< ids of effects, or names of signals, that explain the runs almost as well
  std::vector<std::string> experiments;      ///< experiments that separate them, in the same order
};

/// Reason to reject a candidate that explains something.
enum class RefusalReason {
  improbable,                  ///< its probability is too low to name it as the cause
  one_run_only,                ///< it improves the prediction of one left-out run only
  curve_is_better,             ///< a curve over a signal explains the runs better
  unknown_heat_remains,        ///< material unknown heat remains, and the error of whole runs does not fall enough
  hardly_improves_whole_runs,  ///< the prediction of whole runs hardly improves
  no_size                      ///< the fit of the whole model cannot distinguish its size from zero
};
struct Refusal {
  std::string id;
  RefusalReason reason = RefusalReason::improbable;
  double probability = 0.0;         ///< for `improbable`
  double needed_probability = 0.0;  ///< for `improbable`
  std::string signal = {};          ///< for `curve_is_better`

  bool operator==(const Refusal&) const = default;
};

/// Effects that the runs show, with the fits before and after they were added to the model.
struct Selection {
  estimation::Posterior before;  ///< fit of the model's own parameters, without effects
  estimation::Posterior after;
  estimation::Posterior own;  ///< same as `before`, with wider priors for contradicted parameters
  /// Coordinates of parameters that the runs contradict, each with the loss of ln P without its wide prior. Another mounting, another
  /// specimen or a loose terminal changes them; without this test, such a change would be mistaken for an effect.
  std::map<Eigen::Index, double> changed_nats;
  std::vector<AcceptedTerm> terms;
  std::vector<Round> rounds;
  std::vector<Regressor> regressors;  ///< signals of the scan
  std::vector<UntestedEffect> not_judged;
  double mean_heat_W = 0.0;              ///< mean heat of the model along the runs, see usual_heat_W()
  double material_W = 0.0;               ///< unknown heat below this is normal for any model
  std::map<std::string, double> left_W;  ///< by node: RMS of the smoothed unknown heat with the best set
  std::vector<Eigen::VectorXd> weights;  ///< per run and sample: 0 for samples that the model excludes as wrong
  std::vector<std::string> unseen;       ///< effects that would not be visible in these runs at typical size
  double seen_share = 1.0;               ///< fraction of the tested effects that would be visible
  double nothing_probability = 1.0;      ///< probability of the empty set
  std::vector<Refusal> refused;
  bool is_as_usual = false;     ///< the file's model predicts these runs as well as those it was fitted to; it is unchanged
  bool is_unexplained = false;  ///< material unknown heat remains, and no effect of the catalogue explains it

  /// True if the unknown heat at some node exceeds `material_W`.
  [[nodiscard]] bool is_material() const;
  /// True if an effect is probably missing but none can be named.
  [[nodiscard]] bool is_undecided() const { return terms.empty() && nothing_probability < 1.0 - estimation::named_probability(); }
};

/// Selects the effects. Throws Failure (numerics_failed) if the model cannot be simulated along the runs.
Selection select_effects(const SelectionInput& input, const SelectionRules& rules);

}  // namespace heatsoak::attribution
