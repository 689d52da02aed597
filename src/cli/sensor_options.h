// Command line options for a temperature sensor of the motor.
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>

#include "derate/derating.h"

namespace heatsoak {

struct SensorFlags {
  std::string thermistor;  ///< node of the thermistor; empty: no thermistor
  double thermistor_accuracy_K = 2.0;
  double thermistor_lag_s = 0.0;
  bool reads_resistance = false;
  double resistance_accuracy_K = 10.0;
  double voltage_error_V = 0.02;
  double current_error_A = 0.01;
};

/// Adds --thermistor, --winding-resistance and their parameters.
void add_sensor_options(CLI::App& app, SensorFlags& flags);

/// Returns nothing without a sensor. Throws Failure (bad_input) if both sensors are given.
std::optional<SensorOptions> sensor_options(const SensorFlags& flags);

}  // namespace heatsoak
