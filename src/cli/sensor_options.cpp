#include "cli/sensor_options.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/diagnostic.h"
#include "cli/quantity_option.h"

namespace heatsoak::cli {
namespace {

void add_parameters(CLI::App& app, derate::SensorOptions& sensor, CLI::Option* needed) {
  for (const derate::SensorParameter& each : derate::sensor_parameters()) {
    if (each.kind == sensor.kind) {
      std::string flag = fmt::format("--{}", each.spec.key);
      std::ranges::replace(flag, '_', '-');
      add_quantity(app, flag, sensor.*each.value, each.spec)->needs(needed);
    }
  }
}

}  // namespace

void add_sensor_options(CLI::App& app, SensorFlags& flags) {
  add_parameters(app, flags.thermistor,
                 app.add_option("--thermistor", flags.thermistor_node, "node with a thermistor that the guard reads")
                     ->check(CLI::IsMember({"stator", "winding"}))
                     ->type_name("NODE"));
  add_parameters(
      app, flags.resistance,
      app.add_flag("--winding-resistance", flags.reads_resistance,
                   "let the guard find the winding's temperature from its resistance, with voltage and current at the terminals"));
}

std::optional<derate::SensorOptions> sensor_options(const SensorFlags& flags) {
  if (flags.reads_resistance && !flags.thermistor_node.empty()) {
    throw base::Failure(base::ExitCode::bad_input,
                        "--thermistor and --winding-resistance: expected one sensor; leave out the less accurate one");
  }
  if (flags.reads_resistance) {
    return flags.resistance;
  }
  if (flags.thermistor_node.empty()) {
    return std::nullopt;
  }
  derate::SensorOptions thermistor = flags.thermistor;
  thermistor.node = flags.thermistor_node == "winding" ? motor::states::winding : motor::states::stator;
  return thermistor;
}

}  // namespace heatsoak::cli
