// Every effect that a model may lack, as columns: how the sensors would move with its size, from a size of nothing.
#pragma once

#include <string>
#include <vector>

#include "attribution/run_deviation.h"
#include "estimation/linearised_run.h"
#include "estimation/model.h"
#include "motor/sensor_effect.h"

namespace heatsoak {

struct ExtendedModel;

/// One effect in one shape at certain nodes, of the network or of a sensor, or a deviation of some runs: one of the three types is there.
struct Candidate {
  const EffectType* type = nullptr;
  const SensorEffectType* sensor_type = nullptr;
  const RunDeviationType* deviation_type = nullptr;
  std::string id;                  ///< the type's name; "@node" follows where it is not at its usual node
  std::vector<std::string> nodes;  ///< as the type's roles
  std::vector<double> parameters;  ///< at the typical size, in declared order
  int variant = 0;
  double column_at_share = 1.0;  ///< sensor errors only: the column is linearised at this size, in typical sizes
  Condition condition;           ///< the candidate acts only in runs with this condition; empty: in all runs

  /// Named for unmistakable evidence only: what few runs have, and laws at another node than their usual one.
  [[nodiscard]] bool is_rare() const;
  [[nodiscard]] int size_parameter() const;
  [[nodiscard]] double typical_size() const { return parameters[static_cast<std::size_t>(size_parameter())]; }
  [[nodiscard]] const ParameterSpec& size_spec() const;
  [[nodiscard]] std::string_view family() const;
  [[nodiscard]] std::string_view experiment() const;
};

struct CandidateList {
  std::vector<Candidate> candidates;
  std::vector<std::string> not_judged;  ///< "windage: the logs have no speed": what the runs cannot speak about
};

/// What the runs can speak about: signals are there, sensors are there, and the model does not have the effect already. Some may act under
/// the conditions that part the runs, each run by itself among them.
CandidateList candidates_for(const ExtendedModel& model, const std::vector<MeasuredRun>& runs);

/// Candidates that bring a body of their own, in their order.
std::vector<int> candidates_with_body(const std::vector<Candidate>& candidates);

/// One column per candidate, per typical size, at the model's present parameters; then one per candidate with a body, per kelvin that the
/// body begins above ambient at the typical size. n·s rows.
Columns candidate_columns(const std::vector<Candidate>& candidates, const ExtendedModel& model, const LinearisedRun& fitted,
                          const MeasuredRun& run);

}  // namespace heatsoak
