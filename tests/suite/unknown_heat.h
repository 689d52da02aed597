#pragma once
// Heat that follows no logged signal.
#include <string>
#include <vector>

#include "random.h"

namespace heatsoak::suite {

enum class UnknownHeat { kOrnsteinUhlenbeck, kSteps, kSines, kDrift };

std::string name_of(UnknownHeat kind);

/// Heat at each integration step in W. `size_W` is the standard deviation of Ornstein-Uhlenbeck heat, and the size of the others.
std::vector<double> unknown_heat_W(UnknownHeat kind, double size_W, std::size_t steps, double step_s, Random random);

}  // namespace heatsoak::suite
