#include "input/toml_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <random>

#include "input/reader.h"
#include "support/longest_line.h"

namespace heatsoak::input {
namespace {

using testing::HasSubstr;

/// Returns the texts of the array `key`, as the reader of files reads them.
std::vector<std::string> texts_of(const std::string& toml, std::string_view key) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("heatsoak_toml_text_" + std::to_string(::getpid()) + ".toml");
  std::ofstream(file, std::ios::binary) << toml;
  base::Diagnostics diagnostics;
  const Value root = read_toml(file);
  std::filesystem::remove(file);
  return Reader(root, "", diagnostics).texts(key, Need::required);
}

std::string repeated(const std::string& text, int count) {
  std::string all;
  for (int i = 0; i < count; ++i) {
    all += text;
  }
  return all;
}

TEST(ShortLines, LeaveShortLinesCommentsAndMultiLineStrings) {
  const std::string text = "a = \"b\"\n# " + repeated("comment ", 40) + "\nb = \"\"\"\\\n" + repeated("inside ", 40) + "\"\"\"\nc = [1]";
  EXPECT_EQ(with_short_lines(text), text);
}

TEST(ShortLines, BreakStringsAtSpacesAndArraysBetweenElements) {
  const std::string note = repeated("word ", 60) + "end";
  const std::string broken = with_short_lines("note = { value = \"1 K\", derivation = \"" + note + "\" }\n");
  EXPECT_THAT(broken, HasSubstr("note = { value = \"1 K\", derivation = \"\"\"\\\n  word word"));
  EXPECT_THAT(broken, HasSubstr("end\"\"\" }\n"));
  EXPECT_LE(longest_line(broken), 120U);
  const std::string names = with_short_lines("names = [" + repeated("\"effects.contact.conductance\", ", 8) + "\"last\"]");
  EXPECT_LE(longest_line(names), kLongestTomlLine);
  EXPECT_THAT(names, HasSubstr("\", \"last\"]"));
  EXPECT_EQ(texts_of(names, "names").size(), 9U);
}

// Seeded texts with quotes, backslashes, brackets, commas, runs of spaces and control characters keep their values.
TEST(ShortLines, KeepEveryValue) {
  std::mt19937 random(1);
  const std::string alphabet = "abcde   ,[]{}#\"\\'=\n\t";
  std::uniform_int_distribution<std::size_t> letter(0, alphabet.size() - 1);
  std::uniform_int_distribution<int> length(0, 400);
  for (int round = 0; round < 300; ++round) {
    std::vector<std::string> values(3);
    std::string toml = "values = [";
    for (std::string& value : values) {
      for (int i = length(random); i > 0; --i) {
        value += alphabet[letter(random)];
      }
      value += "x";  // an empty text is a problem of its own
      toml += (toml.ends_with('[') ? "" : ", ") + toml_text(value);
    }
    EXPECT_EQ(texts_of(with_short_lines(toml + "]\n"), "values"), values) << with_short_lines(toml);
  }
}

}  // namespace
}  // namespace heatsoak::input
