#include <nlohmann/json.hpp>

#include "base/number_ranges.h"
#include "present/measured/friction.h"
#include "present/measured/friction_words.h"

namespace heatsoak::present {
namespace {

Json number_or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

/// Returns the id of the motor, or null if it has no file.
Json motor_json(const friction::FrictionJob& job) { return job.motor ? Json(job.motor_id) : Json(); }

Json json(const std::optional<friction::Estimate>& estimate) {
  const std::optional<friction::Interval> interval = estimate ? estimate->interval : std::nullopt;
  return {{"value", estimate ? Json(estimate->value) : Json()},
          {"ci95", interval ? Json{interval->low, interval->high} : Json{nullptr, nullptr}}};
}

Json wheels_json(const friction::FrictionFit& fit, const friction::HeldOutError& error, std::size_t rows) {
  Json wheels = Json::array();
  for (std::size_t i = 0; i < fit.wheels.size(); ++i) {
    const friction::WheelFriction& wheel = fit.wheels[i];
    wheels.push_back({{"index", i + 1},
                      {"damping_V_s_per_rad", json(wheel.damping_V_s_per_rad)},
                      {"a_V", json(wheel.sine_V)},
                      {"b_V", json(wheel.constant_V)},
                      {"phase_rad", json(wheel.phase_rad)},
                      {"rotation_V", json(wheel.rotation_V)},
                      {"r2", number_or_null(wheel.r2_ratio)},
                      {"rmse_V", number_or_null(wheel.rmse_V)},
                      {"rows_used", wheel.rows_used},
                      {"rows_left_out", rows - wheel.rows_used},
                      {"legs_used", wheel.parts_used},
                      {"legs_standing", wheel.parts_standing},
                      {"legs_outlying", wheel.parts_outlying},
                      {"damping_given", wheel.damping_is_given},
                      {"phase_given", wheel.phase_is_given},
                      {"phase_bounded", wheel.phase_is_bounded},
                      {"lack_of_fit", wheel.lack.is_found},
                      {"left_V", number_or_null(wheel.lack.left_V)},
                      {"repeats_V", number_or_null(wheel.lack.repeats_V)},
                      {"before_rmse_V", number_or_null(error.before_of_wheel_V[i])},
                      {"after_rmse_V", number_or_null(error.after_of_wheel_V[i])},
                      {"problem", wheel.problem ? words_of(*wheel.problem) : ""}});
  }
  return wheels;
}

}  // namespace

Json friction_json(const friction::FrictionJob& job, const friction::SteadyFriction& found, const FrictionRemarks& remarks) {
  const friction::SteadyParts& steady = found.steady;
  Json answer{{"schema", "heatsoak.friction/1"},
              {"method", "steady_state"},
              {"robot", job.robot.id},
              {"motor", motor_json(job)},
              {"wheels", wheels_json(found.fit, found.error, steady.rows)},
              {"before",
               {{"rmse", number_or_null(found.error.before_V)},
                {"unit", "V"},
                {"from", found.expected_from ? words_of(*found.expected_from) : ""}}},
              {"after", {{"rmse", number_or_null(found.error.after_V)}, {"unit", "V"}}},
              {"headings", found.fit.headings},
              {"headings_held_out", found.error.headings},
              {"rows", steady.rows},
              {"rows_steady", steady.rows_steady},
              {"legs", steady.legs},
              {"return_legs", steady.return_legs},
              {"findings", remarks.findings},
              {"suspicions", remarks.suspicions}};
  return base::with_ranges(std::move(answer), {{"rmse", base::kNotNegative},
                                               {"rmse_V", base::kNotNegative},
                                               {"left_V", base::kNotNegative},
                                               {"repeats_V", base::kNotNegative},
                                               {"before_rmse_V", base::kNotNegative},
                                               {"after_rmse_V", base::kNotNegative}});
}

Json friction_json(const friction::FrictionJob& job, const friction::RollOutFriction& found, const FrictionRemarks& remarks) {
  const friction::RollOutResult& result = found.result;
  Json wheels = Json::array();
  for (std::size_t i = 0; i < result.wheel_damping_Nm_s_per_rad.size(); ++i) {
    const std::optional<friction::Estimate>& mechanical = result.wheel_damping_Nm_s_per_rad[i];
    std::size_t used = 0;
    for (const friction::RollOutRun& run : result.runs) {
      used += !run.wheel || run.wheel == static_cast<int>(i) ? static_cast<std::size_t>(run.rows_used) : 0U;
    }
    wheels.push_back({{"index", i + 1},
                      {"damping_V_s_per_rad", json(damping_with_back_emf(found.drive, mechanical))},
                      {"a_V", json(std::nullopt)},
                      {"b_V", json(std::nullopt)},
                      {"phase_rad", json(std::nullopt)},
                      {"wheel_damping_Nm_s_per_rad", json(mechanical)},
                      {"wheel_torque_Nm", json(result.wheel_torque_Nm[i])},
                      {"r2", Json()},
                      {"rows_used", used},
                      {"rows_left_out", result.rows - used}});
  }
  return {{"schema", "heatsoak.friction/1"},
          {"method", "roll_out"},
          {"robot", job.robot.id},
          {"motor", motor_json(job)},
          {"wheels", wheels},
          {"before", {{"rmse", Json()}}},
          {"after", {{"rmse", Json()}}},
          {"findings", remarks.findings},
          {"suspicions", remarks.suspicions}};
}

}  // namespace heatsoak::present
