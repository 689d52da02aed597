// Slip and heat over a match: bang-bang plans compared with jerk-limited plans, with the drive core and realistic sensors.
#include <fmt/format.h>

#include "base/parallel.h"
#include "drive_core_studies.h"
#include "duty/duty.h"
#include "firmware/core_config.h"
#include "simulate/match_run.h"
#include "support/source_folder.h"

namespace heatsoak::simulate::studies {
namespace {

constexpr std::size_t kSeeds = 10;
constexpr std::array<duty::Planner, 2> kPlanners{duty::Planner::bang_bang, duty::Planner::jerk_limited};
constexpr std::array<const char*, 2> kNames{"bang-bang", "jerk-limited"};
constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

struct Value {
  const char* name;
  const char* column;
  int decimals;
  double (*of)(const DriveScore& score);
  std::array<double, 2> before;  ///< mean of an earlier simple controller with exact sensors, by planner; NaN if not reported
};

constexpr Value kValues[] = {
    {"driven / m", "distance_m", 0, [](const DriveScore& s) { return s.distance_m; }, {680.0, 680.0}},
    {"distance slid beyond creep / m", "sliding_m", 2, [](const DriveScore& s) { return s.sliding_m; }, {1.4, 0.02}},
    {"time in which a wheel slides / s", "sliding_s", 0, [](const DriveScore& s) { return s.sliding_s; }, {229.0, 5.0}},
    {"slip of a mean wheel, creep included / mm per m",
     "slip_mm_per_m",
     1,
     [](const DriveScore& s) { return 1e3 * s.slip_m / s.distance_m; },
     {kNoValue, kNoValue}},
    {"copper heat, all motors / kJ", "copper_kJ", 1, [](const DriveScore& s) { return 1e-3 * s.energy.copper_J; }, {16.4, 12.9}},
    {"copper heat per metre / J/m",
     "copper_J_per_m",
     1,
     [](const DriveScore& s) { return s.energy.copper_J / s.distance_m; },
     {kNoValue, kNoValue}},
    {"winding peak / °C", "winding_peak_C", 0, [](const DriveScore& s) { return s.winding_peak_C; }, {67.0, 61.0}},
    {"RMS current, hottest motor / A", "current_rms_A", 2, [](const DriveScore& s) { return s.current_rms_A; }, {kNoValue, kNoValue}},
    {"tracking error / mm rms", "tracking_rms_mm", 0, [](const DriveScore& s) { return 1e3 * s.tracking_rms_m; }, {kNoValue, kNoValue}},
    {"overshoot, mean of arrivals / mm",
     "overshoot_mm",
     1,
     [](const DriveScore& s) { return 1e3 * s.overshoot_mean_m; },
     {kNoValue, kNoValue}},
    {"core limits by traction / s", "traction_limited_s", 0, [](const DriveScore& s) { return s.limited_s[3]; }, {kNoValue, kNoValue}},
    {"faults that the core reports / s", "fault_s", 3, [](const DriveScore& s) { return s.fault_s; }, {kNoValue, kNoValue}},
    {"radio packets lost / %", "lost_percent", 2, [](const DriveScore& s) { return 100.0 * s.lost_packets_share; }, {kNoValue, kNoValue}},
};
static_assert(kLimits[3] == robot_core::Reason::traction);

/// Sensors and robot of a match.
struct Setting {
  const char* name;
  bool is_exact;          ///< no errors, delays or lost packets
  bool has_double_angle;  ///< adds friction that equation (3) does not describe
};
constexpr std::array<Setting, 3> kSettings{
    {{"real sensing", false, true}, {"exact sensors", true, true}, {"real sensing, friction without double angle", false, false}}};

/// Scores by setting and planner, then by seed.
using Scores = std::array<std::vector<DriveScore>, kSettings.size() * kPlanners.size()>;

/// No errors, delays or lost packets, but the gains of the real link, so that only the sensors differ.
DriveOptions exact_drive(const robot::Robot& robot) {
  DriveOptions options = ideal_drive();
  const RadioConfig real = radio_of(robot);
  options.radio.position_gain_per_s = real.position_gain_per_s;
  options.radio.heading_gain_per_s = real.heading_gain_per_s;
  return options;
}

Scores play_all(const Subject& subject, const duty::MatchInputs& inputs, double ambient_C) {
  Scores scores;
  scores.fill(std::vector<DriveScore>(kSeeds));
  base::in_parallel(kSeeds * scores.size(), 0, [&](std::size_t i) {
    const std::size_t seed = i / scores.size() + 1;
    const std::size_t set = i % scores.size();
    const Setting& setting = kSettings.at(set / kPlanners.size());
    robot::Robot robot = subject.robot;
    if (!setting.has_double_angle) {
      robot.friction.heading.double_angle_Nm = 0.0;
    }
    const robot_core::Config core = firmware::make_core_config(robot, subject.motor.nominal, firmware::with_tolerance({}, subject.motor));
    MatchRunOptions options;
    options.planner = kPlanners.at(set % kPlanners.size());
    options.ambient_C = ambient_C;
    options.drive = setting.is_exact ? exact_drive(robot) : sensed_drive(robot, seed, true);
    scores.at(set)[seed - 1] = run_match(play_game(inputs, robot, seed), robot, subject.motor, core, options).score;
  });
  return scores;
}

std::vector<double> values_of(const std::vector<DriveScore>& scores, const Value& value) {
  std::vector<double> values;
  for (const DriveScore& each : scores) {
    values.push_back(value.of(each));
  }
  return values;
}

std::string before(const Value& value, std::size_t planner) {
  return std::isnan(value.before.at(planner)) ? std::string("–") : fmt::format("{}", value.before.at(planner));
}

Sheet summary(const Scores& scores) {
  Sheet sheet{{"real sensing", "bang-bang", "jerk-limited", "difference in the same match", "earlier controller: bang-bang",
               "earlier controller: jerk-limited"},
              {}};
  for (const Value& value : kValues) {
    std::vector<double> differences = values_of(scores[1], value);
    const std::vector<double> bang_bang = values_of(scores[0], value);
    for (std::size_t i = 0; i < differences.size(); ++i) {
      differences[i] -= bang_bang[i];
    }
    sheet.rows.push_back({value.name, to_text(spread_of(bang_bang), value.decimals),
                          to_text(spread_of(values_of(scores[1], value)), value.decimals), to_text(spread_of(differences), value.decimals),
                          before(value, 0), before(value, 1)});
  }
  return sheet;
}

/// Table of the differences between the drive core and the earlier controller.
Sheet causes(const Scores& scores, std::size_t planner) {
  Sheet sheet{{kNames.at(planner)}, {}};
  for (const Setting& setting : kSettings) {
    sheet.header.emplace_back(setting.name);
  }
  sheet.header.emplace_back("earlier controller");
  for (const Value& value : kValues) {
    sheet.rows.push_back({value.name});
    for (std::size_t s = 0; s < kSettings.size(); ++s) {
      sheet.rows.back().push_back(to_text(spread_of(values_of(scores.at(s * kPlanners.size() + planner), value)), value.decimals));
    }
    sheet.rows.back().push_back(before(value, planner));
  }
  return sheet;
}

Sheet all_runs(const Scores& scores) {
  Sheet sheet{{"planner", "setting", "seed"}, {}};
  for (const Value& value : kValues) {
    sheet.header.emplace_back(value.column);
  }
  for (std::size_t p = 0; p < scores.size(); ++p) {
    for (std::size_t i = 0; i < kSeeds; ++i) {
      std::string setting = kSettings.at(p / kPlanners.size()).name;
      std::erase(setting, ',');
      sheet.rows.push_back({kNames.at(p % kNames.size()), setting, fmt::format("{}", i + 1)});
      for (const Value& value : kValues) {
        sheet.rows.back().push_back(fmt::format("{:.4g}", value.of(scores.at(p)[i])));
      }
    }
  }
  return sheet;
}

report::Chart picture(const Scores& scores) {
  const Value& slid = kValues[2];
  const Value& heat = kValues[4];
  const auto mean = [&](std::size_t planner, const Value& value) { return spread_of(values_of(scores.at(planner), value)).mean; };
  report::Chart chart{
      .title = fmt::format("Jerk limit: wheels slide {:.0f} s instead of {:.0f} s, copper heat {:.1f} instead of {:.1f} kJ", mean(1, slid),
                           mean(0, slid), mean(1, heat), mean(0, heat)),
      .subtitle = "division A match, Twente v2024, ECX FLAT 32 L, simulated with real sensing; earlier: a plain controller, mean",
      .x_label = "seed of the match",
      .panels = {},
      .panel_height_px = 270};
  struct Shown {
    const char* title;
    const char* label;
    std::size_t value;
  };
  constexpr Shown kShown[] = {{"Time in which a wheel slides", "time / s", 2},
                              {"Copper heat of all motors", "heat / kJ", 4},
                              {"Peak of the hottest winding", "temperature / °C", 6},
                              {"Distance between plan and robot", "distance / (mm rms)", 8}};
  for (const Shown& shown : kShown) {
    report::ChartPanel panel{.title = shown.title, .y_label = shown.label, .curves = {}, .bands = {}, .levels = {}};
    for (std::size_t p = 0; p < kPlanners.size(); ++p) {
      report::ChartCurve curve{.name = chart.panels.empty() ? kNames.at(p) : "", .color_index = static_cast<int>(p), .dots = true};
      for (std::size_t i = 0; i < kSeeds; ++i) {
        curve.x.push_back(static_cast<double>(i + 1));
      }
      curve.y = values_of(scores.at(p), kValues[shown.value]);
      const double before = kValues[shown.value].before.at(p);
      if (!std::isnan(before)) {
        panel.curves.push_back({.name = chart.panels.empty() ? fmt::format("{}, earlier", kNames.at(p)) : "",
                                .x = {0.5, static_cast<double>(kSeeds) + 0.5},
                                .y = {before, before},
                                .color_index = static_cast<int>(p),
                                .dashed = true});
      }
      panel.curves.push_back(std::move(curve));
    }
    chart.panels.push_back(std::move(panel));
  }
  return chart;
}

}  // namespace

void study_planners_in_match(const Subject& subject, const Report& report) {
  const duty::Duty duty = duty::read_duty(kSource / "duty_profiles" / "division_a_match.toml");
  const auto match = std::dynamic_pointer_cast<const duty::MatchDuty>(duty.shape_data);
  const Scores scores = play_all(subject, match->inputs(), duty.ambient_C.value);
  report.write("planners.md",
               fmt::format("Means of {} matches; in brackets 5th and 95th percentile. *Earlier controller*: means of ten matches that "
                           "a plain controller with exact sensors drove.\n\n{}\n{}\n{}",
                           kSeeds, summary(scores).markdown(), causes(scores, 1).markdown(), causes(scores, 0).markdown()));
  report.write("planners.csv", all_runs(scores).csv());
  report.draw("planners.svg", picture(scores));
}

}  // namespace heatsoak::simulate::studies
