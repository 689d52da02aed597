// Every effect that a model may lack, as columns: how the sensors would move with its size, from a size of nothing.
#pragma once

#include <string>
#include <vector>

#include "identify/linearised_run.h"
#include "identify/model.h"
#include "identify/sensor_effect.h"

namespace heatsoak {

/// One effect in one shape at certain nodes, of the network or of a sensor.
struct Candidate {
  const EffectType* type = nullptr;               ///< nothing where it is a sensor's
  const SensorEffectType* sensor_type = nullptr;  ///< nothing where it is the network's
  std::string id;                                 ///< the type's name; "@node" follows where it is not at its usual node
  std::vector<std::string> nodes;                 ///< as the type's roles
  std::vector<double> parameters;                 ///< at the typical size, in declared order
  int variant = 0;

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

/// What the runs can speak about: signals are there, sensors are there, and the network does not have the effect already.
CandidateList candidates_for(const Network& network, const std::vector<MeasuredRun>& runs);

/// One column per candidate, per typical size, at the network's present parameters; n·s rows.
Columns candidate_columns(const std::vector<Candidate>& candidates, const Network& network, std::span<const double> parameters,
                          const LinearisedRun& fitted, const MeasuredRun& run);

}  // namespace heatsoak
