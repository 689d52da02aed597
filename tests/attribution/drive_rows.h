// What a robot asks of a wheel's motor, second by second, and what a patient person asks of it on a bench.
#pragma once

#include <cstdint>
#include <vector>

#include "truth_motor.h"

namespace heatsoak::truth {

/// Sprints, cruises, pushes against others, rests; with a battery that sags, air that warms, and a neighbour at work.
std::vector<RowInputs> robot_rows(int count, std::uint64_t seed);

/// A staircase of speeds without load in both directions, pulses at standstill, a hot spin, a long rest.
std::vector<RowInputs> bench_rows(int count, std::uint64_t seed);

}  // namespace heatsoak::truth
