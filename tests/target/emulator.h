// Files of the builds for the target, QEMU to run them, and the cross compiler's tools to inspect them.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "conformance/program_run.h"
#include "image/replay_files.h"
#include "support/skip_reasons.h"

namespace heatsoak::target {

/// Skips the test if no cross compiler was found at configuration.
#define SKIP_WITHOUT_COMPILER()                                  \
  do {                                                           \
    if (*HEATSOAK_TARGET_MISSING != '\0') {                      \
      GTEST_SKIP() << HEATSOAK_FAILS_CI HEATSOAK_TARGET_MISSING; \
    }                                                            \
  } while (false)

/// Skips the test if the cross compiler or the emulator is missing.
#define SKIP_WITHOUT_EMULATOR()                                             \
  do {                                                                      \
    SKIP_WITHOUT_COMPILER();                                                \
    if (std::string(HEATSOAK_EMULATOR).empty()) {                           \
      GTEST_SKIP() << HEATSOAK_FAILS_CI "qemu-system-arm is not installed"; \
    }                                                                       \
  } while (false)

/// Output of a program on the target.
struct Replay {
  std::string output;                       ///< results, one after the other
  std::vector<std::uint32_t> instructions;  ///< instructions of each record
  ReplaySummary summary;

  [[nodiscard]] double mean_instructions() const;
  [[nodiscard]] std::uint32_t most_instructions() const;
};

/// Runs the image under QEMU with `input` and `start` as input files. Fails the test if the exit code is not 0.
Replay replay(const std::string& image, const std::string& input, const std::string& start = "");

/// Returns the output of a tool of the cross compiler: `tool` is "nm", "size", … or "g++".
std::string output_of_tool(const std::string& tool, const Words& arguments);

/// Returns the compiler options that name the processor.
Words processor_options();

/// Links a static library into one relocatable object. With roots (mangled names) only the code that they reach is kept.
std::string linked_object(const TemporaryFolder& folder, const std::string& library, const Words& roots = {});

/// Returns the names that the object needs from elsewhere.
std::vector<std::string> undefined_names(const std::string& object);

/// Returns the bytes of all sections whose names begin with one of `beginnings`.
std::uint64_t section_bytes(const std::string& object, const std::vector<std::string>& beginnings);

/// Returns the lines of a disassembly that calculate in double precision, and the compiler functions that do.
std::vector<std::string> double_arithmetic(const std::string& disassembly);

template <typename Value>
std::string bytes_of(const std::vector<Value>& values) {
  static_assert(std::is_trivially_copyable_v<Value>);
  return values.empty() ? std::string() : std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value));
}

/// Returns the index of the first record with different bytes, or the number of records if all are equal.
std::size_t first_difference(const std::string& a, const std::string& b, std::size_t record_size);

}  // namespace heatsoak::target
