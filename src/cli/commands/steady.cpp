#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/quantity.h"
#include "cli/command.h"
#include "cli/named_files.h"
#include "cli/quantity_option.h"
#include "motor/datasheet_network.h"
#include "motor/motor.h"
#include "thermal/steady_state.h"
#include "thermal/transient.h"

namespace heatsoak::commands {
namespace {

struct Options {
  std::string motor;
  OnOffCurrent current;
};

/// The highest temperature of the winding in a cycle, once all cycles are alike: (8) to (12) are means over one.
double cycle_peak_C(const Motor& motor, const OnOffCurrent& current, const OnOffSteadyState& mean) {
  // At standstill, so that only copper loss heats, as in the equations.
  const Network network = datasheet_network(motor, nominal_sample(motor));
  OperatingPoint<double> on;
  on.current_rms_A = current.current_on_A;
  on.ambient_C = current.ambient_C;
  OperatingPoint<double> off;
  off.ambient_C = current.ambient_C;
  const std::vector<Interval> cycle{{current.time_on_s, on}, {std::max(current.time_off_s, 1e-9), off}};
  TransientOptions options;
  options.start_C = {mean.winding_C, mean.stator_C};
  constexpr int kMostCycles = 200;
  constexpr double kAlike_K = 0.01;
  double peak_C = mean.winding_C;
  for (int i = 0; i < kMostCycles; ++i) {
    const TransientResult result = run_transient(network, network.values(), cycle, options);
    const double change_K = std::abs(result.peak_C.front() - std::exchange(peak_C, result.peak_C.front()));
    options.start_C = result.end_C;
    if (result.destroyed || (i > 0 && change_K < kAlike_K)) {
      break;
    }
  }
  return peak_C;
}

ExitCode run(const Options& options, Session& session) {
  const Motor motor = motor_named(session.folders(), options.motor);
  const MotorValues& values = motor.nominal;
  const OnOffSteadyState state =
      on_off_steady_state({.terminal_resistance_25C_ohm = values.terminal_resistance_ohm,
                           .temperature_coefficient_per_K = values.temperature_coefficient_per_K,
                           .thermal_resistance_winding_stator_K_per_W = values.thermal_resistance_winding_stator_K_per_W,
                           .thermal_resistance_stator_ambient_K_per_W = values.thermal_resistance_stator_ambient_K_per_W},
                          options.current);
  const double peak_C = state.runaway ? 0.0 : cycle_peak_C(motor, options.current, state);
  const bool over = state.runaway || peak_C > values.winding_limit_C;
  std::string text = fmt::format("{} ({} thermal data), rms current {:.2f} A, ambient {:.0f} °C\n", motor.id, data_quality(motor),
                                 state.current_rms_A, options.current.ambient_C);
  if (state.runaway) {
    text += "thermal runaway: there is no steady state, the winding's loss grows faster than heat can leave\n";
  } else {
    text += fmt::format(
        "winding {:.1f} °C on average, {:.1f} °C at the end of each time on (limit {:.0f} °C, {})\nstator  {:.1f} °C on average\n",
        state.winding_C, peak_C, values.winding_limit_C, over ? "exceeded" : "kept", state.stator_C);
  }
  session.say(text);
  const auto temperature = [&](double value_C) { return state.runaway ? nlohmann::ordered_json() : nlohmann::ordered_json(value_C); };
  session.answer({{"schema", "heatsoak.steady/1"},
                  {"motor", motor.id},
                  {"ambient_C", options.current.ambient_C},
                  {"current_rms_A", state.current_rms_A},
                  {"winding_C", temperature(state.winding_C)},
                  {"stator_C", temperature(state.stator_C)},
                  {"winding_peak_C", temperature(peak_C)},
                  {"winding_limit_C", values.winding_limit_C},
                  {"runaway", state.runaway}});
  return over ? ExitCode::limit_exceeded : ExitCode::done;
}

}  // namespace

Command steady() {
  return {.name = {},
          .summary = "Steady temperatures under an on/off current: equations (8) to (12) of the RoboTeam Twente paper (copper loss only)",
          .example = "heatsoak steady --motor maxon_ec45_flat_70w_24v --current-on 6A --time-on 4s --time-off 6s --ambient 25degC",
          .declare = [](CLI::App& app, Session& session) -> std::function<ExitCode()> {
            const auto options = std::make_shared<Options>();
            app.add_option("--motor", options->motor, "id (see `heatsoak list motors`) or file")->required()->type_name("M");
            add_quantity(app, "--current-on", options->current.current_on_A,
                         {"current-on", "A", Range::between(0.0, 1e5), "current while on"})
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
            session.add_json_option(app);
            return [options, &session] { return run(*options, session); };
          }};
}

}  // namespace heatsoak::commands
