// Budgets for one step of the drive core on the target: four wheels, with guard, without planner.
#pragma once

#include <cstddef>
#include <cstdint>

namespace heatsoak::target {

/// About a seventieth of the computing time of a controller at 216 MHz and 1 kHz.
inline constexpr double kMeanInstructions = 3000.0;
/// The same with current sensors, changing commands, and faults in a third of the time.
inline constexpr double kMeanInstructionsWithFaults = 3100.0;
/// The same with one step in ten late by up to two periods, which then has more work.
inline constexpr double kMeanInstructionsLate = 3200.0;
/// The same with one wheel sensor lost permanently: its speed follows from the others, and each current must suit all of them.
inline constexpr double kMeanInstructionsLostSensor = 3650.0;
/// Worst step of the asserted streams: on time or late, with or without the faults of drive_stream.h.
inline constexpr std::uint32_t kMostInstructions = 6000;
/// Code and constants, with the motor's law and tables.
inline constexpr std::uint64_t kMostCode_bytes = 24 * 1024;
/// Bytes of Config and State together.
inline constexpr std::uint32_t kMostMemory_bytes = 2 * 1024;
inline constexpr std::size_t kMostStack_bytes = 1024;

}  // namespace heatsoak::target
