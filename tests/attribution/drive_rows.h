// Synthetic loads, one row per second: a wheel motor of a robot, and a long bench test.
#pragma once

#include <cstdint>
#include <vector>

#include "truth_motor.h"

namespace heatsoak::attribution::truth {

/// Returns a load with sprints, cruises, pushes and rests. The battery voltage sags, the air warms up, and a neighbouring motor works.
std::vector<RowInputs> robot_rows(int count, std::uint64_t seed);

/// Returns a bench load: a staircase of no-load speeds in both directions, pulses at standstill, a hot spin, a long rest.
std::vector<RowInputs> bench_rows(int count, std::uint64_t seed);

}  // namespace heatsoak::attribution::truth
