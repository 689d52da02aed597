// Command line options for a temperature sensor of the motor.
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>

#include "derate/derating.h"

namespace heatsoak {

struct SensorFlags {
  std::string thermistor_node;  ///< empty: no thermistor
  bool reads_resistance = false;
  SensorOptions thermistor = default_sensor(SensorKind::thermistor);
  SensorOptions resistance = default_sensor(SensorKind::winding_resistance);
};

/// Adds --thermistor, --winding-resistance and their parameters.
void add_sensor_options(CLI::App& app, SensorFlags& flags);

/// Returns nothing without a sensor. Throws Failure (bad_input) if both sensors are given.
std::optional<SensorOptions> sensor_options(const SensorFlags& flags);

}  // namespace heatsoak
