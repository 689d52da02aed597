// Nodes that store heat, effects that book it, and the parameters of both in one flat list.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "thermal/effect.h"

namespace heatsoak {

struct NetworkParameter {
  std::string name;  ///< "winding_stator.thermal_resistance", "winding.heat_capacity"
  std::string_view unit;
  Range range;
  double value = 0.0;
  std::span<const Choice> choices = {};  ///< where there are any, the value is the place of one: no number to sample or to fit
};

/// An effect in place: which nodes play its roles, where its parameters stand in the flat list.
struct EffectInPlace {
  std::string name;  ///< of this instance, unique in the network
  const EffectType* type = nullptr;
  std::vector<int> node_index;
  std::vector<int> parameter_index;
};

/// Rates of the state nodes and their derivatives at one moment; n state nodes, p parameters.
struct Linearised {
  Eigen::VectorXd rate_K_per_s;  ///< n
  Eigen::MatrixXd by_state;      ///< n × n, 1/s
  Eigen::MatrixXd by_parameter;  ///< n × p, K/s per unit of the parameter
};

/// The structure is shared by all samples; the values of the parameters are passed in, so that one network
/// serves single runs, ensembles and fits. Ambient is the last node; its temperature is prescribed.
class Network {
 public:
  static constexpr std::string_view kAmbient = "ambient";
  /// Ambient included. Bounded so that rates, which are asked for a million times, find room on the stack.
  static constexpr int kMostNodes = 16;
  static constexpr int kMostRoles = 4;        ///< of one effect
  static constexpr int kMostParameters = 16;  ///< of one effect

  /// Returns the node's index. `heat_capacity_J_per_K` > 0.
  int add_node(std::string name, double heat_capacity_J_per_K);
  /// `nodes` and `parameters` in the order of the type's declaration. Nodes must exist, but for a node of the effect's
  /// own, which is added under the name given in its place.
  void add_effect(std::string name, const EffectType& type, std::span<const std::string> nodes, std::span<const double> parameters);

  /// Names the copper loss: its heat is the copper_loss_W that other laws see, and the current is cut to what the operating
  /// point's headroom drives through its R25·(1+α·(T−25 °C)).
  /// `copper_effect` is the name of an effect with terminal_resistance and temperature_coefficient as its parameters.
  void limit_current_by(std::string_view copper_effect);

  [[nodiscard]] int state_count() const { return static_cast<int>(node_names_.size()); }
  [[nodiscard]] int node_count() const { return state_count() + 1; }
  /// -1 where there is no such node; ambient is state_count().
  [[nodiscard]] int find_node(std::string_view name) const;
  [[nodiscard]] std::string_view node_name(int node) const;
  /// Place of a state node's heat capacity in the list of parameters.
  [[nodiscard]] int capacity_index(int node) const { return capacity_index_.at(static_cast<std::size_t>(node)); }
  [[nodiscard]] std::span<const EffectInPlace> effects() const { return effects_; }
  [[nodiscard]] std::span<const NetworkParameter> parameters() const { return parameters_; }
  [[nodiscard]] std::vector<double> values() const;

  /// dT/dt of every state node in K/s. `temperature_C` has node_count() entries; the last one is ignored and
  /// overwritten with the point's ambient. S is double or Lanes. Works on the point's current and copper loss, for copies
  /// of it would take half the time, and leaves them as they were.
  template <class S>
  void rate_K_per_s(OperatingPoint<S>& at, std::span<const S> parameters, std::span<S> temperature_C, std::span<S> rate) const;
  template <class S>
  void rate_K_per_s(const OperatingPoint<S>& at, std::span<const S> parameters, std::span<S> temperature_C, std::span<S> rate) const {
    OperatingPoint<S> own = at;
    rate_K_per_s<S>(own, parameters, temperature_C, rate);
  }

  /// Exact derivatives of the laws. The current is taken as given: the operating point's headroom must be infinite.
  /// `state_C` has state_count() entries. Does not allocate where `out` has its shapes already.
  void linearise(const OperatingPoint<double>& at, std::span<const double> parameters, std::span<const double> state_C,
                 Linearised& out) const;

  /// The laws as formulas, with the network's own parameters as constants: heat of every node at node_heat[n], node_count() entries.
  /// `temperature_C` has as many, ambient last. The current is taken as given: the operating point's headroom must be infinite.
  void trace(const OperatingPoint<Traced>& at, std::span<const Traced> temperature_C, std::span<TracedHeat> node_heat) const;

  /// Heat in W that effect e books into node n, at heat_W[e · node_count() + n]; positive into the node.
  void balance_W(const OperatingPoint<double>& at, std::span<const double> parameters, std::span<const double> state_C,
                 std::span<double> heat_W) const;

  /// What of the point's current in A its headroom lets through at these temperatures (state_count() entries at least); all of it
  /// where no copper loss is named.
  template <class S>
  [[nodiscard]] S within_headroom(const OperatingPoint<S>& at, const S* parameters, const S* temperature_C) const;

 private:
  int add_parameter(NetworkParameter parameter);
  int add_state(std::string name, int capacity_index);
  /// Effects in the order in which they are booked: the copper loss first, for others look at its heat.
  [[nodiscard]] std::size_t booked_at(std::size_t turn) const;

  std::vector<std::string> node_names_;
  std::vector<int> capacity_index_;
  std::vector<EffectInPlace> effects_;
  std::vector<NetworkParameter> parameters_;
  int copper_effect_ = -1;
};

extern template double Network::within_headroom<double>(const OperatingPoint<double>&, const double*, const double*) const;
extern template void Network::rate_K_per_s<double>(OperatingPoint<double>&, std::span<const double>, std::span<double>,
                                                   std::span<double>) const;
extern template void Network::rate_K_per_s<Lanes>(OperatingPoint<Lanes>&, std::span<const Lanes>, std::span<Lanes>, std::span<Lanes>) const;

}  // namespace heatsoak
