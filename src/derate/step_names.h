// Names of a formula's steps in generated code, the same in every language.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "derate/observer.h"
#include "derate/unit_suffix.h"

namespace heatsoak::derate {

/// Gives each step a name of its own, which ends in its unit if that is known. A quantity that a law names keeps that name
/// ("copper_loss_W"). The others are derived from their operands ("winding_above_stator_K") or from the only quantity that they determine:
/// the factor of a loss in W on a squared current is "copper_loss_resistance_ohm". The rest is named after its law.
class StepNames {
 public:
  /// `rate_steps`: the set of the observer's rates that is written. `reserved`: names that the generated code uses for something else. The
  /// observer must outlive this object.
  StepNames(const Observer& observer, std::span<const int> rate_steps, std::set<std::string> reserved = {});

  /// Returns the name of a step; must be called once per step.
  std::string name_for(int place);

 private:
  [[nodiscard]] const thermal::Formula::Step& step(int place) const;
  [[nodiscard]] bool is_constant(int place) const;
  [[nodiscard]] std::string known(int place) const;  ///< empty if the step has no name yet
  [[nodiscard]] bool is_one(int place) const;
  void suggest(int place, const std::string& name);
  void suggest_by_user(int place, const std::string& name);
  void name_rates(std::span<const int> rate_steps);
  void name_from_operands(int place, bool is_last);  ///< `is_last`: also names without a unit
  void name_operands_of(int place);
  void name_addends(int place, const NameWithUnit& sum);
  void name_factors(int place, const NameWithUnit& product);
  [[nodiscard]] std::string fallback_name(int place) const;

  const Observer& observer_;
  std::map<int, std::string> derived_;  ///< names of steps that no law names
  std::map<int, int> uses_;             ///< number of steps that use a step
  std::set<std::string> names_;         ///< names that are in use
};

}  // namespace heatsoak::derate
