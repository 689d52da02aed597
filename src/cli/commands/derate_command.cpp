#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/condition_option.h"
#include "cli/named_files.h"
#include "cli/quantity_option.h"
#include "cli/silent_effects.h"
#include "cli/verdict_words.h"
#include "derate/exporter.h"
#include "motor/conditions.h"
#include "motor/datasheet_network.h"

namespace heatsoak::commands {
namespace {

using Json = nlohmann::ordered_json;

struct Options {
  std::string motor;
  std::string model;
  std::string robot;
  std::string to = "c_header";
  std::string out;
  std::map<std::string, std::string> conditions;
  DerateOptions derate;
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

/// The model takes the motor's place; where both are named it must be a model of that motor.
Motor motor_of(const Options& options, NamedFiles& named) {
  if (options.motor.empty() && options.model.empty()) {
    throw Failure(ExitCode::bad_input, "which motor? Expected --motor M or --model FILE");
  }
  const std::optional<std::filesystem::path> file = options.motor.empty() ? std::nullopt : named.motor_file(options.motor);
  const std::optional<Motor> motor = named.motor(options.model.empty() ? options.motor : options.model);
  named.throw_if_any();
  if (file && !options.model.empty() && motor->id != file->stem() && (!motor->fit || motor->fit->motor != file->stem())) {
    throw Failure(ExitCode::bad_input, fmt::format("--model {} is no model of {}: it {}", options.model, file->stem().string(),
                                                   motor->fit ? fmt::format("was fitted from {}", motor->fit->motor)
                                                              : std::string("has another name and no [fit]")));
  }
  return under(*motor, options.conditions);
}

/// Allowed at moments of a use that goes on for long.
constexpr double kMoments_s[] = {1.0, 10.0, 60.0, 600.0};

double current_at_A(const UsePlayed& played, double time_s) {
  const auto found = std::ranges::lower_bound(played.time_s, time_s);
  return found == played.time_s.end() ? played.current_A.back() : played.current_A[static_cast<std::size_t>(found - played.time_s.begin())];
}

std::string table_text(const Derating& derating) {
  std::string text = "allowed while all of it is used, from a motor as warm as the air, A:\n  speed rad/s";
  for (const double time_s : kMoments_s) {
    text += fmt::format(" {:>9}", fmt::format("at {}", duration_text(time_s)));
  }
  text += "   lasting\n";
  for (const UsePlayed& played : derating.uses) {
    if (played.use.on_s > 0.0) {
      break;  // what is held in the plain case comes first
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
  text += own.empty() ? "" : fmt::format("effects of the file that act: {}\n", own);
  text += fmt::format(
      "heat counts {:.2f} times: of {} motors drawn from the declared tolerances {} passed a limit in one of the {} hardest uses ({:.1f} "
      "%; "
      "other draws: {:.1f} to {:.1f} %)\ntheir windings reached {:.0f} °C (median), {:.0f} °C (95th percentile), {:.0f} °C (the "
      "hottest)\n\n",
      derating.observer.heat_reserve_ratio(), checked.samples, checked.over, derating.uses.size(), 100.0 * checked.over / checked.samples,
      100.0 * checked.over_share.low, 100.0 * checked.over_share.high, checked.winding_p50_C, checked.winding_p95_C,
      checked.winding_most_C);
  text += table_text(derating);
  if (derating.rules.most_speed_rad_per_s < derating.reachable_speed_rad_per_s) {
    text += fmt::format("beyond {:.0f} of {:.0f} rad/s the motor may pass a limit without any current: none is allowed there\n",
                        derating.rules.most_speed_rad_per_s, derating.reachable_speed_rad_per_s);
  }
  std::string asked;
  for (std::size_t i = firmware::vehicle_speed; i < firmware::kSignalCount; ++i) {
    if (derating.observer.uses(static_cast<firmware::Signal>(i))) {
      asked += fmt::format("{}{}", asked.empty() ? "" : ", ", firmware::signals()[i].name);
    }
  }
  return text + (asked.empty() ? "" : fmt::format("besides current, speed and air the firmware is asked for {}\n", asked));
}

Json json(const Derating& derating, const Options& options) {
  const Guarantee& checked = derating.guarantee;
  const CurrentTable& table = derating.table;
  Json effects = Json::array();
  for (const ActingEffect& effect : derating.effects) {
    effects.push_back({{"id", effect.name}, {"type", effect.type}});
  }
  Json nodes = Json::array();
  for (const std::string& name : derating.observer.state_names()) {
    nodes.push_back(name);
  }
  Json current = Json::array();
  for (const double current_A : table.current_A) {
    current.push_back(rounded(current_A, 4));
  }
  return {
      {"schema", "heatsoak.derating/1"},
      {"motor", derating.motor_id},
      {"robot", derating.robot_id},
      {"data_quality", derating.data_quality},
      {"seed", options.derate.guarantee.seed},
      {"winding_limit_C", derating.rules.limits.winding_C},
      {"stator_limit_C", derating.rules.limits.stator_C ? Json(*derating.rules.limits.stator_C) : Json()},
      {"hottest_ambient_C", derating.rules.hottest_ambient_C},
      {"period_s", derating.options.period_s},
      {"approach_s", derating.options.approach_s},
      {"heat_reserve_ratio", rounded(derating.observer.heat_reserve_ratio(), 4)},
      {"conditions", derating.assumed},
      {"nodes", nodes},
      {"effects", effects},
      {"guarantee",
       {{"confidence", derating.options.guarantee.confidence},
        {"samples", checked.samples},
        {"over", checked.over},
        {"over_share_ci95", {rounded(checked.over_share.low, 4), rounded(checked.over_share.high, 4)}},
        {"winding_peak_C",
         {{"p50", rounded(checked.winding_p50_C, 2)},
          {"p95", rounded(checked.winding_p95_C, 2)},
          {"most", rounded(checked.winding_most_C, 2)}}}}},
      {"table",
       {{"speed_rad_per_s", table.speed_rad_per_s}, {"stator_C", table.stator_C}, {"winding_C", table.winding_C}, {"current_A", current}}}};
}

ExitCode run(const Options& options, Session& session) {
  const ExporterType& exporter = exporter_named(options.to);
  if (options.out == "-") {
    throw Failure(ExitCode::bad_input, "--out -: expected a file; /dev/stdout stands for the terminal");
  }
  if (options.derate.coldest_ambient_C >= options.derate.hottest_ambient_C) {
    throw Failure(ExitCode::bad_input, fmt::format("--coldest {:.4g} °C is not below --ambient {:.4g} °C", options.derate.coldest_ambient_C,
                                                   options.derate.hottest_ambient_C));
  }
  NamedFiles named(session.folders());
  const std::optional<Robot> robot = named.robot(options.robot);
  const Motor motor = motor_of(options, named);
  const Derating derating = derate(motor, *robot, options.derate, progress_bar("looking for the reserve"));
  session.write(options.out, exporter.write(derating));
  session.say(report(derating) + columns_at_their_hottest({&motor, 1}) + effects_under_conditions({&motor, 1}) +
              fmt::format("\n{}: {}\n", exporter.name, options.out));
  session.answer(json(derating, options));
  return ExitCode::done;
}

}  // namespace

Command derate_command() {
  return {
      .name = {},
      .summary = "How much current the firmware may still give: observer and derating table, checked on motors of every declared tolerance",
      .example = "heatsoak derate --motor maxon_ecx_flat_32l_48v --robot roboteam_twente_v2024 --to c_header --out motor_guard.h",
      .declare = [](CLI::App& app, Session& session) -> std::function<ExitCode()> {
        const auto options = std::make_shared<Options>();
        GuaranteeOptions& guarantee = options->derate.guarantee;
        app.add_option("--motor", options->motor, "id (see `heatsoak list motors`) or file")->type_name("M");
        app.add_option("--model", options->model, "a motor file that `calibrate` or `diagnose` wrote, in its place")
            ->type_name("FILE.toml");
        add_conditions(app, options->conditions);
        app.add_option("--robot", options->robot, "id (see `heatsoak list robots`) or file")->required()->type_name("R");
        app.add_option("--to", options->to, "form (see `heatsoak list formats`)")->capture_default_str()->type_name("FORM");
        app.add_option("--out", options->out, "file to write")->required()->type_name("FILE");
        add_quantity(app, "--ambient", options->derate.hottest_ambient_C,
                     {"ambient", "degC", Range::between(-40.0, 120.0), "hottest air at the motor; 40degC unless given"});
        add_quantity(app, "--coldest", options->derate.coldest_ambient_C,
                     {"coldest", "degC", Range::between(-60.0, 120.0),
                      "coldest air; a sensor that shows less is taken for broken; 0degC unless given"});
        add_quantity(app, "--period", options->derate.period_s,
                     {"period", "s", Range::between(1e-3, 1.0), "between two calls of the firmware; 10 ms unless given"});
        add_quantity(app, "--approach", options->derate.approach_s,
                     {"approach", "s", Range::between(0.01, 100.0),
                      "in which the winding may come near its limit: shorter lets peaks through for longer; 0.5 s unless given"});
        add_quantity(app, "--confidence", guarantee.confidence,
                     {"confidence", "", Range::between(0.5, 0.999), "share of motors that keep their limits; 0.95 unless given"});
        app.add_option("--samples", guarantee.samples, "motors drawn to find the reserve, and as many fresh ones to check it")
            ->check(whole_number(100'000))
            ->capture_default_str();
        add_seed(app, guarantee.seed, "of the draws; same seed, same bytes");
        app.add_option("--threads", guarantee.threads, "0: all cores; the result does not depend on it")
            ->check(whole_number(1024))
            ->capture_default_str();
        session.add_data_option(app);
        session.add_json_option(app);
        return [options, &session] { return run(*options, session); };
      }};
}

}  // namespace heatsoak::commands
