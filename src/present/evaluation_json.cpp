#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/number_ranges.h"
#include "present/closed_loop_json.h"
#include "present/default_spreads_json.h"
#include "present/evaluation.h"
#include "select/decision.h"

namespace heatsoak::present {
namespace {

Json json(const std::optional<select::Interval95>& interval, int decimals) {
  return interval ? Json{rounded(interval->low, decimals), rounded(interval->high, decimals)} : Json();
}

Json json(const select::Spread95& peak, const std::optional<select::Interval95>& of_p95) {
  return {{"nominal", rounded(peak.nominal, 2)},
          {"p05", rounded(peak.p05, 2)},
          {"p50", rounded(peak.p50, 2)},
          {"p95", rounded(peak.p95, 2)},
          {"p95_ci95", json(of_p95, 2)}};
}

Json json(const std::vector<select::RestOfHotMotor>& rests) {
  Json all = Json::array();
  for (const select::RestOfHotMotor& each : rests) {
    Json rest{{"play", fmt::format("{:.0f}min", each.play_s / 60.0)},
              {"rest_half_s", rounded(each.half_s, 0)},
              {"rest_all_s", rounded(each.all_s, 0)},
              {"starts", each.starts},
              {"starts_never", each.starts_never},
              {"over_without_current", each.over_without_current},
              {"longest_rest_s", select::kLongestRest_s}};
    // A longer rest than the longest one may suffice, unless the motor is over its limits without current.
    if (each.over_without_current) {
      add_never(rest, {"rest_half_s", "rest_all_s"});
    } else {
      add_never(rest, {});
    }
    all.push_back(std::move(rest));
  }
  return all;
}

Json json(const select::MotorEvaluation& each) {
  const auto number = [](const std::optional<int>& value) { return value ? Json(*value) : Json(); };
  const select::DecidingSamples deciding = select::deciding_samples(each);
  Json result{{"id", each.motor_id},
              {"winding_limit_C", rounded(each.winding_limit_C, 2)},
              {"winding_peak_C", json(each.winding_peak_C, each.winding_p95_interval_C)},
              {"stator_peak_C", json(each.stator_peak_C, each.stator_p95_interval_C)},
              {"samples", each.samples},
              {"samples_needed", number(each.samples_needed)},
              {"deciding_samples", {{"p50", number(deciding.half)}, {"p90", number(deciding.nine_in_ten)}}},
              {"probability_over_limit", rounded(each.probability_over_limit, 4)},
              {"probability_ci95", json(each.probability_interval, 4)},
              {"winding_p95_ci95_C", json(each.winding_p95_interval_C, 2)},
              {"time_to_limit_s", rounded(each.time_to_limit_s, 3)},
              {"current_rms_A", rounded(each.current_rms_A, 4)},
              {"verdict", select::to_string(select::stated_verdict(each))},
              {"decided", select::is_decided(each)},
              {"limiting_factor", select::to_string(each.limiting_factor)},
              {"data_quality", each.data_quality},
              {"wheel", each.wheel},
              {"margin_K", rounded(each.margin_K, 2)},
              {"stator_margin_K", rounded(each.stator_margin_K, 2)},
              {"ranking_margin_K", rounded(select::nearest_margin_K(each), 2)},
              {"margin_A", rounded(each.margin_A, 4)},
              {"stator_limit_C", rounded(each.stator_limit_C, 2)},
              {"delivered_share", rounded(each.least_torque_share, 4)},
              {"short_time_share", rounded(each.short_time_share, 4)},
              {"short_probability", rounded(each.short_probability, 4)},
              {"short_probability_ci95", json(each.short_interval, 4)},
              {"voltage_needed_V", rounded(each.highest_voltage_V, 3)},
              {"runaway", each.destroyed}};
  add_never(result, {"time_to_limit_s"});
  return result;
}

Json changes_json(const simulate::SuggestedChanges& changes) {
  Json all = Json::array();
  for (const select::ChangeEffect& each : changes.effects) {
    const bool is_value = each.before.has_value();
    all.push_back({{"quantity", select::name_of(each.quantity)},
                   {"unit", select::unit_of(each.quantity)},
                   {"from", is_value ? rounded(each.before, 6) : Json(changes.motor_id)},
                   {"to", is_value ? rounded(*each.before * each.factor, 6) : Json(each.other_motor)},
                   {"saved_K", rounded(each.saved_K, 2)},
                   {"standard_error_K", each.standard_error_K ? rounded(*each.standard_error_K, 2) : Json()},
                   {"deliverable", each.is_deliverable}});
  }
  return all;
}

}  // namespace

Json evaluation_json(const simulate::EvaluationAnswer& answer) {
  Json result{{"schema", "heatsoak.evaluate/1"}, {"robot", answer.robot.id},          {"conditions", answer.conditions},
              {"duty", answer.duty.id},          {"duty_origin", answer.duty.origin}, {"seed", answer.seed},
              {"samples", answer.samples},       {"duty_draws", answer.draw_count}};
  result["default_spreads"] = default_spreads_json(answer.motors);
  if (answer.changes) {
    result["changes"] = changes_json(*answer.changes);
  }
  result["is_friction_assumed"] = answer.robot.friction.is_assumed;
  result["motors"] = Json::array();
  for (std::size_t i = 0; i < answer.results.size(); ++i) {
    const auto rests = answer.rests.find(answer.results[i].motor_id);
    result["motors"].push_back(json(answer.results[i]));
    result["motors"].back()["rest_of_hot_motor"] =
        json(rests == answer.rests.end() ? std::vector<select::RestOfHotMotor>() : rests->second);
    if (answer.closed_loop) {
      result["motors"].back()["closed_loop"] = closed_loop_json(answer.ranks[i], answer.seed);
    }
  }
  return base::with_ranges(std::move(result), {{"probability_over_limit", base::kShare},
                                               {"short_probability", base::kShare},
                                               {"short_probability_ci95", base::kShare},
                                               {"probability_ci95", base::kShare},
                                               {"delivered_share", base::kShare},
                                               {"short_time_share", base::kShare},
                                               {"time_to_limit_s", base::kNotNegative},
                                               {"current_rms_A", base::kNotNegative},
                                               {"voltage_needed_V", base::kNotNegative},
                                               {"from", base::kNotNegative},
                                               {"to", base::kNotNegative},
                                               {"standard_error_K", base::kNotNegative},
                                               {"rest_half_s", base::kNotNegative},
                                               {"rest_all_s", base::kNotNegative},
                                               {"longest_rest_s", base::kNotNegative}});
}

}  // namespace heatsoak::present
