// Effects: an effect is one physical law with its parameters and the heat that it books into nodes.
//
// Sign convention of the whole program: heat is in watts and positive *into* a node. A law books heat in two ways only. flow(from, to, W)
// moves heat between nodes and so conserves energy; source(into, W) generates heat and is used by losses.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/lanes.h"
#include "base/parameter.h"
#include "thermal/operating_point.h"
#include "thermal/tangent.h"
#include "thermal/traced.h"

namespace heatsoak {

/// The inputs of a law: the operating point, its own parameters and the temperatures of its nodes. Parameters and nodes are numbered in the
/// order of the effect's declaration.
template <class S>
class Situation {
 public:
  Situation(const OperatingPoint<S>& point, const S* parameters, const int* parameter_index, const S* temperatures_C, const int* node_index)
      : at(point), parameters_(parameters), parameter_index_(parameter_index), temperatures_C_(temperatures_C), node_index_(node_index) {}

  const OperatingPoint<S>& at;  // NOLINT(misc-non-private-member-variables-in-classes): a view, read only
  const S& parameter(int declared_place) const { return parameters_[parameter_index_[declared_place]]; }
  const S& temperature_C(int role) const { return temperatures_C_[node_index_[role]]; }

 private:
  const S* parameters_;
  const int* parameter_index_;
  const S* temperatures_C_;
  const int* node_index_;
};

template <class S>
class HeatBook {
 public:
  HeatBook(S* node_heat_W, const int* node_index) : node_heat_W_(node_heat_W), node_index_(node_index) {}

  void flow(int from_role, int to_role, const S& heat_W) {
    node_heat_W_[node_index_[from_role]] -= heat_W;
    node_heat_W_[node_index_[to_role]] += heat_W;
  }
  void source(int into_role, const S& heat_W) { node_heat_W_[node_index_[into_role]] += heat_W; }

 private:
  S* node_heat_W_;
  const int* node_index_;
};

/// Heat as formulas. Moved and generated heat are kept apart, because a safety factor on heat applies to generated heat only.
struct TracedHeat {
  Traced moved_W;
  Traced made_W;
};

/// Names of a law's heat in generated code: "winding_to_stator_W", "copper_loss_W".
struct HeatNames {
  std::string law;
  std::vector<std::string> nodes;  ///< as the nodes of the network

  void name_flow(int from_node, int to_node, const Traced& heat_W) const;
  void name_source(int into_node, const Traced& heat_W) const;
};

template <>
class HeatBook<Traced> {
 public:
  HeatBook(TracedHeat* node_heat, const int* node_index, HeatNames names)
      : node_heat_(node_heat), node_index_(node_index), names_(std::move(names)) {}

  void flow(int from_role, int to_role, const Traced& heat_W) {
    names_.name_flow(node_index_[from_role], node_index_[to_role], heat_W);
    node_heat_[node_index_[from_role]].moved_W -= heat_W;
    node_heat_[node_index_[to_role]].moved_W += heat_W;
  }
  void source(int into_role, const Traced& heat_W) {
    names_.name_source(node_index_[into_role], heat_W);
    node_heat_[node_index_[into_role]].made_W += heat_W;
  }

 private:
  TracedHeat* node_heat_;
  const int* node_index_;
  HeatNames names_;
};

/// One law compiled for every scalar type that the network uses; laws<Law>() fills it from one template.
struct Laws {
  void (*one)(const Situation<double>&, HeatBook<double>&) = nullptr;
  void (*lanes)(const Situation<Lanes>&, HeatBook<Lanes>&) = nullptr;
  void (*tangent)(const Situation<Tangent>&, HeatBook<Tangent>&) = nullptr;
  void (*traced)(const Situation<Traced>&, HeatBook<Traced>&) = nullptr;
};

template <class Law>
constexpr Laws laws() {
  return {[](const Situation<double>& x, HeatBook<double>& heat) { Law::book(x, heat); },
          [](const Situation<Lanes>& x, HeatBook<Lanes>& heat) { Law::book(x, heat); },
          [](const Situation<Tangent>& x, HeatBook<Tangent>& heat) { Law::book(x, heat); },
          [](const Situation<Traced>& x, HeatBook<Traced>& heat) { Law::book(x, heat); }};
}

struct NodeRole {
  std::string_view role;          ///< key in a motor file by which another node can play the role
  std::string_view default_node;  ///< node that plays the role by default
  /// Index of the parameter that is the node's heat capacity if the effect adds a node of its own; -1 if it does not.
  int own_capacity = -1;
};

/// How an effect is proposed when a model may lack it: parameter values typical for a motor of about 50 W, one variant for each
/// distinguishable shape of the law.
struct Candidacy {
  /// Index of the parameter that the heat is proportional to; 0 is the model without the effect. -1: the effect is never a candidate.
  int size_parameter = -1;
  std::vector<std::vector<double>> variants;
  std::string_view family;      ///< name of the group while the exact law is undetermined: "speed loss at the stator"
  std::string_view experiment;  ///< measurement that separates it from the effects it is confounded with
  bool is_anywhere = false;     ///< tried at every node, also in a network of only two nodes
};

/// A hand-calculated example of the equation; a test runs it for every effect.
struct WorkedExample {
  std::vector<double> parameters;  ///< in the order of declaration
  OperatingPoint<double> at;
  std::vector<double> temperature_C;    ///< one per role
  std::vector<double> expected_heat_W;  ///< one per role, positive into the node
};

/// Name of the choice "a column of the log"; the motor file names the column.
inline constexpr std::string_view kColumnChoice = "column";

struct EffectType {
  std::string_view name;  ///< name in motor files; set by find_effect()
  std::string_view summary;
  std::string_view equation;
  std::string_view reference;
  std::vector<NodeRole> nodes;
  std::vector<ParameterSpec> parameters;
  std::string_view typical;          ///< typical size for a motor of about 50 W
  std::string_view confounded_with;  ///< effects that it is confounded with, and what separates them
  WorkedExample example;
  Laws laws;
  std::vector<Signal> needs = {};
  Candidacy candidacy = {};
  /// Signals needed with these parameters, for an effect whose signals depend on a choice; null: all of `needs`.
  std::vector<Signal> (*needs_of)(std::span<const double> parameters) = nullptr;

  [[nodiscard]] std::vector<Signal> needed_with(std::span<const double> values) const { return needs_of ? needs_of(values) : needs; }
};

/// Returns all effects, sorted by name. The list lives as long as the program.
const std::vector<EffectType>& all_effects();
/// Returns the effect of that name, or null if there is none.
const EffectType* find_effect(std::string_view name);

}  // namespace heatsoak
