#include <fmt/format.h>

#include "derate/c_header/c_text.h"
#include "derate/c_header/parts.h"

namespace heatsoak::derate::c_header {
namespace {

std::string rates_function(std::string_view comment, std::string_view name, const std::string& prefix, const RateLines& lines) {
  return fmt::format("{0}\nstatic inline void {1}_{2}(const {1}_input *input, const float *state_C, float *rate_K_per_s) {{\n{3}}}\n\n",
                     comment, prefix, name, lines.text());
}

}  // namespace

Rates rates(const Source& source) {
  const Observer& observer = source.derating.observer;
  const RateLines guarded(observer, observer.rate_steps(), line_style());
  const RateLines nominal(observer, observer.nominal_rate_steps(), line_style());
  return {.text = rates_function("/* dT/dt of every node of the guard */", "rates", source.prefix, guarded) +
                  rates_function("/* the same of the nominal motor */", "nominal_rates", source.prefix, nominal),
          .calls_thermal_math = guarded.calls_thermal_math()};
}

}  // namespace heatsoak::derate::c_header
