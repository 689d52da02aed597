// The law of an effect: its inputs, and the heat that it books into nodes. Files that only need the description include effect.h.
//
// Sign convention of the whole program: heat is in watts and positive *into* a node. A law books heat in two ways only. flow(from, to, W)
// moves heat between nodes and so conserves energy; source(into, W) generates heat and is used by losses.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "thermal/effect.h"
#include "thermal/lanes.h"
#include "thermal/operating_point.h"
#include "thermal/scalar.h"
#include "thermal/tangent.h"
#include "thermal/traced.h"

namespace heatsoak::thermal {

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
  auto difference_K(int hot_role, int cold_role) const { return thermal::difference_K(temperature_C(hot_role), temperature_C(cold_role)); }

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

/// Names of a law's heat in generated code: "winding_to_stator_W", "copper_loss_W".
struct HeatNames {
  std::string law;
  std::vector<std::string> nodes;  ///< node names, in the order of the network

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

/// One law compiled for every scalar type that the network uses; laws<Law>() makes it from one template.
struct Laws {
  void (*one)(const Situation<double>&, HeatBook<double>&) = nullptr;
  void (*lanes)(const Situation<Lanes>&, HeatBook<Lanes>&) = nullptr;
  void (*tangent)(const Situation<Tangent>&, HeatBook<Tangent>&) = nullptr;
  void (*traced)(const Situation<Traced>&, HeatBook<Traced>&) = nullptr;

  void book(const Situation<double>& x, HeatBook<double>& heat) const { one(x, heat); }
  void book(const Situation<Lanes>& x, HeatBook<Lanes>& heat) const { lanes(x, heat); }
  void book(const Situation<Tangent>& x, HeatBook<Tangent>& heat) const { tangent(x, heat); }
  void book(const Situation<Traced>& x, HeatBook<Traced>& heat) const { traced(x, heat); }
};

/// Returns the law of an effect in all scalar types; it lives as long as the program.
template <class Law>
const Laws* laws() {
  static constexpr Laws kLaws{[](const Situation<double>& x, HeatBook<double>& heat) { Law::book(x, heat); },
                              [](const Situation<Lanes>& x, HeatBook<Lanes>& heat) { Law::book(x, heat); },
                              [](const Situation<Tangent>& x, HeatBook<Tangent>& heat) { Law::book(x, heat); },
                              [](const Situation<Traced>& x, HeatBook<Traced>& heat) { Law::book(x, heat); }};
  return &kLaws;
}

}  // namespace heatsoak::thermal
