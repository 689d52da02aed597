// Writes the demand of all wheels as CSV rows that a recorded duty can read. Rows are written immediately, so memory does not grow with the
// duration.
#pragma once

#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "duty/duty.h"

namespace heatsoak::duty {

/// Writer of rows. A row holds until the next; its torque is the RMS with the sign of the mean, which conserves the heat.
class DutyRows {
 public:
  using Put = std::function<void(std::string_view text)>;
  /// Writes the header. Moments are merged into rows of `every_s`.
  DutyRows(std::size_t wheel_count, DutyKind kind, double every_s, Put put);

  /// Adds a moment that holds for `duration_s`, with one value per wheel.
  void add(double duration_s, std::span<const double> torque_Nm, std::span<const double> speed_rad_per_s);
  /// Writes one row from one bin per wheel.
  void add(std::span<const LoadBin> bins);
  /// Writes the last row, which only marks the end of the duty.
  void finish();

 private:
  void close();

  DutyKind kind_;
  double every_s_;
  Put put_;
  std::vector<LoadMeans> means_;
  std::vector<LoadBin> row_;
  double time_s_ = 0.0;
};

}  // namespace heatsoak::duty
