// What looks like a wrong unit, a wrong sign or swapped channels. Said to the user, never acted on.
#pragma once

#include <string>
#include <vector>

#include "identify/measurement/quality.h"
#include "identify/measurement/recording.h"

namespace heatsoak {

struct Suspicions {
  std::vector<std::string> all;
  std::vector<std::string> spoiling;         ///< of them: units, signs and sensors with which nothing can be fitted, were it so
  std::vector<std::string> spoiling_wheels;  ///< of them: the same of a robot's wheels and angles, and of the clock
};
/// Of what is told of sampling, channels and clocks. `ambient_C`: of the air as the user states it, NaN where not.
Suspicions suspicions(const Recording& recording, const DataQuality& told, double ambient_C);

}  // namespace heatsoak
