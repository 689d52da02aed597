// Severity of a finding by its kind, for the findings of a calibration and of a diagnosis. A kind that is in none of the three lists, or in
// two, does not compile.
#pragma once

#include <type_traits>
#include <variant>

#include "present/document.h"

namespace heatsoak::present {

template <class... Kind>
struct Kinds {
  template <class Finding>
  static constexpr int count = (0 + ... + (std::is_same_v<Finding, Kind> ? 1 : 0));
};

/// Returns the severity of the kind that the variant holds. `Warnings`, `Notes` and `Background` are Kinds.
template <class Warnings, class Notes, class Background, class Variant>
Severity severity_in(const Variant& finding) {
  return std::visit(
      []<class Finding>(const Finding&) {
        static_assert(Warnings::template count<Finding> + Notes::template count<Finding> + Background::template count<Finding> == 1,
                      "each kind of finding needs one severity");
        return Warnings::template count<Finding> == 1 ? Severity::warning
               : Notes::template count<Finding> == 1  ? Severity::note
                                                      : Severity::background;
      },
      finding);
}

}  // namespace heatsoak::present
