// Builds for the target as files, QEMU to run them, and the tools of the cross compiler to look into them.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "conformance/program_run.h"
#include "image/replay_files.h"

namespace heatsoak::target {

/// Skips the test where no cross compiler was found when the build was configured.
#define SKIP_WITHOUT_COMPILER()                               \
  do {                                                        \
    if (*HEATSOAK_TARGET_MISSING != '\0') {                   \
      GTEST_SKIP() << "skipped: " << HEATSOAK_TARGET_MISSING; \
    }                                                         \
  } while (false)

/// Skips the test where the emulator is missing as well.
#define SKIP_WITHOUT_EMULATOR()                                    \
  do {                                                             \
    SKIP_WITHOUT_COMPILER();                                       \
    if (std::string(HEATSOAK_EMULATOR).empty()) {                  \
      GTEST_SKIP() << "skipped: qemu-system-arm is not installed"; \
    }                                                              \
  } while (false)

/// What a program on the target wrote.
struct Replay {
  std::string output;                       ///< results, one behind the other
  std::vector<std::uint32_t> instructions;  ///< for each record
  ReplaySummary summary;

  [[nodiscard]] double mean_instructions() const;
  [[nodiscard]] std::uint32_t most_instructions() const;
};

/// Runs the image under QEMU with these bytes as its input, and as what it starts from. Fails the test if it does not end with exit code 0.
Replay replay(const std::string& image, const std::string& input, const std::string& start = "");

/// What a tool of the cross compiler prints: `tool` is "nm", "size", … or "g++".
std::string output_of_tool(const std::string& tool, const Words& arguments);

/// Options that name the processor.
Words processor_options();

/// All of a static library as one relocatable object; with roots (mangled names), only what is reached from them.
std::string linked_object(const TemporaryFolder& folder, const std::string& library, const Words& roots = {});

/// Names that the object needs from elsewhere.
std::vector<std::string> undefined_names(const std::string& object);

/// Bytes that the sections whose names begin with one of these occupy.
std::uint64_t section_bytes(const std::string& object, const std::vector<std::string>& beginnings);

/// Lines of a disassembly that compute in double precision, and names of the compiler's functions that do.
std::vector<std::string> double_arithmetic(const std::string& disassembly);

template <typename Value>
std::string bytes_of(const std::vector<Value>& values) {
  static_assert(std::is_trivially_copyable_v<Value>);
  return values.empty() ? std::string() : std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value));
}

/// Index of the first record in which the bytes differ; the number of records where they are alike.
std::size_t first_difference(const std::string& a, const std::string& b, std::size_t record_size);

}  // namespace heatsoak::target
