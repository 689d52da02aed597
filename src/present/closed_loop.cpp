#include "present/closed_loop.h"

#include <fmt/format.h>

#include <algorithm>

#include "present/evaluation.h"
#include "simulate/sensing.h"

namespace heatsoak::present {
namespace {

std::string spread_text(const simulate::GameSpread& spread, double scale, int decimals) {
  return fmt::format("{:.{}f} [{:.{}f}…{:.{}f}]", scale * spread.nominal, decimals, scale * spread.low, decimals, scale * spread.high,
                     decimals);
}

std::vector<Text> closed_loop_row(std::size_t rank, const simulate::ClosedLoopRank& of) {
  const simulate::GameDrives& drives = of.drives;
  if (drives.games.empty()) {
    std::vector<Text> cells{{fmt::format("{}", rank)}, {drives.motor_id}, {"not driven", Tone::bad}};
    cells.resize(8, {"–"});
    return cells;
  }
  return {{fmt::format("{}", rank)},
          {drives.motor_id},
          {std::string(select::to_string(of.verdict)), tone_of(of.verdict)},
          {spread_text(drives.spread(&simulate::DriveScore::winding_peak_C), 1.0, 0)},
          {spread_text(drives.spread(&simulate::DriveScore::stator_peak_C), 1.0, 0)},
          {drives.is_guarded ? spread_text(drives.spread(&simulate::DriveScore::guard_limited_s), 1.0, 0) : "no guard"},
          {spread_text(drives.spread(&simulate::DriveScore::tracking_rms_m), 1e3, 0)},
          {spread_text(drives.spread(&simulate::DriveScore::distance_m), 1.0, 0)}};
}

}  // namespace

std::string words_of(simulate::DriveProblem problem, const simulate::DriveScore& score) {
  switch (problem) {
    case simulate::DriveProblem::battery_empty:
      return fmt::format("the battery is empty after {:.0f} s; the robot stands still for the rest of the match",
                         score.time_s - score.battery_empty_s);
    case simulate::DriveProblem::tips:
      return fmt::format("wheels are off the ground for {:.0f} s: the robot tips", score.lifted_s);
    case simulate::DriveProblem::off_plan:
      break;
  }
  return fmt::format("the robot is {:.1f} m (rms) off its plan, more than its own size: motors, driver or grip are too weak",
                     score.tracking_rms_m);
}

void add_missing_sensors(Document& document, const robot::Robot& robot) {
  if (!simulate::sensing_of(robot).has_motor_current) {
    document.add_note(
        Severity::note,
        fmt::format("{} has no sensors of the motor currents, because its file states no [drive] current_limit: the drive core "
                    "computes the currents from voltage and speed.",
                    robot.id));
  }
}

void add_closed_loop(Document& document, const robot::Robot& robot, const std::vector<simulate::ClosedLoopRank>& ranks, int games,
                     std::uint64_t seed) {
  Table table{
      .title = fmt::format("Closed loop: {} driven by the drive core, seeds {} to {}; first game [lowest…highest of all]",
                           fmt::format("{} game{}", games, games == 1 ? "" : "s"), seed, seed + static_cast<std::uint64_t>(games) - 1),
      .columns = {{"", "", 0},
                  {"motor", "", 0, Alignment::left},
                  {"verdict", "", 0, Alignment::left},
                  {"winding peak", "°C", 0},
                  {"stator peak", "°C", 2},
                  {"guard limits", "s", 1},
                  {"error", "mm rms", 3},
                  {"driven", "m", 4}}};
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    table.rows.push_back(closed_loop_row(i + 1, ranks[i]));
    const simulate::GameDrives& drives = ranks[i].drives;
    if (drives.games.empty()) {
      document.add_note(Severity::warning, fmt::format("{} was not driven: {}", drives.motor_id, drives.why_none));
    }
    const auto bad =
        std::ranges::find_if(drives.games, [](const simulate::DriveScore& game) { return simulate::drive_problem(game).has_value(); });
    if (bad != drives.games.end()) {
      document.add_note(Severity::warning, fmt::format("{}: {}", drives.motor_id, words_of(*simulate::drive_problem(*bad), *bad)));
    }
    if (!drives.why_no_guard.empty()) {
      document.add_note(Severity::note, fmt::format("{} has no thermal guard: {}", drives.motor_id, drives.why_no_guard));
    }
  }
  add_missing_sensors(document, robot);
  const auto passed = std::ranges::count(ranks, select::Verdict::pass, &simulate::ClosedLoopRank::verdict);
  document.headline.insert(document.headline.begin(),
                           {fmt::format("Driven in a closed loop, {} of {} pass. The ranking below follows these games.", passed,
                                        fmt::format("{} motor{}", ranks.size(), ranks.size() == 1 ? "" : "s")),
                            passed == 0 ? Tone::bad : Tone::good});
  document.tables.insert(document.tables.begin(), std::move(table));
  document.add_note(
      Severity::note,
      "The two tables differ: the one without a closed loop uses the torque that an exactly followed plan needs. In the closed loop the "
      "drive core works with noisy, delayed sensors and lost packets, wheels slip, and the battery sags. Corrections add heat; grip, "
      "voltage and current limits take heat away.");
  document.add_note(Severity::background,
                    "The closed loop uses nominal motors; the other table includes tolerances. guard limits: time in which the thermal "
                    "guard would have limited a motor; it limits nothing here.");
}

}  // namespace heatsoak::present
