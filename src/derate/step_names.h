// Names of a formula's steps in generated code, the same in every language.
#pragma once

#include <set>
#include <string>
#include <utility>

#include "derate/observer.h"

namespace heatsoak::derate {

/// Gives each step a name of its own: the physical quantity ("copper_loss_W", "winding_above_stator_K", "winding_rate_K_per_s"),
/// or the law to which it belongs ("copper_loss_term", "copper_loss_constant").
class StepNames {
 public:
  /// `reserved`: names that the generated code uses for something else. The observer must outlive this object.
  explicit StepNames(const Observer& observer, std::set<std::string> reserved = {}) : observer_(observer), names_(std::move(reserved)) {}

  /// Returns the name of a step; must be called once per step.
  std::string name_for(int place);

 private:
  const Observer& observer_;
  std::set<std::string> names_;  ///< names that are in use
};

}  // namespace heatsoak::derate
