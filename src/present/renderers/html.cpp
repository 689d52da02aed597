#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/xml_text.h"
#include "present/renderer.h"

namespace heatsoak::present::renderers {
namespace {

constexpr std::string_view kStyle =
    "body{font:15px/1.5 sans-serif;max-width:70em;margin:2em auto;padding:0 1em}table{border-collapse:collapse;margin:1em 0}"
    "th,td{padding:.2em .7em;border-bottom:1px solid #ddd;text-align:left;vertical-align:top}.number{text-align:right}"
    ".good{color:#1a7f37}.undecided{color:#9a6700}.bad{color:#cf222e}h1{font-size:1.3rem}h2{font-size:1.1rem}.lead{font-weight:bold}td."
    "number{white-space:nowrap}"
    "pre{background:#f6f8fa;padding:1em}";

/// Returns the text with XML entities; control characters become '?'.
std::string in_html(std::string_view text) { return base::xml_text(text); }

std::string_view class_of(Tone tone) {
  constexpr std::array<std::string_view, 4> kClasses{"", "good", "undecided", "bad"};
  return kClasses.at(static_cast<std::size_t>(tone));
}

std::string table_of(const Table& table) {
  std::string text = table.title.empty() ? "" : fmt::format("<h2>{}</h2>\n", in_html(table.title));
  text += "<table>\n";
  if (!std::ranges::all_of(table.columns, [](const Column& each) { return each.name.empty(); })) {
    text += "<tr>";
    for (const Column& column : table.columns) {
      text += fmt::format("<th{}>{}{}</th>", column.alignment == Alignment::right ? " class=\"number\"" : "", in_html(column.name),
                          column.unit.empty() ? "" : fmt::format(" / {}", in_html(column.unit)));
    }
    text += "</tr>\n";
  }
  for (const std::vector<Text>& row : table.rows) {
    text += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) {
      text += fmt::format("<td class=\"{} {}\">{}</td>", table.columns[i].alignment == Alignment::right ? "number" : "",
                          class_of(row[i].tone), in_html(row[i].words));
    }
    text += "</tr>\n";
  }
  return text + "</table>\n";
}

std::string render_html(const Document& document, const RenderOptions& /*options*/) {
  std::string text =
      fmt::format("<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>{}</title><style>{}</style></head>\n<body>\n",
                  document.headline.empty() ? "Heatsoak" : in_html(document.headline.front().words), kStyle);
  for (const Text& sentence : document.headline) {
    const std::string_view element = &sentence == &document.headline.front() ? "h1" : "p";
    text += fmt::format("<{0} class=\"lead {1}\">{2}</{0}>\n", element, class_of(sentence.tone), in_html(sentence.words));
  }
  for (const std::string& paragraph : document.paragraphs) {
    text += fmt::format("<p>{}</p>\n", in_html(paragraph));
  }
  for (const Table& table : document.tables) {
    text += table_of(table);
  }
  text += document.notes.empty() ? "" : "<ul>\n";
  for (const Note& note : by_urgency(document.notes)) {
    text += fmt::format("<li>{}{}</li>\n", note.severity == Severity::warning ? "<b>warning:</b> " : "", in_html(note.words));
  }
  text += document.notes.empty() ? "" : "</ul>\n";
  for (const std::string& file : document.files) {
    text += fmt::format("<p>written: {}</p>\n", in_html(file));
  }
  for (const Listing& listing : document.listings) {
    text += listing.title.empty() ? "" : fmt::format("<h2>{}</h2>\n", in_html(listing.title));
    text += fmt::format("<pre>{}</pre>\n", in_html(listing.lines));
  }
  return text + "</body>\n</html>\n";
}

}  // namespace

Renderer html() {
  return {.name = {}, .file_ending = ".html", .summary = "one HTML page with every column and every note", .render = render_html};
}

}  // namespace heatsoak::present::renderers
