#pragma once
// Inputs of one run: a bench test or a drive of a wheel motor. Current and speed vary within a second.
#include <cstdint>
#include <vector>

#include "motor.h"

namespace heatsoak::suite {

constexpr int kStepsPerRow = 25;
constexpr double kStep_s = 1.0 / kStepsPerRow;

/// One element per integration step; the number of steps is a multiple of kStepsPerRow.
using Inputs = std::vector<Instant>;

/// A run of 25 to 30 min. `load_factor` scales currents and loads. The sequence of motions depends on the seed only.
Inputs bench_run(const Motor& motor, double load_factor, std::uint64_t seed);
Inputs wheel_run(const Motor& motor, double load_factor, std::uint64_t seed);

}  // namespace heatsoak::suite
