#include "present/match_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "present/match.h"

namespace heatsoak::present {
namespace {

std::vector<double> column(const std::vector<simulate::MatchRow>& rows, const std::function<double(const simulate::MatchRow&)>& of) {
  std::vector<double> values;
  for (const simulate::MatchRow& row : rows) {
    values.push_back(of(row));
  }
  return values;
}

report::ChartLevel limit_level(double limit_C) { return {fmt::format("limit {:.0f} °C", limit_C), limit_C, true}; }

/// Peak of the same game with the forecast band at its upper end.
report::ChartLevel upper_level(double peak_C) { return {"peak " + upper_losses_words(), peak_C, true}; }

/// Returns the panels for one planner: windings and stators of all wheels, then the motor of the hottest one, the robot and the battery.
std::vector<report::ChartPanel> detail(const simulate::MatchSimulation& match, const simulate::DrivenMatch& driven) {
  const auto hottest = static_cast<std::size_t>(driven.run.score.hottest_wheel);
  const std::vector<double> minutes = column(driven.rows, [](const simulate::MatchRow& row) { return row.time_s / 60.0; });
  const auto curve = [&](std::string name, int color, const std::function<double(const simulate::MatchRow&)>& of) {
    return report::ChartCurve{std::move(name), minutes, column(driven.rows, of), color, false};
  };
  report::ChartPanel winding{.title = "Winding", .y_label = "temperature / °C", .curves = {}, .bands = {}, .levels = {}};
  report::ChartPanel stator{.title = "Stator", .y_label = "temperature / °C", .curves = {}, .bands = {}, .levels = {}};
  for (std::size_t i = 0; i < match.robot.wheels.axis_rad.size(); ++i) {
    const int color = static_cast<int>(i);
    winding.curves.push_back(
        curve(fmt::format("wheel {}", i + 1), color, [i](const simulate::MatchRow& row) { return row.winding_peak_C[i]; }));
    stator.curves.push_back(curve("", color, [i](const simulate::MatchRow& row) { return row.stator_C[i]; }));
  }
  winding.levels.push_back(limit_level(match.motor.nominal.winding_limit_C));
  if (match.motor.nominal.stator_limit_C) {
    stator.levels.push_back(limit_level(*match.motor.nominal.stator_limit_C));
  }
  if (driven.upper) {
    winding.levels.push_back(upper_level(driven.upper->winding_peak_C));
    stator.levels.push_back(upper_level(driven.upper->stator_peak_C));
  }
  const auto single = [](std::string title, std::string label, report::ChartCurve one) {
    return report::ChartPanel{
        .title = std::move(title), .y_label = std::move(label), .curves = {std::move(one)}, .bands = {}, .levels = {}};
  };
  const int color = static_cast<int>(hottest);
  return {std::move(winding), std::move(stator),
          single(fmt::format("Motor of wheel {}", hottest + 1), "current, rms of 2 s / A",
                 curve("", color, [&](const simulate::MatchRow& row) { return std::abs(row.current_A[hottest]); })),
          single("Robot", "speed / m/s",
                 curve("", 5, [](const simulate::MatchRow& row) { return std::hypot(row.velocity.x_m_per_s, row.velocity.y_m_per_s); })),
          single("Battery", "voltage / V", curve("", 6, [](const simulate::MatchRow& row) { return row.battery_V; }))};
}

/// Returns the panels that compare both planners: heat and precision.
std::vector<report::ChartPanel> comparison(const simulate::MatchSimulation& match) {
  std::vector<report::ChartPanel> panels{
      {.title = "Hottest winding", .y_label = "temperature / °C", .curves = {}, .bands = {}, .levels = {}},
      {.title = "Copper heat of all motors so far", .y_label = "heat / kJ", .curves = {}, .bands = {}, .levels = {}},
      {.title = "Distance between plan and robot", .y_label = "distance / mm", .curves = {}, .bands = {}, .levels = {}}};
  for (std::size_t p = 0; p < match.runs.size(); ++p) {
    const simulate::DrivenMatch& driven = match.runs[p];
    const std::string name(duty::to_string(driven.planner));
    const auto hottest = static_cast<std::size_t>(driven.run.score.hottest_wheel);
    const std::vector<double> minutes = column(driven.rows, [](const simulate::MatchRow& row) { return row.time_s / 60.0; });
    double sum_kJ = 0.0;
    const int color = static_cast<int>(p);
    panels[0].curves.push_back(
        {name, minutes, column(driven.rows, [&](const simulate::MatchRow& row) { return row.winding_peak_C[hottest]; }), color, false});
    panels[1].curves.push_back({"", minutes,
                                column(driven.rows,
                                       [&](const simulate::MatchRow& row) {
                                         for (const double copper_W : row.copper_W) {
                                           sum_kJ += 1e-3 * copper_W * simulate::kMatchRow_s;
                                         }
                                         return sum_kJ;
                                       }),
                                color, false});
    panels[2].curves.push_back(
        {"", minutes, column(driven.rows, [](const simulate::MatchRow& row) { return 1e3 * row.tracking_error_m; }), color, false});
  }
  panels[0].levels.push_back(limit_level(match.motor.nominal.winding_limit_C));
  return panels;
}

/// Returns the outcome of one game. `evaluate` may give another verdict, because it includes tolerances.
std::string_view outcome_of(select::Verdict verdict) {
  constexpr std::array<std::string_view, 4> kOutcomes{"within limits", "may exceed a limit or miss the demand", "over a limit",
                                                      "not driven"};
  return kOutcomes.at(static_cast<std::size_t>(verdict));
}

/// Formats as "within limits, winding 62 °C (limit 155 °C)" or "winding 149 to 158 °C" with the upper end of the forecast band, for the
/// hottest run; the outcome is that of the deciding one.
std::string verdict_and_peak(const simulate::MatchSimulation& match) {
  double peak_C = 0.0;
  double upper_C = 0.0;
  for (const simulate::DrivenMatch& each : match.runs) {
    peak_C = std::max(peak_C, each.run.score.winding_peak_C);
    upper_C = std::max(upper_C, each.upper ? each.upper->winding_peak_C : 0.0);
  }
  // With more heat, an empty battery may end the game earlier.
  const bool is_range = upper_C > peak_C;
  return fmt::format("{}, winding {:.0f}{} °C (limit {:.0f} °C)", outcome_of(match.verdict()), peak_C,
                     is_range ? fmt::format(" to {:.0f}", upper_C) : "", match.motor.nominal.winding_limit_C);
}

}  // namespace

report::Chart match_chart(const simulate::MatchSimulation& match) {
  return {.title = fmt::format("{}: {}, {} on {}", match.motor.id, verdict_and_peak(match), match.robot.name, match.duty.id),
          .subtitle = fmt::format("closed loop, synthetic match, seed {}{}", match.seed,
                                  motor::data_quality(match.motor) == "estimated" ? "; thermal data partly estimated" : ""),
          .x_label = "time / min",
          .panels = match.runs.size() == 1 ? detail(match, match.runs.front()) : comparison(match),
          .panel_height_px = 260};
}

}  // namespace heatsoak::present
