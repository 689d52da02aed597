// A temperature sensor of the motor, as options of a verb.
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>

#include "derate/derating.h"

namespace heatsoak {

struct SensorFlags {
  std::string thermistor;  ///< node; empty: none
  double thermistor_accuracy_K = 2.0;
  double thermistor_lag_s = 0.0;
  bool reads_resistance = false;
  double resistance_accuracy_K = 10.0;
  double voltage_error_V = 0.02;
  double current_error_A = 0.01;
};

/// --thermistor, --winding-resistance and what belongs to them.
void add_sensor_options(CLI::App& app, SensorFlags& flags);

/// Nothing without a sensor. Throws Failure (bad_input) for both at once.
std::optional<SensorOptions> sensor_options(const SensorFlags& flags);

/// What the sensor is worth and what it can do wrong; empty without one.
std::string sensor_text(const Derating& derating);

}  // namespace heatsoak
