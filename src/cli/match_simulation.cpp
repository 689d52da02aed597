#include "cli/match_simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "cli/default_spreads.h"
#include "present/match.h"
#include "report/chart.h"
#include "simulate/match_trace.h"
#include "simulate/reason_name.h"

namespace heatsoak {
namespace {

constexpr double kMostRows = 500'000.0;  ///< about 250 MB of text
constexpr double kPictureStep_s = 2.0;

/// One simulated run and its recorded data.
struct Played {
  Planner planner = Planner::jerk_limited;
  MatchRun run;
  std::string csv;
  std::vector<MatchRow> rows;  ///< rows for the picture
};

Played play(const MatchSimulation& wanted, const Game& game, const robot_core::Config& core, Planner planner) {
  Played played{planner, {}, {}, {}};
  const double ambient_C = wanted.duty.ambient_C.value;
  const auto wheels = static_cast<int>(wanted.robot.wheels.axis_rad.size());
  const MatchAdditions added = additions_of(wanted.motor);
  if (!wanted.out.empty()) {
    played.csv = csv_header(wheels, added);
  }
  MatchRows csv(wanted.every_s, ambient_C, added, [&](const MatchRow& row) { append_csv(played.csv, row, wheels, ambient_C, added); });
  MatchRows picture(kPictureStep_s, ambient_C, {}, [&](const MatchRow& row) { played.rows.push_back(row); });
  MatchRunOptions options;
  options.planner = planner;
  options.ambient_C = ambient_C;
  options.drive = wanted.is_sensing_ideal ? ideal_drive() : real_drive(wanted.robot, wanted.seed);
  options.progress = progress_bar(fmt::format("driving, {}", to_string(planner)));
  played.run = run_match(game, wanted.robot, wanted.motor, core, options, [&](const LoopMoment& moment) {
    if (!wanted.out.empty()) {
      csv.take(moment);
    }
    if (!wanted.plot.empty()) {
      picture.take(moment);
    }
  });
  csv.finish();
  picture.finish();
  return played;
}

/// Verdict over all runs: fail (a limit exceeded) takes precedence over infeasible (not driven).
Verdict verdict(const MatchSimulation& wanted, const std::vector<Played>& all) {
  const MotorValues& limits = wanted.motor.nominal;
  const auto too_hot = [&](const Played& each) {
    return each.run.score.winding_peak_C > limits.winding_limit_C || each.run.score.stator_peak_C > limits.stator_limit_C;
  };
  if (std::ranges::any_of(all, too_hot)) {
    return Verdict::fail;
  }
  return std::ranges::all_of(all, [](const Played& each) { return !drive_problem(each.run.score); }) ? Verdict::pass : Verdict::infeasible;
}

nlohmann::ordered_json guard_json(const MatchSimulation& wanted, const MotorGuard& guard) {
  const bool is_missing = wanted.guard != GuardUse::off && !guard.guard;
  return {{"use", is_missing ? kGuardUses[0] : kGuardUses[static_cast<std::size_t>(wanted.guard)]},
          {"asked_for", kGuardUses[static_cast<std::size_t>(wanted.guard)]},
          {"why_none", is_missing ? nlohmann::ordered_json(guard.why_none) : nlohmann::ordered_json()},
          {"heat_reserve_ratio", guard.derating ? rounded(guard.derating->observer.heat_safety_factor(), 4) : nlohmann::ordered_json()}};
}

nlohmann::ordered_json json(const Played& played) {
  const DriveScore& s = played.run.score;
  nlohmann::ordered_json limited;
  for (std::size_t limit = 0; limit < kLimits.size(); ++limit) {
    limited[std::string(to_string(kLimits[limit]))] = rounded(s.limited_s[limit], 3);
  }
  nlohmann::ordered_json energy{{"battery_J", rounded(s.energy.battery_J, 2)}};
  for (const present::EnergyPart& row : present::energy_parts()) {
    energy[fmt::format("{}_J", row.name)] = rounded(s.energy.*row.value, 2);
  }
  energy["kinetic_J"] = rounded(s.energy.kinetic_J, 4);
  energy["external_J"] = rounded(s.energy.external_J, 4);
  energy["residual_J"] = rounded(s.energy.residual_J(), 4);
  nlohmann::ordered_json phases = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < played.run.phases.size(); ++i) {
    phases.push_back({{"phase", kPhaseNames[i]},
                      {"time_s", rounded(played.run.phases[i].time_s, 3)},
                      {"copper_J", rounded(played.run.phases[i].copper_J, 3)}});
  }
  return {{"planner", to_string(played.planner)},
          {"distance_m", rounded(s.distance_m, 2)},
          {"slip_m", rounded(s.slip_m, 4)},
          {"sliding_m", rounded(s.sliding_m, 4)},
          {"sliding_s", rounded(s.sliding_s, 3)},
          {"lifted_s", rounded(s.lifted_s, 3)},
          {"tracking_rms_m", rounded(s.tracking_rms_m, 6)},
          {"tracking_most_m", rounded(s.tracking_most_m, 5)},
          {"arrivals", s.arrivals_count},
          {"overshoot_mean_m", rounded(s.overshoot_mean_m, 6)},
          {"overshoot_most_m", rounded(s.overshoot_most_m, 5)},
          {"peak_current_A", rounded(s.peak_current_A, 3)},
          {"current_rms_A", rounded(s.current_rms_A, 4)},
          {"short_s", rounded(s.short_s, 3)},
          {"lowest_battery_V", rounded(s.lowest_battery_V, 3)},
          {"battery_empty_s", rounded(s.battery_empty_s, 3)},
          {"winding_peak_C", rounded(s.winding_peak_C, 3)},
          {"stator_peak_C", rounded(s.stator_peak_C, 3)},
          {"duel_copper_share", rounded(s.duel_copper_share, 4)},
          {"guard_limited_s", rounded(s.guard_limited_s, 3)},
          {"guard_missing_A_s", rounded(s.guard_missing_A_s, 3)},
          {"guard_winding_peak_C", rounded(s.guard_winding_peak_C, 3)},
          {"limited_s", limited},
          {"fault_s", rounded(s.fault_s, 3)},
          {"lost_packets_share", rounded(s.lost_packets_share, 5)},
          {"energy", energy},
          {"phases", phases}};
}

std::vector<double> column(const std::vector<MatchRow>& rows, const std::function<double(const MatchRow&)>& of) {
  std::vector<double> values;
  for (const MatchRow& row : rows) {
    values.push_back(of(row));
  }
  return values;
}

/// Panels for one planner: the windings of all wheels, then the motor of the hottest one, the robot and the battery.
std::vector<ChartPanel> detail(const MatchSimulation& wanted, const Played& played) {
  const auto hottest = static_cast<std::size_t>(played.run.score.hottest_wheel);
  const std::vector<double> minutes = column(played.rows, [](const MatchRow& row) { return row.time_s / 60.0; });
  const auto curve = [&](std::string name, int color, const std::function<double(const MatchRow&)>& of) {
    return ChartCurve{std::move(name), minutes, column(played.rows, of), color, false};
  };
  ChartPanel heat{.title = "Windings and stator", .y_label = "temperature / °C", .curves = {}, .bands = {}, .levels = {}};
  for (std::size_t i = 0; i < wanted.robot.wheels.axis_rad.size(); ++i) {
    heat.curves.push_back(
        curve(fmt::format("winding {}", i + 1), static_cast<int>(i), [i](const MatchRow& row) { return row.winding_peak_C[i]; }));
  }
  heat.curves.push_back(curve(fmt::format("stator {}", hottest + 1), 4, [&](const MatchRow& row) { return row.stator_C[hottest]; }));
  heat.levels.push_back({fmt::format("limit {:.0f} °C", wanted.motor.nominal.winding_limit_C), wanted.motor.nominal.winding_limit_C});
  const auto single = [](std::string title, std::string label, ChartCurve one) {
    return ChartPanel{.title = std::move(title), .y_label = std::move(label), .curves = {std::move(one)}, .bands = {}, .levels = {}};
  };
  const int color = static_cast<int>(hottest);
  return {std::move(heat),
          single(fmt::format("Motor {}", hottest + 1), "current, rms of 2 s / A",
                 curve("", color, [&](const MatchRow& row) { return std::abs(row.current_A[hottest]); })),
          single("Robot", "speed / m/s",
                 curve("", 5, [](const MatchRow& row) { return std::hypot(row.velocity.x_m_per_s, row.velocity.y_m_per_s); })),
          single("Battery", "voltage / V", curve("", 6, [](const MatchRow& row) { return row.battery_V; }))};
}

/// Panels that compare both planners: heat and precision.
std::vector<ChartPanel> comparison(const MatchSimulation& wanted, const std::vector<Played>& all) {
  std::vector<ChartPanel> panels{
      {.title = "Hottest winding", .y_label = "temperature / °C", .curves = {}, .bands = {}, .levels = {}},
      {.title = "Copper heat of all motors so far", .y_label = "heat / kJ", .curves = {}, .bands = {}, .levels = {}},
      {.title = "Distance between plan and robot", .y_label = "distance / mm", .curves = {}, .bands = {}, .levels = {}}};
  for (std::size_t p = 0; p < all.size(); ++p) {
    const Played& played = all[p];
    const std::string name(to_string(played.planner));
    const auto hottest = static_cast<std::size_t>(played.run.score.hottest_wheel);
    const std::vector<double> minutes = column(played.rows, [](const MatchRow& row) { return row.time_s / 60.0; });
    double sum_kJ = 0.0;
    const int color = static_cast<int>(p);
    panels[0].curves.push_back(
        {name, minutes, column(played.rows, [&](const MatchRow& row) { return row.winding_peak_C[hottest]; }), color, false});
    panels[1].curves.push_back({"", minutes,
                                column(played.rows,
                                       [&](const MatchRow& row) {
                                         for (const double copper_W : row.copper_W) {
                                           sum_kJ += 1e-3 * copper_W * kPictureStep_s;
                                         }
                                         return sum_kJ;
                                       }),
                                color, false});
    panels[2].curves.push_back(
        {"", minutes, column(played.rows, [](const MatchRow& row) { return 1e3 * row.tracking_error_m; }), color, false});
  }
  panels[0].levels.push_back({fmt::format("limit {:.0f} °C", wanted.motor.nominal.winding_limit_C), wanted.motor.nominal.winding_limit_C});
  return panels;
}

/// Formats as "winding 62 °C, within the limit of 155 °C", for the hottest run.
std::string verdict_of(const MatchSimulation& wanted, const std::vector<Played>& all) {
  double peak_C = 0.0;
  for (const Played& each : all) {
    peak_C = std::max(peak_C, each.run.score.winding_peak_C);
  }
  const double limit_C = wanted.motor.nominal.winding_limit_C;
  return fmt::format("winding {:.0f} °C, {} the limit of {:.0f} °C", peak_C, peak_C > limit_C ? "over" : "within", limit_C);
}

Chart picture(const MatchSimulation& wanted, const std::vector<Played>& all) {
  return {.title = fmt::format("{}: {}, {} on {}", wanted.motor.id, verdict_of(wanted, all), wanted.robot.name, wanted.duty.id),
          .subtitle = fmt::format("closed loop, synthetic match, seed {}{}", wanted.seed,
                                  data_quality(wanted.motor) == "estimated" ? "; thermal data partly estimated" : ""),
          .x_label = "time / min",
          .panels = all.size() == 1 ? detail(wanted, all.front()) : comparison(wanted, all),
          .panel_height_px = 260};
}

}  // namespace

ExitCode simulate_match(const MatchSimulation& wanted, Session& session) {
  if (!wanted.out.empty() && wanted.planners.size() > 1) {
    throw Failure(ExitCode::bad_input, "--out holds one run; expected --planner bang_bang or jerk_limited with it");
  }
  if (!wanted.out.empty() && 1e4 / wanted.every_s > kMostRows) {
    throw Failure(ExitCode::bad_input, fmt::format("--every {} s makes too many rows of a match; expected 0.02 s or more", wanted.every_s));
  }
  const MotorGuard guard = wanted.guard == GuardUse::off
                               ? MotorGuard{}
                               : make_guard(wanted.motor, wanted.robot, wanted.duty.ambient_C.value, 0, progress_bar("making the guard"));
  const Game game = play_game(wanted.inputs, wanted.robot, wanted.seed);
  std::vector<Played> all;
  for (const Planner planner : wanted.planners) {
    const GuardedCore core(wanted.robot, wanted.motor, wanted.guard, guard);
    all.push_back(play(wanted, game, core.config(), planner));
  }
  if (!wanted.out.empty()) {
    session.write(wanted.out, std::move(all.front().csv));
  }
  if (!wanted.plot.empty()) {
    session.write(wanted.plot, draw_picture(picture(wanted, all), wanted.plot));
  }
  const DriveScore& first = all.front().run.score;
  std::vector<DriveScore> scores;
  std::ranges::transform(all, std::back_inserter(scores), [](const Played& each) { return each.run.score; });
  present::Document document =
      present::match_document({wanted.robot, wanted.motor, wanted.duty, wanted.inputs.role, wanted.seed, wanted.guard, guard,
                               wanted.is_sensing_ideal, wanted.planners, std::move(scores), verdict(wanted, all)});
  document.add_file(wanted.out);
  document.add_file(wanted.plot);
  session.show(document);
  const bool is_guarded = wanted.guard != GuardUse::off;
  nlohmann::ordered_json planners = nlohmann::ordered_json::array();
  for (const Played& each : all) {
    planners.push_back(json(each));
  }
  session.answer({{"schema", "heatsoak.simulate/1"},
                  {"motor", wanted.motor.id},
                  {"conditions", wanted.motor.assumed},
                  {"robot", wanted.robot.id},
                  {"duty", wanted.duty.id},
                  {"duty_origin", wanted.duty.origin},
                  {"seed", wanted.seed},
                  {"duration_s", rounded(first.time_s, 3)},
                  {"wheel", fmt::format("wheel {}", first.hottest_wheel + 1)},
                  {"winding_peak_C", rounded(first.winding_peak_C, 3)},
                  {"stator_peak_C", rounded(first.stator_peak_C, 3)},
                  {"winding_limit_C", rounded(wanted.motor.nominal.winding_limit_C, 2)},
                  {"current_rms_A", rounded(first.current_rms_A, 4)},
                  {"verdict", to_string(verdict(wanted, all))},
                  {"data_quality", data_quality(wanted.motor)},
                  {"is_friction_assumed", wanted.robot.friction.is_assumed},
                  {"sensing", wanted.is_sensing_ideal ? "ideal" : "real"},
                  {"guard", guard_json(wanted, guard)},
                  {"default_spreads", is_guarded ? default_spreads_json({&wanted.motor, 1}) : nlohmann::ordered_json::array()},
                  {"planners", planners}});
  return verdict(wanted, all) != Verdict::pass ? ExitCode::limit_exceeded : ExitCode::done;
}

}  // namespace heatsoak
