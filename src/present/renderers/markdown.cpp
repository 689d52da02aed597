#include <fmt/format.h>

#include "present/renderer.h"

namespace heatsoak::present::renderers {
namespace {

/// Escapes characters that Markdown would interpret, and replaces control characters by '?'.
std::string escaped(std::string_view text) {
  constexpr std::string_view kSpecial = "\\`*_[]<>|#";
  std::string result;
  for (const char c : text) {
    if (kSpecial.find(c) != std::string_view::npos) {
      result += '\\';
    }
    result += (static_cast<unsigned char>(c) < ' ' || c == 0x7f) ? '?' : c;
  }
  return result;
}

std::string text_of(const Table& table) {
  std::string text = table.title.empty() ? "" : fmt::format("### {}\n\n", escaped(table.title));
  std::string rule = "|";
  text += "|";
  for (const Column& column : table.columns) {
    text += fmt::format(" {}{} |", escaped(column.name), column.unit.empty() ? "" : fmt::format(" / {}", escaped(column.unit)));
    rule += column.alignment == Alignment::right ? "---:|" : "---|";
  }
  text += fmt::format("\n{}\n", rule);
  for (const std::vector<Text>& row : table.rows) {
    text += "|";
    for (const Text& cell : row) {
      text += fmt::format(" {} |", escaped(cell.words));
    }
    text += "\n";
  }
  return text + "\n";
}

std::string listings_in_markdown(const std::vector<Listing>& listings, bool before_notes) {
  std::string text;
  for (const Listing& listing : listings) {
    if (listing.precedes_notes == before_notes) {
      text += listing.title.empty() ? "" : fmt::format("\n{}\n", escaped(listing.title));
      text += fmt::format("\n```\n{}{}```\n", listing.lines, listing.lines.ends_with('\n') ? "" : "\n");
    }
  }
  return text;
}

std::string render_markdown(const Document& document, const RenderOptions& /*options*/) {
  std::string text;
  for (const Text& sentence : document.headline) {
    text += fmt::format("**{}**\n\n", escaped(sentence.words));
  }
  for (const std::string& paragraph : document.paragraphs) {
    text += escaped(paragraph) + "\n\n";
  }
  for (const Table& table : document.tables) {
    text += text_of(table);
  }
  if (const std::string listings = listings_in_markdown(document.listings, true); !listings.empty()) {
    text += listings + "\n";
  }
  for (const Note& note : notes_with_legends(document)) {
    text += fmt::format("- {}{}\n", note.severity == Severity::warning ? "warning: " : "", escaped(note.words));
  }
  for (const std::string& file : document.files) {
    text += fmt::format("\nwritten: {}\n", escaped(file));
  }
  text += listings_in_markdown(document.listings, false);
  return text;
}

}  // namespace

Renderer markdown() {
  return {.name = {}, .file_ending = ".md", .summary = "Markdown with every column and every note", .render = render_markdown};
}

}  // namespace heatsoak::present::renderers
