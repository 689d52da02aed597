// What one step of the drive core may take on the target: four wheels, guard included, planner left out.
#pragma once

#include <cstddef>
#include <cstdint>

namespace heatsoak::target {

/// At 1 kHz about a seventieth of the time of a controller at 216 MHz.
inline constexpr double kMeanInstructions = 3000.0;
inline constexpr std::uint32_t kMostInstructions = 6000;
/// Code and constants, the motor's law and its tables included.
inline constexpr std::uint64_t kMostCode_bytes = 24 * 1024;
/// Config and State.
inline constexpr std::uint32_t kMostMemory_bytes = 2 * 1024;
inline constexpr std::size_t kMostStack_bytes = 1024;

}  // namespace heatsoak::target
