#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "present/renderer.h"
#include "present/wrap.h"

namespace heatsoak::renderers {
namespace {

using present::Alignment;
using present::Column;
using present::Document;
using present::leading;
using present::Note;
using present::RenderOptions;
using present::Severity;
using present::Table;
using present::Text;
using present::Tone;
using present::trailing;
using present::width_of;
using present::wrapped;

constexpr std::size_t kGap = 2;  ///< characters between columns

/// Replaces control characters, which could come from file names and control the terminal.
std::string printable(std::string text) {
  std::ranges::replace_if(
      text, [](unsigned char c) { return c < ' ' || c == 0x7f; }, '?');
  return text;
}

std::string toned(const std::string& text, Tone tone, bool with_colors) {
  if (!with_colors || tone == Tone::neutral) {
    return text;
  }
  const int color = tone == Tone::good ? 32 : tone == Tone::undecided ? 33 : 31;
  return fmt::format("\x1b[{}m{}\x1b[0m", color, text);
}

std::string head_of(const Column& column) { return column.unit.empty() ? column.name : fmt::format("{} {}", column.name, column.unit); }

/// Returns the width of the widest cell of each column.
std::vector<std::size_t> widths_of(const Table& table) {
  std::vector<std::size_t> widths;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    std::size_t width = width_of(head_of(table.columns[i]));
    for (const std::vector<Text>& row : table.rows) {
      width = std::max(width, width_of(row[i].words));
    }
    widths.push_back(width);
  }
  return widths;
}

/// Returns the columns that fit, in the order of the table; those of priority 0 always. Columns are dropped strictly by priority.
std::vector<std::size_t> shown_columns(const Table& table, const std::vector<std::size_t>& widths, std::size_t width) {
  std::vector<std::size_t> order(table.columns.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return table.columns[i].priority; });
  std::vector<std::size_t> shown;
  std::size_t used = 0;
  for (const std::size_t i : order) {
    const std::size_t more = widths[i] + (used > 0 ? kGap : 0);
    if (table.columns[i].priority > 0 && used + more > width) {
      break;
    }
    used += more;
    shown.push_back(i);
  }
  std::ranges::sort(shown);
  return shown;
}

/// Pads a cell to its width. A longer text is shortened in the middle, because similar names often differ at their ends.
std::string padded(const std::string& text, std::size_t width, Alignment alignment) {
  const std::size_t own = width_of(text);
  if (own > width) {
    return fmt::format("{}…{}", leading(text, width / 2), trailing(text, width - width / 2 - 1));
  }
  const std::string blanks(width - own, ' ');
  return alignment == Alignment::left ? text + blanks : blanks + text;
}

std::string without_trailing_blanks(std::string line) { return line.substr(0, line.find_last_not_of(' ') + 1) + "\n"; }

/// Narrows the widest left-aligned column if the columns of priority 0 are too wide.
void fit(std::vector<std::size_t>& widths, const std::vector<std::size_t>& shown, const Table& table, std::size_t width) {
  constexpr std::size_t kLeastCell = 8;
  std::size_t total = kGap * (shown.size() - 1);
  std::size_t widest = shown.front();
  for (const std::size_t i : shown) {
    total += widths[i];
    if (table.columns[i].alignment == Alignment::left && widths[i] > widths[widest]) {
      widest = i;
    }
  }
  if (total > width) {
    widths[widest] = std::max(kLeastCell, widths[widest] - std::min(widths[widest], total - width));
  }
}

std::string text_of(Table table, const RenderOptions& options) {
  for (std::vector<Text>& row : table.rows) {
    for (Text& cell : row) {
      cell.words = printable(std::move(cell.words));
    }
  }
  std::vector<std::size_t> widths = widths_of(table);
  const std::vector<std::size_t> shown = shown_columns(table, widths, options.width);
  if (shown.empty()) {
    return "";
  }
  fit(widths, shown, table, options.width);
  const std::string gap(kGap, ' ');
  std::string text = table.title.empty() ? "" : wrapped(printable(table.title), "", options.width) + "\n";
  std::string head;
  for (const std::size_t i : shown) {
    head += (head.empty() ? "" : gap) + padded(head_of(table.columns[i]), widths[i], table.columns[i].alignment);
  }
  text += without_trailing_blanks(head);
  for (const std::vector<Text>& row : table.rows) {
    std::string line;
    for (const std::size_t i : shown) {
      line += (i == shown.front() ? "" : gap) +
              toned(padded(row[i].words, widths[i], table.columns[i].alignment), row[i].tone, options.with_colors);
    }
    text += without_trailing_blanks(line);
  }
  return text;
}

std::string text_of(const std::vector<Note>& notes, const RenderOptions& options) {
  const std::vector<Note> sorted = present::by_urgency(notes);
  const std::size_t most = options.explains ? sorted.size() : std::min(sorted.size(), present::kMostNotes);
  std::string text;
  for (std::size_t i = 0; i < most; ++i) {
    const bool is_warning = sorted[i].severity == Severity::warning;
    text += wrapped((is_warning ? "warning: " : "") + printable(sorted[i].words), "- ", options.width) + "\n";
  }
  if (most < sorted.size()) {
    text += wrapped(fmt::format("{} more note{}: add --explain", sorted.size() - most, sorted.size() - most == 1 ? "" : "s"), "- ",
                    options.width) +
            "\n";
  }
  return text;
}

/// Each sentence starts on its own line and keeps its tone.
std::string text_of(const std::vector<Text>& headline, const RenderOptions& options) {
  std::string text;
  for (const Text& sentence : headline) {
    text += toned(wrapped(printable(sentence.words), "", options.width), sentence.tone, options.with_colors) + "\n";
  }
  return text;
}

std::string render(const Document& document, const RenderOptions& given) {
  RenderOptions options = given;
  options.width = std::max(options.width, present::kLeastWidth);
  std::string text = text_of(document.headline, options);
  if (options.is_quiet) {
    return text;
  }
  for (const std::string& paragraph : document.paragraphs) {
    text += wrapped(printable(paragraph), "", options.width) + "\n";
  }
  for (const Table& table : document.tables) {
    text += '\n';
    text += text_of(table, options);
  }
  if (!document.notes.empty()) {
    text += '\n';
    text += text_of(document.notes, options);
  }
  return text;
}

}  // namespace

present::Renderer terminal() { return {.name = {}, .file_ending = {}, .summary = "plain text, as wide as the terminal", .render = render}; }

}  // namespace heatsoak::renderers
