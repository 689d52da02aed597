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
  /// What is shown of a temperature that has not moved for long or, where `is_change`, of a derivative of one.
  double (*at_rest)(double size, double true_C, bool is_change) = nullptr;
  /// What is shown at the end of an interval over which the temperature (or a derivative of it) went evenly from `before_C` to `now_C`,
  /// after `shown_C` at its beginning. Null where a sensor has no memory: it shows what it does at rest.
  double (*after)(double size, double duration_s, double before_C, double now_C, double shown_C) = nullptr;
  /// d reading / d size at that size, for true temperatures.
  Eigen::VectorXd (*by_size)(std::span<const double> time_s, double size, const Eigen::VectorXd& true_C) = nullptr;

  [[nodiscard]] double next_C(double size, double duration_s, double before_C, double now_C, double shown_C, bool is_change) const {
    return after ? after(size, duration_s, before_C, now_C, shown_C) : at_rest(size, now_C, is_change);
  }
  /// `shown` holds the true temperatures (or, where `is_change`, a derivative of them) at `time_s` and becomes the reading's.
  void apply(std::span<const double> time_s, double size, bool is_change, Eigen::Ref<Eigen::VectorXd> shown) const;
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

/// One fault of one sensor.
struct SensorFault {
  const SensorEffectType* type = nullptr;
  double size = 0.0;  ///< in the unit of the type's size
};

// Of a sensor with several faults, each acts on what the one before it shows.

/// As SensorLaw::apply().
void apply(std::span<const SensorFault> faults, std::span<const double> time_s, bool is_change, Eigen::Ref<Eigen::VectorXd> shown);
/// Shown of a temperature that has not moved for long, and the other way round.
double shown_at_rest_C(std::span<const SensorFault> faults, double true_C);
double true_at_rest_C(std::span<const SensorFault> faults, double shown_C);

/// What a sensor shows while time goes on.
class Reading {
 public:
  Reading() = default;
  /// Of a node that has long had the temperature.
  Reading(std::vector<SensorFault> faults, double true_C);

  /// The temperature went evenly to this one.
  void advance(double duration_s, double true_C);
  [[nodiscard]] double shown_C() const { return passed_C_.back(); }

 private:
  std::vector<SensorFault> faults_;
  std::vector<double> passed_C_{0.0};  ///< the true temperature, then what each fault makes of the one before
};

/// Laws that more than one sensor has.
SensorLaw sensor_offset_law();
SensorLaw sensor_gain_law();
SensorLaw sensor_lag_law();

}  // namespace heatsoak
