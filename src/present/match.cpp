#include "present/match.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include "base/confidence.h"
#include "present/closed_loop.h"
#include "present/evaluation.h"
#include "present/motor_notes.h"
#include "present/robot_notes.h"
#include "present/shell_word.h"
#include "present/verdict_words.h"

namespace heatsoak::present {
namespace {

double limited_s(const simulate::DriveScore& score, robot_core::Reason limit) {
  return score.limited_s.at(static_cast<std::size_t>(std::ranges::find(simulate::kLimits, limit) - simulate::kLimits.begin()));
}

/// Returns a value per metre driven.
std::string per_metre(double value, const simulate::DriveScore& score) {
  return score.distance_m > 0.0 ? fmt::format("{:.1f}", value / score.distance_m) : "not moved";
}

struct ScoreRow {
  std::string_view name;
  std::string_view unit;
  std::string (*cell)(const simulate::DriveScore& score);
};

constexpr ScoreRow kScores[] = {
    {"driven", "m", [](const simulate::DriveScore& s) { return fmt::format("{:.0f}", s.distance_m); }},
    {"slip of a mean wheel", "mm per m", [](const simulate::DriveScore& s) { return per_metre(1e3 * s.slip_m, s); }},
    {"slip of a mean wheel, sliding", "mm per m", [](const simulate::DriveScore& s) { return per_metre(1e3 * s.sliding_m, s); }},
    {"time in which a wheel slides", "s", [](const simulate::DriveScore& s) { return fmt::format("{:.0f}", s.sliding_s); }},
    {"time in which a wheel is lifted", "s", [](const simulate::DriveScore& s) { return fmt::format("{:.0f}", s.lifted_s); }},
    {"tracking error, rms", "mm", [](const simulate::DriveScore& s) { return fmt::format("{:.1f}", 1e3 * s.tracking_rms_m); }},
    {"tracking error, largest", "mm", [](const simulate::DriveScore& s) { return fmt::format("{:.0f}", 1e3 * s.tracking_most_m); }},
    {"arrivals", "", [](const simulate::DriveScore& s) { return fmt::format("{:.0f}", s.arrivals_count); }},
    {"overshoot, mean of arrivals", "mm", [](const simulate::DriveScore& s) { return fmt::format("{:.1f}", 1e3 * s.overshoot_mean_m); }},
    {"overshoot, largest", "mm", [](const simulate::DriveScore& s) { return fmt::format("{:.1f}", 1e3 * s.overshoot_most_m); }},
    {"peak current", "A", [](const simulate::DriveScore& s) { return fmt::format("{:.1f}", s.peak_current_A); }},
    {"rms current, hottest motor", "A", [](const simulate::DriveScore& s) { return fmt::format("{:.2f}", s.current_rms_A); }},
    {"driver or battery falls short", "s", [](const simulate::DriveScore& s) { return fmt::format("{:.1f}", s.short_s); }},
    {"lowest battery voltage", "V", [](const simulate::DriveScore& s) { return fmt::format("{:.1f}", s.lowest_battery_V); }},
    {"core limits by traction", "s",
     [](const simulate::DriveScore& s) { return fmt::format("{:.1f}", limited_s(s, robot_core::Reason::traction)); }},
    {"core limits by voltage, current or sag", "s",
     [](const simulate::DriveScore& s) {
       return fmt::format("{:.1f}", limited_s(s, robot_core::Reason::voltage) + limited_s(s, robot_core::Reason::driver_current) +
                                        limited_s(s, robot_core::Reason::battery_sag));
     }},
    {"faults that the core reports", "s", [](const simulate::DriveScore& s) { return fmt::format("{:.1f}", s.fault_s); }},
    {"radio packets lost", "%", [](const simulate::DriveScore& s) { return fmt::format("{:.1f}", 100.0 * s.lost_packets_share); }},
    {"battery empty", "s", [](const simulate::DriveScore& s) { return fmt::format("{:.0f}", s.battery_empty_s); }},
    {"copper heat, all motors", "kJ", [](const simulate::DriveScore& s) { return fmt::format("{:.2f}", 1e-3 * s.energy.copper_J); }},
    {"copper heat per metre", "J per m", [](const simulate::DriveScore& s) { return per_metre(s.energy.copper_J, s); }},
    {"share of copper heat in duels", "%",
     [](const simulate::DriveScore& s) { return fmt::format("{:.0f}", 100.0 * s.duel_copper_share); }},
    {"winding peak", "°C", [](const simulate::DriveScore& s) { return fmt::format("{:.1f}", s.winding_peak_C); }},
    {"stator peak", "°C", [](const simulate::DriveScore& s) { return fmt::format("{:.1f}", s.stator_peak_C); }},
};

/// Returns a table whose columns after name and unit are the planners.
Table planner_table(std::string title, const simulate::MatchSimulation& answer) {
  Table table{.title = std::move(title), .columns = {{"", "", 0, Alignment::left}, {"", "", 0, Alignment::left}}, .rows = {}};
  for (const simulate::DrivenMatch& each : answer.runs) {
    table.columns.push_back({std::string(duty::to_string(each.planner)), "", 0});
  }
  return table;
}

template <class Cell>
void add_row(Table& table, const simulate::MatchSimulation& answer, std::string_view name, std::string_view unit, const Cell& cell) {
  std::vector<Text> row{{std::string(name)}, {std::string(unit)}};
  for (const simulate::DrivenMatch& each : answer.runs) {
    row.push_back({cell(each.run.score)});
  }
  table.rows.push_back(std::move(row));
}

Table score_table(const simulate::MatchSimulation& answer) {
  Table table = planner_table("Driving performance and heat of the match", answer);
  for (const ScoreRow& each : kScores) {
    add_row(table, answer, each.name, each.unit, each.cell);
  }
  return table;
}

Table energy_table(const simulate::MatchSimulation& answer) {
  Table table = planner_table("Energy out of the battery", answer);
  add_row(table, answer, "in all", "kJ",
          [](const simulate::DriveScore& score) { return fmt::format("{:.2f}", 1e-3 * score.energy.battery_J); });
  for (const EnergyPart& each : energy_parts()) {
    std::string name(each.name);
    std::ranges::replace(name, '_', ' ');
    add_row(table, answer, name, "%", [&](const simulate::DriveScore& score) {
      return fmt::format("{:.1f}", 100.0 * score.energy.*each.value / score.energy.battery_J);
    });
  }
  add_row(table, answer, "not accounted for", "%", [](const simulate::DriveScore& score) {
    return fmt::format("{:.3f}", 100.0 * score.energy.residual_J() / score.energy.battery_J);
  });
  return table;
}

/// Reports what the thermal guard did or, in shadow mode, would have done.
void add_guard_notes(Document& document, const simulate::MatchSimulation& answer) {
  if (answer.guard_use == simulate::GuardUse::off) {
    document.add_note(Severity::note, "thermal guard: off");
    return;
  }
  if (!answer.guard.guard) {
    document.add_note(Severity::warning, fmt::format("thermal guard: none, because this motor cannot be guarded: {}",
                                                     answer.guard.why_none ? answer.guard.why_none->message() : ""));
    return;
  }
  for (const simulate::DrivenMatch& each : answer.runs) {
    const simulate::DriveScore& score = each.run.score;
    const bool is_on = answer.guard_use == simulate::GuardUse::on;
    const std::string what = score.guard_limited_s == 0.0 ? fmt::format("{}limited no motor in", is_on ? "" : "would have ")
                             : is_on                      ? fmt::format("limited a motor for {:.1f} s of", score.guard_limited_s)
                                     : fmt::format("would have limited a motor for {:.1f} s and taken away {:.1f} A s of",
                                                   score.guard_limited_s, score.guard_missing_A_s);
    document.add_note(
        Severity::note,
        fmt::format(
            "thermal guard ({}), {}: {} {}; its observer, with air of {:.0f} °C and its safety factor on heat, reached {:.0f} °C",
            simulate::kGuardUses[static_cast<std::size_t>(answer.guard_use)], duty::to_string(each.planner), what,
            duration_text(score.time_s),
            answer.is_sensing_ideal ? answer.duty.ambient_C.value : static_cast<double>(answer.guard.guard->model().hottest_ambient_C),
            score.guard_winding_peak_C.value()));
  }
}

std::string upper_words(double peak_C) { return fmt::format("{:.1f} °C {}", peak_C, upper_losses_words()); }

/// Returns the verdict as words in front of a peak.
std::string verdict_words(const simulate::DrivenMatch& driven) {
  const simulate::DriveScore& score = driven.run.score;
  switch (driven.verdict) {
    case select::Verdict::pass:
      return "stays within its limits: ";
    case select::Verdict::marginal:
      return "may exceed a limit or miss the demand: ";
    case select::Verdict::fail:
      return "exceeds a limit: ";
    case select::Verdict::infeasible:
      break;
  }
  return fmt::format("cannot drive this match: {}. The nominal run is not too hot: ", words_of(*simulate::drive_problem(score), score));
}

/// Formats as "(limit 155 °C)", with the peak of the upper end of the forecast band if there is one.
std::string limit_words(double limit_C, std::optional<double> upper_C) {
  return fmt::format("(limit {:.0f} °C{})", limit_C, upper_C ? "; " + upper_words(*upper_C) : "");
}

/// Returns the sentence about one planner: the verdict with its reason, then the hottest body over its limit, else the hottest winding.
Text sentence(const simulate::MatchSimulation& answer, const simulate::DrivenMatch& driven) {
  const simulate::DriveScore& score = driven.run.score;
  const motor::MotorValues& limits = answer.motor.nominal;
  const bool is_driven = driven.verdict != select::Verdict::infeasible;
  const auto upper_C = [&](double simulate::DriveScore::*peak_C) {
    return driven.upper ? std::optional((*driven.upper).*peak_C) : std::nullopt;
  };
  const simulate::DriveScore& deciding = driven.verdict == select::Verdict::marginal ? driven.upper.value() : score;
  const bool is_of_stator = is_driven && deciding.winding_peak_C <= limits.winding_limit_C &&
                            deciding.stator_peak_C > limits.stator_limit_C.value_or(std::numeric_limits<double>::infinity());
  const std::string peak =
      is_of_stator ? fmt::format("the stator reaches {:.1f} °C {}", score.stator_peak_C,
                                 limit_words(*limits.stator_limit_C, upper_C(&simulate::DriveScore::stator_peak_C)))
                   : fmt::format("the hottest winding, of wheel {}, reaches {:.1f} °C {}", score.hottest_wheel + 1, score.winding_peak_C,
                                 limit_words(limits.winding_limit_C, upper_C(&simulate::DriveScore::winding_peak_C)));
  return {fmt::format("In this one game (seed {}) the nominal {} {}{}{}.", answer.seed, answer.motor.id,
                      answer.runs.size() > 1 ? fmt::format("with {} ", duty::to_string(driven.planner)) : "", verdict_words(driven), peak),
          tone_of(driven.verdict)};
}

std::string evaluate_command(const GivenInputs& given) {
  std::string words = fmt::format("heatsoak evaluate --robot {} --duty {}", shell_word(given.robot), shell_word(given.duty));
  words += given.model.empty() ? fmt::format(" --motors {}", shell_word(given.motor)) : fmt::format(" --model {}", shell_word(given.model));
  for (const auto& [key, value] : given.conditions) {
    words += fmt::format(" --condition {}", shell_word(fmt::format("{}={}", key, value)));
  }
  return words + (given.database.empty() ? "" : fmt::format(" --db {}", shell_word(given.database)));
}

/// Names the command that gives the verdict: one run with nominal values leaves out all tolerances.
void add_scope(Document& document, const GivenInputs& given, bool is_game) {
  document.add_note(
      Severity::scope,
      fmt::format("This is {} with nominal values and no verdict over tolerances. `{}` gives it; {}.", is_game ? "one game" : "one run",
                  evaluate_command(given),
                  is_game ? "there the plan is followed exactly, so its temperatures differ, and --closed-loop states by how much"
                          : "its nominal temperatures are the same"));
}

std::string_view verb_of(select::Verdict verdict) {
  constexpr std::array<std::string_view, 4> kVerbs{"stays within its limits on", "may exceed a limit or miss the demand on",
                                                   "exceeds a limit on", "cannot drive"};
  return kVerbs.at(static_cast<std::size_t>(verdict));
}

}  // namespace

std::string upper_losses_words() { return fmt::format("with the losses at their {:.0f}th percentile", 50.0 * (1.0 + base::kBand_share)); }

std::span<const EnergyPart> energy_parts() {
  static constexpr std::array<EnergyPart, 9> kParts{{{"copper", &simulate::EnergyAccount::copper_J},
                                                     {"iron_and_bearings", &simulate::EnergyAccount::motor_drag_J},
                                                     {"drivers", &simulate::EnergyAccount::driver_J},
                                                     {"battery_resistance", &simulate::EnergyAccount::battery_loss_J},
                                                     {"gear", &simulate::EnergyAccount::gear_J},
                                                     {"rolling", &simulate::EnergyAccount::rolling_J},
                                                     {"wheel_friction", &simulate::EnergyAccount::friction_J},
                                                     {"rollers", &simulate::EnergyAccount::roller_J},
                                                     {"slip", &simulate::EnergyAccount::slip_J}}};
  return kParts;
}

Document match_document(const simulate::MatchSimulation& answer, const GivenInputs& given) {
  Document document{.headline = {},
                    .paragraphs = {fmt::format(
                        "{} on {} as {}, seed {}: closed loop of {} at 1 kHz with the drive core, {}, {} thermal data. The load is {}.",
                        answer.robot.id, answer.duty.id, duty::kRoleNames.at(static_cast<std::size_t>(answer.role)), answer.seed,
                        duration_text(answer.runs.front().run.score.time_s),
                        answer.is_sensing_ideal ? std::string("exact sensors and no delays")
                                                : fmt::format("real sensing and {:.0f} radio packets per second",
                                                              simulate::radio_of(answer.robot).packet_rate_Hz),
                        motor::data_quality(answer.motor), answer.duty.origin)},
                    .tables = {score_table(answer), energy_table(answer)}};
  add_scope(document, given, true);
  for (const simulate::DrivenMatch& each : answer.runs) {
    document.headline.push_back(sentence(answer, each));
    if (const std::optional<simulate::DriveProblem> problem = simulate::drive_problem(each.run.score);
        problem && each.verdict != select::Verdict::infeasible) {
      document.add_note(Severity::warning, fmt::format("{}: {}", duty::to_string(each.planner), words_of(*problem, each.run.score)));
    }
  }
  add_robot_notes(document, answer.robot);
  add_guard_notes(document, answer);
  if (!answer.is_sensing_ideal) {
    add_missing_sensors(document, answer.robot);
  }
  add_motor_notes(document, {&answer.motor, 1}, Neighbours::known);
  if (answer.guard_use != simulate::GuardUse::off) {
    add_lines(document.notes, default_spreads_text({&answer.motor, 1}), Severity::note);
  }
  add_assumed_friction(document, answer.robot);
  document.data = match_json(answer);
  add_notes(document.data, document.notes);
  return document;
}

Document load_simulation_document(const select::LoadSimulation& simulation, const GivenInputs& given) {
  const auto& [robot, motor, duty, duration_s, result, upper, trace] = simulation;
  Document document{
      .headline = {{fmt::format("In this one run the nominal {} {} {}: winding peak {:.1f} °C (limit {:.0f} °C{}).", motor.id,
                                verb_of(result.verdict), load_words(duty), result.winding_peak_C.nominal, result.winding_limit_C,
                                upper ? "; " + upper_words(upper->winding_C) : ""),
                    tone_of(result.verdict)}},
      .paragraphs = {fmt::format("{} on {} ({}, {}): stator peak {:.1f} °C{}, rms current {:.2f} A, {} thermal data. The load is {}.",
                                 robot.id, duty.id, duration_text(duration_s), result.wheel, result.stator_peak_C.nominal,
                                 upper ? fmt::format(" ({})", upper_words(upper->stator_C)) : "", result.current_rms_A, result.data_quality,
                                 duty.origin)}};
  Table table{.title = "Mean heat into the nodes (positive: into)",
              .columns = {{"effect", "", 0, Alignment::left}, {"node", "", 0, Alignment::left}, {"heat", "W", 0}},
              .rows = {}};
  for (const select::BookedHeat& each : trace.balance) {
    table.rows.push_back({{std::string(each.effect)}, {std::string(each.node)}, {fmt::format("{:+.3f}", each.mean_W)}});
  }
  table.rows.push_back({{"stored in the motor"}, {""}, {fmt::format("{:+.3f}", trace.stored_W)}});
  document.tables.push_back(std::move(table));
  add_scope(document, given, false);
  add_lines(document.notes, why_infeasible(result, robot), Severity::warning);
  add_robot_notes(document, robot);
  add_motor_notes(document, {&motor, 1});
  document.data = load_simulation_json(simulation);
  add_notes(document.data, document.notes);
  return document;
}

}  // namespace heatsoak::present
