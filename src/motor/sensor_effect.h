// Sensor faults: how the reading of a sensor differs from the temperature of its node. Each has one size; 0 is a perfect sensor.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "base/parameter.h"

namespace heatsoak::motor {

/// Law of a sensor error. The reading is linear in the history of the temperature: shown = L(T) + c; both depend on the size.
struct SensorLaw {
  /// Reading of a constant temperature. With `is_change` the argument is a derivative of the temperature, and the constant c is left out.
  double (*at_rest)(double size, double true_C, bool is_change) = nullptr;
  /// Reading at the end of an interval in which the temperature (or its derivative) changed linearly from `before_C` to `now_C`; `sensor_C`
  /// is the reading at its beginning. Null for a sensor without memory: at_rest applies.
  double (*after)(double size, double duration_s, double before_C, double now_C, double sensor_C) = nullptr;
  /// Derivative of the reading with respect to the size, for a series of true temperatures.
  std::vector<double> (*by_size)(std::span<const double> time_s, double size, std::span<const double> true_C) = nullptr;

  [[nodiscard]] double next_C(double size, double duration_s, double before_C, double now_C, double sensor_C, bool is_change) const {
    return after ? after(size, duration_s, before_C, now_C, sensor_C) : at_rest(size, now_C, is_change);
  }
  /// Replaces the true temperatures in `shown_C` (with `is_change` a derivative of them) at `time_s` by the readings.
  void apply(std::span<const double> time_s, double size, bool is_change, std::span<double> shown_C) const;
};

/// A hand-calculated example of the equation; a test runs it for every sensor effect.
struct SensorExample {
  double size = 0.0;  ///< in the unit of the parameter
  std::vector<double> time_s;
  std::vector<double> true_C;
  std::vector<double> sensor_C;
};

struct SensorEffectType {
  std::string_view name;  ///< name in motor files; set by find_sensor_effect()
  std::string_view summary;
  std::string_view equation;
  std::string_view reference;
  std::string_view signal;  ///< column of the log that it affects, "winding_C"
  base::ParameterSpec size;
  double typical_size = 0.0;  ///< in the unit of `size`
  std::string_view typical;
  std::string_view confounded_with;
  std::string_view experiment;  ///< measurement that separates it from the effects it is confounded with
  SensorExample example;
  SensorLaw law;
};

/// Returns all sensor effects, sorted by name. The list lives as long as the program.
const std::vector<SensorEffectType>& all_sensor_effects();
/// Returns the sensor effect of that name, or null if there is none.
const SensorEffectType* find_sensor_effect(std::string_view name);

/// One fault of one sensor.
struct SensorFault {
  const SensorEffectType* type = nullptr;
  double size = 0.0;  ///< in the unit of the type's size
};

// A sensor with several faults: each acts on the reading of the one before.

/// Like SensorLaw::apply(), for all faults in order.
void apply(std::span<const SensorFault> faults, std::span<const double> time_s, bool is_change, std::span<double> shown_C);
/// Returns the reading at a constant temperature, and the constant temperature of a reading.
double sensor_at_rest_C(std::span<const SensorFault> faults, double true_C);
double true_at_rest_C(std::span<const SensorFault> faults, double sensor_C);

/// Reading of a sensor as time advances.
class Reading {
 public:
  Reading() = default;
  /// Starts from a node that has had this temperature for a long time.
  Reading(std::vector<SensorFault> faults, double true_C);

  /// The temperature changes linearly to `true_C` within the duration.
  void advance(double duration_s, double true_C);
  [[nodiscard]] double sensor_C() const { return passed_C_.back(); }

 private:
  std::vector<SensorFault> faults_;
  std::vector<double> passed_C_{0.0};  ///< the true temperature, then the reading after each fault
};

/// Laws shared by several sensors.
SensorLaw sensor_offset_law();
SensorLaw sensor_gain_law();
SensorLaw sensor_lag_law();

}  // namespace heatsoak::motor
