// What a sensor does to the temperature of its node: one fault, one size, 0 is a faultless sensor.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string_view>
#include <vector>

#include "base/parameter.h"

namespace heatsoak {

/// A reading is linear in the history of the node's temperature: shown = L(T) + c. Both parts depend on the size.
struct SensorLaw {
  /// `shown` holds the true temperatures (or, where `is_change`, a derivative of them) at `time_s` and becomes the reading's.
  void (*apply)(std::span<const double> time_s, double size, bool is_change, Eigen::Ref<Eigen::VectorXd> shown);
  /// d reading / d size at that size, for true temperatures.
  Eigen::VectorXd (*by_size)(std::span<const double> time_s, double size, const Eigen::VectorXd& true_C);
};

/// Numbers computed by hand beside the equation; run as a test for every sensor effect.
struct SensorExample {
  double size = 0.0;  ///< of the parameter, in its unit
  std::vector<double> time_s;
  std::vector<double> true_C;
  std::vector<double> shown_C;
};

struct SensorEffectType {
  std::string_view name;  ///< the file's name; set by find_sensor_effect()
  std::string_view summary;
  std::string_view equation;
  std::string_view reference;
  std::string_view signal;  ///< of the recording, "winding_C"
  ParameterSpec size;
  double typical_size = 0.0;  ///< in the unit of `size`
  std::string_view typical;
  std::string_view look_alike;
  std::string_view experiment;  ///< what to record so that its look-alikes separate
  SensorExample example;
  SensorLaw law;
};

/// All of them, sorted by name. The list lives as long as the program.
const std::vector<SensorEffectType>& all_sensor_effects();
/// Nothing where there is no sensor effect of that name.
const SensorEffectType* find_sensor_effect(std::string_view name);

/// Laws that more than one sensor has.
SensorLaw sensor_offset_law();
SensorLaw sensor_gain_law();
SensorLaw sensor_lag_law();

}  // namespace heatsoak
