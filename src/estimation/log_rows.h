// Converts the rows of a recording to operating points of a network.
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "estimation/measured_run.h"
#include "recording/quantities.h"
#include "recording/recording.h"

namespace heatsoak::estimation {

using recording::column_of;
/// Returns the name of a signal in sentences, for example "torque and speed".
std::string_view words_of(thermal::Signal signal);
/// Returns what at least one run lacks to test the effect, in words: signals, or a current that follows from the torque.
std::vector<std::string_view> lacking(const thermal::EffectType& type, const std::vector<MeasuredRun>& runs);

/// Returns whether the channel exists and has a value in any row.
bool has_values(const recording::Channel* channel);

/// Returns the value of a signal in an operating point, in the unit of thermal::kQuantities.
double quantity_of(const thermal::OperatingPoint<double>& at, thermal::Signal signal);

/// Operating points of single rows; NaN if a logged quantity has no value there. The surroundings are coolant_C if the log has it, else
/// ambient_C, interpolated where two values are less than 60 s apart (Thresholds::slow_s). Recording and options must outlive this object.
class LogRows {
 public:
  LogRows(const recording::Recording& recording, const MeasuredRunOptions& options);
  LogRows(const LogRows&) = delete;  // columns_ points into bridged_
  LogRows& operator=(const LogRows&) = delete;
  [[nodiscard]] thermal::OperatingPoint<double> at(std::size_t row) const;
  /// True if the row has the temperature of the surroundings and all signals that the options need.
  [[nodiscard]] bool is_known(std::size_t row) const;
  [[nodiscard]] bool has_surroundings() const { return !surroundings_C_.empty(); }
  [[nodiscard]] bool has_measured_current() const { return current_A_ != nullptr; }

 private:
  /// Current in A for a log with torque but no current. The drag opposes the motion and adds to the torque.
  [[nodiscard]] double current_of_torque_A(double torque_Nm, double speed_rad_per_s) const;
  /// Shaft power in W from current and speed. Braking is recognised only if the log has signs for both; otherwise the motor drives.
  [[nodiscard]] double power_of_current_W(double current_A, double speed_rad_per_s) const;
  /// Modulation (terminal voltage / supply voltage, at most 1) from back-EMF and resistance. 0 if a constant or a signal is missing.
  [[nodiscard]] double modulation_of_current(double current_A, double speed_rad_per_s, double bus_V) const;

  const std::vector<double>*current_A_, *speed_rad_per_s_, *torque_Nm_, *bus_V_, *modulation_;
  /// Columns in the order of the table of quantities; null if the log lacks one, or if the quantity is computed.
  std::array<const std::vector<double>*, thermal::kQuantityCount> columns_{};
  std::array<std::vector<double>, thermal::kQuantityCount>
      bridged_{};  ///< columns that are no heat input, interpolated where values are less than 60 s apart
  std::vector<double> surroundings_C_;
  bool is_signed_;  ///< current and speed both have negative values
  bool is_driven_;  ///< the current exceeds least_current_A at any time
  const std::vector<double>& time_s_;
  const MeasuredRunOptions& options_;
};

}  // namespace heatsoak::estimation
