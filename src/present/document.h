// The answer of a command in text and tables, independent of how it is rendered.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "present/json.h"
#include "report/chart.h"

namespace heatsoak::present {

/// Rating of a piece of text; renderers may colour it.
enum class Tone { neutral, good, undecided, bad };

struct Text {
  std::string words = {};
  Tone tone = Tone::neutral;
};

enum class Alignment { left, right };

/// Columns with priority 0 are always shown. A narrow terminal drops the others, the highest number first.
struct Column {
  std::string name = {};
  std::string unit = {};  ///< empty for text and pure numbers
  int priority = 0;
  Alignment alignment = Alignment::right;
  std::size_t least_width = 0;  ///< a narrower terminal drops the column, whatever its priority
  bool is_prose = false;        ///< long text, broken into lines; only the last column may be prose
  std::string meaning = {};     ///< explanation, shown as a note where the column is shown; may be empty
  /// A terminal may shorten the cells, as long as all stay different, to show a column of priority 1.
  bool may_shorten = false;
};

/// Each row has one cell for each column. If no column has a name, no head is shown.
struct Table {
  std::string title = {};  ///< may be empty
  std::vector<Column> columns = {};
  std::vector<std::vector<Text>> rows = {};
};

/// Lines to copy or to read by another program. Files and pipes get them as they are.
struct Listing {
  std::string title = {};  ///< may be empty
  std::string lines = {};
  bool is_prose = false;        ///< a terminal may break long lines at blanks
  bool precedes_notes = false;  ///< shown before the notes, because it states more serious findings; else last
};

/// Severity of a note, in ascending order.
enum class Severity {
  background,  ///< explains how the answer was made
  note,        ///< limits the accuracy or scope of the answer
  warning,     ///< the answer may be wrong or unsafe to rely on
  scope,       ///< states what the answer does not cover, and the command that does; shown without --explain too
};

/// One or two sentences; the first states the consequence.
struct Note {
  Severity severity = Severity::note;
  std::string words = {};
};

struct Document {
  std::vector<Text> headline = {};           ///< the verdict, sentence by sentence
  std::vector<std::string> paragraphs = {};  ///< computed quantities and their inputs
  std::vector<Table> tables = {};
  std::vector<Note> notes = {};
  std::vector<std::string> files = {};     ///< names of the written files; cli::Session sets them
  std::vector<Listing> listings = {};      ///< shown last, or before the notes
  std::vector<report::Chart> charts = {};  ///< only HTML contains them
  Json data = {};                          ///< the same answer for other programs; begins with the key "schema"

  void add_note(Severity severity, std::string_view words);
};

/// Returns a document that has only one sentence as its headline.
Document short_answer(std::string sentence, Json data);

}  // namespace heatsoak::present
