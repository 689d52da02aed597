#include "present/derating.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "base/quantity.h"
#include "base/version.h"
#include "derate/derating_json.h"
#include "derate/export_text.h"
#include "derate/exporter.h"
#include "derate/own_friction.h"
#include "derate/power_off.h"
#include "motor/datasheet_network.h"
#include "present/evaluation.h"
#include "present/motor_notes.h"
#include "present/robot_notes.h"
#include "present/verdict_words.h"

namespace heatsoak::present {
namespace {

/// Times at which the allowed current of a long use is printed.
constexpr double kMoments_s[] = {1.0, 10.0, 60.0, 600.0};

double current_at_A(const derate::UsePlayed& played, double time_s) {
  const auto found = std::ranges::lower_bound(played.time_s, time_s);
  return found == played.time_s.end() ? played.current_A.back() : played.current_A[static_cast<std::size_t>(found - played.time_s.begin())];
}

Table allowed_currents(const derate::Derating& derating) {
  Table table{.title = "Allowed current in A after a time of full use, beginning with a cold motor",
              .columns = {{"speed", "rad/s", 0}},
              .rows = {}};
  for (const double time_s : kMoments_s) {
    table.columns.push_back({fmt::format("at {}", duration_text(time_s)), "", 0});
  }
  table.columns.push_back({"continuous", "", 0});
  for (const derate::UsePlayed& played : derating.uses) {
    if (played.use.on_s > 0.0) {
      break;  // the plain case, a current held without pauses, comes first
    }
    std::vector<Text> row{{fmt::format("{:.0f}", played.use.speed_share * derating.rules.most_speed_rad_per_s)}};
    for (const double time_s : kMoments_s) {
      row.push_back({fmt::format("{:.2f}", current_at_A(played, time_s))});
    }
    row.push_back({fmt::format("{:.2f}", played.current_A.back())});
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// Adds the notes about the table: range, accuracy, and signals that the firmware must supply.
void add_table_notes(Document& document, const derate::Derating& derating) {
  if (derating.rules.most_speed_rad_per_s < derating.reachable_speed_rad_per_s) {
    document.add_note(
        Severity::warning,
        fmt::format("Above {:.0f} of {:.0f} rad/s the motor may exceed a limit even without current: the allowed current falls to 0 A at "
                    "{:.0f} rad/s.",
                    derating.rules.most_speed_rad_per_s, derating.reachable_speed_rad_per_s, derating.table.no_current_speed_rad_per_s));
  }
  std::vector<std::string_view> asked;
  for (std::size_t i = 0; i < derate::observed::kSignalCount; ++i) {
    const bool is_searched = derate::observed::signals()[i].worst == thermal::WorstCase::searched;
    if (is_searched && derating.observer.uses(static_cast<derate::observed::Signal>(i))) {
      asked.push_back(derate::observed::signals()[i].name);
    }
  }
  if (!asked.empty()) {
    document.add_note(Severity::warning,
                      fmt::format("Besides current, speed and air temperature the firmware must supply {}.", fmt::join(asked, ", ")));
  }
  if (!limit_range_words(derating).empty()) {
    document.add_note(
        Severity::note,
        fmt::format("The file gives the winding limit as a range around {:.0f} °C. Its lower end counts here, because the true "
                    "limit is unknown.",
                    derating.nominal.winding_limit_C));
  }
  const derate::TableBound& bound = derating.table.bound;
  const derate::TableGoal& goal = derating.options.table;
  if (bound.shortfall_ratio > goal.shortfall_ratio) {
    document.add_note(
        Severity::note,
        fmt::format("Some current is lost: the table is up to {} % below the exact answer, more than the {} % of --error. {}",
                    derate::significant_above(100.0 * bound.shortfall_ratio, 2), base::significant(100.0 * goal.shortfall_ratio, 2),
                    bound.is_limited_by_size
                        ? "A larger --size lowers the loss."
                        : "More grid points do not help: the exact answer has an edge between them. A larger --error saves memory."));
  }
  document.add_note(
      Severity::background,
      fmt::format("Table: {} bytes. Its current never exceeds the exact answer of the network. It is at most {} % lower, from {} A up. "
                  "It changes by at most {} A per K of the winding, {} A per K of the stator and {} A per rad/s.",
                  derating.table.size_bytes(), derate::significant_above(100.0 * bound.shortfall_ratio, 2),
                  base::significant(derating.table.straight_below_A, 2), derate::significant_above(bound.winding_slope_A_per_K, 2),
                  derate::significant_above(bound.stator_slope_A_per_K, 2), derate::significant_above(bound.speed_slope_A_s_per_rad, 2)));
}

/// Adds the allowed currents after a loss of power, and a warning if the current for an unknown speed does not suffice to turn the motor.
void add_power_off_and_friction(Document& document, const derate::Derating& derating) {
  std::vector<std::string> cases;
  for (const derate::PowerOffCase& each : derate::power_off_report(derating).cases) {
    cases.push_back(fmt::format("{:.1f} A ({})", fmt::join(each.allowed_A, ", "), each.name));
  }
  document.add_note(
      Severity::background,
      fmt::format("After a loss of power a guard that saves and restores its state allows at standstill, {:.0f} s after power-on: "
                  "{}. The motor was as hot as continuous use permits.",
                  fmt::join(derate::kPowerOffMoments_s, ", "), fmt::join(cases, "; ")));
  const std::optional<derate::OwnFriction> friction = derate::own_friction(derating);
  if (const double limp_A = derate::limp_current_A(derating); friction && limp_A < friction->needed_A) {
    document.add_note(
        Severity::warning,
        fmt::format("A wheel whose speed is unknown stops: the guard then allows {:.2f} A, and the no-load current is {:.2f} A. "
                    "If the speed is known, the allowed current suffices up to {:.0f} rad/s; only a push turns the motor faster.",
                    limp_A, friction->needed_A, friction->held_rad_per_s));
  }
}

/// Adds the benefit and the possible faults of the sensor, if there is one.
void add_sensor(Document& document, const derate::Derating& derating) {
  if (!derating.sensor) {
    return;
  }
  const derate::SensorPlan& plan = *derating.sensor;
  document.paragraphs.push_back(
      fmt::format("With {} at the {}, error up to {:.3g} K{}: safety factor on heat {:.2f} (without {:.2f}). {} Each sensor reads too "
                  "little by its whole error; the windings reached {:.0f} °C (95th percentile), {:.0f} °C (the hottest). The cross-check "
                  "drops the correct sensor "
                  "of {}.",
                  plan.resistance ? "the resistance from voltage and current" : "a thermistor",
                  plan.observer.state_names()[static_cast<std::size_t>(plan.options.node)], plan.options.accuracy_K,
                  plan.options.lag_s > 0.0 ? fmt::format(", lag {:.3g} s", plan.options.lag_s) : "", plan.observer.heat_safety_factor(),
                  derating.observer.heat_safety_factor(), derate::confidence_text(derating, plan.guarantee), plan.guarantee.winding_p95_C,
                  plan.guarantee.winding_most_C, plan.dropped));
  document.add_note(Severity::warning,
                    fmt::format("With a plausible but wrong sensor the guard allows at most {:.2f} A more than without a sensor: the "
                                "nominal motor then reaches {:.0f} °C ({:.0f} °C from a warm start), and {} of {} drawn motors exceed a "
                                "limit.",
                                plan.most_gain_A, plan.sensor_fault_nominal_C, plan.sensor_fault_warm_C, plan.sensor_fault_over,
                                derating.options.guarantee.samples));
  if (!plan.resistance) {
    document.add_note(Severity::warning,
                      "Measure the air temperature at the motor as well: without it the guard does not notice a thermistor that fell off, "
                      "or one that is stuck near the air temperature.");
  } else {
    document.add_note(Severity::note, fmt::format("Readings need {:.2f} A at rest and {:.3f} A more per rad/s.",
                                                  plan.resistance->least_current_A, plan.resistance->current_per_speed_A_s_per_rad));
  }
  Table table{.title = "Continuous current of the nominal motor in A",
              .columns = {{"speed", "rad/s", 0}, {"without sensor", "", 0}, {"with sensor", "", 0}},
              .rows = {}};
  for (const derate::LastingCurrent& each : plan.lasting) {
    table.rows.push_back(
        {{fmt::format("{:.0f}", each.speed_rad_per_s)}, {fmt::format("{:.2f}", each.without_A)}, {fmt::format("{:.2f}", each.with_A)}});
  }
  document.tables.push_back(std::move(table));
}

std::string place_text(const derate::TablePlace& place) {
  return fmt::format("at {:.0f} rad/s, stator {:.1f} °C, winding {:.1f} °C: {:.3f} A, a fresh table {:.3f} A", place.speed_rad_per_s,
                     place.stator_C, place.winding_C, place.committed_A, place.fresh_A);
}

std::string holding_words() { return fmt::format("still holds: no current is above a fresh table by more than {}", derate::kIgnored); }

/// Lists the lines that explain the difference best.
void add_differing_lines(Document& document, const std::vector<derate::HeaderDifference>& differing) {
  constexpr std::size_t kMostShown = 5;
  document.add_note(Severity::warning, "Unsafe: the observer differs from that of a fresh header, so the table has another meaning.");
  Table table{.title = differing.size() > kMostShown
                           ? fmt::format("Differing lines, {} of {}; laws and limits first", kMostShown, differing.size())
                           : "Differing lines; laws and limits first",
              .columns = {{"line", "", 0},
                          {"committed header", "", 0, Alignment::left},
                          {.name = "fresh header", .alignment = Alignment::left, .is_prose = true}},
              .rows = {}};
  for (const derate::HeaderDifference& each : std::span(differing).first(std::min(kMostShown, differing.size()))) {
    table.rows.push_back({{std::to_string(each.line)}, {each.text}, {each.other_text}});
  }
  document.tables.insert(document.tables.begin(), std::move(table));
}

/// Returns in one line why a committed table must not be used any more.
std::string broken_words(const derate::TableCheck& check) {
  const derate::TableComparison& found = check.found;
  const std::string why = found.is_other_motor ? fmt::format("it is for another motor, {}", check.committed.motor_id)
                          : found.excess.difference_A > 0.0
                              ? fmt::format("it allows up to {:.3f} A more than a fresh table", found.excess.difference_A)
                              : fmt::format("its observer differs from a fresh one in {} {}, the first in line {}: \"{}\", fresh \"{}\"",
                                            found.differing.size(), found.differing.size() == 1 ? "place" : "places",
                                            found.differing.front().line, found.differing.front().text, found.differing.front().other_text);
  return fmt::format("no longer holds: {}; write it again with --out", why);
}

Document document_of(const derate::Derating& derating, const motor::Motor& motor) {
  const derate::Guarantee& checked = derating.guarantee;
  Document document{
      .headline =
          {{fmt::format("{} in {}: {} keep the winding below {:.0f} °C{}{} in air of {:.0f} °C.", derating.motor_id, derating.robot_id,
                        derate::promised_share_text(derating), derating.rules.limits.winding_C, limit_range_words(derating),
                        derating.rules.limits.stator_C ? fmt::format(", the stator below {:.0f} °C", *derating.rules.limits.stator_C) : "",
                        derating.rules.hottest_ambient_C)},
           {fmt::format("The {} hottest load patterns were simulated, with {} thermal data.", derating.uses.size(), derating.data_quality)},
           {fmt::format("Safety factor on heat {:.2f}; current {:.1f} A for a cold motor, {:.2f} A continuous.",
                        derating.observer.heat_safety_factor(),
                        derating.table.allowed_A(0.0, derating.rules.hottest_ambient_C, derating.rules.hottest_ambient_C),
                        derate::limp_current_A(derating))}},
      .paragraphs = {fmt::format("Confidence {:.6g}: {} in the {} hottest load patterns. This confidence needs at least {} draws.",
                                 derating.options.guarantee.required_share, derate::drawn_motors_text(checked), derating.uses.size(),
                                 derate::least_samples(derating.options.guarantee)),
                     fmt::format("The windings of the {} drawn motors reached {:.0f} °C (median), {:.0f} °C (95th percentile), {:.0f} °C "
                                 "(the hottest).",
                                 checked.samples, checked.winding_p50_C, checked.winding_p95_C, checked.winding_most_C)}};
  std::vector<std::string> own;
  for (const derate::ActingEffect& effect : derating.effects) {
    if (std::ranges::find(motor::kDatasheetEffects, effect.name) == motor::kDatasheetEffects.end()) {
      own.push_back(effect.name == effect.type ? effect.name : fmt::format("{} ({})", effect.name, effect.type));
    }
  }
  if (!own.empty()) {
    document.paragraphs.push_back(fmt::format("Active effects of the file: {}.", fmt::join(own, ", ")));
  }
  document.tables.push_back(allowed_currents(derating));
  add_table_notes(document, derating);
  add_power_off_and_friction(document, derating);
  add_sensor(document, derating);
  add_lines(document.notes, value_warnings({&motor, 1}), Severity::warning);
  add_lines(document.notes, default_spreads_text({&motor, 1}), Severity::note);
  add_lines(document.notes, columns_at_their_hottest({&motor, 1}) + effects_under_conditions({&motor, 1}), Severity::note);
  return document;
}

/// Adds what changed since the file was written.
void add_table_check(Document& document, const derate::Derating& derating, const derate::TableCheck& check) {
  const derate::TableComparison& found = check.found;
  document.headline.insert(document.headline.begin(), {fmt::format("{}: {}", check.committed.file.string(),
                                                                   check.found.holds() ? holding_words() : broken_words(check)),
                                                       check.found.holds() ? Tone::good : Tone::bad});
  if (found.is_other_motor) {
    document.add_note(Severity::warning, fmt::format("Unsafe: the table is for another motor, {}; expected a table for {}.",
                                                     check.committed.motor_id, derating.motor_id));
  }
  if (found.excess.difference_A > 0.0) {
    document.add_note(Severity::warning, fmt::format("Unsafe: the table allows up to {:.3f} A more than a fresh table, {}.",
                                                     found.excess.difference_A, place_text(found.excess)));
  }
  if (!found.differing.empty()) {
    add_differing_lines(document, found.differing);
  }
  if (found.lost.difference_A > 0.0) {
    document.add_note(Severity::note,
                      fmt::format("{} the table allows up to {:.3f} A less than a fresh table, {}.",
                                  check.found.holds() ? "Safe, but" : "At other places", found.lost.difference_A, place_text(found.lost)));
  }
  if (!check.committed.robot_id.empty() && check.committed.robot_id != derating.robot_id) {
    document.add_note(Severity::note,
                      fmt::format("The table was written for the robot {}, this is {}.", check.committed.robot_id, derating.robot_id));
  }
  if (!found.holds() && !found.other_version.empty()) {
    document.add_note(Severity::note, fmt::format("The table was {}.", upgrade_words(found.other_version)));
  }
}

}  // namespace

std::string upgrade_words(const std::string& other_version) {
  return fmt::format("written by heatsoak {}, this program is {}: an upgrade may explain the difference", other_version,
                     base::program_version());
}

std::string limit_range_words(const derate::Derating& derating) {
  return derating.rules.limits.winding_C < derating.nominal.winding_limit_C
             ? fmt::format(" (lower end of the limit's range around {:.0f} °C)", derating.nominal.winding_limit_C)
             : "";
}

std::string words_of(const derate::SensorDifference& difference) {
  using Kind = derate::SensorDifference::Kind;
  switch (difference.kind) {
    case Kind::options_unstated:
      return "the header has a temperature sensor and does not state its options; generate the header again";
    case Kind::sensor_unexpected:
      return fmt::format("the header has a temperature sensor; expected the options that it was generated with: {}",
                         difference.header_flags);
    case Kind::sensor_missing:
      return "the header has no temperature sensor; leave out the options of the sensor, or generate the header again with them";
    case Kind::other_options:
      break;
  }
  std::string options;
  for (const derate::SensorDifference::Option& each : difference.options) {
    options += each.expected_value ? fmt::format(" {} {}, not {};", each.name, each.value, *each.expected_value)
                                   : fmt::format(" {} {}, which is missing;", each.name, each.value);
  }
  return fmt::format("the header was generated with{} use its options or generate the header again", options);
}

Document derating_document(const derate::DeratingJob& job, const derate::DeratingAnswer& answer, const std::string& out) {
  Document document = document_of(answer.derating, job.motor);
  if (const derate::ExporterType* const expected = job.exporter ? derate::expected_by_name(*job.exporter, out) : nullptr) {
    document.add_note(
        Severity::warning,
        fmt::format("{} may be read wrongly: its name is that of a {} file, but its format is {}; rename it, or leave out --to", out,
                    expected->name, job.exporter->name));
  }
  if (job.exporter && job.exporter->omitted) {
    const derate::OmittedHeat heat = job.exporter->omitted(answer.derating);
    document.headline.push_back(
        {fmt::format("The winding in the {} file may be too cold: the format has no heat capacity of the stator and no no-load loss, which "
                     "warms a winding at its limit by {:.1f} K at {:.0f} rad/s. The rise that the file states as its limit allows for the "
                     "loss.",
                     job.exporter->name, heat.rise_K, heat.speed_rad_per_s),
         Tone::bad});
  }
  add_robot_notes(document, job.robot);
  document.data = derate::derating_json(answer.derating);
  if (answer.check) {
    add_table_check(document, answer.derating, *answer.check);
    document.data["check"] = table_check_json(*answer.check);
  }
  add_notes(document.data, document.notes);
  return document;
}

}  // namespace heatsoak::present
