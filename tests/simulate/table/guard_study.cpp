// A match that overheats the motor: without guard, with it, and with the alternative of a fixed current cap.
#include "guard_study.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/parallel.h"

namespace heatsoak::simulate::studies {
namespace {

constexpr std::size_t kSeeds = 5;
constexpr std::size_t kMotors = 12;

/// The core's knowledge of the motor, and all drives with this knowledge.
struct Group {
  std::string name;
  motor::Motor known;
  MotorGuard guard;
  std::vector<motor::Motor> drawn;              ///< motors drawn within the tolerances of `known`
  std::vector<Way> ways;                        ///< the first has no limit
  std::vector<std::vector<Hardship>> by_seed;   ///< [way][seed], nominal motor
  std::vector<std::vector<Hardship>> by_motor;  ///< [way][motor], first match
};

struct Study {
  HardMatch match;
  std::vector<Game> games;  ///< index is the seed − 1
  Group file;
  Group bench;
};

std::vector<Hardship> drive_motors(const Study& study, const Way& way, const std::vector<motor::Motor>& motors) {
  std::vector<Hardship> hardships(motors.size());
  base::in_parallel(motors.size(), 0,
                    [&](std::size_t i) { hardships[i] = drive_hard(study.match, study.games.front(), way, motors[i], 1, false); });
  return hardships;
}

std::vector<Hardship> drive_seeds(const Study& study, const Way& way, const motor::Motor& motor) {
  std::vector<Hardship> hardships(kSeeds);
  base::in_parallel(kSeeds, 0, [&](std::size_t i) { hardships[i] = drive_hard(study.match, study.games[i], way, motor, i + 1, i == 0); });
  return hardships;
}

/// Adds the largest caps that keep the limit in the first match: for the nominal motor, and for the hottest drawn motor.
void add_caps(const Study& study, Group& group) {
  const auto hottest = std::ranges::max_element(group.by_motor.front(), {}, [](const Hardship& each) { return each.score.winding_peak_C; });
  const std::array<const motor::Motor*, 2> kept{&group.known,
                                                &group.drawn[static_cast<std::size_t>(hottest - group.by_motor.front().begin())]};
  std::array<double, 2> cap_A{};
  base::in_parallel(2, 0,
                    [&](std::size_t i) { cap_A.at(i) = largest_cap_A(study.match, study.games.front(), group.known, *kept.at(i), 1); });
  group.ways.push_back({.name = fmt::format("cap {:.1f} A, for the nominal motor", cap_A[0]), .motor = &group.known, .cap_A = cap_A[0]});
  group.ways.push_back({.name = fmt::format("cap {:.1f} A, for the hottest motor", cap_A[1]), .motor = &group.known, .cap_A = cap_A[1]});
}

void run_group(const Study& study, Group& group, bool has_unsensed_guard) {
  group.drawn = drawn_motors(group.known, kMotors);
  group.ways.push_back({.name = "no guard", .motor = &group.known});
  group.ways.push_back({.name = "guard, current and air sensed", .motor = &group.known, .guard = &group.guard, .has_sensors = true});
  group.by_motor.push_back(drive_motors(study, group.ways.front(), group.drawn));
  add_caps(study, group);
  if (has_unsensed_guard) {
    group.ways.push_back({.name = "guard, nothing sensed", .motor = &group.known, .guard = &group.guard});
  }
  for (std::size_t w = 0; w < group.ways.size(); ++w) {
    group.by_seed.push_back(drive_seeds(study, group.ways[w], group.known));
    if (w > 0) {
      group.by_motor.push_back(drive_motors(study, group.ways[w], group.drawn));
    }
  }
}

struct Value {
  const char* name;
  const char* column;
  int decimals;
  double (*of)(const Hardship& hardship);
};
constexpr Value kValues[] = {
    {"winding peak / °C", "winding_peak_C", 0, [](const Hardship& h) { return h.score.winding_peak_C; }},
    {"observer peak / °C", "observer_peak_C", 0, [](const Hardship& h) { return h.score.guard_winding_peak_C.value_or(0.0); }},
    {"distance / m", "distance_m", 0, [](const Hardship& h) { return h.score.distance_m; }},
    {"guard limits / s", "guard_limited_s", 0, [](const Hardship& h) { return h.score.limited_s.back(); }},
    {"more than 90 mm off the plan / s", "off_plan_s", 0, [](const Hardship& h) { return h.off_plan_s; }},
    {"tracking error / m rms", "tracking_rms_m", 2, [](const Hardship& h) { return h.score.tracking_rms_m; }},
    {"RMS current, hottest motor / A", "current_rms_A", 2, [](const Hardship& h) { return h.score.current_rms_A; }},
    {"false faults / s", "fault_s", 3, [](const Hardship& h) { return h.score.fault_s; }},
};
constexpr const Value& kPeak = kValues[0];
constexpr const Value& kObserver = kValues[1];
constexpr const Value& kDistance = kValues[2];
constexpr const Value& kOffPlan = kValues[4];

std::vector<double> values_of(const std::vector<Hardship>& hardships, const Value& value) {
  std::vector<double> values;
  for (const Hardship& each : hardships) {
    values.push_back(value.of(each));
  }
  return values;
}

std::string seed_table(const Group& group) {
  Sheet sheet{{"nominal motor"}, {}};
  for (const Value& value : kValues) {
    sheet.header.emplace_back(value.name);
  }
  for (std::size_t w = 0; w < group.ways.size(); ++w) {
    sheet.rows.push_back({group.ways[w].name});
    for (const Value& value : kValues) {
      const bool has_value = &value != &kObserver || group.ways[w].guard != nullptr;
      sheet.rows.back().push_back(has_value ? to_text(spread_of(values_of(group.by_seed[w], value)), value.decimals) : "–");
    }
  }
  return sheet.markdown();
}

std::size_t over_limit(const Group& group, std::size_t way) {
  return static_cast<std::size_t>(std::ranges::count_if(
      group.by_motor[way], [&](const Hardship& each) { return each.score.winding_peak_C > group.known.nominal.winding_limit_C; }));
}

std::string motor_table(const Group& group) {
  Sheet sheet{{"drawn motors", "winding peak / °C", "hottest / °C", "over the limit", "distance / m", "more than 90 mm off the plan / s"},
              {}};
  for (std::size_t w = 0; w < group.ways.size(); ++w) {
    const Spread peak = spread_of(values_of(group.by_motor[w], kPeak));
    sheet.rows.push_back(
        {group.ways[w].name, to_text(peak, 0), fmt::format("{:.0f}", peak.most), fmt::format("{} of {}", over_limit(group, w), kMotors),
         to_text(spread_of(values_of(group.by_motor[w], kDistance)), 0), to_text(spread_of(values_of(group.by_motor[w], kOffPlan)), 0)});
  }
  return sheet.markdown();
}

std::string group_text(const Group& group) {
  return fmt::format(
      "## {}\n\nSafety factor on heat: {:.2f}.\n\n{} matches, nominal motor:\n\n{}\n"
      "{} motors in the first match:\n\n{}\n",
      group.name, group.guard.derating->observer.heat_safety_factor(), kSeeds, seed_table(group), kMotors, motor_table(group));
}

std::string input_table(const HardMatch& match) {
  Sheet sheet{{"input", "files", "hard match", "remark"}, {}};
  for (const HardInput& each : match.changed) {
    sheet.rows.push_back({each.name, each.usual, each.hard, each.remark});
  }
  return sheet.markdown();
}

void add_runs(Sheet& sheet, const Group& group, const char* known) {
  const auto add = [&](std::size_t w, const std::vector<Hardship>& hardships, bool by_seed) {
    for (std::size_t i = 0; i < hardships.size(); ++i) {
      std::string name = group.ways[w].name;
      std::erase(name, ',');
      const std::string number = fmt::format("{}", i + 1);
      sheet.rows.push_back({known, name, by_seed ? "nominal" : number, by_seed ? number : "1"});
      for (const Value& value : kValues) {
        sheet.rows.back().push_back(fmt::format("{:.4g}", value.of(hardships[i])));
      }
    }
  };
  for (std::size_t w = 0; w < group.ways.size(); ++w) {
    add(w, group.by_seed[w], true);
    add(w, group.by_motor[w], false);
  }
}

Sheet all_runs(const Study& study) {
  Sheet sheet{{"known_from", "way", "motor", "seed"}, {}};
  for (const Value& value : kValues) {
    sheet.header.emplace_back(value.column);
  }
  add_runs(sheet, study.file, "file");
  add_runs(sheet, study.bench, "bench_test");
  return sheet;
}

const std::vector<Second>& seconds_of(const Group& group, std::size_t way) { return group.by_seed[way].front().seconds; }

report::ChartCurve curve_of(std::string name, const std::vector<Second>& seconds, double Second::*value, int color) {
  report::ChartCurve curve{.name = std::move(name), .color_index = color};
  for (const Second& each : seconds) {
    curve.x.push_back(each.time_s / 60.0);
    curve.y.push_back(each.*value);
  }
  return curve;
}

/// Returns the accumulated lost distance, relative to a drive with the same knowledge without guard.
report::ChartCurve lost_m(const Group& group, std::size_t way, std::string name, int color) {
  report::ChartCurve curve = curve_of(std::move(name), seconds_of(group, way), &Second::distance_m, color);
  for (std::size_t i = 0; i < curve.y.size(); ++i) {
    curve.y[i] = seconds_of(group, 0)[i].distance_m - curve.y[i];
  }
  return curve;
}

report::ChartPanel panel(std::string title, std::string label) {
  return {.title = std::move(title), .y_label = std::move(label), .curves = {}, .bands = {}, .levels = {}};
}

constexpr const char* kGuardOfBench = "guard from bench data";
constexpr const char* kGuardOfFile = "guard from the file's estimates";

/// Draws the first match of the nominal motor.
report::Chart time_picture(const Study& study) {
  const Group& file = study.file;
  const Group& bench = study.bench;
  const double limit_C = file.known.nominal.winding_limit_C;
  const auto peak_C = [](const Group& group, std::size_t way) { return group.by_seed[way].front().score.winding_peak_C; };
  report::Chart chart{
      .title =
          fmt::format("Hard match: winding at {:.0f} °C without guard, {:.0f} °C with it (bench data)", peak_C(bench, 0), peak_C(bench, 1)),
      .subtitle = "Twente v2024, ECX FLAT 32 L (nominal), simulated with real sensing, seed 1; hottest wheel of each second",
      .x_label = "time / min",
      .panels = {},
      .panel_height_px = 280};
  report::ChartPanel heat = panel("Hottest winding", "temperature / °C");
  heat.curves = {curve_of("no guard", seconds_of(bench, 0), &Second::winding_C, 0),
                 curve_of(kGuardOfBench, seconds_of(bench, 1), &Second::winding_C, 2),
                 curve_of(kGuardOfFile, seconds_of(file, 1), &Second::winding_C, 1),
                 curve_of("file: " + file.ways[3].name, seconds_of(file, 3), &Second::winding_C, 5),
                 curve_of("bench: " + bench.ways[3].name, seconds_of(bench, 3), &Second::winding_C, 3)};
  heat.levels = {{fmt::format("limit {:.0f} °C", limit_C), limit_C}};
  report::ChartPanel observer = panel("Winding of the guard's observer, which adds the safety factor on heat", "temperature / °C");
  observer.curves = {curve_of("", seconds_of(bench, 1), &Second::observer_C, 2), curve_of("", seconds_of(file, 1), &Second::observer_C, 1)};
  observer.levels = heat.levels;
  report::ChartPanel allowed = panel("Allowed current of the most limited wheel; top: limited by grip, not by the guard", "current / A");
  allowed.curves = {curve_of("", seconds_of(bench, 1), &Second::allowed_A, 2), curve_of("", seconds_of(file, 1), &Second::allowed_A, 1)};
  report::ChartPanel distance = panel("Distance lost against no guard", "distance / m");
  distance.curves = {lost_m(file, 1, "", 1), lost_m(file, 3, "", 5), lost_m(bench, 1, "", 2), lost_m(bench, 3, "", 3)};
  report::ChartPanel off = panel("Distance between plan and robot", "largest of a second / m");
  off.curves = {curve_of("", seconds_of(file, 1), &Second::off_plan_m, 1), curve_of("", seconds_of(file, 3), &Second::off_plan_m, 5),
                curve_of("", seconds_of(bench, 1), &Second::off_plan_m, 2), curve_of("", seconds_of(bench, 3), &Second::off_plan_m, 3)};
  chart.panels = {std::move(heat), std::move(observer), std::move(allowed), std::move(distance), std::move(off)};
  return chart;
}

/// Draws peak temperature over distance, one point per drawn motor.
report::Chart motor_picture(const Study& study) {
  const Group& file = study.file;
  const Group& bench = study.bench;
  const auto over = [&](std::size_t way) { return over_limit(file, way) + over_limit(bench, way); };
  report::Chart chart{.title = fmt::format("Over the limit: {} of {} motors unguarded, {} with the nominal cap, {} with guard", over(0),
                                           2 * kMotors, over(2), over(1)),
                      .subtitle =
                          "hard match, seed 1; motors known from their file and from a bench test, drawn within their tolerances; "
                          "each point is one motor",
                      .x_label = "distance driven in the match / m",
                      .panels = {},
                      .panel_height_px = 400};
  constexpr double kRoom_m = 4.0;
  std::vector<double> driven_m;
  for (const Group* const group : {&study.file, &study.bench}) {
    for (const std::vector<Hardship>& way : group->by_motor) {
      std::ranges::copy(values_of(way, kDistance), std::back_inserter(driven_m));
    }
  }
  const auto add = [&](const char* title, const Group& group) {
    const bool is_file = &group == &study.file;
    // Colours and names must match those of time_picture().
    const char* const names[] = {"no guard", is_file ? kGuardOfFile : kGuardOfBench, "cap for the nominal motor",
                                 is_file ? "file: cap for the hottest motor" : "bench: cap for the hottest motor", "guard, nothing sensed"};
    const int colors[] = {0, is_file ? 1 : 2, 4, is_file ? 5 : 3, 6};
    const auto [least, most] = std::ranges::minmax(driven_m);
    report::ChartPanel one = panel(title, "winding peak / °C");
    for (std::size_t w = 0; w < group.ways.size(); ++w) {
      one.curves.push_back({.name = names[w],
                            .x = values_of(group.by_motor[w], kDistance),
                            .y = values_of(group.by_motor[w], kPeak),
                            .color_index = colors[w],
                            .dots = true});
    }
    // Adds a margin around the outermost points.
    constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
    one.curves.push_back({.x = {least - kRoom_m, most + kRoom_m}, .y = {kNothing, kNothing}});
    const double limit_C = group.known.nominal.winding_limit_C;
    one.levels = {{fmt::format("limit {:.0f} °C", limit_C), limit_C}};
    chart.panels.push_back(std::move(one));
  };
  add("Motors within the ranges of the file, whose thermal values are estimates", study.file);
  add("Motors within the tolerances that a bench test leaves", study.bench);
  return chart;
}

}  // namespace

void study_guard(const Subject& subject, const Report& report) {
  Study study;
  study.match = make_hard_match(subject.robot);
  for (std::size_t seed = 1; seed <= kSeeds; ++seed) {
    study.games.push_back(play_game(study.match.inputs, study.match.robot, seed));
  }
  study.file.name = "Motor known from its file";
  study.file.known = subject.motor;
  study.bench.name = fmt::format("Motor known from a bench test: {}", kBenchTolerances);
  study.bench.known = bench_tested(subject.motor);
  for (Group* const group : {&study.file, &study.bench}) {
    group->guard = make_guard(group->known, study.match.robot, study.match.ambient_C, 0);
    run_group(study, *group, group == &study.file);
  }
  report.write("guard.md", fmt::format("## The hard match\n\n{}\nIn all tables: means; in brackets 5th and 95th percentile.\n\n{}{}",
                                       input_table(study.match), group_text(study.file), group_text(study.bench)));
  report.write("guard.csv", all_runs(study).csv());
  report.draw("guard.svg", time_picture(study));
  report.draw("guard_motors.svg", motor_picture(study));
}

}  // namespace heatsoak::simulate::studies
