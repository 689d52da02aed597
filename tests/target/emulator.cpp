#include "emulator.h"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <numeric>
#include <regex>
#include <sstream>

#include "robot_core/port/instruction_counter.h"

namespace heatsoak::target {

double Replay::mean_instructions() const {
  const std::uint64_t sum = std::accumulate(instructions.begin(), instructions.end(), std::uint64_t{0});
  return static_cast<double>(sum) / static_cast<double>(std::max<std::size_t>(instructions.size(), 1));
}

std::uint32_t Replay::most_instructions() const { return instructions.empty() ? 0 : *std::ranges::max_element(instructions); }

Replay replay(const std::string& image, const std::string& input, const std::string& start) {
  const TemporaryFolder folder;
  write(folder.path() / kInputFile, input);
  write(folder.path() / kStartFile, start);
  RunOptions options;
  options.folder = folder.path();
  options.program = HEATSOAK_EMULATOR;
  const ProgramRun run = heatsoak::run({"-M", "mps2-an500", "-nographic", "-semihosting-config", "enable=on,target=native", "-icount",
                                        "shift=" + std::to_string(robot_core::port::kInstructionShift), "-kernel", image},
                                       options);
  Replay result;
  EXPECT_EQ(run.exit_code, 0) << run.out << run.err;
  if (run.exit_code != 0) {
    return result;
  }
  result.output = content_of(folder.path() / kOutputFile);
  const std::string counts = content_of(folder.path() / kInstructionsFile);
  result.instructions.resize(counts.size() / sizeof(std::uint32_t));
  std::memcpy(result.instructions.data(), counts.data(), result.instructions.size() * sizeof(std::uint32_t));
  const std::string summary = content_of(folder.path() / kSummaryFile);
  EXPECT_EQ(summary.size(), sizeof(ReplaySummary));
  std::memcpy(&result.summary, summary.data(), std::min(summary.size(), sizeof(ReplaySummary)));
  return result;
}

std::string output_of_tool(const std::string& tool, const Words& arguments) {
  RunOptions options;
  options.program = HEATSOAK_TARGET_COMPILER;
  options.program.replace(options.program.rfind("g++"), 3, tool);
  const ProgramRun run = heatsoak::run(arguments, options);
  EXPECT_EQ(run.exit_code, 0) << options.program << ": " << run.err;
  return run.out;
}

Words processor_options() {
  std::istringstream stream(HEATSOAK_TARGET_PROCESSOR);
  return {std::istream_iterator<std::string>(stream), {}};
}

std::string linked_object(const TemporaryFolder& folder, const std::string& library, const Words& roots) {
  const std::string object = (folder.path() / "linked.o").string();
  Words words = processor_options() + Words{"-r", "-nostdlib", "-o", object};
  if (roots.empty()) {
    words = words + Words{"-Wl,--whole-archive", library, "-Wl,--no-whole-archive"};
  } else {
    words.push_back("-Wl,--gc-sections,--entry=" + roots[0]);
    for (const std::string& root : roots) {
      words.push_back("-Wl,-u," + root);
    }
    words.push_back(library);
  }
  output_of_tool("g++", words);
  return object;
}

std::vector<std::string> undefined_names(const std::string& object) {
  std::istringstream stream(output_of_tool("nm", {"-u", object}));
  std::vector<std::string> names;
  for (std::string kind, name; stream >> kind >> name;) {
    names.push_back(name);
  }
  std::ranges::sort(names);
  return names;
}

std::uint64_t section_bytes(const std::string& object, const std::vector<std::string>& beginnings) {
  std::istringstream stream(output_of_tool("size", {"-A", "-d", object}));
  std::uint64_t sum = 0;
  for (std::string line; std::getline(stream, line);) {
    std::istringstream words(line);
    std::string name;
    std::uint64_t bytes = 0;
    if (words >> name >> bytes && std::ranges::any_of(beginnings, [&](const std::string& each) { return name.starts_with(each); })) {
      sum += bytes;
    }
  }
  return sum;
}

std::vector<std::string> double_arithmetic(const std::string& disassembly) {
  // Excludes vmov.f64 and loads, which only move the bits of two registers.
  static const std::regex kDouble(R"(\bv(?!mov)[a-z]+\S*\.f64\b|\bvcvt\S*\.f64\S*|__aeabi_(d|f2d|i2d|ui2d|l2d|ul2d|cd)\w*)");
  std::vector<std::string> found;
  std::istringstream stream(disassembly);
  for (std::string line; std::getline(stream, line);) {
    if (std::regex_search(line, kDouble)) {
      found.push_back(line);
    }
  }
  return found;
}

std::size_t first_difference(const std::string& a, const std::string& b, std::size_t record_size) {
  const auto [in_a, in_b] = std::ranges::mismatch(a, b);
  return static_cast<std::size_t>(in_a - a.begin()) / record_size;
}

}  // namespace heatsoak::target
