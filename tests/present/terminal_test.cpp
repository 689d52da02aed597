// Documents on terminals of any width.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "present/renderer.h"
#include "present/wrap.h"

namespace heatsoak::present {
namespace {

using testing::HasSubstr;
using testing::Not;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  return lines;
}

Document example() {
  Document document;
  document.headline = {{"One motor passes.", Tone::good}, {"Another one fails.", Tone::bad}};
  document.paragraphs = {"robot on duty with quite a number of words that go on for longer than a line of eighty characters has room for"};
  document.tables = {{.title = "",
                      .columns = {{"", "", 0}, {"motor", "", 0, Alignment::left}, {"peak", "°C", 1}, {"rms", "A", 3}, {"data", "", 2}},
                      .rows = {{{"1"}, {"maxon_ec45_flat_70w_30v_402685"}, {"98 [68…137]", Tone::bad}, {"2.47"}, {"datasheet"}}}}};
  for (const char* words : {"first", "second", "third"}) {
    document.add_note(Severity::background, words);
  }
  document.add_note(Severity::warning, "urgent");
  return document;
}

TEST(Terminal, no_line_is_wider_than_the_terminal) {
  for (std::size_t width = 40; width <= 200; width += 7) {
    for (const std::string& line : lines_of(terminal_text(example(), {.width = width, .explains = true}))) {
      EXPECT_LE(width_of(line), width) << line;
    }
  }
}

TEST(Terminal, columns_leave_by_priority_and_come_back_in_order) {
  EXPECT_THAT(terminal_text(example(), {.width = 100}), HasSubstr("peak °C  rms A       data"));
  const std::string middle = terminal_text(example(), {.width = 60});
  EXPECT_THAT(middle, HasSubstr("peak °C       data"));
  EXPECT_THAT(middle, Not(HasSubstr("rms A")));
  const std::string narrow = terminal_text(example(), {.width = 36});
  EXPECT_THAT(narrow, Not(HasSubstr("peak")));
  EXPECT_THAT(narrow, HasSubstr("maxon_ec45_flat_70w_30v_402685"));
}

TEST(Terminal, a_long_name_keeps_its_beginning) {
  const std::string text = terminal_text(example(), {.width = 24});
  EXPECT_THAT(text, HasSubstr("maxon_ec45…30v_402685"));
}

TEST(Terminal, three_notes_are_shown_the_most_urgent_first) {
  const std::string text = terminal_text(example(), {});
  EXPECT_LT(text.find("warning: urgent"), text.find("- first"));
  EXPECT_THAT(text, Not(HasSubstr("- third")));
  EXPECT_THAT(text, HasSubstr("1 more note: add --explain"));
  EXPECT_THAT(terminal_text(example(), {.explains = true}), HasSubstr("- third"));
}

TEST(Terminal, quiet_is_the_headline) {
  EXPECT_EQ(terminal_text(example(), {.is_quiet = true}), "One motor passes.\nAnother one fails.\n");
}

TEST(Terminal, colours_only_where_they_are_asked_for) {
  EXPECT_THAT(terminal_text(example(), {}), Not(HasSubstr("\x1b")));
  const std::string colored = terminal_text(example(), {.with_colors = true});
  EXPECT_THAT(colored, HasSubstr("\x1b[32mOne motor passes.\x1b[0m\n"));
  EXPECT_THAT(colored, HasSubstr("\x1b[31mAnother one fails.\x1b[0m\n"));
  std::string plain;
  for (std::size_t i = 0; i < colored.size(); ++i) {
    if (colored[i] == '\x1b') {
      i = colored.find('m', i);
    } else {
      plain += colored[i];
    }
  }
  EXPECT_EQ(plain, terminal_text(example(), {})) << "colours move no column";
}

TEST(Terminal, a_name_cannot_command_the_terminal) {
  Document document = example();
  document.tables[0].rows[0][1].words = "\x1b[2Jevil";
  document.headline[0].words = "a\x1b]b";
  EXPECT_THAT(terminal_text(document, {}), Not(HasSubstr("\x1b")));
}

TEST(Wrap, breaks_between_words_and_keeps_long_ones) {
  EXPECT_EQ(wrapped("a bb ccc", "- ", 6), "- a bb\n  ccc");
  EXPECT_EQ(wrapped("abcdefghij kl", "", 4), "abcdefghij\nkl");
  EXPECT_EQ(wrapped("", "", 10), "");
  EXPECT_EQ(width_of("°C …"), 4U);
  EXPECT_EQ(leading("°C…x", 3), "°C…");
}

TEST(Markdown, has_every_column_and_note_and_escapes_its_own_signs) {
  Document document = example();
  document.tables[0].rows[0][1].words = "a|b_c";
  const std::string text = rendered_for("x.md", document);
  EXPECT_THAT(text, HasSubstr("|  | motor | peak / °C | rms / A | data |\n|---:|---|---:|---:|---:|\n| 1 | a\\|b\\_c |"));
  EXPECT_THAT(text, HasSubstr("- third\n"));
  EXPECT_THROW(rendered_for("x.docx", document), std::exception);
}

}  // namespace
}  // namespace heatsoak::present
