// Runs every command in README.md, docs/ and reports/, and compares its output with the shown output. generate_test.cpp runs `make host`
// and `make firmware` of src/firmware/templates/README.md, which needs the names of a robot and a motor first.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <regex>
#include <sstream>

#include "program_run.h"
#include "support/source_folder.h"
#include "verb_examples.h"

namespace heatsoak {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// Fenced block of a Markdown document.
struct Block {
  std::string language;
  int line = 0;  ///< line number of its first line
  std::vector<std::string> lines;
};

std::vector<Block> blocks_of(const std::string& markdown) {
  std::vector<Block> blocks;
  std::istringstream stream(markdown);
  bool is_inside = false;
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    if (line.starts_with("```")) {
      is_inside = !is_inside;
      if (is_inside) {
        blocks.push_back({line.substr(3), number + 1, {}});
      }
    } else if (is_inside) {
      blocks.back().lines.push_back(line);
    }
  }
  return blocks;
}

/// Command with the output that the document shows below it.
struct Shown {
  std::string command;
  int line = 0;
  std::vector<std::string> output;
};

bool is_comment(const std::string& line) { return line.empty() || line.starts_with("#"); }

std::vector<Shown> commands_of(const Block& block) {
  std::vector<Shown> all;
  const bool is_console = block.language == "console";
  bool continues = false;
  for (std::size_t i = 0; i < block.lines.size(); ++i) {
    const std::string& line = block.lines[i];
    const bool begins = is_console ? line.starts_with("$ ") : !is_comment(line);
    if (continues) {
      all.back().command += "\n" + line;
    } else if (begins) {
      all.push_back({is_console ? line.substr(2) : line, block.line + static_cast<int>(i), {}});
    } else if (is_console && !all.empty()) {
      all.back().output.push_back(line);
    }
    continues = (continues || begins) && line.ends_with("\\");
  }
  return all;
}

/// Commands that install, build or test the whole project cannot run inside one of its tests.
bool is_for_the_checkout(const std::string& command) {
  return std::ranges::any_of(std::vector<std::string>{"./bootstrap", "cmake ", "git ", "ctest "},
                             [&](const std::string& begin) { return command.starts_with(begin); });
}

/// Recordings of others are not part of the project: commands that read them from $DATA cannot run here, nor can those that use their
/// output.
bool needs_recordings(const Block& block) {
  return std::ranges::any_of(block.lines, [](const std::string& line) { return line.find("$DATA") != std::string::npos; });
}

/// True if the lines occur in the text in this order. Gaps are allowed only at a line "…".
bool shows(const std::string& text, const std::vector<std::string>& expected) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  auto at = lines.begin();
  bool may_skip = true;
  for (const std::string& each : expected) {
    if (each == "…") {
      may_skip = true;
      continue;
    }
    const auto found = may_skip ? std::find(at, lines.end(), each) : at;
    if (found == lines.end() || *found != each) {
      return false;
    }
    at = found + 1;
    may_skip = false;
  }
  return true;
}

std::vector<std::string> documents() {
  std::vector<std::string> all{"README.md"};
  for (const std::string& name : files_of(kSource / "docs", "", ".md")) {
    all.push_back("docs/" + name);
  }
  for (const std::string& name : files_of(kSource / "reports", "", "")) {
    if (fs::exists(kSource / "reports" / name / "README.md")) {
      all.push_back("reports/" + name + "/README.md");
    }
  }
  return all;
}

class Document : public testing::TestWithParam<std::string> {
 protected:
  /// Links the checkout's folders, so that the commands find the files that they read.
  void SetUp() override {
    for (const char* name : {"reports", "motor_db", "robot_core", "duty_profiles", "tests"}) {
      fs::create_directory_symlink(kSource / name, folder_.path() / name);
    }
    options_.folder = folder_.path();
    options_.environment = {"DISPLAY", "WAYLAND_DISPLAY", "COLUMNS=80"};  // the width of a usual terminal
    options_.time_limit_s = 280;
  }
  TemporaryFolder folder_;
  RunOptions options_;
};

TEST_P(Document, shows_commands_that_run_and_their_output) {
  for (const Block& block : blocks_of(content_of(kSource / GetParam()))) {
    if (block.language != "sh" && block.language != "console") {
      for (const std::string& line : block.lines) {
        EXPECT_FALSE(line.starts_with("heatsoak ") || line.starts_with("$ "))
            << GetParam() << ":" << block.line << ": a block that shows a command is marked sh or console: " << line;
      }
      continue;
    }
    for (const Shown& shown : commands_of(block)) {
      if (is_for_the_checkout(shown.command) || needs_recordings(block)) {
        continue;
      }
      const ProgramRun result = run_line(shown.command, options_);
      const int expected = shown.command.find("# exit code 1") != std::string::npos ? 1 : 0;
      EXPECT_EQ(result.exit_code, expected) << GetParam() << ":" << shown.line << ": " << shown.command << "\n" << result.err;
      EXPECT_TRUE(shows(result.out + result.err, shown.output))
          << GetParam() << ":" << shown.line << ": the output of this command is not the one shown; it is\n"
          << result.out << result.err;
    }
  }
}

TEST_P(Document, names_verbs_and_options_that_exist) {
  const std::string text = content_of(kSource / GetParam());
  static const std::regex command("`heatsoak ([a-z_]+)([^`]*)`");
  static const std::regex option("--[a-z][a-z-]*");
  for (auto at = std::sregex_iterator(text.begin(), text.end(), command); at != std::sregex_iterator(); ++at) {
    const std::string verb = (*at)[1];
    const std::string words = (*at)[2];
    const ProgramRun help = run({verb, "--help"});
    EXPECT_EQ(help.exit_code, 0) << GetParam() << ": " << at->str();
    for (auto each = std::sregex_iterator(words.begin(), words.end(), option); each != std::sregex_iterator(); ++each) {
      EXPECT_THAT(help.out, HasSubstr(each->str())) << GetParam() << ": " << at->str();
    }
  }
}

TEST_P(Document, links_to_files_that_exist) {
  const std::string text = content_of(kSource / GetParam());
  static const std::regex link("\\]\\(([^)#:]+)\\)");
  for (auto at = std::sregex_iterator(text.begin(), text.end(), link); at != std::sregex_iterator(); ++at) {
    EXPECT_TRUE(fs::exists((kSource / GetParam()).parent_path() / (*at)[1].str())) << GetParam() << ": " << at->str();
  }
}

INSTANTIATE_TEST_SUITE_P(pages, Document, testing::ValuesIn(documents()), [](const auto& instance) { return test_name(instance.param); });

std::vector<std::string> shown_verbs() {
  std::vector<std::string> verbs;
  for (const VerbCell& each : verb_cells()) {
    verbs.push_back(each.verb);
  }
  return verbs;
}

std::vector<std::string> documented_verbs() {
  std::vector<std::string> verbs;
  for (const std::string& name : files_of(kSource / "docs" / "reference", "", ".md")) {
    if (name != "README.md") {
      verbs.push_back(fs::path(name).stem().string());
    }
  }
  return verbs;
}

// Verb.has_an_example_that_runs runs the examples of the help.
TEST(Documents, pages_of_the_reference_show_the_examples_of_the_help) {
  for (const std::string& verb : documented_verbs()) {
    const std::vector<Block> blocks = blocks_of(content_of(kSource / "docs" / "reference" / (verb + ".md")));
    ASSERT_EQ(blocks.size(), 1U) << verb;
    EXPECT_EQ(blocks.front().language, "sh") << verb;
    std::vector<std::string> commands;
    for (const Shown& each : commands_of(blocks.front())) {
      commands.push_back(with_single_blanks(std::regex_replace(each.command, std::regex("\\\\\n"), "")));
    }
    std::vector<std::string> examples = examples_of_the_help(verb);
    std::ranges::transform(examples, examples.begin(), with_single_blanks);
    EXPECT_EQ(commands, examples) << verb;
  }
}

TEST(Documents, every_verb_is_in_the_table) {
  std::vector<std::string> verbs = shown_verbs();
  std::ranges::sort(verbs);
  EXPECT_EQ(verbs, documented_verbs());
}

TEST(Documents, readme_is_short) {
  const std::string text = content_of(kSource / "README.md");
  EXPECT_LE(std::ranges::count(text, '\n'), 150);
  // Three minutes at 240 words per minute.
  std::istringstream words(text);
  EXPECT_LE(std::distance(std::istream_iterator<std::string>(words), std::istream_iterator<std::string>()), 720);
}

TEST(Documents, reference_is_what_the_help_says) {
  const TemporaryFolder folder;
  const fs::path fresh = folder.path() / "reference";
  ASSERT_EQ(run({"manual", "--to", "markdown", "--out", fresh.string()}).exit_code, 0);
  const fs::path committed = kSource / "docs" / "reference";
  EXPECT_EQ(files_of(committed, "", ".md"), files_of(fresh, "", ".md"));
  for (const std::string& name : files_of(fresh, "", ".md")) {
    EXPECT_TRUE(content_of(fresh / name) == content_of(committed / name))
        << "docs/reference/" << name << " is old; run: cmake --build --preset release --target reference_pages";
  }
}

// The checks above must find planted mistakes.
TEST(Documents, planted_mistakes_are_found) {
  const std::vector<Block> blocks =
      blocks_of("text\n```console\n$ heatsoak a \\\n  --b\none\n…\nthree\n```\n```sh\n# x\nheatsoak c\n```\n");
  ASSERT_EQ(blocks.size(), 2U);
  const std::vector<Shown> first = commands_of(blocks[0]);
  ASSERT_EQ(first.size(), 1U);
  EXPECT_EQ(first[0].command, "heatsoak a \\\n  --b");
  EXPECT_EQ(first[0].line, 3);
  EXPECT_EQ(commands_of(blocks[1]).size(), 1U);
  EXPECT_TRUE(shows("zero\none\ntwo\nthree\n", first[0].output));
  EXPECT_FALSE(shows("three\none\n", first[0].output));
  EXPECT_FALSE(shows("one\ntwo\n", {"one", "three"}));
  EXPECT_FALSE(shows("one\n", {"one", "two"}));
}

}  // namespace
}  // namespace heatsoak
