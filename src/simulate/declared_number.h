// Numbers of a simulation that robot files do not contain. Each is declared once with unit, range and origin.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "base/parameter.h"
#include "base/parameter_value.h"

namespace heatsoak::simulate {

/// One number of a `Config`. The default is the member's initial value.
template <class Config>
struct DeclaredNumber {
  base::ParameterSpec spec;  ///< its range is the one that a run accepts
  double Config::*value = nullptr;
  base::Origin origin = base::Origin::estimated;
  base::Range plausible;  ///< expected range of the true value for robots of this league
  std::string_view derivation;
};

/// Throws Failure (bad_input) that lists every value outside its declared range.
void require_declared_ranges(std::span<const base::ParameterSpec> specs, std::span<const double> values);

template <class Config>
void require_declared_ranges(const Config& config, std::span<const DeclaredNumber<Config>> numbers) {
  std::vector<base::ParameterSpec> specs;
  std::vector<double> values;
  for (const DeclaredNumber<Config>& each : numbers) {
    specs.push_back(each.spec);
    values.push_back(config.*each.value);
  }
  require_declared_ranges(specs, values);
}

}  // namespace heatsoak::simulate
