// The match as a duty.
#pragma once

#include <utility>

#include "duty/duty.h"
#include "duty/match/generator.h"

namespace heatsoak {

class MatchDuty final : public DutyShape {
 public:
  explicit MatchDuty(MatchInputs inputs) : inputs_(std::move(inputs)) {}

  [[nodiscard]] const MatchInputs& inputs() const { return inputs_; }
  [[nodiscard]] std::vector<WheelDemand> demand(const Robot& robot, std::uint64_t seed) const override {
    return play_match(inputs_, inputs_.nominal(), robot, seed, Planner::jerk_limited).wheels;
  }

 private:
  MatchInputs inputs_;
};

}  // namespace heatsoak
