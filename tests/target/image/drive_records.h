// One step of the drive core as bytes, with the same layout on host and target. A record is a robot_core::Input.
#pragma once

#include <cstdint>

#include "drive_setup.h"
#include "robot_core/drive_core.h"

namespace heatsoak::target {

struct DriveResult {
  robot_core::PerWheel pwm_ratio;
  robot_core::PerWheel voltage_V;
  robot_core::PerWheel allowed_current_A;
  robot_core::PerWheel winding_C;
  float time_to_guard_limit_s;
  std::uint8_t is_open[robot_core::kMostWheels];
  std::uint8_t reason[robot_core::kMostWheels];
  std::uint8_t is_warning;
  std::uint8_t robot_reason;
  std::uint8_t unused[2];
  std::uint32_t state_digest;  ///< digest of the State
};

/// State of the run between two records.
struct DriveRun {
  robot_core::Config config;
  robot_core::State state;
  robot_core::Output output;
};

inline void begin(DriveRun& run) {
  run.config = drive_setup();
  robot_core::start(run.config, run.state, {.is_rested = true, .body_C = 25.0F});
}

/// FNV-1a over the words of the State (Fowler, Noll, Vo).
inline std::uint32_t digest(const robot_core::State& state) {
  static_assert(sizeof(state) % sizeof(std::uint32_t) == 0);
  std::uint32_t sum = 2166136261U;
  for (unsigned i = 0; i < sizeof(state) / sizeof(std::uint32_t); ++i) {
    std::uint32_t word = 0;
    __builtin_memcpy(&word, reinterpret_cast<const unsigned char*>(&state) + i * sizeof(word), sizeof(word));
    sum = (sum ^ word) * 16777619U;
  }
  return sum;
}

/// Copies member by member, because padding bytes are undefined.
inline void copy_output(const robot_core::Output& output, const robot_core::State& state, DriveResult& result) {
  for (int i = 0; i < robot_core::kMostWheels; ++i) {
    result.pwm_ratio[i] = output.pwm_ratio[i];
    result.voltage_V[i] = output.voltage_V[i];
    result.allowed_current_A[i] = output.allowed_current_A[i];
    result.winding_C[i] = output.winding_C[i];
    result.is_open[i] = output.is_open[i] ? 1 : 0;
    result.reason[i] = static_cast<std::uint8_t>(output.reason[i]);
  }
  result.time_to_guard_limit_s = output.time_to_guard_limit_s;
  result.is_warning = output.is_warning ? 1 : 0;
  result.robot_reason = static_cast<std::uint8_t>(output.robot_reason);
  result.unused[0] = result.unused[1] = 0;
  result.state_digest = digest(state);
}

/// Start of the recorded part of a match.
struct MatchStart {
  std::uint32_t config_check_sum = 0;
  std::uint32_t unused = 0;
  robot_core::State state;
};

}  // namespace heatsoak::target
