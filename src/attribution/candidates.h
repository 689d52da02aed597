// Candidate effects as regressor columns: the sensitivity of each sensor to the effect's size, evaluated at size zero.
#pragma once

#include <string>
#include <vector>

#include "estimation/linearised_run.h"
#include "estimation/model.h"
#include "estimation/run_deviation.h"
#include "motor/sensor_effect.h"

namespace heatsoak::attribution {

/// One candidate effect: a variant of a network effect at given nodes, a sensor error, or a run deviation. Exactly one of the three types
/// is set.
struct Candidate {
  const thermal::EffectType* type = nullptr;
  const motor::SensorEffectType* sensor_type = nullptr;
  const estimation::RunDeviationType* deviation_type = nullptr;
  std::string id = {};                  ///< name of the type, followed by "@node" if it is not at its default node
  std::vector<std::string> nodes = {};  ///< one node per role of the type
  std::vector<double> parameters = {};  ///< values at the typical size, in declared order
  int variant = 0;
  double column_at_share = 1.0;          ///< sensor errors only: size of the linearisation point, in typical sizes
  estimation::Condition condition = {};  ///< the candidate acts only in runs with this condition; empty: in all runs

  /// True for a deviation marked as rare, and for a one-node effect at another node than its default, without a condition.
  [[nodiscard]] bool is_rare() const;
  /// Index of the parameter that the effect is proportional to.
  [[nodiscard]] int size_parameter() const;
  [[nodiscard]] double typical_size() const { return parameters[static_cast<std::size_t>(size_parameter())]; }
  [[nodiscard]] const base::ParameterSpec& size_spec() const;
  [[nodiscard]] std::string_view family() const;
  [[nodiscard]] std::string_view experiment() const;
};

/// Type of effect that these runs cannot test, because not all of them have the signals.
struct UntestedEffect {
  std::string effect;
  std::vector<std::string> lacking;  ///< names of the signals
};

struct CandidateList {
  std::vector<Candidate> candidates;
  std::vector<UntestedEffect> not_judged;
};

/// Returns the candidates that these runs can test: all needed signals and sensors are logged, and the model does not contain the effect
/// yet. Includes candidates limited to runs with one condition, for every condition that divides the runs; each run alone is such a
/// condition.
CandidateList candidates_for(const estimation::Model& model, const std::vector<estimation::MeasuredRun>& runs);

/// Returns the indices of the candidates that add a body (node with a heat capacity) of their own, ascending.
std::vector<int> candidates_with_body(const std::vector<Candidate>& candidates);

/// Returns the columns of one run (n·s rows), in K, at the model's present parameters. First one column per candidate, per typical size.
/// Then one per candidate with a body, per kelvin of the body's start temperature above ambient, at the typical size.
estimation::Columns candidate_columns(const std::vector<Candidate>& candidates, const estimation::Model& model,
                                      const estimation::LinearisedRun& fitted, const estimation::MeasuredRun& run);

}  // namespace heatsoak::attribution
