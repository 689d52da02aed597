#include "present/renderer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <utility>

#include "base/diagnostic.h"
#include "present/renderers_registry.h"

namespace heatsoak::present {

const std::vector<Renderer>& all_renderers() {
  static const std::vector<Renderer> all = [] {
    std::vector<Renderer> made;
    for (const auto& [name, make] : renderers::registry) {
      made.push_back(make());
      made.back().name = name;
    }
    return made;
  }();
  return all;
}

std::string terminal_text(const Document& document, const RenderOptions& options) {
  return std::ranges::find(all_renderers(), "terminal", &Renderer::name)->render(document, options);
}

std::string rendered_as(std::string_view name, const Document& document) {
  return std::ranges::find(all_renderers(), name, &Renderer::name)->render(document, {.explains = true});
}

std::string rendered_for(const std::string& file, const Document& document) {
  const std::string ending = std::filesystem::path(file).extension().string();
  std::vector<std::string_view> known;
  for (const Renderer& each : all_renderers()) {
    if (each.file_ending.empty()) {
      continue;
    }
    if (each.file_ending == ending) {
      return each.render(document, {.explains = true});
    }
    known.push_back(each.file_ending);
  }
  throw base::Failure(base::ExitCode::bad_input, fmt::format("{}: there is no format '{}'; expected a name that ends in one of {}", file,
                                                             ending, fmt::join(known, ", ")));
}

std::vector<Note> by_urgency(std::vector<Note> notes) {
  std::ranges::stable_sort(notes, std::ranges::greater(), &Note::severity);
  return notes;
}

std::string legend_of(const Table& table, std::span<const std::size_t> shown) {
  std::string text;
  for (const std::size_t i : shown) {
    if (const Column& column = table.columns[i]; !column.meaning.empty()) {
      text += fmt::format("{}{}: {}", text.empty() ? "Columns. " : "; ", column.name, column.meaning);
    }
  }
  return text.empty() ? text : text + ".";
}

std::vector<Note> notes_with_legends(const Document& document) {
  std::vector<Note> notes = document.notes;
  for (const Table& table : document.tables) {
    std::vector<std::size_t> all(table.columns.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    if (std::string legend = legend_of(table, all); !legend.empty()) {
      notes.push_back({Severity::background, std::move(legend)});
    }
  }
  return by_urgency(std::move(notes));
}

}  // namespace heatsoak::present
