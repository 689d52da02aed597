// Tests of the static library that the cross compiler built for the target.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "emulator.h"

namespace heatsoak::target {
namespace {

using testing::IsEmpty;
using testing::IsSubsetOf;
using testing::Not;

TEST(CoreLibrary, NeedsNothingButMemcpyAndMemset) {
  SKIP_WITHOUT_COMPILER();
  const TemporaryFolder folder;
  const std::string object = linked_object(folder, HEATSOAK_TARGET_LIBRARY);
  EXPECT_NE(output_of_tool("nm", {"-C", "--defined-only", object}).find("robot_core::plan_plane<float>"), std::string::npos);
  EXPECT_THAT(undefined_names(object), IsSubsetOf(std::vector<std::string>{"memcpy", "memset"}));
}

TEST(CoreLibrary, KeepsNothingInMemory) {
  SKIP_WITHOUT_COMPILER();
  const TemporaryFolder folder;
  const std::string object = linked_object(folder, HEATSOAK_TARGET_LIBRARY);
  EXPECT_GT(section_bytes(object, {".text"}), 0U);
  EXPECT_EQ(section_bytes(object, {".data", ".bss", ".init_array", ".ctors", ".tdata", ".tbss"}), 0U);
}

TEST(CoreLibrary, ComputesInSinglePrecision) {
  SKIP_WITHOUT_COMPILER();
  const TemporaryFolder folder;
  const std::string object = linked_object(folder, HEATSOAK_TARGET_LIBRARY);
  const std::string disassembly = output_of_tool("objdump", {"-dr", object});
  EXPECT_NE(disassembly.find("vsqrt.f32"), std::string::npos);
  EXPECT_THAT(double_arithmetic(disassembly), IsEmpty());
}

/// Double-precision instructions that GCC generates for a function, with the FPU of this processor or with another one.
std::vector<std::string> double_in(const std::string& fpu, const std::string& function) {
  const TemporaryFolder folder;
  write(folder.path() / "x.cpp", function);
  const std::string object = (folder.path() / "x.o").string();
  output_of_tool("g++", processor_options() + Words{"-mfpu=" + fpu, "-O2", "-c", (folder.path() / "x.cpp").string(), "-o", object});
  return double_arithmetic(output_of_tool("objdump", {"-dr", object}));
}

TEST(CoreLibrary, PlantedDoubleIsFound) {
  SKIP_WITHOUT_COMPILER();
  for (const char* fpu : {"fpv5-sp-d16", "fpv5-d16"}) {
    for (const char* function : {"double f(double a, double b) { return a * b; }", "float f(float a) { return float(a + 0.1); }",
                                 "bool f(double a, double b) { return a < b; }", "double f(int a) { return a; }",
                                 "unsigned f(double a) { return unsigned(a); }", "double f(float a) { return double(a); }"}) {
      EXPECT_THAT(double_in(fpu, function), Not(IsEmpty())) << fpu << ": " << function;
    }
    EXPECT_THAT(double_in(fpu, "void f(double* a, double* b) { *a = *b; } float g(float a, int b) { return a * float(b); }"), IsEmpty());
  }
}

}  // namespace
}  // namespace heatsoak::target
