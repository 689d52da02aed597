// Command line options for a temperature sensor of the motor.
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>

#include "derate/derating.h"

namespace heatsoak::cli {

struct SensorFlags {
  std::string thermistor_node;  ///< empty: no thermistor
  bool reads_resistance = false;
  derate::SensorOptions thermistor = derate::default_sensor(derate::SensorKind::thermistor);
  derate::SensorOptions resistance = derate::default_sensor(derate::SensorKind::winding_resistance);
};

/// Adds --thermistor, --winding-resistance and their parameters.
void add_sensor_options(CLI::App& app, SensorFlags& flags);

/// Returns nothing without a sensor. Throws Failure (bad_input) if both sensors are given.
std::optional<derate::SensorOptions> sensor_options(const SensorFlags& flags);

}  // namespace heatsoak::cli
