#include "present/lint.h"

#include <fmt/format.h>

namespace heatsoak::present {

Document lint_document(const duty::FilesLint& lint) {
  const std::size_t files = lint.files.size();
  const std::size_t errors = lint.count(motor::LintFinding::Level::error);
  const std::size_t warnings = lint.count(motor::LintFinding::Level::warning);
  const bool is_sound = errors + warnings == 0;
  Document document{.headline = {{fmt::format("{} file{}: {}", files, files == 1 ? "" : "s",
                                              is_sound ? "sound"
                                                       : fmt::format("{} error{}, {} warning{}", errors, errors == 1 ? "" : "s", warnings,
                                                                     warnings == 1 ? "" : "s")),
                                  is_sound ? Tone::good : Tone::bad}},
                    .paragraphs = {}};
  Listing listing{.title = {}, .lines = {}, .is_prose = true};
  for (const motor::LintFinding& each : lint.findings) {
    if (each.level == motor::LintFinding::Level::note) {
      document.add_note(Severity::note, fmt::format("{}:{}: {}", each.at.file, each.at.line, motor::words_of(each)));
      continue;
    }
    listing.lines +=
        fmt::format("{}:{}:{}: {}: {}\n", each.at.file, each.at.line, each.at.column, motor::to_string(each.level), motor::words_of(each));
  }
  if (!listing.lines.empty()) {
    document.listings.push_back(std::move(listing));
  }
  return document;
}

}  // namespace heatsoak::present
