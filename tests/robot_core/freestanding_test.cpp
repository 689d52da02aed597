// The drive core compiled for a controller: it needs no library, and a square root is one instruction.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

#include "support/skip_reasons.h"

namespace {

/// Returns the output of a command, whose exit code must be 0.
std::string output_of(const std::string& command) {
  std::string text;
  FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) {
    return text;
  }
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) {
    text += static_cast<char>(c);
  }
  EXPECT_EQ(pclose(pipe), 0) << command;
  return text;
}

const std::string& compiler() {
  static const std::string command =
      std::string("c++ -std=c++20 -O2 -ffp-contract=off -Werror ") + HEATSOAK_CORE_OPTIONS + " -I'" + HEATSOAK_SOURCE_DIR + "' ";
  return command;
}

class Freestanding : public testing::Test {
 protected:
  void SetUp() override {
    if (std::system("c++ --version > /dev/null 2>&1 && nm --version > /dev/null 2>&1") != 0) {
      GTEST_SKIP() << HEATSOAK_FAILS_CI "no compiler here";
    }
  }
};

TEST_F(Freestanding, FloatBuildNeedsNothing) {
  const std::string object = testing::TempDir() + "heatsoak_robot_core.o";
  output_of(compiler() + "-DROBOT_CORE_WITHOUT_DOUBLE -r -nostdlib -o '" + object + "' '" + HEATSOAK_SOURCE_DIR + "'/robot_core/*.cpp");
  EXPECT_EQ(output_of("nm -u '" + object + "'"), "");
  EXPECT_NE(output_of("nm -C --defined-only '" + object + "'").find("plan_plane<float>"), std::string::npos);
}

TEST_F(Freestanding, SquareRootIsOneInstruction) {
  for (const char* real : {"float", "double"}) {
    const std::string source = testing::TempDir() + "heatsoak_square_root.cpp";
    std::ofstream(source) << "#include \"robot_core/math.h\"\n"
                          << real << " root(" << real << " x) { return robot_core::square_root(x); }\n";
    std::istringstream assembly(output_of(compiler() + "-S -o - '" + source + "'"));
    int roots = 0;
    for (std::string line; std::getline(assembly, line);) {
      roots += line.starts_with('\t') && line.find("sqrt") != std::string::npos ? 1 : 0;
      EXPECT_EQ(line.find("call"), std::string::npos) << line;
    }
    EXPECT_EQ(roots, 1) << real;
  }
}

}  // namespace
