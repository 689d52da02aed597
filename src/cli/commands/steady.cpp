#include "present/steady.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/quantity.h"
#include "cli/command.h"
#include "cli/condition_option.h"
#include "cli/named_files.h"
#include "cli/quantity_option.h"
#include "motor/conditions.h"
#include "motor/datasheet_network.h"
#include "motor/motor.h"
#include "present/evaluation.h"
#include "present/motor_notes.h"
#include "thermal/periodic_state.h"
#include "thermal/steady_state.h"

namespace heatsoak::commands {
namespace {

struct Options {
  std::string motor;
  std::map<std::string, std::string> conditions;
  OnOffCurrent current;
};

/// Returns the cycle of an on/off or constant current at standstill, so that only copper loss heats the motor, as in the equations.
std::vector<Interval> cycle_of(const OnOffCurrent& current) {
  OperatingPoint<double> on;
  on.current_rms_A = current.current_on_A;
  on.ambient_C = current.ambient_C;
  OperatingPoint<double> off;
  off.ambient_C = current.ambient_C;
  return {{current.time_on_s, on}, {current.time_off_s, off}};
}

/// Returns the result of the closed-form equations. If the motor's file adds effects, returns the steady state of the network under the RMS
/// current instead.
OnOffSteadyState rest_under_rms(const MotorValues& values, const Network& network, bool is_bare, const OnOffCurrent& current) {
  OnOffSteadyState state =
      on_off_steady_state({.terminal_resistance_25C_ohm = values.terminal_resistance_ohm,
                           .temperature_coefficient_per_K = values.temperature_coefficient_per_K,
                           .thermal_resistance_winding_stator_K_per_W = values.thermal_resistance_winding_stator_K_per_W,
                           .thermal_resistance_stator_ambient_K_per_W = values.thermal_resistance_stator_ambient_K_per_W},
                          current);
  if (!is_bare) {
    OnOffCurrent constant = current;
    constant.current_on_A = state.current_rms_A;
    constant.time_off_s = 0.0;
    const PeriodicState rest = periodic_state(network, cycle_of(constant));
    state.runaway = rest.runaway;
    if (!rest.runaway) {
      state.winding_C = rest.mean_C[states::winding];
      state.stator_C = rest.mean_C[states::stator];
    }
  }
  return state;
}

ExitCode run(const Options& options, Session& session) {
  NamedFiles named(session.folders());
  const std::optional<Motor> read = named.motor(options.motor);
  named.throw_if_any();
  const Motor motor = under(*read, options.conditions);
  const MotorValues& values = motor.nominal;
  const Network network = datasheet_network(motor, nominal_sample(motor));
  const bool is_bare = network.effects().size() == kDatasheetEffects.size();
  const OnOffSteadyState rms = rest_under_rms(values, network, is_bare, options.current);
  PeriodicState periodic = periodic_state(network, cycle_of(options.current));
  periodic.runaway = periodic.runaway || (is_bare && rms.runaway);
  const bool runaway = periodic.runaway;
  const bool over = runaway || !(periodic.peak_C[states::winding] <= values.winding_limit_C);
  present::Document document = present::steady_document({motor, periodic, rms, is_bare, options.current.ambient_C, over});
  present::add_motor_notes(document, {&motor, 1});
  session.show(document);
  using Json = nlohmann::ordered_json;
  const auto rest = [&](double value_C) { return runaway || rms.runaway ? Json() : Json(value_C); };
  const auto of_winding = [&](const std::vector<double>& value_C) { return runaway ? Json() : Json(value_C[states::winding]); };
  session.answer({{"schema", "heatsoak.steady/1"},
                  {"motor", motor.id},
                  {"conditions", motor.assumed},
                  {"ambient_C", options.current.ambient_C},
                  {"current_rms_A", rms.current_rms_A},
                  {"winding_C", rest(rms.winding_C)},
                  {"stator_C", rest(rms.stator_C)},
                  {"winding_mean_C", of_winding(periodic.mean_C)},
                  {"stator_mean_C", runaway ? Json() : Json(periodic.mean_C[states::stator])},
                  {"winding_peak_C", of_winding(periodic.peak_C)},
                  {"winding_limit_C", values.winding_limit_C},
                  {"destroyed_after_s", periodic.destroyed_s ? Json(*periodic.destroyed_s) : Json()},
                  {"runaway", runaway}});
  return over ? ExitCode::limit_exceeded : ExitCode::done;
}

}  // namespace

Command steady() {
  return {
      .name = {},
      .summary =
          "Temperatures in the steady state of an on/off current, mean and highest; and equations (8) to (12) of the RoboTeam Twente paper "
          "(copper loss only)",
      .example = "heatsoak steady --motor maxon_ec45_flat_70w_24v --current-on 6A --time-on 4s --time-off 6s --ambient 25degC",
      .declare = [](CLI::App& app, Session& session) -> std::function<ExitCode()> {
        const auto options = std::make_shared<Options>();
        app.add_option("--motor", options->motor, "id (see `heatsoak list motors`) or file")->required()->type_name("M");
        add_conditions(app, options->conditions);
        add_quantity(app, "--current-on", options->current.current_on_A, {"current-on", "A", Range::between(0.0, 1e5), "current while on"})
            ->required();
        add_quantity(app, "--time-on", options->current.time_on_s,
                     {"time-on", "s", Range::between(1e-9, 1e9), "time of a cycle with current"})
            ->required();
        add_quantity(app, "--time-off", options->current.time_off_s,
                     {"time-off", "s", Range::between(0.0, 1e9), "time of a cycle without current"})
            ->required();
        add_quantity(app, "--ambient", options->current.ambient_C,
                     {"ambient", "degC", Range::between(-60.0, 200.0), "temperature of the air; 25degC unless given"});
        session.add_data_option(app);
        session.add_answer_options(app);
        return [options, &session] { return run(*options, session); };
      }};
}

}  // namespace heatsoak::commands
