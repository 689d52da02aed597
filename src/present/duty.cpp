#include "present/duty.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>

#include "base/quantity.h"
#include "present/evaluation.h"
#include "present/game_words.h"
#include "present/robot_notes.h"
#include "present/verdict_words.h"

namespace heatsoak::present {
namespace {

Table role_table(const duty::RoleLoads& roles) {
  Table table{
      .title = "Share of torque squared, by phase and role", .columns = {{"", "", 0, Alignment::left}, {"time", "s", 1}}, .rows = {}};
  for (const std::string_view role : duty::kRoleNames) {
    table.columns.push_back({std::string(role), "", 0});
  }
  const auto add = [&](std::string_view name, const std::string& time, const std::function<std::string(const duty::MatchLoad&)>& cell) {
    std::vector<Text> row{{std::string(name)}, {time}};
    for (const duty::MatchLoad& load : roles) {
      row.push_back({cell(load)});
    }
    table.rows.push_back(std::move(row));
  };
  const auto share = [](double part_Nm2_s, const duty::MatchLoad& load) {
    return fmt::format("{:.1f} %", 100.0 * part_Nm2_s / duty::effort_Nm2_s(load));
  };
  for (std::size_t i = 0; i < duty::kPhaseNames.size(); ++i) {
    if (const double time_s = roles.back().phases[i].time_s; time_s > 0.0) {
      std::string name(duty::kPhaseNames[i]);
      std::ranges::replace(name, '_', ' ');
      add(name, fmt::format("{:.0f}", time_s), [&](const duty::MatchLoad& load) {
        return share(duty::effort_Nm2_s(load.phases[i]) - load.phases[i].duel_torque_squared_Nm2_s, load);
      });
    }
  }
  const double most_Nm2_s = duty::most_effort_Nm2_s(roles);
  add("duels (pushing at stall)", "", [&](const duty::MatchLoad& load) { return share(duty::duel_effort_Nm2_s(load), load); });
  add("time in duels", "", [](const duty::MatchLoad& load) { return fmt::format("{:.0f} s", duty::duel_s(load)); });
  add("driven", "", [](const duty::MatchLoad& load) { return fmt::format("{:.0f} m", load.distance_m); });
  add("torque of a mean wheel, rms", "",
      [](const duty::MatchLoad& load) { return fmt::format("{:.1f} mN m", 1e3 * duty::torque_rms_Nm(load)); });
  add("torque squared / busiest role's", "",
      [&](const duty::MatchLoad& load) { return fmt::format("{:.0f} %", 100.0 * duty::effort_Nm2_s(load) / most_Nm2_s); });
  return table;
}

Document document_of(const duty::DutyAnswer& answer, const duty::PrescribedLoad& load) {
  const duty::Duty& duty = *answer.duty;
  return {.headline = {{fmt::format("{}: {}, {:.0f} s.", duty.id, duty.summary, load.duration_s)}},
          .paragraphs = {fmt::format("The load is {}.", duty.origin)}};
}

Document document_of(const duty::DutyAnswer& answer, const duty::GeneratedMatch& match) {
  const duty::Duty& duty = *answer.duty;
  const robot::Robot& robot = answer.robot;
  const duty::MatchLoad& load = match.load;
  Document document{.headline = {{fmt::format("{} of {} as {}: {} with {:.0f} s of play, {:.2f} km.", duty.id, robot.id,
                                              duty::kRoleNames.at(static_cast<std::size_t>(match.role)), duration_text(load.duration_s),
                                              load.play_s, load.distance_m / 1e3)}},
                    .paragraphs = {fmt::format("Seed {}. The load is {}.", match.seed, duty.origin)},
                    .tables = {role_table(match.roles)}};
  if (const std::string slip = slip_text(load.wheels.front()); !slip.empty()) {
    document.add_note(Severity::note, slip + ": a wheel slides there (`heatsoak simulate` includes this)");
  }
  const std::optional<double> acceleration_m_per_s2 = robot.limits.acceleration_m_per_s2;
  const std::optional<double> braking_m_per_s2 = robot.limits.braking_m_per_s2;
  if (acceleration_m_per_s2 && braking_m_per_s2 && *braking_m_per_s2 > *acceleration_m_per_s2) {
    document.add_note(Severity::note,
                      fmt::format("In a match the robot brakes with its acceleration of {} m/s²: its braking limit of {} m/s² is not used.",
                                  base::significant(*acceleration_m_per_s2, 3), base::significant(*braking_m_per_s2, 3)));
  }
  return document;
}

Document document_of(const duty::DutyAnswer& answer, const duty::GameDemand& game) {
  Document document{
      .headline = {{fmt::format("{} of {}, driven by {}: {}.", game.player, std::filesystem::path(answer.log).filename().string(),
                                answer.robot.id, duration_text(game.wheels.front().duration_s()))}},
      .paragraphs = {}};
  document.paragraphs = words_of(game);
  return document;
}

}  // namespace

Document duty_document(const duty::DutyAnswer& answer) {
  Document document = std::visit([&](const auto& content) { return document_of(answer, content); }, answer.content);
  add_robot_notes(document, answer.robot);
  document.data = duty_json(answer);
  return document;
}

void add_next_command(Document& document, const std::string& description) {
  document.add_note(Severity::note, fmt::format("Next: `heatsoak evaluate --duty {}` with a robot.", description));
}

}  // namespace heatsoak::present
