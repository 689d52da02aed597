// A duty whose demand is given explicitly by a test.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "duty/duty.h"

namespace heatsoak {

/// One piece of one wheel: {duration_s, torque_Nm, speed_rad_per_s, current_A}.
struct GivenPiece {
  double duration_s = 0.0;
  double torque_Nm = 0.0;
  double speed_rad_per_s = 0.0;
  double current_A = 0.0;
};

class GivenDemand final : public DutyShape {
 public:
  explicit GivenDemand(std::vector<WheelDemand> wheels) : wheels_(std::move(wheels)) {}
  [[nodiscard]] std::vector<WheelDemand> demand(const Robot& /*robot*/, std::uint64_t /*seed*/) const override { return wheels_; }

 private:
  std::vector<WheelDemand> wheels_;
};

inline void give(Duty& duty, const std::vector<GivenPiece>& pieces) {
  WheelDemand wheel{.wheel = "the wheel", .bins = {}, .points = {}};
  for (const GivenPiece& piece : pieces) {
    wheel.bins.push_back(constant_bin(piece.duration_s, piece.torque_Nm, piece.speed_rad_per_s, piece.current_A));
    wheel.points.push_back({piece.torque_Nm, piece.speed_rad_per_s, piece.current_A, piece.duration_s});
  }
  duty.shape_data = std::make_shared<GivenDemand>(std::vector<WheelDemand>{wheel});
}

/// Shortens the demand of the duty to this number of bins.
inline void shorten(Duty& duty, std::size_t bins) {
  std::vector<WheelDemand> wheels = duty.demand({}, 1);
  for (WheelDemand& wheel : wheels) {
    wheel.bins.resize(bins);
  }
  duty.shape_data = std::make_shared<GivenDemand>(std::move(wheels));
}

}  // namespace heatsoak
