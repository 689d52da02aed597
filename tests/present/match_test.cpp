// Answer of `simulate` for a match that two planners drive: verdict, reason and temperature belong to one run.
#include "present/match.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "present/match_chart.h"
#include "present/renderer.h"
#include "present/verdict_chart.h"
#include "support/shipped.h"

namespace heatsoak::present {
namespace {

simulate::DrivenMatch driven(duty::Planner planner, select::Verdict verdict, double winding_peak_C) {
  simulate::DrivenMatch match{.planner = planner, .run = {}, .verdict = verdict, .csv = {}, .rows = {}};
  match.run.score.time_s = 1000.0;
  match.run.score.winding_peak_C = winding_peak_C;
  match.run.score.tracking_rms_m = verdict == select::Verdict::infeasible ? 0.2 : 0.01;
  return match;
}

simulate::MatchSimulation both(simulate::DrivenMatch first, simulate::DrivenMatch second) {
  simulate::MatchSimulation match{.robot = twente(),
                                  .motor = ecx_32(),
                                  .duty = duty::read_duty(kSource / "duty_profiles/division_a_match.toml"),
                                  .guard_use = simulate::GuardUse::off,
                                  .guard = {},
                                  .runs = {}};
  match.runs.push_back(std::move(first));
  match.runs.push_back(std::move(second));
  return match;
}

const GivenInputs kGiven{.robot = "roboteam_twente_v2024", .duty = "division_a_match", .motor = "maxon_ecx_flat_32l_48v"};

TEST(MatchAnswer, verdict_and_temperature_are_of_the_same_planner) {
  const simulate::MatchSimulation match = both(driven(duty::Planner::jerk_limited, select::Verdict::pass, 71.5),
                                               driven(duty::Planner::bang_bang, select::Verdict::infeasible, 73.5));
  EXPECT_EQ(match.verdict(), select::Verdict::infeasible);
  const Json json = match_json(match);
  EXPECT_EQ(json.at("planner"), "bang_bang");
  EXPECT_EQ(json.at("verdict"), "infeasible");
  EXPECT_EQ(json.at("winding_peak_C"), 73.5);
  EXPECT_EQ(json.at("planners").at(0).at("verdict"), "pass");
  EXPECT_EQ(json.at("planners").at(1).at("verdict"), "infeasible");
}

TEST(MatchAnswer, has_one_sentence_per_planner_with_its_own_verdict) {
  const Document document = match_document(both(driven(duty::Planner::jerk_limited, select::Verdict::pass, 71.5),
                                                driven(duty::Planner::bang_bang, select::Verdict::infeasible, 73.5)),
                                           kGiven);
  ASSERT_EQ(document.headline.size(), 2U);
  EXPECT_EQ(document.headline[0].tone, Tone::good);
  EXPECT_EQ(document.headline[1].tone, Tone::bad);
}

// One game with nominal values is no verdict over tolerances, which `evaluate` gives.
TEST(MatchAnswer, says_first_that_it_is_one_game_and_names_evaluate) {
  const Document document = match_document(both(driven(duty::Planner::jerk_limited, select::Verdict::pass, 71.5),
                                                driven(duty::Planner::bang_bang, select::Verdict::fail, 173.5)),
                                           kGiven);
  for (const Text& sentence : document.headline) {
    EXPECT_NE(sentence.words.find("In this one game (seed 1) the nominal"), std::string::npos) << sentence.words;
    EXPECT_EQ(sentence.words.find("passes"), std::string::npos) << sentence.words;
  }
  EXPECT_NE(by_urgency(document.notes).front().words.find("`heatsoak evaluate --robot"), std::string::npos);
}

TEST(MatchAnswer, repeats_the_inputs_as_the_user_gave_them) {
  const simulate::MatchSimulation match =
      both(driven(duty::Planner::jerk_limited, select::Verdict::pass, 71.5), driven(duty::Planner::bang_bang, select::Verdict::pass, 73.5));
  const auto scope = [&match](const GivenInputs& given) { return by_urgency(match_document(match, given).notes).front().words; };
  EXPECT_NE(scope(kGiven).find("--robot roboteam_twente_v2024 --duty division_a_match --motors maxon_ecx_flat_32l_48v`"),
            std::string::npos);
  EXPECT_NE(scope({.robot = "our robot.toml",
                   .duty = "match.toml",
                   .model = "../fit/model.toml",
                   .database = "db",
                   .conditions = {{"cooling", "fan"}}})
                .find("`heatsoak evaluate --robot 'our robot.toml' --duty match.toml --model ../fit/model.toml --condition 'cooling=fan' "
                      "--db db`"),
            std::string::npos);
}

TEST(LoadAnswer, says_first_that_mass_and_wheels_do_not_matter) {
  const select::LoadSimulation simulation = select::simulate_load(
      {.robot = twente(), .motor = ecx_32(), .duty = duty::read_duty(kSource / "duty_profiles/paper_intermittent.toml")});
  const Document document = load_simulation_document(simulation, kGiven);
  EXPECT_NE(document.headline.front().words.find("mass and wheel size of the robot do not matter"), std::string::npos);
  EXPECT_NE(document.headline.front().words.find("nominal"), std::string::npos);
  EXPECT_NE(by_urgency(document.notes).front().words.find("`heatsoak evaluate --robot"), std::string::npos);
}

TEST(MatchAnswer, names_the_part_that_only_the_upper_end_of_the_band_heats_too_much) {
  simulate::MatchSimulation match = both(driven(duty::Planner::jerk_limited, select::Verdict::marginal, 141.5),
                                         driven(duty::Planner::bang_bang, select::Verdict::marginal, 120.0));
  match.motor.nominal.stator_limit_C = 90.0;
  for (simulate::DrivenMatch& each : match.runs) {
    each.run.score.stator_peak_C = 85.0;
    each.upper = each.run.score;
    each.upper->stator_peak_C = 95.0;
  }
  match.runs[0].upper->winding_peak_C = 160.0;
  match.runs[1].upper->winding_peak_C = 130.0;
  const Document document = match_document(match, kGiven);
  EXPECT_NE(document.headline[0].words.find("may exceed a limit or miss the demand: the hottest winding, of wheel 1, reaches 141.5 °C "
                                            "(limit 155 °C; 160.0 °C with the losses"),
            std::string::npos)
      << document.headline[0].words;
  EXPECT_NE(document.headline[1].words.find(
                "may exceed a limit or miss the demand: the stator reaches 85.0 °C (limit 90 °C; 95.0 °C with the losses"),
            std::string::npos)
      << document.headline[1].words;
  EXPECT_EQ(document.data["upper_winding_peak_C"], 160.0);
  EXPECT_EQ(document.data["planners"][1]["upper_winding_peak_C"], 130.0);
}

// Without a forecast band the answer is that of the nominal motor alone.
TEST(LoadAnswer, has_the_peak_at_the_upper_end_of_the_band) {
  motor::Motor motor = ecx_32();
  const auto answer = [&] {
    return load_simulation_document(
        select::simulate_load(
            {.robot = twente(), .motor = motor, .duty = duty::read_duty(kSource / "duty_profiles/paper_intermittent.toml")}),
        kGiven);
  };
  EXPECT_TRUE(answer().data["upper_winding_peak_C"].is_null());
  motor.fit.emplace();
  motor.fit->band = motor::ForecastBand{{0.0, 0.0}, 100.0, 0.1, 1.0};
  motor.nominal.winding_limit_C = 170.0;  // nominal 162 °C
  const Document document = answer();
  EXPECT_NE(document.headline.front().words.find("may exceed a limit or miss the demand on"), std::string::npos);
  EXPECT_NE(document.headline.front().words.find("with the losses at their 95th percentile"), std::string::npos);
  EXPECT_EQ(document.data["verdict"], "marginal");
  EXPECT_GT(document.data["upper_winding_peak_C"], 170.0);
}

TEST(MatchAnswer, an_exceeded_limit_decides_before_a_match_that_was_not_driven) {
  const simulate::MatchSimulation match = both(driven(duty::Planner::jerk_limited, select::Verdict::infeasible, 71.5),
                                               driven(duty::Planner::bang_bang, select::Verdict::fail, 173.5));
  EXPECT_EQ(match.verdict(), select::Verdict::fail);
  EXPECT_EQ(match.deciding().planner, duty::Planner::bang_bang);
}

// A row is read alone in JSON, in a report, or by a screen reader.
TEST(MatchAnswer, no_row_leans_on_the_row_above) {
  const Document document = match_document(
      both(driven(duty::Planner::jerk_limited, select::Verdict::pass, 71.5), driven(duty::Planner::bang_bang, select::Verdict::pass, 73.5)),
      kGiven);
  for (const std::vector<Text>& row : document.tables.front().rows) {
    EXPECT_NE(row.front().words.front(), ' ') << row.front().words;
  }
}

// The stator changes far less than the winding, so it has its own axes below it. The picture of `evaluate` does the same.
TEST(MatchChart, has_the_winding_above_the_stator_with_one_colour_per_wheel) {
  simulate::MatchSimulation match = both(driven(duty::Planner::jerk_limited, select::Verdict::pass, 71.5), {});
  match.runs.resize(1);
  match.runs.front().rows.resize(2);
  match.motor.nominal.stator_limit_C = 90.0;
  const std::vector<report::ChartPanel> panels = match_chart(match).panels;
  EXPECT_EQ(panels[0].title, "Winding");
  EXPECT_EQ(panels[1].title, "Stator");
  ASSERT_EQ(panels[1].curves.size(), panels[0].curves.size());
  std::set<std::optional<int>> colors;
  for (std::size_t i = 0; i < panels[0].curves.size(); ++i) {
    EXPECT_NE(panels[0].curves[i].name, "");
    EXPECT_EQ(panels[1].curves[i].color_index, panels[0].curves[i].color_index);
    colors.insert(panels[0].curves[i].color_index);
  }
  EXPECT_EQ(colors.size(), match.robot.wheels.axis_rad.size());
  EXPECT_EQ(panels[0].levels.front().y, match.motor.nominal.winding_limit_C);
  EXPECT_EQ(panels[1].levels.front().y, 90.0);
}

TEST(MatchChart, shows_the_peak_at_the_upper_end_of_the_forecast_band) {
  simulate::MatchSimulation match = both(driven(duty::Planner::jerk_limited, select::Verdict::marginal, 71.5), {});
  match.runs.resize(1);
  match.runs.front().rows.resize(2);
  match.runs.front().upper = match.runs.front().run.score;
  match.runs.front().upper->winding_peak_C = 174.0;
  const report::Chart chart = match_chart(match);
  EXPECT_NE(chart.title.find("may exceed a limit or miss the demand, winding 72 to 174 °C"), std::string::npos) << chart.title;
  EXPECT_EQ(chart.panels[0].levels.back().y, 174.0);
  EXPECT_NE(chart.panels[0].levels.back().name.find("95th percentile"), std::string::npos);
}

/// The upper run may lack the voltage for its demand although no body is over its limit, which a stator need not have.
TEST(MatchAnswer, a_match_that_may_miss_its_demand_names_the_winding) {
  simulate::MatchSimulation match = both(driven(duty::Planner::jerk_limited, select::Verdict::marginal, 71.5), {});
  match.runs.resize(1);
  match.motor.nominal.stator_limit_C.reset();
  match.runs.front().upper = match.runs.front().run.score;
  EXPECT_NE(match_document(match, kGiven).headline.front().words.find("the hottest winding"), std::string::npos);
}

TEST(VerdictChart, draws_one_line_for_a_load_that_does_not_repeat) {
  select::MotorEvaluation motor;
  motor.curves.time_s = {0.0, 60.0};
  motor.curves.winding_C = motor.curves.stator_C = {25.0, 30.0};
  for (const auto& [duty, has_ripple] : {std::pair("division_a_match", false), std::pair("paper_intermittent", true)}) {
    const report::Chart chart =
        verdict_chart({motor}, twente(), duty::read_duty(kSource / "duty_profiles" / (std::string(duty) + ".toml")));
    EXPECT_EQ(chart.panels.front().curves.front().has_ripple, has_ripple) << duty;
  }
}

// Bands of many motors would cover each other. The range of every peak is shown for any number of motors.
TEST(VerdictChart, shows_the_range_of_every_motor) {
  select::MotorEvaluation motor;
  motor.curves.time_s = motor.curves.band_time_s = {0.0, 60.0};
  motor.curves.winding_C = motor.curves.stator_C = {25.0, 30.0};
  motor.curves.winding_p05_C = motor.curves.stator_p05_C = {25.0, 28.0};
  motor.curves.winding_p95_C = motor.curves.stator_p95_C = {25.0, 35.0};
  motor.winding_peak_C = motor.stator_peak_C = {.nominal = 30.0, .p05 = 28.0, .p50 = 30.0, .p95 = 35.0};
  const duty::Duty duty = duty::read_duty(kSource / "duty_profiles/paper_intermittent.toml");
  for (const auto& [motors, bands] : {std::pair(1U, 1U), {4U, 4U}, {6U, 0U}}) {
    const report::Chart chart = verdict_chart(std::vector(motors, motor), twente(), duty);
    for (const report::ChartPanel& panel : chart.panels) {
      EXPECT_EQ(panel.bands.size(), bands);
      ASSERT_EQ(panel.ranges.size(), motors);
      EXPECT_EQ(panel.ranges.back().low, 28.0);
      EXPECT_EQ(panel.ranges.back().high, 35.0);
      EXPECT_EQ(panel.ranges.back().y, 30.0);
      EXPECT_EQ(panel.ranges.back().color_index, panel.curves.back().color_index);
    }
  }
  // None of eight is the robot's motor.
  EXPECT_TRUE(verdict_chart(std::vector(8, motor), twente(), duty).subtitle.starts_with("the best 6 of 8"));
  motor.curves.band_time_s.clear();
  motor.winding_peak_C = motor.stator_peak_C = {.nominal = 30.0};
  EXPECT_TRUE(verdict_chart({motor}, twente(), duty).panels.front().ranges.empty()) << "without samples";
}

}  // namespace
}  // namespace heatsoak::present
