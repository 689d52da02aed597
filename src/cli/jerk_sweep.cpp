#include "cli/jerk_sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "present/jerk_sweep.h"
#include "report/chart.h"
#include "simulate/planner_study.h"

namespace heatsoak {
namespace {

bool is_bang_bang(const StudyResult& result) { return std::isinf(result.limits.jerk_m_per_s3); }

/// Adds a curve for each acceleration, and bang-bang as a dashed line of the same colour.
void add_curves(ChartPanel& panel, const std::vector<StudyResult>& results, const Robot& robot, bool named, double scale,
                double StudyResult::*value) {
  std::vector<double> jerk_m_per_s3;
  std::vector<double> curve;
  int color = 0;
  for (const StudyResult& each : results) {
    if (!is_bang_bang(each)) {
      jerk_m_per_s3.push_back(each.limits.jerk_m_per_s3);
      curve.push_back(scale * each.*value);
      continue;
    }
    const double acceleration = each.limits.acceleration_m_per_s2;
    const std::string name = fmt::format("{:.1f} m/s², {:.0f} % of grip", acceleration, 100.0 * acceleration / grip_m_per_s2(robot));
    panel.curves.push_back({named ? name : "", jerk_m_per_s3, curve, color, false});
    const double level = scale * each.*value;
    panel.curves.push_back({"", {jerk_m_per_s3.front(), jerk_m_per_s3.back()}, {level, level}, color, true});
    jerk_m_per_s3.clear();
    curve.clear();
    ++color;
  }
}

Chart picture(const std::vector<StudyResult>& results, const Robot& robot, const Motor& motor) {
  struct Shown {
    const char* title = nullptr;
    const char* label = nullptr;
    double scale = 1.0;
    double StudyResult::*value = nullptr;
    bool logarithmic = false;
  };
  constexpr Shown kShown[] = {{"Slip of a mean wheel", "slip / mm per m", 1e3, &StudyResult::slip_share, true},
                              {"Settling time to within 1 cm of the target", "time / s", 1.0, &StudyResult::settled_s},
                              {"Distance between plan and robot", "distance / mm rms", 1e3, &StudyResult::tracking_rms_m, true},
                              {"Copper heat of all motors", "heat / J per drive", 1.0, &StudyResult::copper_J}};
  Chart chart{.title = fmt::format("{}: jerk limit against bang-bang", robot.name),
              .subtitle = fmt::format(
                  "{}; simulated drives of 0.5, 1 and 2 m in eight directions, means; dashed: bang-bang, same acceleration", motor.id),
              .x_label = "jerk limit / (m/s³)",
              .panels = {},
              .panel_height_px = 270};
  for (const Shown& each : kShown) {
    chart.panels.push_back(
        {.title = each.title, .y_label = each.label, .curves = {}, .bands = {}, .levels = {}, .logarithmic = each.logarithmic});
    add_curves(chart.panels.back(), results, robot, chart.panels.size() == 1, each.scale, each.value);
  }
  return chart;
}

nlohmann::ordered_json json(const std::vector<StudyResult>& results) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const StudyResult& each : results) {
    rows.push_back({{"planner", is_bang_bang(each) ? "bang_bang" : "jerk_limited"},
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

ExitCode sweep_jerk(const Robot& robot, const Motor& motor, const DriveOptions& drive, const std::string& plot, Session& session) {
  const std::vector<StudyCase> cases = jerk_sweep(robot);
  const std::vector<StudyResult> results = study_planners(robot, motor, cases, drive, 0, progress_bar("driving"));
  present::Document document = present::jerk_sweep_document(results, robot, motor);
  if (!plot.empty()) {
    session.write(plot, draw_picture(picture(results, robot, motor), plot));
    document.add_file(plot);
  }
  session.show(document);
  session.answer({{"schema", "heatsoak.jerk_sweep/1"},
                  {"motor", motor.id},
                  {"robot", robot.id},
                  {"grip_m_per_s2", rounded(grip_m_per_s2(robot), 4)},
                  {"cases", json(results)}});
  return ExitCode::done;
}

}  // namespace heatsoak
