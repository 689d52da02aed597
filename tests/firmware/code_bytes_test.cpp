#include <gtest/gtest.h>

#include "firmware/core_files.h"

namespace heatsoak::firmware {
namespace {

TEST(CodeBytes, CommentsAndEmptyLinesDoNotCount) {
  const std::string code = "int a;\nint b;\n";
  EXPECT_EQ(code_bytes("a.cpp", code), code.size());
  EXPECT_EQ(code_bytes("a.h", "/* one\n   two */\nint a;  // three\n\nint b;\n"), code.size());
  EXPECT_EQ(code_bytes("README.md", code), 0U);
  EXPECT_EQ(code_bytes("firmware/stm32.ld", code), 0U);
}

}  // namespace
}  // namespace heatsoak::firmware
