// Rules for all verbs (interfaces.md). The test finds the verbs in the program's own help.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <sstream>

#include "program_run.h"
#include "short_runs.h"
#include "verb_examples.h"

namespace heatsoak {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// Returns the verbs that the help lists.
std::vector<std::string> verbs_of_the_help() {
  std::istringstream help(run({"--help"}).out);
  std::vector<std::string> result;
  bool listed = false;
  for (std::string line; std::getline(help, line);) {
    if (line == "Verbs:") {
      listed = true;
    } else if (listed && line.starts_with("  ") && !line.starts_with("   ")) {
      result.push_back(line.substr(2, line.find(' ', 2) - 2));
    } else if (listed && line.empty()) {
      break;
    }
  }
  return result;
}

TEST(Verbs, have_a_reference_page_each) { EXPECT_THAT(verbs_of_the_help(), testing::UnorderedElementsAreArray(verb_names())); }

class Verb : public testing::TestWithParam<std::string> {};

TEST_P(Verb, has_help_on_stdout) {
  for (const char* option : {"--help", "-h"}) {
    const ProgramRun result = run({GetParam(), option});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.err, "");
    EXPECT_THAT(result.out, HasSubstr("Usage: heatsoak " + GetParam()));
  }
}

/// Returns the number of files, also in subfolders.
std::ptrdiff_t file_count(const fs::path& folder) {
  return std::ranges::count_if(fs::recursive_directory_iterator(folder), [](const auto& entry) { return entry.is_regular_file(); });
}

/// Removes the files from `folder` that the text lists as written. A line names a file, or a folder with the number of its files.
void remove_listed(const fs::path& folder, const std::string& text) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (!std::regex_match(line, match, std::regex(R"(written: (.*?)(?: \((\d+) files\))?)"))) {
      continue;
    }
    const fs::path listed = folder / match.str(1);
    ASSERT_TRUE(fs::exists(listed)) << line;
    EXPECT_EQ(fs::is_directory(listed), match[2].matched) << line;
    if (match[2].matched) {
      EXPECT_EQ(file_count(listed), std::stol(match.str(2))) << line;
    }
    fs::remove_all(listed);
  }
}

/// Expects the output that README.md shows for the first example of the verb.
void expect_output_of_readme(const std::string& verb, const std::string& line, const std::string& output) {
  // The shell reads the output of the command in source <(…), so it shows nothing.
  static const std::regex substitution(R"(^source <\((.*)\)$)");
  std::smatch command;
  const std::string text = std::regex_match(line, command, substitution) ? run_line(command.str(1)).out : output;
  for (const VerbCell& each : verb_cells()) {
    if (each.verb == verb) {
      EXPECT_THAT(with_single_blanks(text), HasSubstr(with_single_blanks(each.output))) << line;
    }
  }
}

// The examples must run in any folder, because all files that they need are installed.
TEST_P(Verb, has_an_example_that_runs) {
  const std::vector<std::string> lines = examples_of_the_help(GetParam());
  ASSERT_THAT(lines, Not(IsEmpty()));
  for (const std::string& line : lines) {
    const TemporaryFolder folder;
    RunOptions options;
    options.folder = folder.path();
    options.environment = {"DISPLAY", "WAYLAND_DISPLAY", "COLUMNS=80"};  // the width of a usual terminal
    options.time_limit_s = 280;
    EXPECT_THAT(line, HasSubstr("heatsoak " + GetParam()));
    const bool answers = line.find("--json") == std::string::npos && run({GetParam(), "--help"}).out.find("--report") != std::string::npos;
    const ProgramRun result = run_line(line + (answers ? " --report all.md --json all.json" : ""), options);
    EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 1) << line << "\nends with " << result.exit_code << "\n" << result.err;
    EXPECT_THAT(folder.names(), Not(Contains(HasSubstr("partial"))));
    if (line == lines.front()) {
      expect_output_of_readme(GetParam(), line, result.out);
    }
    // The example must have written its declared output files.
    std::istringstream words(line);
    std::string before;
    for (std::string word; words >> word; before = word) {
      if (before == "--plot" || before == "--out" || (before == "--json" && word != "-")) {
        EXPECT_TRUE(fs::exists(folder.path() / word)) << word;
      }
    }
    if (answers) {
      EXPECT_TRUE(fs::exists(folder.path() / "all.md"));
      EXPECT_TRUE(fs::exists(folder.path() / "all.json"));
      EXPECT_EQ(content_of(folder.path() / "all.md").find("written: all.md"), std::string::npos) << "a report does not list itself";
    }
    // The answer must list all files that the command has written.
    remove_listed(folder.path(), result.out + result.err);
    EXPECT_EQ(file_count(folder.path()), 0) << line << "\nleaves " << testing::PrintToString(folder.names()) << "\n" << result.out;
  }
}

TEST_P(Verb, suggests_the_option_that_was_meant) {
  const ProgramRun result = run({GetParam(), "--hepl"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, HasSubstr("did you mean '--help'?"));
}

TEST_P(Verb, refuses_unknown_words) {
  for (const Words& wrong : {Words{"--surprise"}, Words{"-Q"}, Words{"--surprise=1"}, Words{"a", "b", "c", "d"}}) {
    const ProgramRun result = run(Words{GetParam()} + wrong);
    EXPECT_EQ(result.exit_code, 2) << testing::PrintToString(wrong) << result.out;
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, Not(IsEmpty()));
    EXPECT_THAT(result.err, Not(HasSubstr("bug")));
  }
}

TEST_P(Verb, bears_a_full_disk) {
  RunOptions full;
  full.stdout_file = "/dev/full";
  const ProgramRun result = run({GetParam(), "--help"}, full);
  EXPECT_EQ(result.exit_code, 2) << result.err;
  EXPECT_THAT(result.err, HasSubstr("stdout cannot be written"));
}

INSTANTIATE_TEST_SUITE_P(help, Verb, testing::ValuesIn(verb_names()), [](const auto& instance) { return test_name(instance.param); });

}  // namespace
}  // namespace heatsoak
