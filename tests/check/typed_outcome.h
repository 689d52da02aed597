// Reasons and bases of outcomes by their type.
#pragma once

#include <string>
#include <variant>

#include "check/run_checks.h"

namespace heatsoak::check {

/// Returns null if the threshold was evaluated or has another reason.
template <class Kind>
const Kind* reason_of(const Outcome& outcome) {
  return outcome.reason ? std::get_if<Kind>(&*outcome.reason) : nullptr;
}

/// Returns the text of the failure; empty if the threshold was evaluated or has another reason.
inline std::string failure_of(const Outcome& outcome) {
  const Failed* const failed = reason_of<Failed>(outcome);
  return failed != nullptr ? failed->failure.what() : "";
}

/// Throws std::bad_variant_access if the basis is of another type, and std::bad_optional_access without a value.
template <class Kind>
const Kind& basis_of(const Outcome& outcome) {
  return std::get<Kind>(outcome.measured.value().basis);
}

}  // namespace heatsoak::check
