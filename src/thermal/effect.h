// What an effect is: one physical law, the parameters it has, and how it books heat.
//
// Sign convention, here and nowhere else: heat is in watts and positive *into* a node. A law books through
// two verbs only. flow(from, to, W) moves heat and so cannot create any; source(into, W) makes heat, which
// only losses do.
#pragma once

#include <limits>
#include <string_view>
#include <vector>

#include "base/lanes.h"
#include "base/parameter.h"

namespace heatsoak {

/// What the machine does during one interval. Means are over the interval, so that intervals can be merged
/// without changing any heat: I²R takes the rms current, a loss ∝ |ω| the mean, one ∝ ω² the rms.
template <class S>
struct OperatingPoint {
  S current_rms_A = S(0.0);         ///< equivalent DC current of the terminals: I²·R of two phases in series is the heat
  S speed_mean_rad_per_s = S(0.0);  ///< mean of |ω|, motor shaft
  S speed_rms_rad_per_s = S(0.0);   ///< root mean square of ω, motor shaft
  S ambient_C = S(25.0);
  /// Voltage that is left for I·R beside the back-EMF, per current that heats: as the winding gets hot and its
  /// resistance rises, less current flows than is asked for. Infinite where voltage is no limit.
  S resistive_headroom_V = S(std::numeric_limits<double>::infinity());
};

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

/// One law for every scalar the network runs on; filled by laws<Law>() from one template.
struct Laws {
  void (*one)(const Situation<double>&, HeatBook<double>&) = nullptr;
  void (*lanes)(const Situation<Lanes>&, HeatBook<Lanes>&) = nullptr;
};

template <class Law>
constexpr Laws laws() {
  return {[](const Situation<double>& x, HeatBook<double>& heat) { Law::book(x, heat); },
          [](const Situation<Lanes>& x, HeatBook<Lanes>& heat) { Law::book(x, heat); }};
}

struct NodeRole {
  std::string_view role;          ///< key in a file that names another node
  std::string_view default_node;  ///< node that plays the role unless the file says otherwise
};

/// Numbers computed by hand beside the equation; run as a test for every effect.
struct WorkedExample {
  std::vector<double> parameters;  ///< in the declared order
  OperatingPoint<double> at;
  std::vector<double> temperature_C;    ///< one per role
  std::vector<double> expected_heat_W;  ///< one per role, positive into the node
};

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
};

/// All effects, sorted by name. The list lives as long as the program.
const std::vector<EffectType>& all_effects();
/// Nothing where there is no effect of that name.
const EffectType* find_effect(std::string_view name);

}  // namespace heatsoak
