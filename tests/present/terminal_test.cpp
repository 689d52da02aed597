// Documents on terminals of any width.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "base/version.h"
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

// Long names give way to a column of priority 1, but never become equal, and no line becomes too wide.
TEST(Terminal, names_are_shortened_for_a_column_of_priority_1) {
  Document document;
  document.tables = {{.columns = {{.name = "motor", .alignment = Alignment::left, .may_shorten = true},
                                  {"margin", "K", 0},
                                  {"winding", "", 1, Alignment::left},
                                  {"data", "", 2, Alignment::left}},
                      .rows = {{{"maxon_ec45_flat_50w_24v_251601"}, {"+127"}, {"▁▁▁▁▁▁▁▁"}, {"datasheet"}},
                               {{"maxon_ec45_flat_50w_24v_339281"}, {"+127"}, {"▁▁▁▁▁▁▁▁"}, {"datasheet"}}}}};
  EXPECT_THAT(terminal_text(document, {.width = 60}), HasSubstr("maxon_ec45_flat_50w_24v_251601      +127  ▁▁▁▁▁▁▁▁\n"));
  const std::string shortened = terminal_text(document, {.width = 42});
  EXPECT_THAT(shortened, HasSubstr("…"));
  EXPECT_THAT(shortened, HasSubstr("251601      +127  ▁▁▁▁▁▁▁▁\n"));
  for (std::size_t width = 20; width < 80; ++width) {
    const std::vector<std::string> lines = lines_of(terminal_text(document, {.width = width}));
    EXPECT_NE(lines.at(1), lines.at(2)) << width;
    for (const std::string& line : lines) {
      EXPECT_LE(width_of(line), width) << line;
    }
  }
}

Document with_prose() {
  Document document;
  document.tables = {
      {.columns = {{"name", "", 0, Alignment::left}, {"meaning", "", 0, Alignment::left, 0, true}},
       .rows = {{{"first_name_of_all"}, {"a rather long explanation that does not fit beside the name on a narrow terminal"}},
                {{"second"}, {"short"}}}}};
  return document;
}

TEST(Terminal, prose_stands_beside_its_row_or_below_it) {
  EXPECT_THAT(terminal_text(with_prose(), {.width = 60}), HasSubstr("first_name_of_all  a rather long explanation that does not\n"
                                                                    "                   fit beside the name on a narrow terminal\n"
                                                                    "second             short\n"));
  EXPECT_THAT(
      terminal_text(with_prose(), {.width = 40}),
      HasSubstr("first_name_of_all\n    a rather long explanation that does\n    not fit beside the name on a narrow\n    terminal\n"));
  for (std::size_t width = 30; width <= 120; width += 9) {
    for (const std::string& line : lines_of(terminal_text(with_prose(), {.width = width}))) {
      EXPECT_LE(width_of(line), width) << line;
    }
  }
}

// A pipe has no width: scripts that search lines find each row with its explanation.
TEST(Terminal, a_row_is_one_line_in_a_pipe) {
  const Document document = with_prose();
  const auto rows_in = [&](bool breaks_rows) {
    return lines_of(terminal_text(document, {.width = 40, .breaks_rows = breaks_rows})).size();
  };
  const std::size_t head_and_rows = 1 + document.tables.front().rows.size();
  EXPECT_EQ(rows_in(false), head_and_rows);
  EXPECT_GT(rows_in(true), head_and_rows);
}

TEST(Terminal, a_quiet_list_shows_its_names) {
  EXPECT_EQ(terminal_text(with_prose(), {.width = 60, .is_quiet = true}), "first_name_of_all\nsecond\n");
}

TEST(Terminal, a_column_may_need_a_wide_terminal) {
  Document document = example();
  document.tables[0].columns[2].least_width = 70;
  EXPECT_THAT(terminal_text(document, {.width = 69}), Not(HasSubstr("peak")));
  EXPECT_THAT(terminal_text(document, {.width = 70}), HasSubstr("peak"));
}

TEST(Terminal, lines_to_copy_come_last_and_whole) {
  Document document = example();
  const std::string line(150, 'x');
  document.listings = {{"to copy:", line + " y\n"}};
  document.files.emplace_back("a.svg");
  const std::string text = terminal_text(document, {.width = 80, .is_terminal = true});
  EXPECT_TRUE(text.ends_with("\nwritten: a.svg\n\nto copy:\n" + line + " y\n")) << text;
  document.listings[0] = {"", "file.toml:1:1: error: " + line.substr(0, 50) + " and more words\n", true};
  EXPECT_THAT(terminal_text(document, {.width = 80, .is_terminal = true}), HasSubstr("xx and\nmore words\n"));
  EXPECT_THAT(terminal_text(document, {.width = 80, .is_terminal = false}), HasSubstr("xx and more words\n"));
}

// Errors of files are listed before notes in every form of the answer.
TEST(Terminal, lines_of_serious_findings_precede_the_notes) {
  Document document = example();
  document.listings = {{.title = "", .lines = "m.toml:3:1: error: wrong\n", .precedes_notes = true}};
  for (const std::string& text :
       {terminal_text(document, {.width = 80}), rendered_for("x.html", document), rendered_for("x.md", document)}) {
    const std::size_t lines = text.find("m.toml:3:1: error: wrong\n");
    ASSERT_NE(lines, std::string::npos) << text;
    EXPECT_LT(lines, text.find("urgent")) << text;
    EXPECT_EQ(text.find("m.toml:3:1", lines + 1), std::string::npos) << "twice";
  }
}

TEST(Html, holds_everything_and_escapes_it) {
  Document document = example();
  document.tables[0].rows[0][1] = {"<b>&"};
  document.listings = {{"", "a < b\n"}};
  const std::string text = rendered_for("x.html", document);
  for (const char* said : {"<td>&lt;b&gt;&amp;</td>", "<th>motor</th>", "rms / A", "<b>warning:</b> urgent", "<pre>a &lt; b\n</pre>"}) {
    EXPECT_THAT(text, HasSubstr(said));
  }
}

TEST(Html, commands_are_code_and_charts_are_inside) {
  Document document = example();
  document.add_note(Severity::note, "`a < b` and a lone ` sign");
  document.charts.push_back({.title = "Chart <1>", .x_label = "time / min", .panels = {{.title = "Panel"}}});
  const std::string text = rendered_for("x.html", document);
  EXPECT_THAT(text, HasSubstr("<code>a &lt; b</code> and a lone ` sign"));
  EXPECT_THAT(text, HasSubstr("<div class=\"picture\"><svg"));
  EXPECT_THAT(text, HasSubstr("Chart &lt;1&gt;"));
  EXPECT_THAT(text, Not(HasSubstr("<?xml")));
  EXPECT_THAT(text, Not(HasSubstr("class=\" ")));
}

TEST(Terminal, hidden_warnings_are_counted) {
  Document document = example();
  for (const char* words : {"a", "b", "c", "d"}) {
    document.add_note(Severity::warning, words);
  }
  EXPECT_THAT(terminal_text(document, {}), HasSubstr("5 more notes, 2 of them warnings: add --explain"));
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

TEST(Terminal, explains_only_the_columns_that_are_shown) {
  Document document = example();
  document.tables[0].columns[1].meaning = "best first";
  document.tables[0].columns.back().meaning = "the widest terminal shows it";
  document.tables[0].columns.back().priority = 9;
  const auto text = [&](std::size_t width) { return terminal_text(document, {.width = width, .explains = true}); };
  EXPECT_THAT(text(400), HasSubstr("Columns. motor: best first; "));
  EXPECT_THAT(text(400), HasSubstr("the widest terminal shows it."));
  EXPECT_THAT(text(40), Not(HasSubstr("the widest")));
  EXPECT_THAT(text(40), HasSubstr("best first."));
  EXPECT_THAT(rendered_for("x.md", document), HasSubstr("the widest terminal shows it."));
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

TEST(Wrap, keeps_a_number_with_its_unit) {
  EXPECT_EQ(wrapped("by 20 K", "", 5), "by\n20 K");
  EXPECT_EQ(wrapped("at 3.5 m/s², then", "", 9), "at\n3.5 m/s²,\nthen");
  EXPECT_EQ(folded("over 10 min at 25 °C", 8), "over\n10 min\nat 25 °C");
  EXPECT_EQ(wrapped("all 20 kelvins", "", 6), "all 20\nkelvins");
}

TEST(Markdown, has_every_column_and_note_and_escapes_its_own_signs) {
  Document document = example();
  document.tables[0].rows[0][1].words = "a|b_c";
  const std::string text = rendered_for("x.md", document);
  EXPECT_THAT(text, HasSubstr("|  | motor | peak / °C | rms / A | data |\n|---:|---|---:|---:|---:|\n| 1 | a\\|b\\_c |"));
  EXPECT_THAT(text, HasSubstr("- third\n"));
  EXPECT_THROW(rendered_for("x.docx", document), std::exception);
}

TEST(JsonAnswer, is_the_data_with_the_version_after_the_schema) {
  Document document = example();
  document.data = {{"schema", "heatsoak.example/1"}, {"peak_C", 98.25}, {"name", "a\xff"}};
  const std::string text = rendered_for("x.json", document);
  EXPECT_EQ(text, "{\n  \"schema\": \"heatsoak.example/1\",\n  \"version\": " + Json(base::program_version()).dump() +
                      ",\n  \"peak_C\": 98.25,\n  \"name\": \"a\xEF\xBF\xBD\"\n}\n");
  EXPECT_EQ(rendered_as("json", document), text);
}

TEST(Renderers, a_wrong_ending_is_answered_with_all_known_ones) {
  try {
    static_cast<void>(rendered_for("x.docx", example()));
    FAIL();
  } catch (const base::Failure& failure) {
    for (const Renderer& each : all_renderers()) {
      EXPECT_THAT(failure.what(), HasSubstr(std::string(each.file_ending)));
    }
  }
}

}  // namespace
}  // namespace heatsoak::present
