// Files between a test and the program that it runs on the target, in the folder in which QEMU runs.
#pragma once

#include <cstdint>

namespace heatsoak::target {

inline constexpr const char* kInputFile = "input.bin";                ///< records, one after the other
inline constexpr const char* kStartFile = "start.bin";                ///< data that some programs need before the first record
inline constexpr const char* kOutputFile = "output.bin";              ///< one result for each record
inline constexpr const char* kInstructionsFile = "instructions.bin";  ///< std::uint32_t for each record
inline constexpr const char* kSummaryFile = "summary.bin";            ///< one ReplaySummary

struct ReplaySummary {
  std::uint32_t record_count = 0;
  std::uint32_t record_size = 0;
  std::uint32_t result_size = 0;
  std::uint32_t memory_bytes = 0;             ///< memory that the function keeps between two records
  std::uint32_t most_stack_bytes = 0;         ///< stack below the caller, largest value of all records
  std::uint32_t known_loop_instructions = 0;  ///< instructions counted for a loop of kLoopInstructions
};

/// Loop with two instructions per round and one before it, to verify the instruction count.
inline constexpr std::uint32_t kLoopRounds = 12345;
inline constexpr std::uint32_t kLoopInstructions = 2 * kLoopRounds + 1;

}  // namespace heatsoak::target
