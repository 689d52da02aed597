#include <nlohmann/json.hpp>

#include "base/number_ranges.h"
#include "motor/datasheet_network.h"
#include "present/steady.h"

namespace heatsoak::present {

Json steady_json(const motor::OnOffAnswer& answer) {
  const motor::Motor& motor = answer.motor;
  const thermal::PeriodicState& periodic = answer.periodic;
  const thermal::OnOffSteadyState& under_rms = answer.under_rms;
  const bool is_runaway = answer.is_runaway();
  const auto rest = [&](double value_C) { return is_runaway || under_rms.runaway ? Json() : Json(value_C); };
  const auto node = [&](const std::vector<double>& value_C, std::size_t state) { return is_runaway ? Json() : Json(value_C[state]); };
  Json result{{"schema", "heatsoak.steady/1"},
              {"motor", motor.id},
              {"conditions", motor.assumed},
              {"ambient_C", answer.current.ambient_C},
              {"current_rms_A", under_rms.current_rms_A},
              {"winding_C", rest(under_rms.winding_C)},
              {"stator_C", rest(under_rms.stator_C)},
              {"winding_mean_C", node(periodic.mean_C, motor::states::winding)},
              {"stator_mean_C", node(periodic.mean_C, motor::states::stator)},
              {"winding_peak_C", node(periodic.peak_C, motor::states::winding)},
              {"winding_limit_C", motor.nominal.winding_limit_C},
              {"destroyed_after_s", periodic.destroyed_s ? Json(*periodic.destroyed_s) : Json()},
              {"runaway", is_runaway}};
  return base::with_ranges(std::move(result), {{"current_rms_A", base::kNotNegative}, {"destroyed_after_s", base::kNotNegative}});
}

}  // namespace heatsoak::present
