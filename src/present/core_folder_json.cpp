#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/number_ranges.h"
#include "present/core_folder.h"
#include "present/default_spreads_json.h"

namespace heatsoak::present {

Json core_folder_json(const CoreInput& input, const firmware::GeneratedCore& core) {
  const auto& [derating, folder] = core;
  const derate::Guarantee& checked = derating.guarantee;
  Json files = Json::array();
  for (const firmware::CoreFile& file : folder.files) {
    files.push_back({{"path", file.path}, {"bytes", file.content.size()}});
  }
  Json answer{{"schema", "heatsoak.core/1"},
              {"robot", derating.robot_id},
              {"motor", derating.motor_id},
              {"out", input.out},
              {"period_s", input.options.period_s},
              {"shadow_mode", input.options.shadow_mode},
              {"input_hash", {{"name", derate::kInputHash}, {"value", folder.hash}}},
              {"config_check_sum", fmt::format("{:08x}", folder.config_check_sum)},
              {"files", files},
              {"derating",
               {{"data_quality", derating.data_quality},
                {"seed", derating.options.guarantee.seed},
                {"guard_period_s", derating.options.period_s},
                {"winding_limit_C", derating.rules.limits.winding_C},
                {"hottest_ambient_C", derating.rules.hottest_ambient_C},
                {"heat_reserve_ratio", rounded(derating.observer.heat_safety_factor(), 4)},
                {"confidence", derating.options.guarantee.required_share},
                {"samples", checked.samples},
                {"over", checked.over},
                {"limp_current_A", rounded(folder.limp_current_A, 4)},
                {"braking_reserve_K", rounded(folder.braking_reserve_K, 3)},
                {"nodes", derating.observer.state_names()}}},
              {"default_spreads", default_spreads_json({&input.motor, 1})}};
  return base::with_ranges(std::move(answer), {{"period_s", base::kNotNegative},
                                               {"guard_period_s", base::kNotNegative},
                                               {"confidence", base::kShare},
                                               {"limp_current_A", base::kNotNegative}});
}

}  // namespace heatsoak::present
