// A document: the answer of a verb in words and tables, free of how it is shown.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace heatsoak::present {

/// How good the news of a piece of text is; renderers may colour it.
enum class Tone { neutral, good, doubtful, bad };

struct Text {
  std::string words = {};
  Tone tone = Tone::neutral;
};

enum class Alignment { left, right };

/// Columns with priority 0 are always shown. A narrow terminal drops the others, the highest number first.
struct Column {
  std::string name = {};
  std::string unit = {};  ///< empty: a word or a number without unit
  int priority = 0;
  Alignment alignment = Alignment::right;
};

/// Each row has one cell for each column.
struct Table {
  std::string title = {};  ///< may be empty
  std::vector<Column> columns = {};
  std::vector<std::vector<Text>> rows = {};
};

/// In rising order of urgency.
enum class Severity {
  background,  ///< explains how the answer was made
  note,        ///< limits what the answer is worth
  warning,     ///< the answer may be wrong or must not be relied on
};

/// One sentence or two that begin with their consequence.
struct Note {
  Severity severity = Severity::note;
  std::string words = {};
};

struct Document {
  std::vector<Text> headline = {};           ///< the verdict, sentence by sentence
  std::vector<std::string> paragraphs = {};  ///< what was computed, on which input
  std::vector<Table> tables = {};
  std::vector<Note> notes = {};

  /// A note that is there already is not added again.
  void add_note(Severity severity, std::string_view words);
};

}  // namespace heatsoak::present
