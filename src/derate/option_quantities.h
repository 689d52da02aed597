// Options of a derating that are quantities. Commands and check files offer the same ones.
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "base/parameter.h"
#include "derate/derating.h"

namespace heatsoak::derate {

struct OptionQuantity {
  base::ParameterSpec spec;
  std::variant<double*, std::optional<double>*> value;  ///< member of the options, in the unit of `spec`; holds the default
};

/// Returns all options but the period, which a drive core determines. The result refers to `options`.
std::vector<OptionQuantity> option_quantities(DerateOptions& options);

/// Range of DerateOptions::table.most_bytes.
inline constexpr base::Range kTableSize_byte = base::Range::between(64.0, 1048576.0);

}  // namespace heatsoak::derate
