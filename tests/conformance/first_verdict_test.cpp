// The README's output and picture of `./bootstrap demo` must match the demo.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "program_run.h"
#include "support/source_folder.h"

namespace heatsoak {
namespace {

namespace fs = std::filesystem;

/// Returns the command of the demo from the script itself, with another name for its picture.
std::vector<std::string> demo_words(const fs::path& picture) {
  const std::string script = content_of(kSource / "bootstrap");
  const std::string opening = "job=(\"$program\" ";
  const std::size_t begin = script.find(opening) + opening.size();
  std::istringstream command(script.substr(begin, script.find(')', begin) - begin));
  std::vector<std::string> words;
  for (std::string word; command >> word;) {
    words.push_back(word == "\"$picture\"" ? picture.string() : word);
  }
  return words;
}

/// Returns the lines of a table: its head, which contains the motor's verdict, and all consecutive lines.
std::vector<std::string> table(const std::string& text) {
  std::istringstream lines(text);
  std::vector<std::string> result;
  for (std::string line; std::getline(lines, line);) {
    const bool is_head = line.starts_with("   motor ") && line.find("verdict") != std::string::npos;
    const bool ends = line.empty() || line.starts_with("```");
    if (is_head || (!result.empty() && !ends)) {
      result.push_back(line);
    } else if (!result.empty()) {
      break;
    }
  }
  return result;
}

class FirstVerdict : public testing::Test {
 protected:
  TemporaryFolder folder_;
  fs::path picture_ = folder_.path() / "first_verdict.svg";
  ProgramRun demo_ = run(demo_words(picture_), {.environment = {"COLUMNS"}});
};

TEST_F(FirstVerdict, table_of_the_readme_is_what_the_demo_prints) {
  ASSERT_EQ(demo_.exit_code, 1) << demo_.err;  // one of the motors exceeds its limit
  const std::vector<std::string> printed = table(demo_.out);
  ASSERT_EQ(printed.size(), 5U) << demo_.out;
  EXPECT_THAT(content_of(kSource / "README.md"), testing::HasSubstr(fmt::format("{}", fmt::join(printed, "\n"))));
}

TEST_F(FirstVerdict, picture_of_the_readme_is_what_the_demo_draws) {
  const std::string committed = content_of(kSource / "reports" / "first_verdict.svg");
  EXPECT_TRUE(content_of(picture_) == committed)
      << "run ./bootstrap demo and put out/first_verdict.svg in the place of reports/first_verdict.svg";
}

}  // namespace
}  // namespace heatsoak
