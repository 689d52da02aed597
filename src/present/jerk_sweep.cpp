#include "present/jerk_sweep.h"

#include <fmt/format.h>

#include <algorithm>

namespace heatsoak::present {

std::string settling_words(const simulate::JerkSweep& sweep) {
  const std::vector<simulate::StudyResult>& results = sweep.results;
  const double own_m_per_s2 = results.front().limits.acceleration_m_per_s2;
  const simulate::StudyResult* best = &results.front();
  for (const simulate::StudyResult& each : results) {
    if (each.limits.acceleration_m_per_s2 == own_m_per_s2 && each.settled_s < best->settled_s) {
      best = &each;
    }
  }
  return fmt::format("at its own acceleration of {:.1f} m/s² it settles earliest, after {:.2f} s, with {}", own_m_per_s2, best->settled_s,
                     best->is_bang_bang() ? "bang-bang" : fmt::format("a jerk limit of {:.1f} m/s³", best->limits.jerk_m_per_s3));
}

Document jerk_sweep_document(const simulate::JerkSweep& sweep) {
  const double grip = simulate::grip_m_per_s2(sweep.robot);
  Document document{
      .headline = {{fmt::format("{}: {}.", sweep.robot.name, settling_words(sweep))}},
      .paragraphs = {fmt::format("{} on {}: simulated drives of 0.5, 1 and 2 m in eight directions, from rest to rest; means.",
                                 sweep.motor.id, sweep.robot.id)}};
  Table table{.columns = {{"acceleration", "m/s²", 0},
                          {"of grip", "%", 4},
                          {"jerk", "m/s³", 0},
                          {"planned", "s", 3},
                          {"settled", "s", 0},
                          {"slip", "mm/m", 1},
                          {"sliding", "mm/m", 5},
                          {"error", "mm", 2},
                          {"overshoot", "mm", 6},
                          {"peak", "A", 7},
                          {"copper", "J", 1}},
              .rows = {}};
  for (const simulate::StudyResult& each : sweep.results) {
    const double acceleration_m_per_s2 = each.limits.acceleration_m_per_s2;
    table.rows.push_back({{fmt::format("{:.1f}", acceleration_m_per_s2)},
                          {fmt::format("{:.0f}", 100.0 * acceleration_m_per_s2 / grip)},
                          {each.is_bang_bang() ? "bang-bang" : fmt::format("{:.1f}", each.limits.jerk_m_per_s3)},
                          {fmt::format("{:.2f}", each.planned_s)},
                          {fmt::format("{:.2f}", each.settled_s)},
                          {fmt::format("{:.1f}", 1e3 * each.slip_share)},
                          {fmt::format("{:.2f}", 1e3 * each.sliding_share)},
                          {fmt::format("{:.2f}", 1e3 * each.tracking_rms_m)},
                          {fmt::format("{:.2f}", 1e3 * each.overshoot_mean_m)},
                          {fmt::format("{:.1f}", each.peak_current_A)},
                          {fmt::format("{:.2f}", each.copper_J)}});
  }
  document.tables.push_back(std::move(table));
  document.add_note(Severity::background,
                    "Grip: the acceleration at which the first wheel slides if it transmits no other force. Contacts creep earlier, and "
                    "corrections of the drive core add to the force, so sliding begins somewhat below.");
  document.add_note(Severity::background,
                    "Slip and sliding: of a mean wheel per metre driven; error: distance between plan and robot, rms.");
  document.data = jerk_sweep_json(sweep);
  return document;
}

}  // namespace heatsoak::present
