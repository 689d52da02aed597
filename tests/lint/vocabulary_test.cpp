// Rejects the words of the left-behind vocabulary. A folder that is not listed may have none.
#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <sstream>
#include <string>

#include "source_text.h"

namespace heatsoak::lint {
namespace {

/// Replacement, and pattern of the word to avoid.
const std::map<std::string, std::string> kInstead{
    {"uncertainty, prior standard deviation", "doubts?"},
    {"drift", "wander(s|ed|ing)?"},
    {"depends on", "hangs? on"},
    {"predict, forecast", "foretells?|foretold"},
    {"interval, segment", "stretch(es)?"},
    {"reported, identifiable", "told"},
    {"counted, included", "reckon(s|ed)?"},
    {"residual", "leaves over|left over"},
    {"unmodelled heat", "nobody logs"},
    {"parameter, value", "figures?"},
    {"confounded with", "look-alikes?"},
    {"accepted, validated", "believ(e|es|ed)"},
    {"safety factor on heat", "heat reserves?"},
    {"limit exceeded", "pass(es|ed|ing)? (a|the|its|their) limits?"},
    {"remainder, residual heat", "what is left"},
    {"accepted, counted", "taken in"},
    {"steady state", "comes? to rest|has settled"},
    {"estimate", "nobody has measured"},
    {"hold-out run", "never saw"},
    {"nominal, in its present form", "as it stands"},
    {"regressor, input signal", "DriverKind|drivers?_of|kTimeDriver|scan_drivers"},
};

/// Allowed counts: `figures` is a table of motor files and a key of answers, <figure> an element of HTML.
const std::map<std::string, int> kMost{{"docs", 4},        {"src/cli", 1},   {"src/duty", 1},     {"src/firmware", 1}, {"src/motor", 6},
                                       {"src/present", 9}, {"src/robot", 1}, {"src/simulate", 1}, {"tests", 11}};

std::regex any_of_them() {
  std::string words;
  for (const auto& [instead, pattern] : kInstead) {
    words += (words.empty() ? "" : "|") + pattern;
  }
  return std::regex("\\b(" + words + ")\\b", std::regex::icase);
}

std::string folder_of(const std::string& path) {
  const std::size_t first = path.find('/');
  return path.starts_with("src/") ? path.substr(0, path.find('/', first + 1)) : path.substr(0, first);
}

int count_in(const std::string& text, const std::regex& words, std::string& places, const std::string& path) {
  int count = 0;
  int line = 1;
  for (std::size_t begin = 0; begin < text.size(); ++line) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    // Long lines are data, and std::regex recurses for each character.
    const std::string part = text.substr(begin, std::min<std::size_t>(end - begin, 2000));
    for (auto at = std::sregex_iterator(part.begin(), part.end(), words); at != std::sregex_iterator(); ++at) {
      ++count;
      places += path + ":" + std::to_string(line) + ": " + at->str() + "\n";
    }
    begin = end + 1;
  }
  return count;
}

bool is_cpp(const std::string& path) { return path.ends_with(".h") || path.ends_with(".cpp"); }

bool is_read_by_people(const std::string& path) {
  if (path.starts_with("tests/")) {
    return (is_cpp(path) || path.ends_with(".md")) && path != "tests/lint/vocabulary_test.cpp";  // this file lists the words
  }
  if (path.starts_with("reports/")) {
    return path.ends_with(".md");
  }
  const bool is_source = path.starts_with("src/") || path.starts_with("robot_core/") || path.starts_with("docs/") || path == "README.md";
  return is_source && (is_cpp(path) || path.ends_with(".md") || path.ends_with(".toml"));
}

/// Blanks the code of a test, whose local names are free.
std::string comments_and_texts(std::string text) {
  const std::string code = code_only(text);
  for (std::size_t i = 0; i < text.size(); ++i) {
    text[i] = code[i] == ' ' || code[i] == '\n' ? text[i] : ' ';
  }
  return text;
}

TEST(Vocabulary, planted_words_are_found) {
  std::string places;
  EXPECT_EQ(count_in("// what is told\nhangs on it; Doubts\nunfold_told stretched", any_of_them(), places, "x"), 3);
  EXPECT_EQ(places, "x:1: told\nx:2: hangs on\nx:2: Doubts\n");
}

TEST(Vocabulary, of_a_test_only_comments_and_texts_count) {
  std::string places;
  EXPECT_EQ(count_in(comments_and_texts("int told = 1;  // what is told\nsay(\"told\");\n"), any_of_them(), places, "x"), 2);
  EXPECT_EQ(places, "x:1: told\nx:2: told\n");
}

TEST(Vocabulary, no_folder_gets_more_of_the_words_left_behind) {
  const std::regex words = any_of_them();
  std::map<std::string, int> counts;
  std::map<std::string, std::string> places;
  for (const SourceFile& file : files_in("")) {
    if (is_read_by_people(file.path)) {
      const std::string folder = folder_of(file.path);
      const bool is_test = file.path.starts_with("tests/") && is_cpp(file.path);
      counts[folder] += count_in(is_test ? comments_and_texts(file.text) : file.text, words, places[folder], file.path);
    }
  }
  for (const auto& [folder, count] : counts) {
    const auto most = kMost.find(folder);
    EXPECT_LE(count, most == kMost.end() ? 0 : most->second) << "write in the words of the field in place of\n" << places[folder];
  }
}

/// Returns "path:line: text" of each doc comment that begins without its subject. Lines that continue a comment are not its beginning.
std::string fragments_in(const std::string& text, const std::string& path) {
  static const std::regex kFragment(R"(///<?\s*(?:of|that|where|how|what|which|whose)\b)", std::regex::icase);
  static const std::regex kComment(R"(^\s*///(?!<))");
  std::istringstream lines(text);
  std::string places;
  bool continues = false;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    const bool is_comment = std::regex_search(line, kComment);
    if (!(is_comment && continues) && std::regex_search(line, kFragment)) {
      places += path + ":" + std::to_string(number) + ": " + line + "\n";
    }
    continues = is_comment;
  }
  return places;
}

TEST(Vocabulary, planted_fragments_are_found) {
  EXPECT_EQ(fragments_in("/// Of the motor.\n/// of which\nint a;  ///< where it is\n/// Returns what\n", "x"),
            "x:1: /// Of the motor.\nx:3: int a;  ///< where it is\n");
}

TEST(Vocabulary, doc_comments_begin_with_their_subject) {
  for (const SourceFile& file : files_in("")) {
    if (is_cpp(file.path) && file.path != "tests/lint/vocabulary_test.cpp") {
      EXPECT_EQ(fragments_in(file.text, file.path), "");
    }
  }
}

}  // namespace
}  // namespace heatsoak::lint
