// Every effect that a model may lack, as columns: how the sensors would move with its size, from a size of nothing.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "identify/linearised_run.h"
#include "identify/model.h"
#include "identify/sensor_effect.h"

namespace heatsoak {

struct ExtendedModel;

/// Usual deviation of the heat that goes in from what the log says, as a share of it.
inline constexpr double kUsualDeviation_share = 0.1;

/// What runs have in common that others lack: "cooling" -> "fan", or "run" -> "run4".
using Condition = std::map<std::string, std::string>;
bool has_condition(const MeasuredRun& run, const Condition& condition);

/// One effect in one shape at certain nodes, of the network, of a sensor, or of what measures the heat that goes in.
struct Candidate {
  const EffectType* type = nullptr;               ///< nothing where it is a sensor's
  const SensorEffectType* sensor_type = nullptr;  ///< nothing where it is the network's
  std::string id;                                 ///< the type's name; "@node" follows where it is not at its usual node
  std::vector<std::string> nodes;                 ///< as the type's roles
  std::vector<double> parameters;                 ///< at the typical size, in declared order
  int variant = 0;
  Condition condition;  ///< where it acts; empty: everywhere

  /// More or less heat goes in than the log says, by a share: another phase of a motor that stands, more of the driver's own loss.
  [[nodiscard]] bool is_heat_share() const { return !type && !sensor_type; }
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

/// One column per candidate, per typical size, at the model's present parameters; n·s rows.
Columns candidate_columns(const std::vector<Candidate>& candidates, const ExtendedModel& model, const LinearisedRun& fitted,
                          const MeasuredRun& run);

/// What turns the electrical input into heat.
bool is_heat_input(const EffectType& type);
/// Places of the parameters in which the heat that goes in is linear: the resistance of copper, the share of the input power.
std::vector<int> heat_input_parameters(const Network& network);

}  // namespace heatsoak
