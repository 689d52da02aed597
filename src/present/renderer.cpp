#include "present/renderer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

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
  throw base::Failure(base::ExitCode::bad_input,
                      fmt::format("{}: there is no format '{}'; expected a name that ends in {}", file, ending, fmt::join(known, " or ")));
}

std::vector<Note> by_urgency(std::vector<Note> notes) {
  std::ranges::stable_sort(notes, std::ranges::greater(), &Note::severity);
  return notes;
}

}  // namespace heatsoak::present
