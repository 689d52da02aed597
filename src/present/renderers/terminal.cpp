#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "present/renderer.h"
#include "present/wrap.h"

namespace heatsoak::present::renderers {
namespace {

constexpr std::size_t kGap = 2;  ///< characters between columns

/// Replaces control characters, which could come from file names and control the terminal. Lines become parts of one line.
std::string printable(std::string text) {
  for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at)) {
    text.replace(at, 1, "; ");
  }
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

/// Prose of several lines goes below its row if the other columns leave fewer characters or a smaller share of the width.
constexpr std::size_t kLeastProse = 28;
constexpr double kLeastProse_share = 0.5;
constexpr std::size_t kProseIndent = 4;

/// Returns the width of the widest cell of each column; 0 for prose, which takes the remaining width.
std::vector<std::size_t> widths_of(const Table& table) {
  std::vector<std::size_t> widths;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (table.columns[i].is_prose) {
      widths.push_back(0);
      continue;
    }
    std::size_t width = width_of(head_of(table.columns[i]));
    for (const std::vector<Text>& row : table.rows) {
      width = std::max(width, width_of(row[i].words));
    }
    widths.push_back(width);
  }
  return widths;
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

/// Returns by how many characters the cells of a column may be shortened so that all stay different.
std::size_t spare_width(const Table& table, std::size_t column, std::size_t width) {
  constexpr std::size_t kLeastShortened = 16;
  const auto are_distinct = [&](std::size_t shortened) {
    std::set<std::string> whole;
    std::set<std::string> short_ones;
    for (const std::vector<Text>& row : table.rows) {
      whole.insert(row[column].words);
      short_ones.insert(padded(row[column].words, shortened, Alignment::left));
    }
    return whole.size() == short_ones.size();
  };
  std::size_t least = width;
  while (least > kLeastShortened && are_distinct(least - 1)) {
    --least;
  }
  return width - least;
}

/// Returns the columns that fit, in the order of the table; those of priority 0 always. Columns are dropped strictly by priority. A column
/// that may be shortened gives way to those of priority 1.
std::vector<std::size_t> shown_columns(const Table& table, const std::vector<std::size_t>& widths, std::size_t width) {
  std::vector<std::size_t> order(table.columns.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return table.columns[i].priority; });
  std::vector<std::size_t> shown;
  std::size_t used = 0;
  std::size_t spare = 0;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    spare += table.columns[i].may_shorten ? spare_width(table, i, widths[i]) : 0;
  }
  for (const std::size_t i : order) {
    if (table.columns[i].least_width > width) {
      continue;
    }
    const std::size_t more = widths[i] + (used > 0 ? kGap : 0);
    if (table.columns[i].priority > 0 && used + more > width + (table.columns[i].priority == 1 ? spare : 0)) {
      break;
    }
    used += more;
    shown.push_back(i);
  }
  std::ranges::sort(shown);
  return shown;
}

std::string without_trailing_blanks(std::string line) { return line.substr(0, line.find_last_not_of(' ') + 1) + "\n"; }

/// Narrows the widest left-aligned column if the columns of priority 0 are too wide.
void fit(std::vector<std::size_t>& widths, const std::vector<std::size_t>& shown, const Table& table, std::size_t width) {
  constexpr std::size_t kLeastCell = 8;
  if (shown.empty()) {
    return;
  }
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

std::size_t longest_word(std::string_view text) {
  std::size_t longest = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    longest = std::max(longest, width_of(text.substr(0, end)));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return longest;
}

/// Adds prose to the line of its row, or below it if it would become a narrow column of several lines.
std::string with_prose(const std::string& line, std::size_t used, const std::string& prose, std::size_t width) {
  if (prose.empty()) {
    return without_trailing_blanks(line);
  }
  const std::size_t place = used + (used > 0 ? kGap : 0);
  const std::size_t left = width - std::min(place, width);
  const std::size_t least = std::max(kLeastProse, static_cast<std::size_t>(kLeastProse_share * static_cast<double>(width)));
  const bool is_wide = left >= std::max(least, longest_word(prose));
  if (place == 0 || is_wide || width_of(prose) <= left) {
    const std::string beside = wrapped(prose, std::string(place, ' '), width);
    return line + beside.substr(used) + "\n";
  }
  return without_trailing_blanks(line) + wrapped(prose, std::string(kProseIndent, ' '), width) + "\n";
}

std::string text_of(Table table, const RenderOptions& options) {
  for (std::vector<Text>& row : table.rows) {
    for (Text& cell : row) {
      cell.words = printable(std::move(cell.words));
    }
  }
  std::vector<std::size_t> widths = widths_of(table);
  std::vector<std::size_t> shown = shown_columns(table, widths, options.width);
  if (shown.empty()) {
    return "";
  }
  const bool has_prose = table.columns[shown.back()].is_prose;
  if (has_prose) {
    shown.pop_back();
  }
  fit(widths, shown, table, options.width);
  constexpr std::size_t kEndless = 1'000'000;
  const std::size_t prose_width = options.breaks_rows ? options.width : kEndless;
  const std::string gap(kGap, ' ');
  std::size_t used = shown.empty() ? 0 : kGap * (shown.size() - 1);
  for (const std::size_t i : shown) {
    used += widths[i];
  }
  const auto line_of = [&](const auto& cell_of) {
    std::string line;
    for (const std::size_t i : shown) {
      const auto [words, tone] = cell_of(i);
      line += (i == shown.front() ? "" : gap) + toned(padded(words, widths[i], table.columns[i].alignment), tone, options.with_colors);
    }
    return line;
  };
  std::string text = table.title.empty() ? "" : wrapped(printable(table.title), "", options.width) + "\n";
  if (std::ranges::any_of(table.columns, [](const Column& column) { return !head_of(column).empty(); })) {
    text += with_prose(line_of([&](std::size_t i) { return Text{head_of(table.columns[i])}; }), used,
                       has_prose ? head_of(table.columns.back()) : "", prose_width);
  }
  for (const std::vector<Text>& row : table.rows) {
    text += with_prose(line_of([&](std::size_t i) { return row[i]; }), used, has_prose ? row.back().words : "", prose_width);
  }
  return text;
}

/// Returns the first cell of each row, without blanks around it.
std::string names_in(const Document& document) {
  std::string text;
  for (const Table& table : document.tables) {
    for (const std::vector<Text>& row : table.rows) {
      text += printable(row.front().words) + "\n";
    }
  }
  return text;
}

std::string text_of(const Listing& listing, const RenderOptions& options) {
  std::string lines = listing.lines;
  std::ranges::replace_if(
      lines, [](unsigned char c) { return (c < ' ' && c != '\n') || c == 0x7f; }, '?');
  if (options.is_terminal && listing.is_prose) {
    lines = folded(lines, options.width);
  }
  return (listing.title.empty() ? "" : wrapped(printable(listing.title), "", options.width) + "\n") + lines;
}

std::string text_of(const std::vector<Note>& notes, const RenderOptions& options) {
  const std::vector<Note> sorted = by_urgency(notes);
  const std::size_t most = options.explains ? sorted.size() : std::min(sorted.size(), kMostNotes);
  std::string text;
  for (std::size_t i = 0; i < most; ++i) {
    const bool is_warning = sorted[i].severity == Severity::warning;
    text += wrapped((is_warning ? "warning: " : "") + printable(sorted[i].words), "- ", options.width) + "\n";
  }
  if (most < sorted.size()) {
    const std::size_t more = sorted.size() - most;
    const auto warnings = std::count_if(sorted.begin() + static_cast<std::ptrdiff_t>(most), sorted.end(),
                                        [](const Note& each) { return each.severity == Severity::warning; });
    const std::string of_warnings = warnings > 0 ? fmt::format(", {} of them warning{}", warnings, warnings == 1 ? "" : "s") : "";
    text += wrapped(fmt::format("{} more note{}{}: add --explain", more, more == 1 ? "" : "s", of_warnings), "- ", options.width) + "\n";
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

std::string render_terminal(const Document& document, const RenderOptions& given) {
  RenderOptions options = given;
  options.width = std::max(options.width, kLeastWidth);
  std::string text = text_of(document.headline, options);
  if (options.is_quiet) {
    return document.headline.empty() ? names_in(document) : text;
  }
  for (const std::string& paragraph : document.paragraphs) {
    text += wrapped(printable(paragraph), "", options.width) + "\n";
  }
  const auto add_block = [&text](const std::string& block) { text += (text.empty() || block.empty() ? "" : "\n") + block; };
  for (const Table& table : document.tables) {
    add_block(text_of(table, options));
  }
  const auto add_listings = [&](bool before_notes) {
    for (const Listing& listing : document.listings) {
      if (listing.precedes_notes == before_notes) {
        add_block(text_of(listing, options));
      }
    }
  };
  add_listings(true);
  std::vector<Note> notes = document.notes;
  for (const Table& table : document.tables) {
    if (std::string legend = legend_of(table, shown_columns(table, widths_of(table), options.width)); !legend.empty()) {
      notes.push_back({Severity::background, std::move(legend)});
    }
  }
  add_block(text_of(notes, options));
  for (const std::string& file : document.files) {
    text += wrapped(printable(file), "written: ", options.width) + "\n";
  }
  add_listings(false);
  return text;
}

}  // namespace

Renderer terminal() { return {.name = {}, .file_ending = {}, .summary = "plain text, as wide as the terminal", .render = render_terminal}; }

}  // namespace heatsoak::present::renderers
