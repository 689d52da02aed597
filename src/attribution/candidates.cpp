#include "attribution/candidates.h"

#include <fmt/format.h>

#include <algorithm>

#include "estimation/added_terms.h"
#include "estimation/log_rows.h"
#include "estimation/model_along_run.h"
#include "estimation/spans.h"
#include "estimation/usual_heat.h"
#include "motor/datasheet_network.h"

namespace heatsoak::attribution {
namespace {

/// Heat capacity of the motors for which the catalogue gives typical sizes (about 50 W).
constexpr double kUsualCapacity_J_per_K = 120.0;
constexpr double kUsual_A = 8.0;  ///< their large current

bool is_in(const estimation::Model& model, const Candidate& candidate) {
  const thermal::Network& network = model.network;
  return std::ranges::any_of(network.effects(), [&](const thermal::EffectInPlace& effect) {
    if (effect.type->name != candidate.type->name) {
      return false;
    }
    if (effect.type->moves_copper_loss) {
      return true;  // a motor file has at most one
    }
    const auto term = std::ranges::find(model.conditional, effect.name, &estimation::ConditionalTerm::effect_name);
    if ((term == model.conditional.end() ? estimation::Condition{} : term->condition) != candidate.condition) {
      return false;
    }
    for (std::size_t role = 0; role < candidate.nodes.size(); ++role) {
      if (!candidate.type->nodes[role].own_capacity && network.node_name(effect.node_index[role]) != candidate.nodes[role]) {
        return false;
      }
    }
    return true;
  });
}

/// Returns the nodes of the roles: `first` for the first role, the default nodes for the others, and an unused name for a node that the
/// effect adds. Empty if a node is missing.
std::vector<std::string> nodes_with(const thermal::Network& network, const thermal::EffectType& type, std::string_view first) {
  std::vector<std::string> nodes;
  for (const thermal::NodeRole& role : type.nodes) {
    std::string node(nodes.empty() ? first : role.default_node);
    if (role.own_capacity) {
      const std::string name = first == type.nodes.front().default_node ? node : fmt::format("{}_{}", node, first);
      node = name;
      for (int number = 2; network.find_node(node); ++number) {
        node = fmt::format("{}_{}", name, number);
      }
    } else if (!network.find_node(node)) {
      return {};
    }
    nodes.push_back(std::move(node));
  }
  return nodes;
}

/// Returns all node assignments to try: the default nodes, winding and stator for effects that may be anywhere, and the file's bodies.
/// The other bodies need a sensor: without one, heat in a body looks like another size of the body.
std::vector<std::vector<std::string>> placements(const thermal::Network& network, const thermal::EffectType& type,
                                                 const std::vector<estimation::MeasuredRun>& runs) {
  std::vector<std::vector<std::string>> all{nodes_with(network, type, type.nodes.front().default_node)};
  for (int node = 0; node < network.state_count(); ++node) {
    const std::string_view name = network.node_name(node);
    const bool is_seen = std::ranges::any_of(runs, [&](const estimation::MeasuredRun& run) { return run.sensor_at(name).has_value(); });
    const bool is_one_node = type.nodes.size() == 1 && !type.nodes.front().own_capacity;
    const bool is_possible = node < motor::states::first_own ? type.candidacy.is_anywhere && (is_one_node || is_seen)
                                                             : (type.candidacy.is_anywhere || is_one_node) && is_seen;
    if (is_possible && name != type.nodes.front().default_node) {
      all.push_back(nodes_with(network, type, name));
    }
  }
  std::erase_if(all, [](const std::vector<std::string>& nodes) { return nodes.empty(); });
  return all;
}

/// Scale of the motor relative to one of about 50 W.
struct MotorSize {
  double heat_ratio = 1.0;     ///< for W, W/K and J/K
  double current_ratio = 1.0;  ///< for A; differs with the winding's voltage
};

std::vector<double> scaled(const thermal::EffectType& type, std::vector<double> parameters, const MotorSize& size) {
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const std::string_view unit = base::unit_of(type.parameters, p, parameters);
    if (!type.parameters[p].choices.empty()) {
      continue;
    }
    if (unit.starts_with("W") || unit == "J/K") {
      parameters[p] *= size.heat_ratio;
    } else if (unit == "A") {
      parameters[p] *= size.current_ratio;
    } else if (unit == "ohm") {
      parameters[p] *= size.heat_ratio / (size.current_ratio * size.current_ratio);
    }
  }
  return parameters;
}

MotorSize size_of(const estimation::Model& model, const std::vector<estimation::MeasuredRun>& runs) {
  double capacity_J_per_K = 0.0;
  for (int node = 0; node < model.network.state_count(); ++node) {
    capacity_J_per_K += model.values[static_cast<std::size_t>(model.network.capacity_index(node))];
  }
  return {std::max(1.0, capacity_J_per_K / kUsualCapacity_J_per_K), estimation::large_current_A(runs).value_or(kUsual_A) / kUsual_A};
}

/// Adds candidates that act only in some runs and appear in no signal: airflow, constant heat, and run deviations.
void add_conditional_candidates(const estimation::Model& model, const std::vector<estimation::MeasuredRun>& runs, const MotorSize& size,
                                CandidateList& list) {
  for (const estimation::Condition& condition : estimation::conditions_of(runs)) {
    for (const std::string_view name : {"airflow", "constant_heat"}) {
      const thermal::EffectType& type = *thermal::find_effect(name);
      for (const std::string_view node : {"stator", "winding"}) {
        Candidate candidate;
        candidate.type = &type;
        candidate.id = fmt::format("{}@{} in {}", name, node, estimation::in_words(condition));
        candidate.nodes.emplace_back(node);
        candidate.condition = condition;
        for (std::size_t role = 1; role < type.nodes.size(); ++role) {
          candidate.nodes.emplace_back(type.nodes[role].default_node);
        }
        candidate.parameters = scaled(type, type.candidacy.variants.front(), size);
        if (!is_in(model, candidate)) {
          list.candidates.push_back(std::move(candidate));
        }
      }
    }
    for (const estimation::RunDeviationType& type : estimation::all_run_deviations()) {
      const bool is_there =
          std::ranges::any_of(model.deviations, [&](const estimation::RunDeviation& each) { return each.is_same(&type, condition); });
      if (!is_there && !type.places_in(model.network).empty()) {
        list.candidates.push_back({.deviation_type = &type,
                                   .id = fmt::format("{} in {}", type.name, estimation::in_words(condition)),
                                   .parameters = {type.usual},
                                   .condition = condition});
      }
    }
  }
}

std::string id_of(const thermal::EffectType& type, const std::vector<std::string>& nodes) {
  for (std::size_t role = 0; role < nodes.size(); ++role) {
    if (!type.nodes[role].own_capacity && nodes[role] != type.nodes[role].default_node) {
      return fmt::format("{}@{}", type.name, nodes[role]);
    }
  }
  return std::string(type.name);
}

void add_network_candidates(const estimation::Model& model, const std::vector<estimation::MeasuredRun>& runs, const MotorSize& size,
                            CandidateList& list) {
  for (const thermal::EffectType& type : thermal::all_effects()) {
    if (!type.candidacy.size_parameter) {
      continue;
    }
    if (const std::vector<std::string_view> names = estimation::lacking(type, runs); !names.empty()) {
      list.not_judged.push_back({std::string(type.name), {names.begin(), names.end()}});
      continue;
    }
    for (const std::vector<std::string>& nodes : placements(model.network, type, runs)) {
      int variant = 0;
      for (const std::vector<double>& parameters : type.candidacy.variants) {
        Candidate candidate{
            .type = &type, .id = id_of(type, nodes), .nodes = nodes, .parameters = scaled(type, parameters, size), .variant = variant++};
        if (!is_in(model, candidate)) {
          list.candidates.push_back(std::move(candidate));
        }
      }
    }
  }
}

Eigen::Index sensor_of(const estimation::MeasuredRun& run, std::string_view signal) {
  return std::ranges::find(run.sensors, signal, &estimation::Sensor::signal) - run.sensors.begin();
}

bool has_sensor(const estimation::MeasuredRun& run, std::string_view signal) { return sensor_of(run, signal) < std::ssize(run.sensors); }

/// Network with all candidates added at size 0. It behaves like the original network, but provides their derivatives.
struct Extended {
  thermal::Network network;
  std::vector<int> wanted;       ///< parameter indices of the sizes; the capacity of an added node follows its size
  std::vector<double> slope;     ///< weight of each parameter in its candidate's column
  std::vector<std::size_t> own;  ///< candidate of each parameter
};

/// Size, in typical sizes, at which an effect with its own body is linearised. Its capacity scales with it, so the time constant stays.
/// With a fixed capacity the body would not warm up at size 0 and act like a wall at ambient temperature.
constexpr double kHardly_share = 1e-3;

void extend(Extended& extended, const Candidate& candidate, std::size_t own) {
  std::vector<double> parameters = candidate.parameters;
  std::vector<std::size_t> scaled{static_cast<std::size_t>(candidate.size_parameter())};
  std::vector<std::string> nodes = candidate.nodes;
  for (std::size_t role = 0; role < nodes.size(); ++role) {
    if (const std::optional<int> capacity = candidate.type->nodes[role].own_capacity) {
      nodes[role] += fmt::format(" {}", own);
      scaled.push_back(static_cast<std::size_t>(*capacity));
    }
  }
  const double share = scaled.size() > 1 ? kHardly_share : 0.0;
  for (const std::size_t place : scaled) {
    parameters[place] *= share;
  }
  extended.network.add_effect(fmt::format("candidate {}", own), *candidate.type, nodes, parameters);
  for (const std::size_t place : scaled) {
    extended.wanted.push_back(extended.network.effects().back().parameter_index[place]);
    extended.slope.push_back(candidate.parameters[place]);
    extended.own.push_back(own);
  }
}

}  // namespace

bool Candidate::is_rare() const { return type && condition.empty() && nodes.front() != type->nodes.front().default_node; }

int Candidate::size_parameter() const { return type ? type->candidacy.size_parameter.value() : 0; }

const base::ParameterSpec& Candidate::size_spec() const {
  if (deviation_type) {
    return deviation_type->size;
  }
  return type ? type->parameters[static_cast<std::size_t>(size_parameter())] : sensor_type->size;
}

std::string_view Candidate::family() const {
  if (deviation_type) {
    return deviation_type->family;
  }
  return type ? type->candidacy.family : std::string_view("error of a sensor");
}

std::string_view Candidate::experiment() const {
  if (deviation_type) {
    return deviation_type->experiment;
  }
  return type ? type->candidacy.experiment : sensor_type->experiment;
}

CandidateList candidates_for(const estimation::Model& model, const std::vector<estimation::MeasuredRun>& runs) {
  CandidateList list;
  const MotorSize size = size_of(model, runs);
  add_network_candidates(model, runs, size, list);
  add_conditional_candidates(model, runs, size, list);
  for (const motor::SensorEffectType& type : motor::all_sensor_effects()) {
    const bool is_there = std::ranges::find(model.sensors, &type, &estimation::SensorTerm::type) != model.sensors.end();
    if (!is_there && std::ranges::any_of(runs, [&](const auto& run) { return has_sensor(run, type.signal); })) {
      list.candidates.push_back({.sensor_type = &type, .id = std::string(type.name), .parameters = {type.typical_size}});
    }
  }
  return list;
}

std::vector<int> candidates_with_body(const std::vector<Candidate>& candidates) {
  std::vector<int> found;
  for (int j = 0; j < static_cast<int>(candidates.size()); ++j) {
    const thermal::EffectType* const type = candidates[static_cast<std::size_t>(j)].type;
    if (type && std::ranges::any_of(type->nodes, [](const thermal::NodeRole& role) { return role.own_capacity.has_value(); })) {
      found.push_back(j);
    }
  }
  return found;
}

estimation::Columns candidate_columns(const std::vector<Candidate>& candidates, const estimation::Model& model,
                                      const estimation::LinearisedRun& fitted, const estimation::MeasuredRun& run) {
  const std::vector<double> parameters = model.values_in(run);
  Extended extended{model.network, {}, {}, {}};
  for (std::size_t j = 0; j < candidates.size(); ++j) {
    if (!run.has(candidates[j].condition)) {
      continue;
    }
    if (candidates[j].type) {
      extend(extended, candidates[j], j);
    } else if (candidates[j].deviation_type) {
      for (const int place : candidates[j].deviation_type->places_in(model.network)) {
        extended.wanted.push_back(place);
        extended.slope.push_back(candidates[j].typical_size() * parameters[static_cast<std::size_t>(place)]);
        extended.own.push_back(j);
      }
    }
  }
  const estimation::Columns by_parameter = estimation::added_sensitivities(extended.network, parameters, extended.wanted, fitted, run);
  const auto count = static_cast<Eigen::Index>(candidates.size());
  const Eigen::Index bodies = extended.network.state_count() - model.network.state_count();
  estimation::Columns columns = estimation::Columns::Zero(fitted.residual_K.size(), count + bodies);
  for (std::size_t i = 0; i < extended.wanted.size(); ++i) {
    columns.col(static_cast<Eigen::Index>(extended.own[i])) += extended.slope[i] * by_parameter.col(static_cast<Eigen::Index>(i));
  }
  columns.rightCols(bodies) = by_parameter.rightCols(bodies) / kHardly_share;
  for (std::size_t j = 0; j < candidates.size(); ++j) {
    const Candidate& candidate = candidates[j];
    if (!candidate.sensor_type || !has_sensor(run, candidate.sensor_type->signal)) {
      continue;
    }
    const Eigen::Index sensor = sensor_of(run, candidate.sensor_type->signal);
    Eigen::VectorXd true_C = fitted.state_C.row(fitted.sensor_node[static_cast<std::size_t>(sensor)]);
    motor::apply(run.sensors[static_cast<std::size_t>(sensor)].faults, run.time_s, false, estimation::as_span(true_C));
    // A lag is strongly nonlinear in its size, so use a finite difference instead of the derivative at 0.
    Eigen::VectorXd sensor_C = true_C;
    candidate.sensor_type->law.apply(run.time_s, candidate.column_at_share * candidate.typical_size(), false,
                                     estimation::as_span(sensor_C));
    for (Eigen::Index k = 0; k < sensor_C.size(); ++k) {
      columns(k * fitted.sensors() + sensor, static_cast<Eigen::Index>(j)) = (sensor_C[k] - true_C[k]) / candidate.column_at_share;
    }
  }
  return columns;
}

}  // namespace heatsoak::attribution
