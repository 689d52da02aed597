#include <nlohmann/json.hpp>

#include "base/number_ranges.h"
#include "present/jerk_sweep.h"

namespace heatsoak::present {
namespace {

Json cases_json(const std::vector<simulate::StudyResult>& results) {
  Json rows = Json::array();
  for (const simulate::StudyResult& each : results) {
    rows.push_back({{"planner", each.is_bang_bang() ? "bang_bang" : "jerk_limited"},
                    {"acceleration_m_per_s2", rounded(each.limits.acceleration_m_per_s2, 4)},
                    {"jerk_m_per_s3", rounded(each.limits.jerk_m_per_s3, 4)},
                    {"planned_s", rounded(each.planned_s, 4)},
                    {"settled_s", rounded(each.settled_s, 4)},
                    {"slip_m_per_m", rounded(each.slip_share, 6)},
                    {"sliding_m_per_m", rounded(each.sliding_share, 6)},
                    {"tracking_rms_m", rounded(each.tracking_rms_m, 6)},
                    {"overshoot_mean_m", rounded(each.overshoot_mean_m, 6)},
                    {"peak_current_A", rounded(each.peak_current_A, 3)},
                    {"copper_J", rounded(each.copper_J, 4)}});
  }
  return rows;
}

}  // namespace

Json jerk_sweep_json(const simulate::JerkSweep& sweep) {
  Json answer{{"schema", "heatsoak.jerk_sweep/1"},
              {"motor", sweep.motor.id},
              {"robot", sweep.robot.id},
              {"grip_m_per_s2", rounded(simulate::grip_m_per_s2(sweep.robot), 4)},
              {"cases", cases_json(sweep.results)}};
  return base::with_ranges(std::move(answer), {{"planned_s", base::kNotNegative},
                                               {"settled_s", base::kNotNegative},
                                               {"slip_m_per_m", base::kNotNegative},
                                               {"sliding_m_per_m", base::kNotNegative},
                                               {"tracking_rms_m", base::kNotNegative},
                                               {"peak_current_A", base::kNotNegative},
                                               {"copper_J", base::kNotNegative}});
}

}  // namespace heatsoak::present
