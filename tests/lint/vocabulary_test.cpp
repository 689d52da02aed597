// Rejects the words of the left-behind vocabulary, in texts and in parts of identifiers.
#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <map>
#include <regex>
#include <sstream>
#include <string>

#include "source_text.h"

namespace heatsoak::lint {
namespace {

/// Replacement, and pattern of the words to avoid, in a line whose identifiers are split into words.
const std::map<std::string, std::string> kInstead{
    {"uncertainty, prior standard deviation", "doubts?"},
    {"drift", "wander(s|ed|ing)?"},
    {"depends on", "hangs? on"},
    {"predict, forecast", "foretells?|foretold"},
    {"interval, segment", "stretch(es)?"},
    {"reported, identifiable", "told|tells?"},
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
    {"regressor, input signal", "driver kind|time driver|scan drivers"},
    {"depends on, is based on", "rest(s|ed|ing)? (on|upon)"},
    {"is, has the size of", "(is|are|was|were|be) worth"},
    {"decision, final result", "last words?"},
    {"permanently, continuously", "for ever|forever|for good|in the long run"},
};

/// Names that files and answers keep: the table [figures] and the key "figures" of motor files, the element <figure> of HTML and CSS, and
/// keys of JSON.
const std::regex kKept(R"(\[figures(?:\.\w+)?\]|\bfigures\.\w+|"figures(?:_contradicted)?\\?"|\bfigures = \[|</?figure\b|\bfigure\{)"
                       R"(|\bheat_reserve_ratio\w*|"tells\\?")");

const std::regex& words_left_behind() {
  static const std::regex kWords = [] {
    std::string words;
    for (const auto& [instead, pattern] : kInstead) {
      words += (words.empty() ? "" : "|") + pattern;
    }
    return std::regex("\\b(" + words + ")\\b", std::regex::icase);
  }();
  return kWords;
}

/// Splits identifiers into words: "is_told_" to "is told ", "kTimeDriver" to "k Time Driver".
std::string in_words(const std::string& line) {
  std::string words;
  for (const char c : line) {
    const bool begins_word =
        std::isupper(static_cast<unsigned char>(c)) != 0 && !words.empty() && std::islower(static_cast<unsigned char>(words.back())) != 0;
    words += begins_word ? std::string{' ', c} : std::string(1, c == '_' ? ' ' : c);
  }
  return words;
}

/// Returns "path:line: word" of each word left behind.
std::string words_in(const std::string& text, const std::string& path) {
  // Names of the selected input signal of a curve. As separate words, "driver of" may be a motor driver.
  static const std::regex kInputSignal(R"(\bdrivers?_of|\b(?:chosen|value_of)_driver\b|\bdriver_count\b|\bkDrivers\b)");
  std::string places;
  int line = 1;
  for (std::size_t begin = 0; begin < text.size(); ++line) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    // Long lines are data, and std::regex recurses for each character.
    const std::string whole = text.substr(begin, std::min<std::size_t>(end - begin, 2000));
    const auto add = [&](const std::string& part, const std::regex& words) {
      for (auto at = std::sregex_iterator(part.begin(), part.end(), words); at != std::sregex_iterator(); ++at) {
        places += path + ":" + std::to_string(line) + ": " + at->str() + "\n";
      }
    };
    if (std::regex_search(in_words(whole), words_left_behind())) {
      add(in_words(std::regex_replace(whole, kKept, "")), words_left_behind());
    }
    add(whole, kInputSignal);
    begin = end + 1;
  }
  return places;
}

bool is_cpp(const std::string& path) { return path.ends_with(".h") || path.ends_with(".cpp"); }

bool is_read_by_people(const std::string& path) {
  if (path.starts_with("tests/")) {
    return (is_cpp(path) || path.ends_with(".md")) && path != "tests/lint/vocabulary_test.cpp";  // this file lists the words
  }
  if (path.starts_with("reports/")) {
    return path.ends_with(".md");
  }
  const std::string name = std::filesystem::path(path).filename().string();
  return is_cpp(path) || path.ends_with(".md") || path.ends_with(".toml") || path.ends_with(".c") || path.ends_with(".cmake") ||
         name == "CMakeLists.txt" || name == "bootstrap";
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
  EXPECT_EQ(words_in("// what is told\nhangs on it; Doubts\nunfolded stretched", "x"), "x:1: told\nx:2: hangs on\nx:2: Doubts\n");
}

TEST(Vocabulary, planted_parts_of_identifiers_are_found) {
  EXPECT_EQ(words_in("bool is_told_; report.tell();\nclass TimeDriver;\nkFigureCount, drivers_of(), driver of", "x"),
            "x:1: told\nx:1: tell\nx:2: Time Driver\nx:3: Figure\nx:3: drivers_of\n");
}

TEST(Vocabulary, planted_names_of_input_signals_are_found) {
  EXPECT_EQ(words_in("int chosen_driver;\nkDrivers[driver_count]\nvalue_of_driver(x); make_driver(); kDriverLimit", "x"),
            "x:1: chosen_driver\nx:2: kDrivers\nx:2: driver_count\nx:3: value_of_driver\n");
}

TEST(Vocabulary, names_that_files_keep_are_no_words_left_behind) {
  EXPECT_EQ(words_in("[figures]\n[figures.rotor_inertia]\nroot.find(\"figures\") <figure> heat_reserve_ratio_r configured", "x"), "");
}

TEST(Vocabulary, of_a_test_only_comments_and_texts_count) {
  EXPECT_EQ(words_in(comments_and_texts("int told = 1;  // what is told\nsay(\"told\");\n"), "x"), "x:1: told\nx:2: told\n");
}

TEST(Vocabulary, no_file_has_words_left_behind) {
  for (const SourceFile& file : files_in("")) {
    if (is_read_by_people(file.path)) {
      const bool is_test = file.path.starts_with("tests/") && is_cpp(file.path);
      EXPECT_EQ(words_in(is_test ? comments_and_texts(file.text) : file.text, file.path), "") << "write in the words of the field";
    }
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
