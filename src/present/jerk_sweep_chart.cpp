#include "present/jerk_sweep_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "present/jerk_sweep.h"

namespace heatsoak::present {
namespace {

/// Adds a curve for each acceleration, and bang-bang as a dashed line of the same colour.
void add_curves(report::ChartPanel& panel, const std::vector<simulate::StudyResult>& results, const robot::Robot& robot, bool named,
                double scale, double simulate::StudyResult::*value) {
  std::vector<double> jerk_m_per_s3;
  std::vector<double> curve;
  int color = 0;
  for (const simulate::StudyResult& each : results) {
    if (!each.is_bang_bang()) {
      jerk_m_per_s3.push_back(each.limits.jerk_m_per_s3);
      curve.push_back(scale * each.*value);
      continue;
    }
    const double acceleration = each.limits.acceleration_m_per_s2;
    const std::string name =
        fmt::format("{:.1f} m/s², {:.0f} % of grip", acceleration, 100.0 * acceleration / simulate::grip_m_per_s2(robot));
    panel.curves.push_back({named ? name : "", jerk_m_per_s3, curve, color, false});
    const double level = scale * each.*value;
    panel.curves.push_back({"", {jerk_m_per_s3.front(), jerk_m_per_s3.back()}, {level, level}, color, true});
    jerk_m_per_s3.clear();
    curve.clear();
    ++color;
  }
}

}  // namespace

report::Chart jerk_sweep_chart(const simulate::JerkSweep& sweep) {
  struct Shown {
    const char* title = nullptr;
    const char* label = nullptr;
    double scale = 1.0;
    double simulate::StudyResult::*value = nullptr;
    bool logarithmic = false;
  };
  constexpr Shown kShown[] = {{"Slip of a mean wheel", "slip / mm per m", 1e3, &simulate::StudyResult::slip_share, true},
                              {"Settling time to within 1 cm of the target", "time / s", 1.0, &simulate::StudyResult::settled_s},
                              {"Distance between plan and robot", "distance / mm rms", 1e3, &simulate::StudyResult::tracking_rms_m, true},
                              {"Copper heat of all motors", "heat / J per drive", 1.0, &simulate::StudyResult::copper_J}};
  report::Chart chart{
      .title = fmt::format("{}: {}", sweep.robot.name, settling_words(sweep)),
      .subtitle = fmt::format("{}; simulated drives of 0.5, 1 and 2 m in eight directions, means; dashed: bang-bang, same acceleration",
                              sweep.motor.id),
      .x_label = "jerk limit / (m/s³)",
      .panels = {},
      .panel_height_px = 270};
  for (const Shown& each : kShown) {
    chart.panels.push_back(
        {.title = each.title, .y_label = each.label, .curves = {}, .bands = {}, .levels = {}, .logarithmic = each.logarithmic});
    add_curves(chart.panels.back(), sweep.results, sweep.robot, chart.panels.size() == 1, each.scale, each.value);
  }
  return chart;
}

}  // namespace heatsoak::present
