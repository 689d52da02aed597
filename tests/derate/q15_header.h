// The headers in integers and in single precision side by side, compiled and driven hard.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>

#include "derate/export_text.h"
#include "exported_motor.h"
#include "support/skip_reasons.h"

namespace heatsoak::derate {

/// Hard driving in both forms: shares of the current that the integer form allows, speeds, air, and occasionally a faulty sensor, each held
/// for a while. Prints the largest excess current of the integer form in mA, its smallest and largest temperature difference in mK, and its
/// largest shortfall in per mille at points at which the float form allows at least `straight_A`. Arguments: straight_A, number of steps,
/// and "broken" for impossible air or "extreme" for any impossible reading.
inline constexpr const char* kBoth = R"(
#include "float_guard.h"
#include "q15_guard.h"
#include <stdio.h>
#include <stdlib.h>
static uint32_t seed = 12345u;
static int32_t below(int32_t end) { seed = seed * 1664525u + 1013904223u; return (int32_t)(((uint64_t)seed * (uint32_t)end) >> 32); }
static const int32_t extremes[6] = {INT32_MAX, INT32_MIN, INT32_MIN + 1, 1000000000, -1000000000, INT32_MAX - 1};
int main(int argc, char **argv) {
  const float straight_A = (float)atof(argv[1]);
  const long steps = atol(argv[2]);
  const int broken = argc > 3 && argv[3][0] == 'b';
  const int extreme = argc > 3 && argv[3][0] == 'e';
  MOTOR_state slow;
  MOTOR_q15_state quick;
  long i;
  int hold = 0, share = 0;
  float excess_mA = -1e9f, coldest_mK = 1e9f, hottest_mK = -1e9f, short_ratio = 0.0f;
  int32_t allowed_mA = 0, speed = 0, air = 25000, sign = 1;
  MOTOR_start(&slow, 31.0f);
  MOTOR_q15_start(&quick, 31000);
  for (i = 0; i < steps; ++i) {
    MOTOR_input in;
    MOTOR_q15_input whole;
    MOTOR_output out;
    MOTOR_q15_output now;
    float difference_mK;
    if (hold-- == 0) {
      hold = 1 + below(600);
      share = below(3) == 0 ? 0 : 600 + below(401);
      speed = below(4) == 0 ? 0 : below(500000) - 250000;
      air = 15000 + below(25001);
      sign = below(2) == 0 ? 1 : -1;
    }
    whole.current_mA = sign * (int32_t)((int64_t)allowed_mA * share / 1000);
    whole.speed_mrad_per_s = speed;
    whole.ambient_mC = air;
    if (broken && below(200) == 0) {
      whole.ambient_mC = -273150;
    }
    if (extreme && below(100) == 0) {
      *(below(3) == 0 ? &whole.current_mA : below(2) == 0 ? &whole.speed_mrad_per_s : &whole.ambient_mC) = extremes[below(6)];
    }
    in.current_A = (float)whole.current_mA / 1000.0f;
    in.speed_rad_per_s = (float)whole.speed_mrad_per_s / 1000.0f;
    in.ambient_C = (float)whole.ambient_mC / 1000.0f;
    out = MOTOR_step(&slow, &in);
    now = MOTOR_q15_step(&quick, &whole);
    allowed_mA = now.allowed_current_mA;
    difference_mK = (float)now.guarded_winding_mC - 1000.0f * out.guarded_winding_C;
    excess_mA = (float)now.allowed_current_mA - 1000.0f * out.allowed_current_A > excess_mA ? (float)now.allowed_current_mA - 1000.0f * out.allowed_current_A : excess_mA;
    coldest_mK = difference_mK < coldest_mK ? difference_mK : coldest_mK;
    hottest_mK = difference_mK > hottest_mK ? difference_mK : hottest_mK;
    if (out.allowed_current_A >= straight_A) {
      const float ratio = 1.0f - (float)now.allowed_current_mA / (1000.0f * out.allowed_current_A);
      short_ratio = ratio > short_ratio ? ratio : short_ratio;
    }
  }
  printf("%g %g %g %g\n", (double)excess_mA, (double)coldest_mK, (double)hottest_mK, 1000.0 * (double)short_ratio);
  return 0;
}
)";

class Q15Header : public testing::Test {
 protected:
  void SetUp() override {
    if (!has("cc")) {
      GTEST_SKIP() << HEATSOAK_FAILS_CI "no compiler here";
    }
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  static bool has(const std::string& program) { return std::system((program + " --version > /dev/null 2>&1").c_str()) == 0; }

  void write(const char* file, const std::string& text, const Derating& derating) const {
    std::ofstream(folder_ / file) << std::regex_replace(text, std::regex("MOTOR"), identifier(derating.motor_id));
  }
  void write_headers(const Derating& derating) const {
    std::ofstream(folder_ / "float_guard.h") << exported("c_header", derating);
    std::ofstream(folder_ / "q15_guard.h") << exported("c_header_q15", derating);
  }
  /// Returns the output of a command and reports errors as failures.
  [[nodiscard]] std::string output_of(const std::string& command) const {
    const auto in_folder = fmt::format("cd '{}' && {{ {}; }} > out 2> errors", folder_.string(), command);
    const int code = std::system(in_folder.c_str());
    std::stringstream out;
    std::stringstream errors;
    out << std::ifstream(folder_ / "out").rdbuf();
    errors << std::ifstream(folder_ / "errors").rdbuf();
    EXPECT_EQ(code, 0) << command << "\n" << errors.str();
    return out.str();
  }

  std::filesystem::path folder_ = std::filesystem::path(testing::TempDir()) / fmt::format("heatsoak_q15_{}", static_cast<int>(getpid()));
};

inline constexpr const char* kWarnings =
    "-O2 -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wdouble-promotion -Werror -ffp-contract=off";

inline double number_after(const std::string& text, const std::string& pattern) {
  std::smatch found;
  EXPECT_TRUE(std::regex_search(text, found, std::regex(pattern))) << pattern;
  return found.empty() ? std::nan("") : std::stod(found[1]);
}

/// Answer of kBoth.
struct Comparison {
  double most_mA = 0.0;     ///< largest excess of the integer form's current
  double coldest_mK = 0.0;  ///< smallest difference of its winding temperature
  double hottest_mK = 0.0;
  double short_permille = 0.0;
};
inline Comparison comparison(const std::string& text) {
  std::istringstream answer(text);
  Comparison found;
  answer >> found.most_mA >> found.coldest_mK >> found.hottest_mK >> found.short_permille;
  EXPECT_TRUE(answer) << text;
  return found;
}

/// Limits that the integer header states.
struct StatedLimits {
  StatedLimits(const std::string& header, const CurrentTable& table)
      : excess_mK(1000.0 * number_after(header, "are 0 to ([0-9.]+) K above")),
        table_permille(10.0 * number_after(header, "at most ([0-9.]+) % below")),
        // The second part is lost by such a temperature difference, from the steepest slope of the table.
        short_permille(table_permille + excess_mK * table.bound.winding_slope_A_per_K / table.straight_below_A + 0.5) {}
  double excess_mK = 0.0;
  double table_permille = 0.0;
  double short_permille = 0.0;
};

}  // namespace heatsoak::derate
