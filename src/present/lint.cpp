#include "present/lint.h"

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

namespace heatsoak::present {

Document lint_document(const duty::FilesLint& lint) {
  const std::size_t files = lint.files.size();
  const std::size_t errors = lint.count(motor::LintFinding::Level::error);
  const std::size_t warnings = lint.count(motor::LintFinding::Level::warning);
  const bool is_sound = errors + warnings == 0 && !lint.unreadable;
  Document document{
      .headline = {{fmt::format("{} file{}: {}", files, files == 1 ? "" : "s",
                                is_sound ? "sound"
                                         : fmt::format("{}{} error{}, {} warning{}", lint.unreadable ? "some cannot be read, " : "", errors,
                                                       errors == 1 ? "" : "s", warnings, warnings == 1 ? "" : "s")),
                    is_sound ? Tone::good : Tone::bad}},
      .paragraphs = {}};
  Listing listing{.title = {}, .lines = {}, .is_prose = true, .precedes_notes = true};
  if (lint.unreadable) {
    listing.lines += fmt::format("{}\n", lint.unreadable->what());
  }
  std::vector<std::string> on_estimates;
  for (const motor::LintFinding& each : lint.findings) {
    if (each.level != motor::LintFinding::Level::note) {
      listing.lines += fmt::format("{}: {}: {}\n", base::to_string(each.at), motor::to_string(each.level), motor::words_of(each));
      continue;
    }
    std::string words = fmt::format("{}: {}", base::to_string(base::Location{each.at.file, each.at.line}), motor::words_of(each));
    if (each.check == motor::kEstimatesCheck) {
      on_estimates.push_back(std::move(words));
    } else {
      document.add_note(Severity::note, std::move(words));
    }
  }
  // Only three notes are shown: missing values prevent an answer, estimates make it less accurate.
  for (std::string& words : on_estimates) {
    document.add_note(Severity::note, std::move(words));
  }
  if (!listing.lines.empty()) {
    document.listings.push_back(std::move(listing));
  }
  document.data = lint_json(lint);
  return document;
}

}  // namespace heatsoak::present
