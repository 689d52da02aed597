#include "cli/sensor_options.h"

#include <fmt/format.h>

#include "base/diagnostic.h"
#include "cli/quantity_option.h"

namespace heatsoak {

void add_sensor_options(CLI::App& app, SensorFlags& flags) {
  CLI::Option* const thermistor =
      app.add_option("--thermistor", flags.thermistor, "the guard reads a thermistor at the stator or at the winding")
          ->check(CLI::IsMember({"stator", "winding"}))
          ->type_name("NODE");
  add_quantity(app, "--thermistor-accuracy", flags.thermistor_accuracy_K,
               {"thermistor_accuracy", "K", Range::between(0.05, 50.0), "its largest error, mounting included; 2 K unless given"})
      ->needs(thermistor);
  add_quantity(app, "--thermistor-lag", flags.thermistor_lag_s,
               {"thermistor_lag", "s", Range::between(0.0, 600.0), "its time constant; 0 s unless given"})
      ->needs(thermistor);
  app.add_flag("--winding-resistance", flags.reads_resistance,
               "the guard reads the winding's temperature from its resistance: voltage and current at the terminals");
  add_quantity(app, "--resistance-accuracy", flags.resistance_accuracy_K,
               {"resistance_accuracy", "K", Range::between(0.5, 50.0),
                "readings are used if current and speed permit this accuracy; 10 K unless given"});
  add_quantity(app, "--voltage-error", flags.voltage_error_V,
               {"voltage_error", "V", Range::between(0.0, 10.0), "offset of the terminal voltage; 20 mV unless given"});
  add_quantity(app, "--current-error", flags.current_error_A,
               {"current_error", "A", Range::between(0.0, 10.0), "offset of the current; 10 mA unless given"});
}

std::optional<SensorOptions> sensor_options(const SensorFlags& flags) {
  if (flags.reads_resistance && !flags.thermistor.empty()) {
    throw Failure(ExitCode::bad_input, "--thermistor and --winding-resistance: expected one sensor; leave out the less accurate one");
  }
  if (flags.reads_resistance) {
    return SensorOptions{.kind = SensorKind::winding_resistance,
                         .node = states::winding,
                         .accuracy_K = flags.resistance_accuracy_K,
                         .voltage_error_V = flags.voltage_error_V,
                         .current_error_A = flags.current_error_A};
  }
  if (flags.thermistor.empty()) {
    return std::nullopt;
  }
  return SensorOptions{.node = flags.thermistor == "winding" ? states::winding : states::stator,
                       .accuracy_K = flags.thermistor_accuracy_K,
                       .lag_s = flags.thermistor_lag_s};
}

}  // namespace heatsoak
