#include "cli/verdict_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>

namespace heatsoak {
namespace {

std::vector<double> in_minutes(std::vector<double> times_s) {
  for (double& time : times_s) {
    time /= 60.0;
  }
  return times_s;
}

/// The robot's own motor and the best of the others: what a team decides between.
std::vector<const MotorEvaluation*> chosen(const std::vector<MotorEvaluation>& results, const Robot& robot) {
  std::vector<const MotorEvaluation*> all;
  for (const MotorEvaluation& each : results) {
    all.push_back(&each);
  }
  std::ranges::stable_partition(all, [&](const MotorEvaluation* each) { return each->motor_id == robot.drive_motor; });
  all.resize(std::min(all.size(), kMostCurves));
  return all;
}

ChartPanel panel(const std::vector<const MotorEvaluation*>& shown, bool of_winding) {
  ChartPanel result{.title = of_winding ? "Winding" : "Stator", .y_label = "temperature / °C", .curves = {}, .bands = {}, .levels = {}};
  std::map<double, std::vector<std::string>> limits_C;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const TemperatureCurves& curves = shown[i]->curves;
    const std::string name =
        of_winding ? fmt::format("{}, {:.0f} °C", shown[i]->motor_id, shown[i]->winding_peak_C.nominal) : std::string();
    const int color = static_cast<int>(i);
    result.curves.push_back({name, in_minutes(curves.time_s), of_winding ? curves.winding_C : curves.stator_C, color, false});
    if (!curves.band_time_s.empty()) {
      result.bands.push_back({"", in_minutes(curves.band_time_s), of_winding ? curves.winding_p05_C : curves.stator_p05_C,
                              of_winding ? curves.winding_p95_C : curves.stator_p95_C, color});
    }
    if (of_winding) {
      limits_C[shown[i]->winding_limit_C].push_back(shown[i]->motor_id);
    } else if (shown[i]->stator_limit_C) {
      limits_C[*shown[i]->stator_limit_C].push_back(shown[i]->motor_id);
    }
  }
  for (const auto& [limit_C, motors] : limits_C) {
    const std::string whose = limits_C.size() == 1 ? ""
                              : motors.size() == 1 ? " of " + motors.front()
                                                   : fmt::format(" of {} motors", motors.size());
    result.levels.push_back({fmt::format("limit {:.0f} °C{}", limit_C, whose), limit_C});
  }
  return result;
}

}  // namespace

Chart verdict_chart(const std::vector<MotorEvaluation>& results, const Robot& robot, const Duty& duty) {
  const std::vector<const MotorEvaluation*> shown = chosen(results, robot);
  const bool estimated = std::ranges::any_of(shown, [](const MotorEvaluation* each) { return each->data_quality == "estimated"; });
  return {.title = fmt::format("{} on {}", robot.name, duty.id),
          .subtitle = fmt::format("{}{}; lines: nominal, areas: 5 % to 95 % of samples{}",
                                  shown.size() < results.size() ? fmt::format("{} of {} motors, ", shown.size(), results.size()) : "",
                                  duty.summary, estimated ? "; thermal data partly estimated" : ""),
          .x_label = "time / min",
          .panels = {panel(shown, false), panel(shown, true)}};
}

}  // namespace heatsoak
