// A recording row by row, as a network takes it.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "identify/measured_run.h"
#include "identify/measurement/recording.h"

namespace heatsoak {

/// Column of a canonical log that a signal is read from; the shaft's power from its torque.
std::string_view column_of(Signal signal);
/// What a signal is called in sentences: "torque and speed".
std::string_view words_of(Signal signal);

bool has_values(const Channel* channel);

/// Of an operating point, what the signal is about.
double quantity_of(const OperatingPoint<double>& at, Signal signal);

/// Operating points of single rows; NaN where a quantity is not known there. Recording and options outlive it.
class LogRows {
 public:
  LogRows(const Recording& recording, const MeasuredRunOptions& options);
  [[nodiscard]] OperatingPoint<double> at(std::size_t row) const;
  /// Whether what happens from this row to the next is known.
  [[nodiscard]] bool is_known(std::size_t row) const;
  [[nodiscard]] bool has_surroundings() const { return !surroundings_C_.empty(); }

 private:
  /// Of a log with a torque and no current: what the torque and the drag take. The drag is against the motion.
  [[nodiscard]] double current_of_torque_A(double torque_Nm, double speed_rad_per_s) const;
  /// Only a current and a speed that both have signs tell braking from driving.
  [[nodiscard]] double power_of_current_W(double current_A, double speed_rad_per_s) const;
  /// Of the supply, from back-EMF and resistance; 0 where a constant or a signal is not known.
  [[nodiscard]] double modulation_of_current(double current_A, double speed_rad_per_s, double bus_V) const;

  const std::vector<double>*current_A_, *speed_rad_per_s_, *torque_Nm_, *input_power_W_, *bus_V_, *modulation_, *vehicle_speed_m_per_s_,
      *neighbour_C_, *age_h_;
  std::vector<double> surroundings_C_;
  bool is_signed_;  ///< current and speed
  bool is_driven_;  ///< at any time
  const std::vector<double>& time_s_;
  const MeasuredRunOptions& options_;
};

}  // namespace heatsoak
