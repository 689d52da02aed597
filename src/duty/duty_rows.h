// The duty of all wheels as rows of a CSV that a recorded duty reads, put out as they come: memory does not grow with the duty.
#pragma once

#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "duty/duty.h"

namespace heatsoak::duty {

/// A row holds until the next; its torque is the rms with the sign of the mean, so that the heat stays.
class DutyRows {
 public:
  using Put = std::function<void(std::string_view text)>;
  /// Moments are merged into rows of `every_s`.
  DutyRows(std::size_t wheel_count, DutyKind kind, double every_s, Put put);

  /// One value per wheel, which holds for `duration_s`.
  void add(double duration_s, std::span<const double> torque_Nm, std::span<const double> speed_rad_per_s);
  /// A row as it is, one bin per wheel.
  void add(std::span<const LoadBin> bins);
  /// The last row, which only ends the duty.
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
