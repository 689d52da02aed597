// The answer of `generate core`: a folder that is complete and states its own content.
#include "firmware/core_files.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <regex>
#include <set>
#include <sstream>

#include "base/diagnostic.h"
#include "support/shipped.h"

namespace heatsoak::firmware {
namespace {

derate::DerateOptions few_samples() {
  derate::DerateOptions options;
  options.guarantee.required_share = 0.9;
  options.guarantee.samples = 32;
  return options;
}

const GeneratedCore& core() {
  static const GeneratedCore made = generate_core(twente(), ecx_32(), {.period_s = 2e-3}, few_samples(), "heatsoak 1.2.3");
  return made;
}

TEST(CoreFiles, list_of_generated_files_is_complete) {
  std::set<std::string> paths;
  std::string listed;
  for (const CoreFile& file : core().folder.files) {
    EXPECT_TRUE(paths.insert(file.path).second) << file.path << " twice";
    EXPECT_FALSE(file.content.empty()) << file.path;
    listed = file.path == kGeneratedFiles ? file.content : listed;
  }
  std::istringstream lines(listed);
  std::set<std::string> in_list;
  for (std::string line; std::getline(lines, line);) {
    in_list.insert(line);
  }
  EXPECT_EQ(in_list, paths);
}

// The folder compiles on its own, so each header in quotes must be in it: beside the file that includes it, or at its top.
TEST(CoreFiles, every_header_in_quotes_is_in_the_folder) {
  std::set<std::string> paths;
  for (const CoreFile& file : core().folder.files) {
    paths.insert(file.path);
  }
  const std::regex include(R"(^\s*#include "([^"]+)\")");
  int includes = 0;
  for (const CoreFile& file : core().folder.files) {
    if (!file.path.ends_with(".h") && !file.path.ends_with(".c") && !file.path.ends_with(".cpp")) {
      continue;
    }
    std::istringstream lines(file.content);
    for (std::string line; std::getline(lines, line);) {
      if (std::smatch match; std::regex_search(line, match, include)) {
        ++includes;
        const std::filesystem::path beside = std::filesystem::path(file.path).parent_path() / match.str(1);
        EXPECT_TRUE(paths.contains(match.str(1)) || paths.contains(beside.lexically_normal().string())) << file.path << ": " << line;
      }
    }
  }
  EXPECT_GT(includes, 0);
}

// The guard runs once in a whole number of control periods, about every 10 ms, and is derated for that period.
TEST(CoreFiles, guard_is_derated_for_the_period_of_the_core) {
  EXPECT_DOUBLE_EQ(core().derating.options.period_s, 0.01);
  const GeneratedCore slow = generate_core(twente(), ecx_32(), {.period_s = 3e-3}, few_samples(), "heatsoak 1.2.3");
  EXPECT_DOUBLE_EQ(slow.derating.options.period_s, 0.009);
  EXPECT_NE(slow.folder.hash, core().folder.hash);
  EXPECT_NE(slow.folder.config_check_sum, core().folder.config_check_sum);
}

// The lasting current lets the motor stay below its limit continuously, so its heat in the steady state must not reach the winding limit.
TEST(CoreFiles, current_of_limp_mode_never_reaches_the_limit) {
  const motor::MotorValues nominal = ecx_32().nominal;
  const double I_A = core().folder.limp_current_A;
  ASSERT_GT(I_A, 0.0);
  const double outer_K_per_W = nominal.thermal_resistance_winding_stator_K_per_W + nominal.thermal_resistance_stator_ambient_K_per_W;
  const double cold_W = I_A * I_A * nominal.terminal_resistance_ohm;
  const double rise_K = outer_K_per_W * cold_W / (1.0 - nominal.temperature_coefficient_per_K * outer_K_per_W * cold_W);
  EXPECT_GT(rise_K, 0.0);
  EXPECT_LT(25.0 + rise_K, nominal.winding_limit_C);
}

TEST(CoreFiles, wrong_period_fails_before_the_search) {
  int reports = 0;
  const auto count = [&reports](std::size_t /*done*/, std::size_t /*total*/) { ++reports; };
  EXPECT_THROW(generate_core(twente(), ecx_32(), {.period_s = 2.0 * kLongestWatched_s}, few_samples(), "x", count), base::Failure);
  EXPECT_EQ(reports, 0);
}

}  // namespace
}  // namespace heatsoak::firmware
