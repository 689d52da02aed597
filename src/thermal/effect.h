// Effects: an effect is one physical law with its parameters. This header has the description, law.h the law.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "base/parameter.h"
#include "thermal/operating_point.h"

namespace heatsoak::thermal {

struct Laws;

struct NodeRole {
  std::string_view role;          ///< key in a motor file by which another node can play the role
  std::string_view default_node;  ///< node that plays the role by default
  /// Index of the parameter that is the node's heat capacity if the effect adds a node of its own.
  std::optional<int> own_capacity = {};
  bool is_surroundings = false;  ///< the surroundings of the motor: no node of the motor can play the role
};

/// Proposal of an effect that a model may lack: parameter values typical for a motor of about 50 W, one variant for each distinguishable
/// shape of the law.
struct Candidacy {
  /// Index of the parameter that the heat is proportional to; 0 is the model without the effect. Empty: the effect is never a candidate.
  std::optional<int> size_parameter = {};
  std::vector<std::vector<double>> variants;
  std::string_view family;      ///< name of the group while the exact law is undetermined: "speed loss at the stator"
  std::string_view experiment;  ///< measurement that separates it from the effects it is confounded with
  bool is_anywhere = false;     ///< tried at every node, also in a network of only two nodes
  bool is_in_current = false;   ///< a measured current contains the effect: tried only if the current follows from the torque
};

/// A hand-calculated example of the equation; a test runs it for every effect.
struct WorkedExample {
  std::vector<double> parameters;  ///< in the order of declaration
  OperatingPoint<double> at;
  std::vector<double> temperature_C;    ///< one per role
  std::vector<double> expected_heat_W;  ///< one per role, positive into the node
};

/// Choices "a column of the log". The motor file writes the first of them and names the column; the reader assigns a place to each column
/// and takes the choice with the same index.
inline constexpr std::array<std::string_view, kLogColumns> kColumnChoices{"column", "column_2", "column_3"};
inline constexpr std::string_view kColumnChoice = kColumnChoices.front();
/// Returns whether a choice is a column of the log.
constexpr bool is_column_choice(std::string_view choice) { return std::ranges::find(kColumnChoices, choice) != kColumnChoices.end(); }

struct EffectType {
  std::string_view name;  ///< name in motor files; set by find_effect()
  std::string_view summary;
  std::string_view equation;
  std::string_view reference;
  std::vector<NodeRole> nodes;
  std::vector<base::ParameterSpec> parameters;
  std::string_view typical;          ///< typical size for a motor of about 50 W
  std::string_view confounded_with;  ///< effects that it is confounded with, and what separates them
  WorkedExample example;
  const Laws* laws = nullptr;  ///< never null in a registered effect
  std::vector<Signal> needs = {};
  Candidacy candidacy = {};
  /// The effect produces no heat, but takes a share of the copper loss from its first node and adds it to the second.
  bool moves_copper_loss = false;
  /// Signals needed with these parameters, for an effect whose signals depend on a choice; null: all of `needs`.
  std::vector<Signal> (*needs_of)(std::span<const double> parameters) = nullptr;

  [[nodiscard]] std::vector<Signal> needed_with(std::span<const double> values) const { return needs_of ? needs_of(values) : needs; }
};

/// Returns all effects, sorted by name. The list lives as long as the program.
const std::vector<EffectType>& all_effects();
/// Returns the effect of that name, or null if there is none.
const EffectType* find_effect(std::string_view name);

}  // namespace heatsoak::thermal
