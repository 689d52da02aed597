// Detects probable wrong units, wrong signs and swapped channels. They are reported to the user, never corrected.
#pragma once

#include <optional>
#include <vector>

#include "recording/findings.h"
#include "recording/quality.h"
#include "recording/recording.h"

namespace heatsoak::recording {

struct Suspicions {
  std::vector<Suspicion> all;
  std::vector<Suspicion> blocking;             ///< subset about units, signs and sensors that, if true, prevents any fit
  std::vector<Suspicion> blocking_for_wheels;  ///< subset about a robot's wheels and angles, and about the clock
};
/// `quality` must contain sampling, channels and clock offsets. `ambient_C`: air temperature if the
/// user states it.
Suspicions suspicions(const Recording& recording, const DataQuality& quality, std::optional<double> ambient_C);

}  // namespace heatsoak::recording
