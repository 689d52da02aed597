// A duty whose demand is given explicitly by a test.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "duty/duty.h"

namespace heatsoak::select {

/// One piece of one wheel: {duration_s, torque_Nm, speed_rad_per_s, current_A}.
struct GivenPiece {
  double duration_s = 0.0;
  double torque_Nm = 0.0;
  double speed_rad_per_s = 0.0;
  double current_A = 0.0;
};

class GivenDemand final : public duty::DutyShape {
 public:
  explicit GivenDemand(std::vector<duty::WheelDemand> wheels) : wheels_(std::move(wheels)) {}
  [[nodiscard]] std::vector<duty::WheelDemand> demand(const robot::Robot& /*robot*/, std::uint64_t /*seed*/) const override {
    return wheels_;
  }

 private:
  std::vector<duty::WheelDemand> wheels_;
};

inline void give(duty::Duty& duty, const std::vector<GivenPiece>& pieces) {
  duty::WheelDemand wheel{.wheel = "the wheel", .bins = {}, .points = {}};
  for (const GivenPiece& piece : pieces) {
    wheel.bins.push_back(duty::constant_bin(piece.duration_s, piece.torque_Nm, piece.speed_rad_per_s, piece.current_A));
    wheel.points.push_back({piece.torque_Nm, piece.speed_rad_per_s, piece.current_A, piece.duration_s});
  }
  duty.shape_data = std::make_shared<GivenDemand>(std::vector<duty::WheelDemand>{wheel});
}

/// Shortens the demand of the duty to this number of bins.
inline void shorten(duty::Duty& duty, std::size_t bins) {
  std::vector<duty::WheelDemand> wheels = duty.demand({}, 1);
  for (duty::WheelDemand& wheel : wheels) {
    wheel.bins.resize(bins);
  }
  duty.shape_data = std::make_shared<GivenDemand>(std::move(wheels));
}

}  // namespace heatsoak::select
