#include "simulate/declared_number.h"

#include <fmt/format.h>

#include "base/diagnostic.h"

namespace heatsoak::simulate {

void require_declared_ranges(std::span<const base::ParameterSpec> specs, std::span<const double> values) {
  base::Diagnostics problems;
  for (std::size_t i = 0; i < specs.size(); ++i) {
    if (!specs[i].range.contains(values[i])) {
      problems.add({}, std::string(specs[i].key),
                   fmt::format("is {} {}; expected {}", values[i], specs[i].unit, base::to_string(specs[i].range, specs[i].unit)));
    }
  }
  problems.throw_if_any();
}

}  // namespace heatsoak::simulate
