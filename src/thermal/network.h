// A thermal network: nodes that store heat, effects that book heat, and one flat list of all their parameters.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "thermal/drive_stage.h"
#include "thermal/effect.h"

namespace heatsoak::thermal {

struct Linearised;
class Traced;
struct TracedHeat;

struct NetworkParameter {
  std::string name;  ///< "winding_stator.thermal_resistance", "winding.heat_capacity"
  std::string_view unit;
  base::Range range;
  double value = 0.0;
  std::span<const base::Choice> choices = {};  ///< if not empty, the value is the index of a choice, which is neither sampled nor fitted
};

/// An effect in a network: the nodes of its roles and the indices of its parameters in the flat list.
struct EffectInPlace {
  std::string name;  ///< name of this instance, unique in the network
  const EffectType* type = nullptr;
  std::vector<int> node_index;
  std::vector<int> parameter_index;
};

/// The structure is shared by all samples; parameter values are passed to each call, so that one network serves single runs, ensembles and
/// fits. Ambient is the last node and has a prescribed temperature.
class Network {
 public:
  static constexpr std::string_view kAmbient = "ambient";
  /// Largest number of nodes, ambient included. The bound lets rate_K_per_s(), which is called millions of times, keep its arrays on the
  /// stack.
  static constexpr int kMostNodes = 16;
  static constexpr int kMostRoles = 4;        ///< node roles of one effect
  static constexpr int kMostParameters = 16;  ///< parameters of one effect

  /// Adds a state node and returns its index. Throws std::logic_error for a capacity ≤ 0, a known name or too many nodes.
  int add_node(std::string name, double heat_capacity_J_per_K);
  /// Adds an effect. `nodes` and `parameters` are in the order of the type's declaration. All nodes must exist, except a node of the
  /// effect's own: it is added under the name given for its role. Throws std::logic_error on a mismatch or a value out of range.
  /// `shared`: declared parameters, by key, that are the parameter of another effect, by its name in the network ("copper_loss.x"); their
  /// element of `parameters` is not used.
  void add_effect(std::string name, const EffectType& type, std::span<const std::string> nodes, std::span<const double> parameters,
                  const std::map<std::string, std::string>& shared = {});

  /// Puts a drive stage before the laws: they see its current and its copper loss. It reads the parameters terminal_resistance and
  /// temperature_coefficient and the node of the effect named. Throws std::logic_error if there is no such effect.
  void limit_current_by(std::string_view copper_effect);

  [[nodiscard]] int state_count() const { return static_cast<int>(node_names_.size()); }
  [[nodiscard]] int node_count() const { return state_count() + 1; }
  /// Returns the index of a node, state_count() for ambient; empty if there is no such node.
  [[nodiscard]] std::optional<int> find_node(std::string_view name) const;
  /// Returns the index of a node. Throws std::logic_error if there is no such node.
  [[nodiscard]] int node(std::string_view name) const;
  [[nodiscard]] std::string_view node_name(int node) const;
  /// Returns the index of a state node's heat capacity in the list of parameters.
  [[nodiscard]] int capacity_index(int node) const { return capacity_index_.at(static_cast<std::size_t>(node)); }
  [[nodiscard]] std::span<const EffectInPlace> effects() const { return effects_; }
  [[nodiscard]] std::span<const NetworkParameter> parameters() const { return parameters_; }
  [[nodiscard]] std::vector<double> values() const;

  /// Writes dT/dt of every state node in K/s. `temperature_C` has node_count() entries; the last one is overwritten with the ambient
  /// temperature of the operating point. S is double or Lanes. `at` is modified during the call and restored, because copying it would
  /// double the run time.
  template <class S>
  void rate_K_per_s(OperatingPoint<S>& at, std::span<const S> parameters, std::span<S> temperature_C, std::span<S> rate) const;
  template <class S>
  void rate_K_per_s(const OperatingPoint<S>& at, std::span<const S> parameters, std::span<S> temperature_C, std::span<S> rate) const {
    OperatingPoint<S> own = at;
    rate_K_per_s<S>(own, parameters, temperature_C, rate);
  }

  /// Computes the rates and their exact derivatives. The current is not limited: the headroom of the operating point must be infinite.
  /// `state_C` has state_count() entries. Does not allocate if `out` already has the right shapes.
  void linearise(const OperatingPoint<double>& at, std::span<const double> parameters, std::span<const double> state_C,
                 Linearised& out) const;

  /// Evaluates the laws as formulas with the network's parameters as constants and writes the heat of every node to node_heat[n].
  /// `node_heat` and `temperature_C` have node_count() entries, ambient last. The headroom of the operating point must be infinite.
  void trace(const OperatingPoint<Traced>& at, std::span<const Traced> temperature_C, std::span<TracedHeat> node_heat) const;

  /// Writes the heat in W that effect e books into node n to heat_W[e · node_count() + n]; positive into the node.
  void balance_W(const OperatingPoint<double>& at, std::span<const double> parameters, std::span<const double> state_C,
                 std::span<double> heat_W) const;

  /// Returns the current in A behind the drive stage at these temperatures (at least state_count() entries); without a drive stage that of
  /// the operating point.
  [[nodiscard]] double flowing_A(const OperatingPoint<double>& at, const double* parameters, const double* temperature_C) const {
    return drive_ ? drive_->current_A(at, parameters, temperature_C) : at.current_rms_A;
  }

 private:
  /// Calls visit(effect, at) for all effects with the operating point behind the drive stage, then restores the point. Rates, balance,
  /// trace and linearisation differ only in what they do with an effect. Defined in evaluation.h.
  template <class S, class Visit>
  void evaluate(OperatingPoint<S>& at, const S* parameters, const S* temperature_C, const Visit& visit) const;
  int add_parameter(NetworkParameter parameter);
  [[nodiscard]] int place_of_parameter(std::string_view name) const;
  int add_state(std::string name, int capacity_index);

  std::vector<std::string> node_names_;
  std::vector<int> capacity_index_;
  std::vector<EffectInPlace> effects_;
  std::vector<NetworkParameter> parameters_;
  std::optional<DriveStage> drive_;
};

extern template void Network::rate_K_per_s<double>(OperatingPoint<double>&, std::span<const double>, std::span<double>,
                                                   std::span<double>) const;

}  // namespace heatsoak::thermal
