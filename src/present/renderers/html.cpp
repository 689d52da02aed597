#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <initializer_list>

#include "base/xml_text.h"
#include "present/renderer.h"

namespace heatsoak::present::renderers {
namespace {

constexpr std::string_view kStyle =
    "body{font:15px/1.5 sans-serif;max-width:70em;margin:2em auto;padding:0 1em}table{border-collapse:collapse;margin:1em 0}"
    "th,td{padding:.2em .7em;border-bottom:1px solid #ddd;text-align:left;vertical-align:top}.number{text-align:right}"
    ".good{color:#1a7f37}.undecided{color:#9a6700}.bad{color:#cf222e}h1{font-size:1.3rem}h2{font-size:1.1rem}.lead{font-weight:bold}td."
    "number{white-space:nowrap}"
    "pre{background:#f6f8fa;padding:1em}code{background:#f6f8fa;padding:0 .2em}.picture svg{max-width:100%;height:auto}";

/// Returns the text with XML entities; control characters become '?', and text between backticks becomes code.
std::string in_html(std::string_view text) {
  std::string html;
  bool is_code = false;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = text.find('`', begin);
    html += base::xml_text(text.substr(begin, end - begin));
    if (end == std::string_view::npos) {
      break;
    }
    // A backtick without a partner stays as it is.
    const bool has_partner = is_code || text.find('`', end + 1) != std::string_view::npos;
    html += !has_partner ? "`" : is_code ? "</code>" : "<code>";
    is_code = has_partner && !is_code;
    begin = end + 1;
  }
  return html;
}

/// Returns ` class="…"` with the names that are not empty; nothing if all are.
std::string classes(std::initializer_list<std::string_view> names) {
  std::string all;
  for (const std::string_view name : names) {
    all += name.empty() ? "" : fmt::format("{}{}", all.empty() ? "" : " ", name);
  }
  return all.empty() ? "" : fmt::format(" class=\"{}\"", all);
}

std::string_view class_of(Tone tone) {
  constexpr std::array<std::string_view, 4> kClasses{"", "good", "undecided", "bad"};
  return kClasses.at(static_cast<std::size_t>(tone));
}

std::string_view class_of(Alignment alignment) { return alignment == Alignment::right ? "number" : ""; }

/// Returns the chart as an element of the page, without the head of an SVG file.
std::string picture_of(const report::Chart& chart) {
  const std::string svg = report::draw_svg(chart);
  return fmt::format("<div class=\"picture\">{}</div>\n", svg.substr(svg.find("<svg")));
}

std::string table_of(const Table& table) {
  std::string text = table.title.empty() ? "" : fmt::format("<h2>{}</h2>\n", in_html(table.title));
  text += "<table>\n";
  if (!std::ranges::all_of(table.columns, [](const Column& each) { return each.name.empty(); })) {
    text += "<tr>";
    for (const Column& column : table.columns) {
      text += fmt::format("<th{}>{}{}</th>", classes({class_of(column.alignment)}), in_html(column.name),
                          column.unit.empty() ? "" : fmt::format(" / {}", in_html(column.unit)));
    }
    text += "</tr>\n";
  }
  for (const std::vector<Text>& row : table.rows) {
    text += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) {
      text += fmt::format("<td{}>{}</td>", classes({class_of(table.columns[i].alignment), class_of(row[i].tone)}), in_html(row[i].words));
    }
    text += "</tr>\n";
  }
  return text + "</table>\n";
}

std::string listings_in_html(const std::vector<Listing>& listings, bool before_notes) {
  std::string text;
  for (const Listing& listing : listings) {
    if (listing.precedes_notes == before_notes) {
      text += listing.title.empty() ? "" : fmt::format("<h2>{}</h2>\n", in_html(listing.title));
      text += fmt::format("<pre>{}</pre>\n", base::xml_text(listing.lines));
    }
  }
  return text;
}

std::string render_html(const Document& document, const RenderOptions& /*options*/) {
  std::string text =
      fmt::format("<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>{}</title><style>{}</style></head>\n<body>\n",
                  document.headline.empty() ? "Heatsoak" : base::xml_text(document.headline.front().words), kStyle);
  for (const Text& sentence : document.headline) {
    const std::string_view element = &sentence == &document.headline.front() ? "h1" : "p";
    text += fmt::format("<{0}{1}>{2}</{0}>\n", element, classes({"lead", class_of(sentence.tone)}), in_html(sentence.words));
  }
  for (const std::string& paragraph : document.paragraphs) {
    text += fmt::format("<p>{}</p>\n", in_html(paragraph));
  }
  for (const report::Chart& chart : document.charts) {
    text += picture_of(chart);
  }
  for (const Table& table : document.tables) {
    text += table_of(table);
  }
  text += listings_in_html(document.listings, true);
  const std::vector<Note> notes = notes_with_legends(document);
  text += notes.empty() ? "" : "<ul>\n";
  for (const Note& note : notes) {
    text += fmt::format("<li>{}{}</li>\n", note.severity == Severity::warning ? "<b>warning:</b> " : "", in_html(note.words));
  }
  text += notes.empty() ? "" : "</ul>\n";
  for (const std::string& file : document.files) {
    text += fmt::format("<p>written: {}</p>\n", in_html(file));
  }
  text += listings_in_html(document.listings, false);
  return text + "</body>\n</html>\n";
}

}  // namespace

Renderer html() {
  return {.name = {}, .file_ending = ".html", .summary = "one HTML page with every column and every note", .render = render_html};
}

}  // namespace heatsoak::present::renderers
