// Duration of a check's duty, from which bounds of a threshold follow.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>

#include "base/random.h"
#include "check/check_file.h"
#include "duty/match/game.h"
#include "duty/match/match_duty.h"

namespace heatsoak::check::thresholds {

/// Returns the duration in s of the phases of the nominal game. Playing it, which takes half a second, rounds each phase to a step.
inline double match_duration_s(const duty::MatchInputs& inputs, std::uint64_t seed) {
  base::Random random(seed, 0);
  double duration_s = 0.0;
  for (const duty::MatchPhase& each : duty::generate_game(inputs.division, inputs.overtime, inputs.nominal(), random)) {
    duration_s += each.duration_s;
  }
  return duration_s;
}

/// Returns the duration of the duty in s; nothing if it cannot be computed, which the evaluation reports.
inline std::optional<double> duty_duration_s(const Check& check) {
  if (!check.robot || !check.duty) {
    return std::nullopt;
  }
  try {
    if (const auto match = std::dynamic_pointer_cast<const duty::MatchDuty>(check.duty->shape_data)) {
      return match_duration_s(match->inputs(), check.seed);
    }
    double longest_s = 0.0;
    for (const duty::WheelDemand& each : check.duty->demand(*check.robot, check.seed)) {
      longest_s = std::max(longest_s, each.duration_s());
    }
    return longest_s;
  } catch (const base::Failure&) {
    return std::nullopt;
  }
}

}  // namespace heatsoak::check::thresholds
