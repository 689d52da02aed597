#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/version.h"
#include "cli/command.h"
#include "cli/default_spreads.h"
#include "cli/guard_options.h"
#include "cli/inactive_effects.h"
#include "cli/named_files.h"
#include "cli/quantity_option.h"
#include "cli/sensor_options.h"
#include "derate/committed_table.h"
#include "derate/derating_json.h"
#include "derate/export_text.h"
#include "derate/exporter.h"
#include "motor/datasheet_network.h"
#include "present/verdict_words.h"

namespace heatsoak::commands {
namespace {

using Json = nlohmann::ordered_json;

struct Options {
  GuardOptions guard;
  std::string robot;
  std::string to = "c_header";
  std::string out;
  std::string committed;  ///< file of --check
  std::string compiler;   ///< C compiler for the binary of an FMU; empty: the FMU contains only sources
  SensorFlags sensor;
};

const ExporterType& exporter_named(const std::string& name) {
  std::vector<std::string> names;
  std::string expected;
  for (const ExporterType& each : all_exporters()) {
    if (each.name == name) {
      return each;
    }
    names.emplace_back(each.name);
    expected += fmt::format("{}{}", expected.empty() ? "" : ", ", each.name);
  }
  throw Failure(ExitCode::bad_input, fmt::format("--to {}: expected one of {}{}", name, expected, did_you_mean(name, names)));
}

/// Times at which the allowed current of a long use is printed.
constexpr double kMoments_s[] = {1.0, 10.0, 60.0, 600.0};

double current_at_A(const UsePlayed& played, double time_s) {
  const auto found = std::ranges::lower_bound(played.time_s, time_s);
  return found == played.time_s.end() ? played.current_A.back() : played.current_A[static_cast<std::size_t>(found - played.time_s.begin())];
}

std::string table_text(const Derating& derating) {
  std::string text = "allowed current in A over time if it is always fully used, from a start at air temperature:\n  speed rad/s";
  for (const double time_s : kMoments_s) {
    text += fmt::format(" {:>9}", fmt::format("at {}", duration_text(time_s)));
  }
  text += "   lasting\n";
  for (const UsePlayed& played : derating.uses) {
    if (played.use.on_s > 0.0) {
      break;  // the plain case, a current held without pauses, comes first
    }
    text += fmt::format("  {:11.0f}", played.use.speed_share * derating.rules.most_speed_rad_per_s);
    for (const double time_s : kMoments_s) {
      text += fmt::format(" {:9.2f}", current_at_A(played, time_s));
    }
    text += fmt::format(" {:9.2f}\n", played.current_A.back());
  }
  return text;
}

std::string report(const Derating& derating) {
  const Guarantee& checked = derating.guarantee;
  std::string text =
      fmt::format("{} in {}: winding below {:.0f} °C{} in air of {:.0f} °C, {} thermal data\n", derating.motor_id, derating.robot_id,
                  derating.rules.limits.winding_C,
                  derating.rules.limits.stator_C ? fmt::format(", stator below {:.0f} °C", *derating.rules.limits.stator_C) : "",
                  derating.rules.hottest_ambient_C, derating.data_quality);
  std::string own;
  for (const ActingEffect& effect : derating.effects) {
    if (std::ranges::find(kDatasheetEffects, effect.name) == kDatasheetEffects.end()) {
      own += fmt::format("{}{}", own.empty() ? "" : ", ",
                         effect.name == effect.type ? effect.name : fmt::format("{} ({})", effect.name, effect.type));
    }
  }
  text += own.empty() ? "" : fmt::format("active effects of the file: {}\n", own);
  text += fmt::format(
      "safety factor on heat {:.2f}. {} (at least {} draws are needed for this)\n"
      "the windings of the {} drawn motors reached {:.0f} °C (median), {:.0f} °C (95th percentile), {:.0f} °C (the hottest)\n\n",
      derating.observer.heat_safety_factor(), confidence_text(derating), least_samples(derating.options.guarantee), checked.samples,
      checked.winding_p50_C, checked.winding_p95_C, checked.winding_most_C);
  text += table_text(derating);
  if (derating.rules.most_speed_rad_per_s < derating.reachable_speed_rad_per_s) {
    text += fmt::format(
        "above {:.0f} of {:.0f} rad/s the motor may exceed a limit even without current: the allowed current falls to 0 A at {:.0f} "
        "rad/s\n",
        derating.rules.most_speed_rad_per_s, derating.reachable_speed_rad_per_s, derating.table.no_current_speed_rad_per_s);
  }
  const TableBound& bound = derating.table.bound;
  text += fmt::format(
      "table: {} bytes, never above the exact answer of the network and at most {:.1f} % below it from {:.2g} A up; it changes by at most "
      "{:.2g} A per K of the winding, {:.2g} A per K of the stator and {:.2g} A per rad/s\n",
      derating.table.size_bytes(), 100.0 * bound.shortfall_ratio, derating.table.straight_below_A, bound.winding_slope_A_per_K,
      bound.stator_slope_A_per_K, bound.speed_slope_A_s_per_rad);
  std::string asked;
  for (std::size_t i = firmware::vehicle_speed; i < firmware::kSignalCount; ++i) {
    if (derating.observer.uses(static_cast<firmware::Signal>(i))) {
      asked += fmt::format("{}{}", asked.empty() ? "" : ", ", firmware::signals()[i].name);
    }
  }
  return text + (asked.empty() ? "" : fmt::format("besides current, speed and air temperature the firmware must supply {}\n", asked));
}

std::string place_text(const TablePlace& place) {
  return fmt::format("  at {:.0f} rad/s, stator {:.1f} °C, winding {:.1f} °C: {:.3f} A, a fresh table {:.3f} A\n", place.speed_rad_per_s,
                     place.stator_C, place.winding_C, place.committed_A, place.fresh_A);
}

Json json(const TablePlace& place) {
  return {{"difference_A", rounded(place.difference_A, 4)}, {"committed_A", rounded(place.committed_A, 4)},
          {"fresh_A", rounded(place.fresh_A, 4)},           {"speed_rad_per_s", rounded(place.speed_rad_per_s, 3)},
          {"stator_C", rounded(place.stator_C, 2)},         {"winding_C", rounded(place.winding_C, 2)}};
}

/// Describes what changed since the file was written: unsafe changes first, then the others.
std::string comparison_text(const CommittedTable& committed, const Derating& derating, const TableComparison& found, bool is_other_motor,
                            bool holds) {
  std::string text =
      fmt::format("\n{}: {}\n", committed.file.string(), holds ? "still holds" : "no longer holds; write it again with --out");
  if (is_other_motor) {
    text += fmt::format("unsafe: it is the table of another motor, {}; expected one of {}\n", committed.motor_id, derating.motor_id);
  }
  if (found.excess.difference_A > 0.0) {
    text += fmt::format("unsafe: it allows up to {:.3f} A more than a fresh table\n", found.excess.difference_A) + place_text(found.excess);
  }
  if (found.differing_line > 0) {
    text += fmt::format(
        "unsafe: its observer differs from that of a fresh header, so the table has another meaning\n  line {}: {}\n  fresh:  {}\n",
        found.differing_line, found.differing_text, found.differing_fresh_text);
  }
  if (found.lost.difference_A > 0.0) {
    text += fmt::format("{} it allows up to {:.3f} A less than a fresh table\n", holds ? "safe, but" : "at other places",
                        found.lost.difference_A) +
            place_text(found.lost);
  }
  if (!committed.robot_id.empty() && committed.robot_id != derating.robot_id) {
    text += fmt::format("it was written for the robot {}, this is {}\n", committed.robot_id, derating.robot_id);
  }
  if (!holds && !committed.version.empty() && committed.version != program_version()) {
    text += fmt::format("it was written by heatsoak {}, this is {}: an upgrade may explain the difference\n", committed.version,
                        program_version());
  }
  return text;
}

ExitCode report_comparison(const CommittedTable& committed, const Derating& derating, Session& session, Json& answer) {
  const TableComparison found = compare(committed, derating);
  const bool is_other_motor = !committed.motor_id.empty() && committed.motor_id != derating.motor_id;
  const bool holds = !is_other_motor && found.excess.difference_A == 0.0 && found.differing_line == 0;
  session.say(comparison_text(committed, derating, found, is_other_motor, holds));
  answer["check"] = {{"file", committed.file.string()},
                     {"motor", committed.motor_id.empty() ? Json() : Json(committed.motor_id)},
                     {"robot", committed.robot_id.empty() ? Json() : Json(committed.robot_id)},
                     {"written_by", committed.version.empty() ? Json() : Json(committed.version)},
                     {"holds", holds},
                     {"excess", json(found.excess)},
                     {"lost", json(found.lost)},
                     {"differing_line", found.differing_line > 0 ? Json(found.differing_line) : Json()}};
  return holds ? ExitCode::done : ExitCode::limit_exceeded;
}

ExitCode run(const Options& options, Session& session) {
  const ExporterType& exporter = exporter_named(options.to);
  DerateOptions derate_options = options.guard.derate;
  derate_options.sensor = sensor_options(options.sensor);
  if (derate_options.sensor && exporter.name != "c_header" && exporter.name != "json") {
    throw Failure(ExitCode::bad_input,
                  fmt::format("--to {} does not support a sensor: expected --to c_header or json, or no sensor", exporter.name));
  }
  if (options.out.empty() && options.committed.empty()) {
    throw Failure(ExitCode::bad_input, "expected --out FILE to write, or --check FILE to compare with");
  }
  if (options.out == "-") {
    throw Failure(ExitCode::bad_input, "--out -: expected a file; /dev/stdout stands for the terminal");
  }
  if (!options.compiler.empty() && exporter.write_compiled == nullptr) {
    throw Failure(
        ExitCode::bad_input,
        fmt::format("--compiler: {} has no binary; expected --to fmi2_motor, fmi2_guard, fmi3_motor or fmi3_guard", exporter.name));
  }
  check_derate_options(options.guard.derate);
  NamedFiles named(session.folders());
  const std::optional<Robot> robot = named.robot(options.robot);
  const Motor motor = guarded_motor(options.guard, named);
  // Read first, so that an invalid file is reported before the computation.
  const std::optional<CommittedTable> committed =
      options.committed.empty() ? std::nullopt : std::optional(read_committed_table(options.committed));
  Derating derating = derate(motor, *robot, derate_options, progress_bar("searching the safety factor on heat"));
  derating.provenance = provenance_of(motor, *robot, derate_options);
  session.say(report(derating) + sensor_text(derating) + default_spreads_text({&motor, 1}) + columns_at_their_hottest({&motor, 1}) +
              effects_under_conditions({&motor, 1}));
  if (!options.out.empty()) {
    session.write(options.out, options.compiler.empty() ? exporter.write(derating) : exporter.write_compiled(derating, options.compiler));
    session.say(fmt::format("\n{}: {}\n", exporter.name, options.out));
  }
  Json answer = derating_json(derating);
  const ExitCode code = committed ? report_comparison(*committed, derating, session, answer) : ExitCode::done;
  session.answer(answer);
  return code;
}

}  // namespace

Command derate_command() {
  return {.name = {},
          .summary =
              "Writes how much current the firmware may allow: observer and derating table, checked on motors of every declared tolerance",
          .example = "heatsoak derate --motor maxon_ecx_flat_32l_48v --robot roboteam_twente_v2024 --to c_header --out motor_guard.h",
          .declare = [](CLI::App& app, Session& session) -> std::function<ExitCode()> {
            const auto options = std::make_shared<Options>();
            add_motor_options(app, options->guard);
            app.add_option("--robot", options->robot, "id (see `heatsoak list robots`) or file")->required()->type_name("R");
            app.add_option("--to", options->to, "output format (see `heatsoak list formats`)")->capture_default_str()->type_name("FORM");
            app.add_option("--out", options->out, "file to write")->type_name("FILE");
            app.add_option("--compiler", options->compiler,
                           "C compiler, such as cc: adds a binary for this machine to an FMU, which otherwise contains only its sources")
                ->type_name("CC");
            app.add_option(
                   "--check", options->committed,
                   "a C header or CSV table that was written earlier, with the same options: exit 1 if it allows more than a fresh one")
                ->type_name("FILE");
            add_quantity(app, "--period", options->guard.derate.period_s,
                         {"period", "s", Range::between(1e-3, 1.0), "between two calls of the firmware; 10 ms unless given"});
            add_derate_options(app, options->guard.derate);
            add_sensor_options(app, options->sensor);
            session.add_data_option(app);
            session.add_json_option(app);
            return [options, &session] { return run(*options, session); };
          }};
}

}  // namespace heatsoak::commands
