#include "base/source_text.h"

#include <gtest/gtest.h>

namespace heatsoak::base {
namespace {

TEST(SourceText, CommentsAndEmptyLinesAreRemoved) {
  EXPECT_EQ(without_comments("int a; // one\n\n  /* two\n lines */\nint b; /* three */ int c;  \n"), "int a;\nint b;   int c;\n");
  EXPECT_EQ(without_comments("int a; /* open"), "int a;\n");
  EXPECT_EQ(without_comments(""), "");
}

TEST(SourceText, LiteralsAreNoComments) {
  EXPECT_EQ(without_comments("s = \"http://x\\\"//\"; // y\n"), "s = \"http://x\\\"//\";\n");
  EXPECT_EQ(without_comments("c = '\"'; d = '\\''; // y\n"), "c = '\"'; d = '\\'';\n");
  EXPECT_EQ(without_comments("n = 4'000'000; // a 'b\n"), "n = 4'000'000;\n");
  EXPECT_EQ(without_comments("n = 0xFF'FF; /* \" */ m = 1;\n"), "n = 0xFF'FF;   m = 1;\n");
}

}  // namespace
}  // namespace heatsoak::base
