// What an effect is: one physical law, the parameters it has, and how it books heat.
//
// Sign convention, here and nowhere else: heat is in watts and positive *into* a node. A law books through
// two verbs only. flow(from, to, W) moves heat and so cannot create any; source(into, W) makes heat, which
// only losses do.
#pragma once

#include <string_view>
#include <vector>

#include "base/lanes.h"
#include "base/parameter.h"
#include "thermal/operating_point.h"
#include "thermal/tangent.h"
#include "thermal/traced.h"

namespace heatsoak {

/// What a law may look at: the operating point, its own parameters and the temperatures of its nodes,
/// both by their place in the effect's declaration.
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

/// Heat as formulas, moved and made apart: only what is made grows with a reserve.
struct TracedHeat {
  Traced moved_W;
  Traced made_W;
};

template <>
class HeatBook<Traced> {
 public:
  HeatBook(TracedHeat* node_heat, const int* node_index) : node_heat_(node_heat), node_index_(node_index) {}

  void flow(int from_role, int to_role, const Traced& heat_W) {
    node_heat_[node_index_[from_role]].moved_W -= heat_W;
    node_heat_[node_index_[to_role]].moved_W += heat_W;
  }
  void source(int into_role, const Traced& heat_W) { node_heat_[node_index_[into_role]].made_W += heat_W; }

 private:
  TracedHeat* node_heat_;
  const int* node_index_;
};

/// One law for every scalar the network runs on; filled by laws<Law>() from one template.
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
  std::string_view role;          ///< key in a file that names another node
  std::string_view default_node;  ///< node that plays the role unless the file says otherwise
  /// Place of the parameter that is the node's heat capacity, where the effect brings a node of its own; -1 otherwise.
  int own_capacity = -1;
};

/// How an effect enters where a model may lack it: its parameters at the typical size of a motor of some 50 W, once for
/// every shape worth telling apart.
struct Candidacy {
  /// Place of the parameter that the heat is proportional to; 0 there is the model without the effect. -1: never a candidate.
  int size_parameter = -1;
  std::vector<std::vector<double>> variants;
  std::string_view family;      ///< what it can be called while the exact law is open: "speed loss at the stator"
  std::string_view experiment;  ///< what to record so that its look-alikes separate
  bool is_anywhere = false;     ///< looked for at every node, also where the network has two only
};

/// Numbers computed by hand beside the equation; run as a test for every effect.
struct WorkedExample {
  std::vector<double> parameters;  ///< in the declared order
  OperatingPoint<double> at;
  std::vector<double> temperature_C;    ///< one per role
  std::vector<double> expected_heat_W;  ///< one per role, positive into the node
};

/// Of a choice of signals: a column of the log, which the motor file names beside it.
inline constexpr std::string_view kColumnChoice = "column";

struct EffectType {
  std::string_view name;  ///< the file's name; set by find_effect()
  std::string_view summary;
  std::string_view equation;
  std::string_view reference;
  std::vector<NodeRole> nodes;
  std::vector<ParameterSpec> parameters;
  std::string_view typical;     ///< size for a motor of some 50 W
  std::string_view look_alike;  ///< effects that leave a similar trace, and what tells them apart
  WorkedExample example;
  Laws laws;
  std::vector<Signal> needs = {};
  Candidacy candidacy = {};
  /// Where it hangs on a choice: what one with these parameters needs of `needs`; null: all.
  std::vector<Signal> (*needs_of)(std::span<const double> parameters) = nullptr;

  [[nodiscard]] std::vector<Signal> needed_with(std::span<const double> values) const { return needs_of ? needs_of(values) : needs; }
};

/// All effects, sorted by name. The list lives as long as the program.
const std::vector<EffectType>& all_effects();
/// Nothing where there is no effect of that name.
const EffectType* find_effect(std::string_view name);

}  // namespace heatsoak
