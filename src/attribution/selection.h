// Which effects a model lacks: the base model, an unknown heat and every candidate compete by the evidence of sets of effects.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "attribution/changed_parameters.h"
#include "attribution/refit.h"
#include "attribution/regressor_scan.h"
#include "attribution/rules.h"

namespace heatsoak {

struct SelectionInput {
  ExtendedModel model;
  std::vector<MeasuredRun> runs;  ///< at least one
};

/// A candidate as one of a round's sets of one.
struct JudgedCandidate {
  Candidate candidate;
  double gain_nats = 0.0;         ///< ln evidence above that of no effect
  double visibility_ratio = 0.0;  ///< share of it that no change of the model's own figures could pass for
  double size_share = 0.0;        ///< in typical sizes
  double probability = 0.0;       ///< of all sets that contain it
};

/// A search at one linearisation.
struct Round {
  std::vector<JudgedCandidate> ladder;  ///< best first
  std::vector<ScanResult> scan;         ///< best first; of the last round
  std::vector<std::string> taken;       ///< members of the best set
  double taken_nats = 0.0;              ///< ln P of the best set above that of the empty one
};

/// An effect that got a name, or a curve that the model was given.
struct AcceptedTerm {
  std::optional<Candidate> candidate;  ///< of the catalogue, or else:
  std::optional<ScanResult> curve;     ///< found by the driver scan
  std::string effect_name;             ///< of the instance in the network; empty for sensors
  double probability = 0.0;            ///< of its family
  double loss_without_nats = 0.0;      ///< of ln P, without any of its family
  double visibility_ratio = 0.0;
  std::vector<std::string> confusable_with;  ///< ids within the ambiguity
  std::vector<std::string> experiments;      ///< that would tell them apart
};

/// What explains something and still gets no name.
struct Refusal {
  std::string id;
  std::string words;
};

struct Selection {
  RefitResult before;  ///< the model's own figures, nothing added
  RefitResult after;
  RefitResult own;  ///< `before` once more, with uncertainty in figures that do not hold
  std::vector<ChangedParameter> changed;
  std::vector<AcceptedTerm> terms;
  std::vector<Round> rounds;
  std::vector<Regressor> drivers;  ///< that the scan looked at
  std::vector<std::string> not_judged;
  double mean_heat_W = 0.0;              ///< that the model knows of, over all runs
  double material_W = 0.0;               ///< unknown heat of less is what every model leaves
  std::map<std::string, double> left_W;  ///< by node: rms of what the best set leaves, smoothed
  std::vector<Eigen::VectorXd> weights;  ///< per run and sample: 0 for what the model makes impossible
  std::vector<std::string> unseen;       ///< effects that at their typical size would not show in these runs
  double seen_share = 1.0;               ///< of the effects that were judged
  double nothing_probability = 1.0;      ///< of the empty set
  std::vector<Refusal> refused;
  bool is_as_usual = false;     ///< whole runs are followed as those that the file was fitted to: nothing was changed
  bool is_unexplained = false;  ///< heat is left that matters, and no effect of the catalogue is it

  /// More heat is left than what every model leaves.
  [[nodiscard]] bool is_material() const;
  /// Something is missing that cannot be named.
  [[nodiscard]] bool is_undecided(const SelectionRules& rules = {}) const {
    return terms.empty() && nothing_probability < 1.0 - rules.named_probability;
  }
};

Selection select_effects(const SelectionInput& input, const SelectionRules& rules);

/// ln evidence of the model with nothing added, its figures fitted and the unknown heat at its most probable.
double evidence_without_effects_nats(const SelectionInput& input);

}  // namespace heatsoak
