#include "present/verdict_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <string_view>

#include "base/confidence.h"
#include "base/counted.h"
#include "present/evaluation.h"
#include "present/verdict_words.h"

namespace heatsoak::present {
namespace {

std::vector<double> in_minutes(std::vector<double> times_s) {
  for (double& time : times_s) {
    time /= 60.0;
  }
  return times_s;
}

/// Returns the robot's own motor first, then the others from the best on.
std::vector<const select::MotorEvaluation*> chosen(const std::vector<select::MotorEvaluation>& results, const robot::Robot& robot) {
  std::vector<const select::MotorEvaluation*> all;
  for (const select::MotorEvaluation& each : results) {
    all.push_back(&each);
  }
  std::stable_partition(all.begin(), all.end(), [&](const select::MotorEvaluation* each) { return each->motor_id == robot.drive.motor; });
  all.resize(std::min(all.size(), kMostCurves));
  return all;
}

double at(const select::TemperatureCurves& curves, const std::vector<double>& values, double time_s) {
  const auto next = std::ranges::lower_bound(curves.time_s, time_s);
  return values[static_cast<std::size_t>(std::min(next, curves.time_s.end() - 1) - curves.time_s.begin())];
}

/// Returns whether two lines nearly coincide: the second is then dashed, so that both are visible.
bool coincide(const select::TemperatureCurves& one, const std::vector<double>& one_C, const select::TemperatureCurves& other,
              const std::vector<double>& other_C) {
  constexpr int kLooks = 60;
  constexpr double kLine_K = 1.0;
  int alike = 0;
  for (int i = 1; i <= kLooks; ++i) {
    const double time_s = one.time_s.back() * i / kLooks;
    alike += std::abs(at(one, one_C, time_s) - at(other, other_C, time_s)) < kLine_K ? 1 : 0;
  }
  return 2 * alike > kLooks;
}

/// Returns whether the bands of these motors stay readable. Those of more motors would cover each other.
bool has_bands(std::size_t motors) {
  constexpr std::size_t kMostWithBands = 4;
  return motors <= kMostWithBands;
}

report::ChartPanel panel(const std::vector<const select::MotorEvaluation*>& shown, bool of_winding, bool has_cycles) {
  report::ChartPanel result{.title = of_winding ? "Winding" : "Stator", .y_label = "temperature / °C", .range_label = "sample peaks"};
  std::map<double, std::vector<std::string>> limits_C;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const select::TemperatureCurves& curves = shown[i]->curves;
    std::string name = of_winding ? fmt::format("{}, {:.0f} °C, {}", shown[i]->motor_id, shown[i]->winding_peak_C.nominal,
                                                to_string(shown_verdict(*shown[i])))
                                  : std::string();
    const int color = static_cast<int>(i);
    const auto values_of = [of_winding](const select::TemperatureCurves& c) -> const std::vector<double>& {
      return of_winding ? c.winding_C : c.stator_C;
    };
    const auto hides = std::find_if(shown.begin(), shown.begin() + color, [&](const select::MotorEvaluation* before) {
      return coincide(curves, values_of(curves), before->curves, values_of(before->curves));
    });
    const bool is_hidden = hides != shown.begin() + color;
    if (is_hidden && of_winding) {
      name += fmt::format(" (as {})", (*hides)->motor_id);
    }
    result.curves.push_back({name, in_minutes(curves.time_s), values_of(curves), color, is_hidden, false, has_cycles});
    if (!curves.band_time_s.empty() && has_bands(shown.size())) {
      result.bands.push_back({"", in_minutes(curves.band_time_s), of_winding ? curves.winding_p05_C : curves.stator_p05_C,
                              of_winding ? curves.winding_p95_C : curves.stator_p95_C, color});
    }
    if (const select::Spread95& peak_C = of_winding ? shown[i]->winding_peak_C : shown[i]->stator_peak_C; peak_C.p05 && peak_C.p95) {
      result.ranges.push_back({*peak_C.p05, *peak_C.p95, peak_C.nominal, color});
    }
    if (of_winding) {
      limits_C[shown[i]->winding_limit_C].push_back(shown[i]->motor_id);
    } else if (shown[i]->stator_limit_C) {
      limits_C[*shown[i]->stator_limit_C].push_back(shown[i]->motor_id);
    }
  }
  for (const auto& [limit_C, motors] : limits_C) {
    const std::string whose = limits_C.size() == 1 ? ""
                              : motors.size() == 1 ? fmt::format(" of {}", motors.front())
                                                   : fmt::format(" of {} motors", motors.size());
    result.levels.push_back({fmt::format("limit {:.0f} °C{}", limit_C, whose), limit_C, true});
  }
  return result;
}

/// States which of the compared motors the picture shows.
std::string selection_of(const std::vector<const select::MotorEvaluation*>& shown, std::size_t compared, const robot::Robot& robot) {
  const bool has_own = std::ranges::find(shown, robot.drive.motor, &select::MotorEvaluation::motor_id) != shown.end();
  return has_own ? fmt::format("the robot's motor and the best of {}, ", compared)
                 : fmt::format("the best {} of {}, ", shown.size(), compared);
}

std::string title_of(const std::vector<select::MotorEvaluation>& results, const robot::Robot& robot, const duty::Duty& duty) {
  const auto count = [&](ShownVerdict verdict) {
    return std::ranges::count_if(results, [verdict](const auto& each) { return shown_verdict(each) == verdict; });
  };
  const auto open = count(ShownVerdict::undecided);
  const std::string verdict =
      results.front().samples == 0 ? fmt::format("Nominal values: {} of {} within the limits", count(ShownVerdict::nominal_within),
                                                 base::counted(results.size(), "motor"))
      : results.size() == 1        ? fmt::format("{}: {}", results.front().motor_id, to_string(shown_verdict(results.front())))
                                   : fmt::format("{}{}", passing_text(count(ShownVerdict::pass), results.size(), "motor"),
                                          open > 0 ? fmt::format(", {} undecided", open) : "");
  return fmt::format("{}, {} on {}", verdict, robot.name, duty.id);
}

}  // namespace

report::Chart verdict_chart(const std::vector<select::MotorEvaluation>& results, const robot::Robot& robot, const duty::Duty& duty) {
  const std::vector<const select::MotorEvaluation*> shown = chosen(results, robot);
  const bool sampled = std::ranges::any_of(shown, [](const select::MotorEvaluation* each) { return !each->curves.band_time_s.empty(); });
  const bool estimated = std::ranges::any_of(shown, [](const select::MotorEvaluation* each) { return each->data_quality == "estimated"; });
  // A load that the robot's motion demands, such as a match, does not repeat in cycles.
  const bool has_cycles = !duty.shape_data->depends_on_robot();
  const std::string percentiles =
      fmt::format("{:.3g}\u00a0% to {:.3g}\u00a0%", 100.0 * base::kLowPercentile_share, 100.0 * base::kHighPercentile_share);
  const std::string areas = has_bands(shown.size()) ? fmt::format("pale areas: {} of the samples at each time; ", percentiles) : "";
  const std::string_view of_cycles = has_cycles ? ", highest and lowest of each load cycle" : "";
  return {
      .title = title_of(results, robot, duty),
      .subtitle = fmt::format("{}{}{}{}", shown.size() < results.size() ? selection_of(shown, results.size(), robot) : "", duty.summary,
                              sampled ? fmt::format("; lines: nominal{}; {}bars: {} of the samples' peaks", of_cycles, areas, percentiles)
                                      : fmt::format("; nominal values{}", of_cycles),
                              estimated ? "; thermal data partly estimated" : ""),
      .x_label = "time / min",
      .panels = {panel(shown, true, has_cycles), panel(shown, false, has_cycles)}};
}

}  // namespace heatsoak::present
