// Duty whose demand is that of a generated match.
#pragma once

#include <utility>

#include "duty/duty.h"
#include "duty/match/generator.h"

namespace heatsoak::duty {

class MatchDuty final : public DutyShape {
 public:
  explicit MatchDuty(MatchInputs inputs) : inputs_(std::move(inputs)) {}

  [[nodiscard]] const MatchInputs& inputs() const { return inputs_; }
  [[nodiscard]] std::vector<WheelDemand> demand(const robot::Robot& robot, std::uint64_t seed) const override {
    return play_nominal(inputs_, robot, seed).wheels;
  }
  [[nodiscard]] bool depends_on_robot() const override { return true; }
  [[nodiscard]] bool has_unknowns() const override { return true; }
  /// Plays another game with drawn inputs and a drawn robot.
  [[nodiscard]] WheelDemand draw(const robot::Robot& robot, std::uint64_t seed, std::uint64_t draw) const override {
    constexpr std::uint64_t kBehindTheSamples = std::uint64_t{1} << 32;
    base::Random random(seed, kBehindTheSamples + draw);
    const MatchValues values = inputs_.draw(random);
    return hardest_wheel_of_match(inputs_, values, robot::draw_sample(robot, random), seed + kBehindTheSamples * (draw + 1),
                                  Planner::jerk_limited, kBin_s, kDrawnGameStep_s);
  }

 private:
  MatchInputs inputs_;
};

/// Returns whether the duty is a match, which the drive core can drive.
inline bool is_match(const Duty& duty) { return dynamic_cast<const MatchDuty*>(duty.shape_data.get()) != nullptr; }

}  // namespace heatsoak::duty
